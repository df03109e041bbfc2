"""Self-contained HTML reports: one file, no network, light, readable, printable.

A report is a title and sections; a section is a heading and HTML made by the functions below, which escape every text
they are given. Figures go in as SVG, so they stay sharp on paper.
"""

import html
import io
import os
import re
from dataclasses import dataclass
from pathlib import Path

import matplotlib

_STYLE = """
:root { color-scheme: light; }
body { margin: 0 auto; max-width: 62rem; padding: 2rem 1.5rem 4rem; background: #fff; color: #1c2530;
       font: 16px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", Arial, sans-serif; }
h1 { font-size: 1.75rem; line-height: 1.2; margin: 0 0 .5rem; }
h2 { font-size: 1.2rem; margin: 2.25rem 0 .5rem; padding-bottom: .25rem; border-bottom: 1px solid #d5dce4; }
p { margin: .5rem 0; max-width: 48rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; margin: .75rem 0; font-size: .875rem; font-variant-numeric: tabular-nums; }
th, td { padding: .3rem .75rem; text-align: left; border-bottom: 1px solid #e4e9ef; }
th { border-bottom: 2px solid #aab6c3; font-weight: 600; vertical-align: bottom; }
th.number, td.number { text-align: right; }
td.number { white-space: nowrap; }
figure { margin: 1rem 0 1.5rem; break-inside: avoid; }
figure svg { max-width: 100%; height: auto; display: block; }
figcaption { color: #51606f; font-size: .875rem; margin-top: .25rem; }
caption { color: #51606f; font-size: .875rem; text-align: left; caption-side: bottom; padding-top: .35rem; }
@media print { body { max-width: none; padding: 0; font-size: 11pt; } h2 { break-after: avoid; } tr { break-inside: avoid; } }
"""

# Same figure, same bytes: no date and no random identifiers in the SVG.
_SVG_SETTINGS = {"svg.hashsalt": "mooring_ros", "svg.fonttype": "path"}
_SVG_METADATA = {"Date": None, "Creator": None, "Format": None, "Type": None}


@dataclass(frozen=True)
class Section:
    """A heading (plain text) and the HTML below it, as `table`, `figure` and `paragraph` build it."""

    heading: str
    html: str


def paragraph(text):
    """HTML of one paragraph of plain text."""
    return f"<p>{html.escape(str(text))}</p>\n"


def table(headers, rows, caption=None):
    """HTML of a table. headers: texts; rows: sequences of cells as long as headers; numbers are set right-aligned.

    Floats are shown with five significant digits; pass a string where another form is wanted. None is shown as a dash.
    Raises ValueError when a row is not as long as the headers.
    """
    headers = [str(header) for header in headers]
    rows = [list(row) for row in rows]
    for row in rows:
        if len(row) != len(headers):
            raise ValueError(f"a row of {len(row)} cells in a table of {len(headers)} columns: {row}")
    numeric = [bool(rows) and all(_is_number(row[column]) for row in rows) for column in range(len(headers))]
    head = "".join(_cell("th", text, number) for text, number in zip(headers, numeric))
    body = "".join(
        "<tr>" + "".join(_cell("td", _text(cell), number) for cell, number in zip(row, numeric)) + "</tr>\n" for row in rows
    )
    note = f"<caption>{html.escape(str(caption))}</caption>" if caption else ""
    return f'<div class="scroll"><table>{note}<thead><tr>{head}</tr></thead>\n<tbody>\n{body}</tbody></table></div>\n'


def figure(fig, caption):
    """HTML of a matplotlib figure with its caption (plain text)."""
    stream = io.StringIO()
    with matplotlib.rc_context(_SVG_SETTINGS):
        fig.savefig(stream, format="svg", metadata=_SVG_METADATA)
    caption = html.escape(str(caption))
    svg = _inline(stream.getvalue()).replace("<svg ", f'<svg role="img" aria-label="{caption}" ', 1)
    return f"<figure>\n{svg}\n<figcaption>{caption}</figcaption>\n</figure>\n"


def document(title, sections):
    """The whole report as HTML text. sections: sequence of Section."""
    title = html.escape(str(title))
    body = "".join(f"<section>\n<h2>{html.escape(str(section.heading))}</h2>\n{section.html}</section>\n" for section in sections)
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{title}</title>\n<style>{_STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n{body}</body>\n</html>\n"
    )


def write_report(path, title, sections):
    """Write the report to path, in one move: a report is never half there. Raises OSError."""
    path = Path(path)
    part = path.with_name(path.name + ".part")
    try:
        part.write_text(document(title, sections), encoding="utf-8")
        os.replace(part, path)
    except OSError:
        part.unlink(missing_ok=True)
        raise


def _inline(svg):
    """SVG as HTML takes it: the element alone, without prologue, metadata and namespaces (HTML knows them)."""
    svg = svg[svg.index("<svg"):]
    svg = re.sub(r"<metadata>.*?</metadata>\s*", "", svg, flags=re.DOTALL)
    return re.sub(r'\s+xmlns(:\w+)?="[^"]*"', "", svg)


def _is_number(cell):
    if cell is None or isinstance(cell, (int, float)):
        return True
    text = str(cell).strip().removesuffix("%").strip()
    if text in ("", "–", "-"):
        return True
    try:
        float(text.replace("−", "-").replace(",", ""))
    except ValueError:
        return False
    return True


def _text(cell):
    if cell is None:
        return "–"
    if isinstance(cell, float):
        return f"{cell:.5g}"
    return str(cell)


def _cell(tag, text, number):
    kind = ' class="number"' if number else ""
    return f"<{tag}{kind}>{html.escape(text)}</{tag}>"
