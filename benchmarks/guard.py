"""What the guard against blow-ups costs: runs beside those of a build in which it is removed (`removed.py`), in turns."""

from . import effects, removed, tables

GOAL = 0.03


def run(quick=False):
    """Prints the table."""
    found = effects.compare([removed.GUARD], 2 if quick else effects.PAIRS, 7 if quick else effects.TURNS)
    more, error = found["run"]
    row = [f"three OC4 chains of {effects.SEGMENTS} segments", f"{100 * more:+.1f} ± {100 * error:.1f} %"]
    content = {"guard": tables.table(["", "a run with the guard takes more by"], [row])}
    print(content["guard"], flush=True)
    failed = [f"the guard costs {100 * more:.1f} %, goal {100 * GOAL:g} %"] if more - 2.0 * error > GOAL else []
    return {"more": more, "error": error, "tables": content, "failed": failed}
