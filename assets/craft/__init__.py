"""Tools to make art and sound: colours, shading, sprite sheets, drawings as text, PNG and Ogg files, a synthesiser."""
