"""A setting as a parameter file of `mooring_node`."""

import os
from pathlib import Path

import yaml


def write_parameters(path, scene, setting, remark, platforms=()):
    """Write the file, in one move. scene: path of the MoorDyn v2 file; remark: one line on what the setting is; platforms: names, if there are any. Raises OSError."""
    values = {
        "scene": str(Path(scene).resolve()), "fidelity": setting.fidelity, "solver": setting.solver, "dt": setting.dt or 0.0,
        "segments": setting.segments or 0, "refine": setting.refine,
    } | ({"platforms": list(platforms)} if platforms else {})
    text = f"# {remark}\n# ros2 run mooring_ros mooring_node --ros-args --params-file {Path(path).name}\n"
    text += yaml.safe_dump({"/**": {"ros__parameters": values}}, sort_keys=False)
    part = Path(path).with_name(Path(path).name + ".part")
    part.write_text(text, encoding="utf-8")
    os.replace(part, path)
