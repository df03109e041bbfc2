"""Options that the demo and its simulator share."""

import argparse
import math

from mooring_ros.demo.waves import SeaState
from mooring_ros.offline.arguments import finite, positive

HEADING = 20.0  # degrees; off the axes of symmetry, so that no motion stays at rest


def add_sea_arguments(parser):
    """--duration, --rate and the sea: --wave-height, --wave-period, --wave-heading, --seed, --ramp."""
    sea = SeaState()
    parser.add_argument("--duration", type=positive, default=60.0, metavar="S", help="simulated time in s (default: 60)")
    parser.add_argument("--rate", type=positive, default=50.0, metavar="HZ", help="samples exchanged for each simulated second (default: 50)")
    parser.add_argument("--seed", type=not_negative_int, default=sea.seed, metavar="N", help=f"seed of the waves (default: {sea.seed})")
    parser.add_argument("--wave-height", type=not_negative, default=sea.height, metavar="M", help=f"significant wave height in m, 0 for still water (default: {sea.height:g})")
    parser.add_argument("--wave-period", type=positive, default=sea.period, metavar="S", help=f"peak period in s (default: {sea.period:g})")
    parser.add_argument("--wave-heading", type=finite, default=HEADING, metavar="DEG", help=f"where the waves go, from the x axis, in degrees (default: {HEADING:g})")
    parser.add_argument("--ramp", type=not_negative, default=sea.ramp, metavar="S", help=f"time over which the waves grow, in s (default: {sea.ramp:g})")


def sea_arguments(options):
    """The words that give the same sea, rate and duration to another process."""
    names = ("duration", "rate", "seed", "wave_height", "wave_period", "wave_heading", "ramp")
    return [f"--{name.replace('_', '-')}={getattr(options, name)!r}" for name in names]


def sea_state(options):
    """The SeaState that the options describe."""
    return SeaState(
        height=options.wave_height, period=options.wave_period, heading=math.radians(options.wave_heading), seed=options.seed, ramp=options.ramp
    )


def not_negative(text):
    """A finite number of at least 0; for argparse."""
    value = finite(text)
    if value < 0.0:
        raise argparse.ArgumentTypeError(f"{text!r}: expected a number of at least 0")
    return value


def not_negative_int(text):
    """A whole number of at least 0; for argparse."""
    try:
        value = int(text)
    except ValueError:
        value = -1
    if value < 0:
        raise argparse.ArgumentTypeError(f"{text!r}: expected a whole number of at least 0")
    return value
