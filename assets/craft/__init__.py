"""What art and sound are made with: colours, fields and shading, sheets, drawings as text, PNG, a synthesiser."""
