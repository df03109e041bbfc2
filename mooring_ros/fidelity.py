"""How much physics each line has: one word for all of them, or line by line."""

from collections.abc import Mapping

FIDELITIES = ("dynamic", "quasi_static", "linear")
DEFAULT = "default"
EXPECTED = f"one of {', '.join(FIDELITIES)}, or line by line as in line1=dynamic,line2=quasi_static,{DEFAULT}=linear"


def is_by_line(fidelity):
    """Whether `fidelity` is given line by line: a mapping, or a text with commas or equals signs."""
    return isinstance(fidelity, Mapping) or isinstance(fidelity, str) and ("=" in fidelity or "," in fidelity)


def parsed(fidelity):
    """The dict of line name (or "default") -> fidelity that a mapping or a text says. Raises ValueError.

    A text is a list with commas of NAME=FIDELITY; a fidelity alone, or that of "default", is for the lines that are not named (dynamic without it).
    """
    if isinstance(fidelity, str):
        parts = [part if "=" in part else f"{DEFAULT}={part}" for part in fidelity.split(",")]
        pairs = [tuple(word.strip() for word in part.split("=", 1)) for part in parts]
    else:
        pairs = list(fidelity.items())
    chosen = {}
    for name, word in pairs:
        if word not in FIDELITIES:
            raise ValueError(f"fidelity of {name} is {word!r}; expected {EXPECTED}")
        if name in chosen:
            raise ValueError(f"fidelity of {name} is given twice; expected {EXPECTED}")
        chosen[name] = word
    return chosen


def of_lines(fidelity, line_names):
    """Dict of every line's fidelity, in the order of `line_names`. Raises ValueError."""
    chosen = parsed(fidelity)
    unknown = [name for name in chosen if name not in line_names and name != DEFAULT]
    if unknown:
        raise ValueError(f"fidelity names {unknown[0]!r}, which is no line; expected {', '.join(line_names)} or {DEFAULT}")
    return {name: chosen.get(name, chosen.get(DEFAULT, FIDELITIES[0])) for name in line_names}


def check(fidelity):
    """Raises ValueError unless `fidelity` is one word, or well written line by line."""
    if is_by_line(fidelity):
        parsed(fidelity)
    elif fidelity not in FIDELITIES:
        raise ValueError(f"fidelity {fidelity!r} is not built; expected {EXPECTED}")
