"""All parameters of the node in one table: default, range, and whether a change needs a new configure."""
import math
from dataclasses import dataclass
from typing import Any

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, SetParametersResult
from rclpy.parameter import Parameter

from mooring_ros.fidelity import EXPECTED, check
from mooring_ros.mooring import SOLVERS
from mooring_ros.motion.frames import CONVENTIONS, TWIST_FRAMES, WRENCH_FRAMES
from mooring_ros.node.access import FILES, Access
from mooring_ros.node.platforms import name_list
from mooring_ros.node.punctuality import DEFAULTS, GRADES, UNITS
from mooring_ros.node.resets import POLICIES
from mooring_ros.node.output import RAMP_FROM
from mooring_ros.node.delay import MODES as DELAY_MODES
from mooring_ros.node.timing import MODES

INPUTS = ("odometry", "pose_twist", "pose")

_HUGE, _TINY = 1e18, 1e-6


@dataclass(frozen=True)
class Entry:
    """One parameter. fixed: a change needs cleanup and configure. low, high: range of a number. choices: of a text; or
    check(text), which raises ValueError, and expected: what it asks for, in words. at_start: never changes while the node lives."""

    name: str
    default: Any
    description: str
    fixed: bool = False
    low: float = 0.0
    high: float = _HUGE
    choices: tuple = ()
    check: Any = None
    expected: str = ""
    at_start: bool = False


