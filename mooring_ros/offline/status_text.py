"""The picture of `mooring status` as text for a terminal."""

import re

LEVELS = ("ok", "WARN", "ERROR", "stale")
_COLOURS = ("32", "33", "31", "35")  # ANSI: green, yellow, red, magenta
_BAR = 30  # characters
# Values that are shown behind a status; the rest are counts at nought, or repeat the message.
_TOLD = re.compile(r"delay|\(ms\)|\(Hz\)|factor|worst|missed|lost|doubled|step \(s\)|limited by|largest|written|steps|transitions|priority|\(s\)$|mode|"
                   "damping|behind")


def status_text(picture, colour=False):
    """The lines of the picture (see status_view.View.picture)."""
    paint = _paint if colour else lambda text, _: text
    lines = [_head(picture, paint)]
    for name, status in picture["statuses"].items():
        level = min(status["level"], len(LEVELS) - 1)
        lines.append(f"{name:<10} {paint(f'{LEVELS[level]:<5}', _COLOURS[level])}  {status['message']}")
        told = [f"{key} {value}" for key, value in status["values"].items() if _TOLD.search(key) and value not in ("", "0", status["message"])]
        lines += [f"{'':<18}{row}" for row in _rows(told)]
    for name, wrench in {"wrench": picture["wrench"], **picture["platforms"]}.items():
        if wrench is None:
            continue
        lines += ["", f"{name:<10}  {_rate(wrench)}, stamp {wrench['stamp']:.3f} s, in frame {wrench['frame'] or '(none)'}",
                  f"            force   {_vector(wrench['force'])} N", f"            torque  {_vector(wrench['torque'])} N m"]
    if picture["lines"]:
        most = max(line["highest_tension"] for line in picture["lines"]) or 1.0
        lines += ["", f"{'line':<12}{'fairlead tension (N)':>22}  {'highest':>12}  {'length (m)':>12}  {'rate (m/s)':>11}"]
        lines += [_line(line, most, paint) for line in picture["lines"]]
    return "\n".join(lines)


def _head(picture, paint):
    if picture["silent"]:
        since = picture["since_diagnostics"]
        return paint(f"{picture['node']}: silent" + ("" if since is None else f" for {since:.1f} s"), _COLOURS[2])
    level = min(picture["level"], len(LEVELS) - 1)
    return f"{picture['node']}: {paint(LEVELS[level], _COLOURS[level])}"


def _rows(told, width=110):
    """Pieces joined by semicolons, no row longer than width."""
    rows = []
    for piece in told:
        if rows and len(rows[-1]) + len(piece) + 2 <= width:
            rows[-1] += f"; {piece}"
        else:
            rows.append(piece)
    return rows


def _rate(wrench):
    return "one heard" if wrench["rate"] is None else f"{wrench['rate']:.1f} Hz, last {1e3 * wrench['age']:.0f} ms ago"


def _vector(values):
    return " ".join(f"{value:>13.5g}" for value in values)


def _line(line, most, paint):
    filled = round(_BAR * max(line["fairlead_tension"], 0.0) / most)
    bar = paint("█" * filled, "36") + "·" * (_BAR - filled)
    return (f"{line['name']:<12}{line['fairlead_tension']:>22.5g}  {line['highest_tension']:>12.5g}  {line['length']:>12.4f}  "
            f"{line['length_rate']:>+11.4f}  {bar}")


def _paint(text, colour):
    return f"\x1b[{colour}m{text}\x1b[0m"
