"""Tools of art and sound: colours, fields and shading, sheets, drawings as text, PNG, a synthesiser."""
