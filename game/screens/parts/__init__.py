"""The pieces that screens are made of: lists of rows, the panel, lines, cards and what lies behind them."""
