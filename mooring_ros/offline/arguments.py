"""Options that several commands share, and their checks."""

import argparse
import math
import os

import numpy as np

from mooring_ros.scene import parse_scene

from .angles import quaternion_from_degrees
from .console import reading


def add_model_arguments(parser):
    """--fidelity, --solver, --dt, --segments, --refine: how the scene is computed. Left out, the scene decides."""
    parser.add_argument(
        "--fidelity", type=fidelity, metavar="F", help="how much physics: linear, quasi_static or dynamic (default), or line by line: line1=dynamic,linear"
    )
    parser.add_argument("--solver", type=solver, metavar="S", help="how the dynamics are stepped: explicit, implicit or auto (default: auto)")
    parser.add_argument("--dt", type=positive, metavar="S", help="time step in s (default: the largest stable one, with a margin)")
    parser.add_argument("--segments", type=count, metavar="N", help="segments of every line (default: as in the scene)")
    parser.add_argument("--refine", type=positive, metavar="X", help="the scene's segments of each line times this; not with --segments")


def add_topic_arguments(parser):
    """--topic and --platforms: which part of a recording is the motion, and of what."""
    parser.add_argument(
        "--topic",
        metavar="NAME",
        help="which topic of an MCAP file is the motion (POSE,TWIST for a pair); of several platforms that of any, with its name in it (/platforms/body1/odom)",
    )
    parser.add_argument("--platforms", metavar="NAME,NAME", help="coupled bodies that move by themselves, where MOTION does not say so itself")


def add_platforms_argument(parser):
    """--platforms, for what needs no motion."""
    parser.add_argument("--platforms", metavar="NAME,NAME", help="coupled bodies that are platforms of their own (default: one, with all that is coupled)")


def names_of(text):
    """Names (a tuple) of a --platforms; none for None."""
    return () if text is None else tuple(text.split(","))


def fidelity(text):
    """A fidelity, or fidelities line by line; for argparse."""
    from mooring_ros.fidelity import check

    try:
        check(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from error
    return text


def solver(text):
    """One of the solvers that are built; for argparse."""
    from mooring_ros.mooring import SOLVERS

    return _one_of(text, SOLVERS)


def finite(text):
    """A finite number; for argparse."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text!r}: expected a finite number")
    return value


def positive(text):
    """A positive, finite number; for argparse."""
    value = finite(text)
    if not value > 0.0:
        raise argparse.ArgumentTypeError(f"{text!r}: expected a positive number")
    return value


def count(text):
    """A whole number of at least 1; for argparse."""
    try:
        value = int(text)
    except ValueError:
        value = 0
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text!r}: expected a whole number of at least 1")
    return value


def pose(text):
    """X,Y,Z,ROLL,PITCH,YAW in m and degrees about the fixed axes, as a pose (7,); for argparse."""
    parts = text.split(",")
    if len(parts) != 6:
        raise argparse.ArgumentTypeError(f"{text!r}: expected six numbers X,Y,Z,ROLL,PITCH,YAW (m, degrees), found {len(parts)}")
    numbers = [finite(part) for part in parts]
    return np.concatenate([numbers[:3], quaternion_from_degrees(*numbers[3:])])


def load_mooring(scene, fidelity=None, solver=None, dt=None, segments=None, refine=None, platforms=None):
    """A Mooring for a scene (path of it, or of a recording that holds it) and options where None means the default. Raises UsageError for bad input."""
    from mooring_ros.mooring import Mooring

    chosen = {"fidelity": fidelity, "solver": solver, "dt": dt, "segments": segments, "refine": refine, "platforms": platforms}
    with reading(scene):
        return Mooring(_recorded_scene(scene) or scene, **{name: value for name, value in chosen.items() if value is not None})


def remarks_on(mooring):
    """What a user should know about a Mooring: its warnings, and that nothing would follow a motion; list of str."""
    nothing = [f"{mooring.scene.path}: nothing is coupled: the platform's motion moves nothing, and its wrench is zero"]
    return [*mooring.warnings, *(nothing if not mooring.coupled_names else [])]


def _recorded_scene(path):
    """The Scene in a recording, with the files that it was read from; None when the path is no recording's. Raises ValueError, OSError."""
    from mooring_ros.recording.reader import Recording
    from mooring_ros.recording.records import is_mcap

    bag, file = os.path.isfile(os.path.join(path, "metadata.yaml")), os.path.isfile(path)  # not a pipe: reading it could last for ever
    if not bag and not (file and is_mcap(path)):
        return None
    attached = Recording(path).scene
    if attached is None:
        raise ValueError(f"{path}: a recording without a scene, expected a MoorDyn v2 input file, or a recording of the node or of a replay")
    return parse_scene(attached.text, os.path.join(path, attached.name), attached.files)


def _one_of(text, built):
    if text not in built:
        raise argparse.ArgumentTypeError(f"{text!r} is not there, expected one of {', '.join(built)}")
    return text
