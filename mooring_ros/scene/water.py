"""Files of waves and currents, as MoorDyn-C and MoorDyn-F read them."""

import math

from .description import COMPONENTS, ELEVATION, Waves
from .files import HEADING_LINES, Files, unquoted
from .rows import Row, parse_number

SHORTEST = 4  # rows of an elevation
_EVEN = 1e-6  # of the interval: by how much times may miss it
_MOST_SAMPLES = 2_000_000

Profile = tuple[tuple[float, float, float, float], ...]


def read_current_profile(files: Files, asked: Row, name: str) -> Profile:
    """(z, vx, vy, vz) with z growing, of MoorDyn-C's current_profile.txt."""
    columns = (("z", "m"), ("ux", "m/s"), ("uy", "m/s"), ("uz", "m/s"))
    rows = files.table(asked, name, "a steady current profile", columns, HEADING_LINES)
    return _growing([(row, tuple(row.number(i, *column) for i, column in enumerate(columns))) for row in rows])


def _growing(rows: list[tuple[Row, tuple[float, ...]]]) -> Profile:
    if rows[0][1][0] > rows[-1][1][0]:
        rows = rows[::-1]
    for (_, (before, *_)), (row, (z, *_)) in zip(rows, rows[1:]):
        if z <= before:
            raise row.error(f"z = {z:g} stands next to {before:g}, expected z to grow or to fall from row to row")
    return tuple(values for _, values in rows)


def read_elevation(files: Files, asked: Row, name: str, interval: float | None = None) -> tuple[tuple[float, float], ...]:
    """(s, m) from 0 s, evenly spaced. With an ``interval`` (s) it is read off linearly there, as MoorDyn does before its Fourier transform."""
    columns = (("time", "s"), ("elevation", "m"))
    rows = files.table(asked, name, "a wave elevation", columns)
    series = [tuple(row.number(i, *column) for i, column in enumerate(columns)) for row in rows]
    if series[0][0] != 0:
        raise rows[0].error(f"time is {rows[0].words[0]}, expected the first to be 0 (s)")
    for row, (before, _), (time, _) in zip(rows[1:], series, series[1:]):
        if time <= before:
            raise row.error(f"time {row.words[0]} follows {before:g}, expected growing times (s)")
    if interval is not None:
        series = _sampled(asked, series, interval)
    if len(series) < SHORTEST:
        raise rows[-1].error(f"the wave elevation has {len(series)} samples, expected {SHORTEST} at least")
    if interval is None:
        step = series[-1][0] / (len(series) - 1)
        for index, (row, (time, _)) in enumerate(zip(rows, series)):
            if abs(time - index * step) > _EVEN * step:
                raise row.error(f"time is {row.words[0]}, expected {index * step:.9g} (s): evenly spaced times")
    return tuple(series)


def _sampled(asked: Row, series: list[tuple[float, float]], interval: float) -> list[tuple[float, float]]:
    count = int(series[-1][0] / interval * (1 + 1e-12)) + 1
    if count > _MOST_SAMPLES:
        raise asked.error(f"a wave elevation of {series[-1][0]:g} s in steps of {interval:g} s, expected {_MOST_SAMPLES} steps at most")
    samples, place = [], 0
    for index in range(count):
        time = min(index * interval, series[-1][0])
        while place < len(series) - 2 and series[place + 1][0] <= time:
            place += 1
        (before, low), (after, high) = series[place : place + 2]
        samples.append((index * interval, low + (high - low) * (time - before) / (after - before)))
    return samples[: count - count % 2]  # MoorDyn drops the last of an odd number


