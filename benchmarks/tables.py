"""Markdown tables, and the places in a document that they refresh."""

import re


def table(header, rows):
    """A Markdown table; all cells are shown by str, the first column to the left and the others to the right."""
    cells = [list(map(str, row)) for row in [header, *rows]]
    widths = [max(len(row[k]) for row in cells) for k in range(len(header))]
    lines = ["| " + " | ".join(c.ljust(w) if k == 0 else c.rjust(w) for k, (c, w) in enumerate(zip(row, widths, strict=True))) + " |" for row in cells]
    rule = "| " + " | ".join("-" * w if k == 0 else "-" * (w - 1) + ":" for k, w in enumerate(widths)) + " |"
    return "\n".join([lines[0], rule, *lines[1:]])


def refresh(text, name, content):
    """The document's text with what stands between ``<!-- NAME -->`` and ``<!-- /NAME -->`` replaced; KeyError when the markers are missing."""
    pattern = re.compile(rf"(<!-- {re.escape(name)} -->\n).*?(<!-- /{re.escape(name)} -->)", re.DOTALL)
    text, count = pattern.subn(lambda m: f"{m[1]}{content}\n{m[2]}", text)
    if count != 1:
        raise KeyError(f"the document has {count} pairs of markers named {name}, expected one")
    return text
