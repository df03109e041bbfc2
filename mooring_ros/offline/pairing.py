"""Which series of a result belongs to which of a reference."""

import difflib

FAIRLEAD = ".fairlead_tension"
TENSION = "_tension"


def pair_names(result, reference, mapping=()):
    """List of (name in result, name in reference): those of mapping first, then equal names that mapping leaves over.

    Of the equal names only the tensions, where there are any; wrenches beside them have to be asked for by mapping.
    result, reference: names in their order; mapping: (A, B) pairs. A name of a line stands for all its series, or, against one
    single series, for its fairlead tension. Raises ValueError for a name that is not there, and when nothing pairs.
    """
    result, reference = list(result), list(reference)
    pairs = []
    for a, b in mapping:
        pairs += _mapped(a, b, result, reference)
    taken_result, taken_reference = {a for a, _ in pairs}, {b for _, b in pairs}
    equal = [name for name in result if name in reference and name not in taken_result and name not in taken_reference]
    tensions = [name for name in equal if name.endswith(TENSION)]
    pairs += [(name, name) for name in tensions or equal]
    if not pairs:
        raise ValueError(
            f"no names in common: the result has {listed(result)}; the reference has {listed(reference)}; expected --map A=B for names that differ"
        )
    return pairs


def listed(names, most=12):
    """Names in a row, shortened when there are many."""
    names = list(names)
    return ", ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "") if names else "no series"


def _mapped(a, b, result, reference):
    of_a, of_b = _series(a, result, "result"), _series(b, reference, "reference")
    if a in of_a.values() or b in of_b.values():
        return [(_single(a, of_a), _single(b, of_b))]
    both = [suffix for suffix in of_a if suffix in of_b]
    if not both:
        raise ValueError(f"--map {a}={b}: {listed(of_a.values())} and {listed(of_b.values())} have no quantity in common")
    return [(of_a[suffix], of_b[suffix]) for suffix in both]


def _series(name, names, whose):
    """{suffix: series} that a name of --map stands for."""
    if name in names:
        return {"": name}
    found = {full[len(name) :]: full for full in names if full.startswith(name + ".")}
    if not found:
        near = difflib.get_close_matches(name, names, n=1)
        raise ValueError(f"--map: the {whose} has no {name!r}, expected {near[0] if near else 'one of ' + listed(names)}")
    return found


def _single(name, series):
    if "" in series:
        return series[""]
    if FAIRLEAD in series:
        return series[FAIRLEAD]
    raise ValueError(f"--map: {name!r} stands for {listed(series.values())}, expected the name of one of them")