def read_frequencies(files: Files, asked: Row, name: str) -> Waves:
    """The sea of MoorDyn-C's wave_frequencies.txt (WaveKin 7): rows of frequency, real and imaginary part, and direction.

    MoorDyn's elevation is the sum of |A| sin(w t - k s + arg A); here it is |A| cos(w t - k s - phase).
    """
    what = "wave components: frequency (rad/s), real and imaginary part (m), direction (rad)"
    components, direction, first = [], 0.0, None
    for row in files.rows(asked, name, what):
        if len(row.words) not in (3, 4):
            raise row.error(f"{len(row.words)} columns, expected 3 or 4: {what}")
        frequency = row.number(0, "frequency", "rad/s", at_least=0)
        real, imaginary = row.number(1, "real part", "m"), row.number(2, "imaginary part", "m")
        heading = row.number(3, "direction", "rad") if len(row.words) == 4 else 0.0
        amplitude = math.hypot(real, imaginary)
        if amplitude == 0:
            continue
        if frequency == 0:
            raise row.error(f"the component of frequency 0 has the amplitude {amplitude:g} m, expected 0: a change of level is not modelled")
        if first is None:
            first, direction = row, heading
        elif heading != direction:
            raise row.error(f"direction is {heading:g} after {direction:g} in line {first.line}, expected one direction for all components")
        components.append((frequency, amplitude, math.pi / 2 - math.atan2(imaginary, real)))
    if first is None:
        raise asked.error(f"'{unquoted(name)}' holds no wave, expected {what} with an amplitude > 0")
    return Waves(COMPONENTS, direction=direction, spectrum=tuple(components))


def read_water_file(files: Files, asked: Row, name: str) -> tuple[Waves | None, Profile]:
    """MoorDyn-F's file of the option WaterKin: waves from an elevation (WaveKinMod 1), a steady current profile (CurrentMod 1)."""
    what = "a water kinematics file of MoorDyn-F"
    rows = files.rows(asked, name, what)
    parts: dict[str, list[Row]] = {}
    inside = None
    for row in rows:
        title = " ".join(row.words).upper()
        if "---" in title:
            inside = next((part for part in ("WAVES", "CURRENT") if part in title and part not in parts), None)
            if inside:
                parts[inside] = []
        elif inside:
            parts[inside].append(row)
    for part in ("WAVES", "CURRENT"):
        if not parts.get(part):
            raise rows[0].error(f"there is no part {part}, expected {what} with the parts WAVES and CURRENT")
    return _waves_of(files, asked, name, parts["WAVES"]), _current_of(files, parts["CURRENT"])


def _waves_of(files: Files, asked: Row, name: str, rows: list[Row]) -> Waves | None:
    if _switch(rows[0], "WaveKinMod", "0 (no waves) or 1 (from an elevation): SeaState is not there") == 0:
        return None
    if len(rows) < 4:
        raise rows[-1].error("the part WAVES ends here, expected WaveKinMod, WaveKinFile, dtWave and WaveDir")
    interval = rows[2].number(0, "dtWave", "s", above=0)
    direction = math.radians(rows[3].number(0, "WaveDir", "degrees"))
    if not unquoted(rows[1].words[0]):
        raise rows[1].error('WaveKinFile is "", expected the name of a file: WaveKinMod is 1')
    elevation = read_elevation(files, rows[1], rows[1].words[0], interval)
    files.warnings.append(
        f"{asked.file}:{asked.line}: the wave grid in '{unquoted(name)}' is not used: the water's motion is computed at the nodes themselves"
    )
    return Waves(ELEVATION, direction=direction, elevation=elevation)


def _current_of(files: Files, rows: list[Row]) -> Profile:
    if _switch(rows[0], "CurrentMod", "0 (no current) or 1 (a steady profile): SeaState is not there") == 0:
        return ()
    values = []
    for row in rows[1:]:
        if len(row.words) == 3 and all(parse_number(word) is not None for word in row.words):
            values.append((row, (row.number(0, "z", "m"), row.number(1, "ux", "m/s"), row.number(2, "uy", "m/s"), 0.0)))
        elif values:
            raise row.error(f"'{' '.join(row.words)[:40]}' stands in the table of the current, expected 3 numbers: z ux uy")
    if not values:
        raise rows[0].error("there is no table of the current, expected rows of 3 numbers: z ux uy")
    heights = [z for _, (z, *_) in values]
    if max(heights) > 0:
        if min(heights) < 0:
            raise rows[0].error("the table of the current has z above and below 0, expected z <= 0 (or depths >= 0 in all rows)")
        values = [(row, (0.0 - z, *velocity)) for row, (z, *velocity) in values]
        first = values[0][0]
        files.warnings.append(f"{first.file}:{first.line}: the numbers > 0 in the table of the current are taken as depths below the water")
    return _growing(values)


def _switch(row: Row, name: str, expected: str) -> int:
    if row.words[0] not in ("0", "1"):
        raise row.error(f"{name} is '{row.words[0]}', expected {expected}")
    return int(row.words[0])
