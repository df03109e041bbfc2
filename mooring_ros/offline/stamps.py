"""Stamps of recorded messages (ns) as times (s)."""

import numpy as np

from mooring_ros.node.timing import WALL_CLOCK


def times_of(stamps, factor=1.0):
    """Times (n,) s of stamps (n,) ns: as they are for a simulated clock, counted from the first for a wall clock.

    factor: seconds at full scale for one of the source's clock.
    """
    stamps = np.asarray(stamps, dtype=np.int64)
    start = stamps[0] if len(stamps) and stamps[0] >= WALL_CLOCK else 0
    return (stamps - start) * 1e-9 * factor


def kept(path, topic, samples, log_times):
    """Which of the samples count: (indices, stamps (n,) ns, remarks).

    samples: tuples that begin with the header's stamp, in the order of the file; log_times: ns. Where every stamp is zero, the log times
    stand in. A message that came twice is left out, with a remark. Raises ValueError for stamps that run backwards,
    two different messages with one stamp, and stamps that are zero in part.
    """
    stamps, remarks = [sample[0] for sample in samples], []
    zeros = sum(stamp == 0 for stamp in stamps)
    if zeros == len(stamps) and len(stamps) > 1:
        stamps = list(log_times)
        remarks.append(f"{topic}: every header stamp is zero, the times of logging were taken")
    elif zeros > 1 or (zeros and max(stamps) >= WALL_CLOCK):
        raise ValueError(f"{path}: topic {topic}: {zeros} of {len(stamps)} header stamps are zero, expected all or none")
    indices, repeated = [], 0
    for index, stamp in enumerate(stamps):
        if indices:
            last = indices[-1]
            if stamp == stamps[last] and samples[index][1:] == samples[last][1:]:
                repeated += 1
                continue
            if stamp <= stamps[last]:
                what = "runs backwards" if stamp < stamps[last] else "comes again with other content"
                raise ValueError(f"{path}: topic {topic}: message {index + 1}: stamp {stamp * 1e-9:.9f} s {what} "
                                 f"(the one before has {stamps[last] * 1e-9:.9f} s), expected it to increase")
        indices.append(index)
    if repeated:
        remarks.append(f"{topic}: {repeated} messages came twice, one of each was taken")
    return indices, np.array([stamps[index] for index in indices], dtype=np.int64), remarks
