"""Whether the twist of a recorded motion moves its pose."""

from mooring_ros.motion.convention_check import FAILS, MISSING, UNDECIDED, WRONG, ConventionCheck


def twist_is_missing(place, source, adapter, stamps, poses, raw, axes, remarks):
    """Whether the twist is zero though the pose moves; what a user should know is added to the list `remarks`.

    place: of the file, for messages; source: topics or columns. stamps (n,) ns, poses (n, 7) inside, raw (n, 6) twists as given,
    axes (n,): frame of each twist, None for that of the adapter. Raises ValueError when the twist is clearly in another convention.
    """
    check = ConventionCheck(adapter)
    for stamp, pose, twist, frame in zip(stamps.tolist(), poses.tolist(), raw, axes):
        verdict = check.add(stamp, pose, twist, frame)
        if check.finished:
            break
    if verdict.kind == WRONG:
        owner = "platform" if (axes[0] or adapter.twist_frame) == "child" else "world"
        raise ValueError(f"{place}: {source}: the twist does not move the pose, expected it in the {owner}'s axes; "
                         f"it fits as {' or '.join(verdict.fits)}")
    if verdict.kind == MISSING:
        remarks.append(f"{source}: the twist is zero though the pose moves")
    if verdict.kind == UNDECIDED and verdict.misfit is not None and verdict.misfit > FAILS:
        remarks.append(f"{place}: {source}: {verdict.text}: a wrong unit, or noise? It is used as it is")
    return verdict.kind == MISSING