TABLE = (
    Entry("autostart", True, "Configure and activate at start, without a lifecycle manager.", fixed=True),
    Entry("scene", "", "Path of the MoorDyn v2 input file.", fixed=True),
    Entry("platforms", [], "Names of coupled bodies that move by themselves, each on topics platforms/NAME/...; empty: all that is coupled rides on one platform.",
          fixed=True, check=name_list, expected="names of coupled bodies"),
    Entry("fidelity", "dynamic", "Model of the lines, of all or line by line.", fixed=True, check=check, expected=EXPECTED),
    Entry("solver", "auto", "Time integration of the dynamic lines.", fixed=True, choices=SOLVERS),
    Entry("dt", 0.0, "Internal time step (s); 0: chosen from the stability limits of the scene.", fixed=True, high=1e3),
    Entry("segments", 0, "Segments of each line; 0: as in the scene.", fixed=True, high=100_000),
    Entry("refine", 1.0, "The scene's segments of each line times this; not with segments.", fixed=True, low=_TINY, high=1e5),
    Entry("input", "odometry", "Topics of the platform's motion: platform/odom; platform/pose and platform/twist with equal stamps; or platform/pose alone.",
          fixed=True, choices=INPUTS),
    Entry("input_rate", 0.0, "Nominal rate of the input (Hz by its own clock), for camera systems: bunched stamps are put right, and poses without a twist are filtered. "
                             "0: not known, stamps are taken at their word.", fixed=True, high=1e5),
    Entry("input_bandwidth", 0.0, "Bandwidth of that filter (Hz): some six times the frequency of the waves. 0: 1.2 Hz at full scale, at most a fifteenth of input_rate.", fixed=True, high=1e5),
    Entry("world_frame", "", "Frame that the motion is given in; others are refused. Empty: that of the first sample.", fixed=True),
    Entry("platform_frame", "", "Frame of the platform; others are refused. Empty: that of the first sample.", fixed=True),
    Entry("twist_frame", "child", "Axes of the given twist: the platform's (child), or the world's.", fixed=True, choices=TWIST_FRAMES),
    Entry("convention", "enu", "Axes of world and platform: ENU and forward-left-up (enu), or NED and forward-right-down (ned).", fixed=True,
          choices=CONVENTIONS),
    Entry("wrench_frame", "world", "Axes of the wrenches: the world's, or the platform's (body).", fixed=True, choices=WRENCH_FRAMES),
    Entry("scale", 1.0, "Froude length scale: full scale over model scale of the platform that moves; the scene is at full scale.", fixed=True,
          low=_TINY, high=1e6),
    Entry("density_ratio", 1.0, "Density of the water at full scale over that at model scale.", fixed=True, low=1e-3, high=1e3),
    Entry("full_scale", False, "Publish the answers a second time at the scale of the scene, on ~/full_scale/wrench, fairleads, lines, line_tensions.", fixed=True),
    Entry("timing.mode", "input", "One step for each input message (input), or at a fixed rate against a steady clock (timer).", fixed=True,
          choices=MODES),
    Entry("timing.rate", 100.0, "Rate of the timer mode, and of the wrench in HOLD and SAFE when no input sets the pace (Hz).", fixed=True, low=0.1, high=2000.0),
    Entry("delay.compensate", "off", "Predict the motion by the delay of the answer: not (off), by delay.seconds (given), or by the measured mean plus "
                                     "delay.seconds (measured).", choices=DELAY_MODES),
    Entry("delay.seconds", 0.0, "Delay by the source's clock (s) that is given, or that lies outside of the node: before the stamp, and after the wrench.", high=1.0),
    Entry("delay.frequency", 0.0, "Natural frequency of the moored platform by the source's clock (Hz), at which ~/delay tells the loss of damping. 0: from the motion.",
          high=1e3),
    *(Entry(f"timing.threshold.{name}.{grade}", default, f"{name} from which on diagnostics are at the level {grade} ({UNITS[name]}). 0: never.")
      for name, defaults in DEFAULTS.items() for grade, default in zip(GRADES, defaults)),
    Entry("realtime.priority", 0, "SCHED_FIFO priority while active, as far as it is granted. 0: ordinary scheduling.", fixed=True, high=98),
    Entry("realtime.lock_memory", False, "Lock the memory while active, as far as it is granted.", fixed=True),
    Entry("limits.force", 0.0, "Largest force on the platform (N, as published); a larger one is scaled down. 0: no limit."),
    Entry("limits.force_rate", 0.0, "Fastest change of that force (N/s, as published); a faster one is followed at this rate. 0: no limit."),
    Entry("limits.input_age", 0.0, "Oldest input that is used, and longest silence before HOLD (s by the node's clock). 0: no limit; timer mode then "
                                   "carries motion on for 0.2 s."),
    Entry("limits.heartbeat", 0.0, "Longest time without a message on ~/heartbeat before SAFE (s). 0: none is asked for."),
    Entry("limits.jump", 10.0, "Farthest a pose may lie from where the motion led (m, full scale). 0: no limit."),
    Entry("limits.jump_angle", 0.5, "The same in angle (rad). 0: no limit."),
    Entry("limits.jump_speed", 10.0, "Largest change of velocity between samples, and speed at which a pose may leave its motion (m/s, full scale). "
                                     "0: no limit."),
    Entry("limits.jump_rate", 2.0, "The same in angular velocity (rad/s, full scale). 0: no limit."),
    Entry("limits.gap", 60.0, "Longest time between two samples of one motion (s, full scale). 0: no limit."),
    Entry("limits.lost_frames", 0, "How many inputs in a row may hold no pose (NaN, zero quaternion), which are bridged by prediction, or not come at all, before HOLD. "
                                   "0: none are bridged, any may stay away.", high=1000),
    Entry("limits.winch", 0.2, "Largest change of a line's unstretched length by one message (share of what it has); a larger one is refused. 0: no limit.",
          high=10.0),
    Entry("ramp_time", 0.0, "Cosine ramp of the wrench after a start or a settle, and into and out of HOLD and SAFE (s). 0: none, and 1 s.", high=1e6),
    Entry("ramp_from", "zero", "What the first ramp begins from: nothing (zero), or the static wrench at the first sample (static).", choices=RAMP_FROM),
    Entry("on_reset", "refuse", "When simulated time goes back: wait for ~/settle (refuse), or settle anew at the next sample (settle).", fixed=True,
          choices=POLICIES),
    Entry("stiffness_rate", 1.0, "At most how often ~/stiffness is solved anew for those who listen (Hz, in the time of the input); it is published after each "
                                 "settle. 0: never.", high=1000.0),
    Entry("visual_rate", 10.0, "Rate of ~/nodes and ~/markers in the time of the input (Hz). 0: never.", high=1000.0),
    Entry("accuracy.enabled", True, "Estimate the accuracy while running, in a process of its own that stands back for all others.", fixed=True),
    Entry("accuracy.share", 0.05, "Share of one processor that it may take over the long run.", fixed=True, low=1e-3, high=1.0),
    Entry("accuracy.window", 30.0, "How much motion an estimate is made from (s of the core's time); the first third is run-in.", fixed=True, low=1.0,
          high=3600.0),
    Entry("access.folders", "", "Folders, separated by colons, below which scene and recording.path may be set over the graph. Empty: working directory, the folders "
                                "of the first scene and recording, and that for temporary files.", fixed=True, at_start=True),
    Entry("recording.enabled", False, "Record inputs, outputs, steps, parameters and scene to MCAP.", fixed=True),
    Entry("recording.path", "", "Where to record: NAME.mcap, or a folder name. Empty: mooring_DATE-TIME.mcap in the working directory.", fixed=True),
)
_BY_NAME = {entry.name: entry for entry in TABLE}


