"""How answers are shown: text, tables, charts and drawings for terminal, page, notebook and JSON."""
