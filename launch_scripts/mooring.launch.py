"""Start the mooring node: `ros2 launch mooring_ros mooring.launch.py scene:=my_mooring.txt`; `--show-args` lists the arguments."""

import os
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

# Beside this file's folder in the source tree as well as in share/mooring_ros.
CONFIG = Path(__file__).resolve().parents[1] / "config"
DEFAULT_SCENE = CONFIG / "scenes" / "volturnus_s_chain.txt"

REACH, REACHES = "ROS_AUTOMATIC_DISCOVERY_RANGE", ("LOCALHOST", "SUBNET", "OFF", "SYSTEM_DEFAULT")

ARGUMENTS = {
    "scene": ("", "MoorDyn v2 input file. Empty: as in params_file; without one, the VolturnUS-S chain."),
    "params_file": ("", "ROS parameter file of the node. Empty: config/mooring.yaml, all defaults."),
    "namespace": ("", "Namespace of the node."),
    "name": ("mooring", "Name of the node."),
    "autostart": ("", "Configure and activate at start: true or false. Empty: as in params_file."),
    "reach": ("", f"Who may discover the node: {', '.join(REACHES)}. Empty: {REACH} of the shell, else LOCALHOST."),
    "recording": ("", "Record to this file or folder. Empty: as in params_file."),
}


def generate_launch_description():
    arguments = [DeclareLaunchArgument(name, default_value=default, description=text) for name, (default, text) in ARGUMENTS.items()]
    return LaunchDescription([*arguments, OpaqueFunction(function=start_node)])


def start_node(context):
    """The node, its parameters from the file, with what the arguments say over them."""
    given = {name: LaunchConfiguration(name).perform(context) for name in ARGUMENTS}
    parameters = [str(existing(given["params_file"] or CONFIG / "mooring.yaml", "params_file"))]
    if over := overrides(given):
        parameters.append(over)
    return [
        Node(
            package="mooring_ros", executable="mooring_node", name=given["name"], namespace=given["namespace"], parameters=parameters, output="screen",
            additional_env={REACH: reach(given["reach"])},
        )
    ]  # fmt: skip


def reach(asked):
    """Value of ROS_AUTOMATIC_DISCOVERY_RANGE for the node."""
    if asked and asked not in REACHES:
        raise ValueError(f"reach:={asked}: expected one of {', '.join(REACHES)}")
    return asked or os.environ.get(REACH) or "LOCALHOST"


def overrides(given):
    """Parameters that the arguments set; what is not given stays as it is in the file."""
    over = {}
    if given["scene"] or not given["params_file"]:
        over["scene"] = str(existing(given["scene"] or DEFAULT_SCENE, "scene"))
    if given["autostart"]:
        if given["autostart"].lower() not in ("true", "false"):
            raise ValueError(f"autostart:={given['autostart']}: expected true or false")
        over["autostart"] = given["autostart"].lower() == "true"
    if given["recording"]:
        over["recording.enabled"] = True
        over["recording.path"] = given["recording"]
    return over


def existing(path, argument):
    """The absolute path of a file, which must be there."""
    path = Path(path).expanduser().absolute()
    if not path.is_file():
        raise FileNotFoundError(f"{argument}:={path}: no such file")
    return path