def declare(node, configured):
    """Declare all parameters on a node; returns their Access. configured(): whether the node stands on the fixed ones now, so that they cannot change.

    Raises what rclpy raises for a value of the wrong type or outside its range.
    """
    access = None       # what stands there at the start may name any file
    node.add_on_set_parameters_callback(lambda changes: _check(changes, configured(), access))
    for entry in TABLE:
        _mend(node, entry)
        node.declare_parameter(entry.name, entry.default, _descriptor(entry))
    access = Access(*(node.get_parameter(name).value for name in (*FILES, "access.folders")))
    return access


def values(node):
    """Name -> value of all parameters in the table."""
    return {entry.name: node.get_parameter(entry.name).value for entry in TABLE}


def _descriptor(entry):
    words = entry.description + (" Fixed while configured." if entry.fixed else "")
    descriptor = ParameterDescriptor(description=words, read_only=entry.at_start, dynamic_typing=isinstance(entry.default, list))  # an empty list has no type
    if entry.choices:
        descriptor.additional_constraints = "one of " + ", ".join(entry.choices)
    if entry.expected:
        descriptor.additional_constraints = entry.expected
    if isinstance(entry.default, float):
        descriptor.floating_point_range = [FloatingPointRange(from_value=entry.low, to_value=entry.high)]
    elif isinstance(entry.default, int) and not isinstance(entry.default, bool):
        descriptor.integer_range = [IntegerRange(from_value=int(entry.low), to_value=int(entry.high))]
    return descriptor


def _mend(node, entry):
    """`-p timing.rate:=100` is an integer to ROS, and an empty list is nothing at all; nobody means that."""
    override = node._parameter_overrides.get(entry.name)
    if override is not None and isinstance(entry.default, float) and override.type_ == Parameter.Type.INTEGER:
        node._parameter_overrides[entry.name] = Parameter(entry.name, value=float(override.value))
    if override is not None and isinstance(entry.default, list) and override.type_ == Parameter.Type.NOT_SET:
        node._parameter_overrides[entry.name] = Parameter(entry.name, Parameter.Type.STRING_ARRAY, [])


def _check(changes, configured, access):
    for change in changes:
        entry = _BY_NAME.get(change.name)
        if entry is None:
            continue
        if entry.fixed and configured:
            return _refused(f"{entry.name} is fixed while configured: clean up first")
        if entry.choices and change.value not in entry.choices:
            return _refused(f"{entry.name} is '{change.value}', expected one of {', '.join(entry.choices)}")
        try:
            if entry.check:
                entry.check(change.value)
            if access is not None and entry.name in FILES:
                access.check(entry.name, change.value)
        except ValueError as error:
            return _refused(str(error))
        if isinstance(change.value, float) and not math.isfinite(change.value):
            return _refused(f"{entry.name} is {change.value}, expected a finite number")
    return SetParametersResult(successful=True)


def _refused(reason):
    return SetParametersResult(successful=False, reason=reason)


def unknown(node):
    """Names that were given for a node at its start and that it does not have."""
    # rclpy keeps what was given on the command line and in files to itself
    given = getattr(node, "_parameter_overrides", {})
    return sorted(name for name in given if not node.has_parameter(name) and not name.startswith("qos_overrides."))
