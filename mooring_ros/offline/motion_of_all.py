"""The motion of several platforms from one recording: the topics of each, and what they tell at the stamps that all of them have."""

from dataclasses import replace
from functools import reduce

import numpy as np

from .stamps import times_of


def own_topics(path, found, topic, names):
    """For each platform in `names`: (the topics in `found` that are its own, dict of name -> type; the words of --topic for it, or None).

    A topic is a platform's when the platform's name is a part of it (/platforms/body1/odom). topic: that of any of them, or
    POSE,TWIST; the others' have their own names in its place. Raises ValueError.
    """
    if topic is not None:
        said = {part for one in topic.split(",") for part in one.strip().split("/")} & set(names)
        if len(said) != 1:
            raise ValueError(f"{path}: topic {topic} of platforms {', '.join(names)}, expected a topic of one of them with its name as a part of it, as "
                             f"/platforms/{names[0]}/odom: the others' have their names in its place")  # fmt: skip
        (whose,) = said
    for name in names:
        asked = None if topic is None else ",".join(_renamed(one, whose, name) for one in topic.split(","))
        yield {one: kind for one, kind in found.items() if name in one.split("/") or topic is not None}, asked


def _renamed(topic, whose, name):
    return "/".join(name if part == whose else part for part in topic.strip().split("/"))


def together(motions, names, factor):
    """One motion_file.Motion of those of each platform, in the order of `names`, at the stamps that all have.

    factor: seconds at full scale for one of the source's clock. Raises ValueError when fewer than two stamps are common.
    """
    path = motions[0].path
    common = reduce(np.intersect1d, [motion.stamps for motion in motions])
    if common.size < 2:
        raise ValueError(f"{path}: {common.size} stamps that all of {', '.join(names)} have, expected at least 2: samples belong together when their stamps are equal")
    rows = [np.searchsorted(motion.stamps, common) for motion in motions]
    remarks = list(dict.fromkeys(remark for motion in motions for remark in motion.remarks))
    for name, motion in zip(names, motions):
        if len(motion.stamps) > common.size:
            remarks.append(f"{name}: {len(motion.stamps) - common.size} of {len(motion.stamps)} samples have a stamp that not all platforms have, and were left out")
    return replace(
        motions[0],
        times=times_of(common, factor),
        poses=np.stack([motion.poses[own] for motion, own in zip(motions, rows)], axis=1),
        twists=np.stack([motion.twists[own] for motion, own in zip(motions, rows)], axis=1),
        stamps=common,
        source="; ".join(motion.source for motion in motions),
        platforms=tuple(names),
        remarks=tuple(remarks),
    )
