"""Where the demo finds its scene and puts its results."""

import time
from pathlib import Path

from ament_index_python.packages import PackageNotFoundError, get_package_share_directory

SCENE = Path("scenes") / "volturnus_s_chain.txt"


def default_scene():
    """Path of the demo's scene: in the source tree, else in the installed share folder."""
    source = Path(__file__).resolve().parents[2] / "config" / SCENE
    if source.is_file():
        return source
    try:
        return Path(get_package_share_directory("mooring_ros")) / "config" / SCENE
    except PackageNotFoundError:
        return source


def make_output(folder=None):
    """Create the folder of the results and return its path: `out/demo-<date-time>` unless given.

    Raises OSError when it cannot be made, ValueError when it is not empty: nothing is overwritten.
    """
    if folder is None:
        folder = _free(Path("out") / time.strftime("demo-%Y%m%d-%H%M%S"))
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    if any(folder.iterdir()):
        raise ValueError(f"{folder}: the folder is not empty, expected a new or an empty one")
    return folder


def _free(path):
    """path, or the next free one of path-2, path-3, … when it is taken."""
    candidate, number = path, 1
    while candidate.exists():
        number += 1
        candidate = path.with_name(f"{path.name}-{number}")
    return candidate
