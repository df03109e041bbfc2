"""`mooring static`: the static solution of a scene at a pose."""

import numpy as np

from mooring_ros.scene import bed_level

from .angles import roll_pitch_yaw
from .arguments import add_platforms_argument, load_mooring, names_of, pose, remarks_on
from .console import ComputationFailed, Preparing, UsageError, complain, print_json, table

_AXES = ("x", "y", "z", "rx", "ry", "rz")
_LONGEST, _DEEPEST = 1.5, 0.05  # of the unstretched length; of the depth: what lies on a bed sinks in by less


def add_arguments(parser):
    parser.add_argument("scene", metavar="SCENE", help="MoorDyn v2 input file, or a recording that holds one")
    parser.add_argument(
        "--pose",
        type=_placed,
        action="append",
        default=[],
        metavar="[NAME=]X,Y,Z,ROLL,PITCH,YAW",
        help="platform pose in m and degrees; roll, pitch, yaw about the fixed x, y, z axes in that order (default: all zero); NAME=… with --platforms, "
        "for each that is not where the file has put it",
    )
    add_platforms_argument(parser)
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output, nothing else")


def _placed(text):
    """(name or None, pose (7,)) of [NAME=]X,Y,Z,ROLL,PITCH,YAW; for argparse."""
    name, equals, numbers = text.rpartition("=")
    return name if equals else None, pose(numbers)


def run(args):
    names = names_of(args.platforms)
    last = dict(args.pose)
    strange = [name for name in last if name not in (names or (None,))]
    if strange:
        found = strange[0] or "a pose without a name"
        raise UsageError(f"--pose: {found}, expected {f'NAME=… of {args.platforms}' if names else 'X,Y,Z,ROLL,PITCH,YAW without a name, or --platforms'}")
    with Preparing("static"):
        solution, remarks = solve(args.scene, last if names else last.get(None, pose("0,0,0,0,0,0")), names or None)
    for remark in remarks:
        complain(remark)
    if args.json:
        print_json(solution)
    else:
        print(_text(args.scene, solution))
    return 0


def solve(scene, pose, platforms=None):
    """(the static solution at a pose (7,) as the object that --json prints: N, N·m, world frame; remarks). Raises UsageError, ComputationFailed.

    platforms: names; `pose` is then a dict of name -> pose (7,) of those that are not where the file has put them.
    """
    from mooring_ros.mooring import MooringError

    mooring = load_mooring(scene, platforms=platforms)
    if platforms:
        pose = [pose.get(name, there) for name, there in zip(platforms, mooring.pose_in_file)]
    try:
        mooring.settle(pose)
        stiffness = mooring.stiffness()
    except MooringError as error:
        raise ComputationFailed(f"{scene}: {error}") from error
    found = mooring.static_result
    if not found.converged:
        raise ComputationFailed(
            f"{scene}: the statics did not converge: {found.residual:.3g} N out of balance after {found.iterations} iterations"
        )
    lines = zip(
        mooring.line_names,
        mooring.fairlead_tension.tolist(),
        mooring.anchor_tension.tolist(),
        mooring.fairlead_end_force.tolist(),
        mooring.anchor_end_force.tolist(),
    )
    keys = ("name", "fairlead_tension", "anchor_tension", "fairlead_end_force", "anchor_end_force")
    solution = {
        "lines": [dict(zip(keys, line)) for line in lines],
        **_wrench(mooring),
        "stiffness": np.asarray(stiffness).tolist(),
        "residual": float(found.residual),
        "iterations": int(found.iterations),
        **_parts(mooring),
    }
    return solution, [*remarks_on(mooring), *_implausible(mooring)]


def _implausible(mooring):
    """Remarks on a solution that no mooring has: the pose is a mistake, or a unit of the scene."""
    env = mooring.scene.environment
    for name, length, unstretched in zip(mooring.line_names, mooring.stretched_length.tolist(), mooring.unstretched_length.tolist()):
        if length > _LONGEST * unstretched:
            yield f"{name} is stretched to {length:.5g} m from {unstretched:.5g} m"
        deepest = max(bed_level(env, x, y) - z for x, y, z in mooring.node_positions(name).tolist())
        if deepest > _DEEPEST * env.depth:
            yield f"{name} is up to {deepest:.5g} m in the ground"


def _wrench(mooring):
    if mooring.platforms is None:
        return {"wrench": {"force": mooring.wrench[:3].tolist(), "torque": mooring.wrench[3:].tolist()}}
    rows = zip(mooring.platforms, mooring.pose.tolist(), mooring.wrench.tolist())
    return {
        "platforms": [
            {"name": name, "position": pose[:3], "quaternion": pose[3:], "wrench": {"force": wrench[:3], "torque": wrench[3:]}} for name, pose, wrench in rows
        ]
    }


def _parts(mooring):
    """Where rods and bodies are, and what each coupled part hands to the platform; nothing for a scene of points and lines alone."""
    scene = mooring.scene
    if not (scene.rods or scene.bodies):
        return {}
    wrenches = zip(mooring.coupled_names, mooring.coupled_wrenches.tolist())
    return {
        "rods": [dict(zip(("name", "end_a", "end_b"), (rod.name, *mooring.rod_positions(rod.name).tolist()))) for rod in scene.rods],
        "bodies": [{"name": name, "position": pose[:3].tolist(), "quaternion": pose[3:].tolist()} for name, pose in mooring.body_poses.items()],
        "coupled": [{"name": name, "force": wrench[:3], "torque": wrench[3:]} for name, wrench in wrenches],
    }


def _text(scene, solution):
    several = solution.get("platforms")
    wrenches = [platform["wrench"] for platform in several] if several else [solution["wrench"]]
    names = [platform["name"] for platform in several] if several else []
    rows = [[*names[k : k + 1], *map(_number, _by_halves(wrench["force"] + wrench["torque"]))] for k, wrench in enumerate(wrenches)]
    axes = [f"{name}.{axis}" for name in names for axis in _AXES] or _AXES
    ends = [
        [line["name"], end, _number(line[f"{end}_tension"]), *map(_number, _without_rounding(line[f"{end}_end_force"]))]
        for line in solution["lines"]
        for end in ("fairlead", "anchor")
    ]
    return "\n".join(
        [
            f"{scene}: in balance to {solution['residual']:.2g} N after {solution['iterations']} iterations",
            "",
            "Forces of the lines on what holds their ends, world axes (N)",
            table(["line", "end", "tension", "fx", "fy", "fz"], ends),
            "",
            "On each platform, about its body's origin, world axes (N, N·m)" if several else "On the platform, about its reference point, world axes (N, N·m)",
            table([*([""] if several else []), "fx", "fy", "fz", "mx", "my", "mz"], rows),
            "",
            *_parts_text(solution),
            "Stiffness −∂wrench/∂pose (N/m, N/rad, N·m/m, N·m/rad)",
            table(["", *axes], [[name, *map(_number, row)] for name, row in zip(axes, _without_rounding(solution["stiffness"]))]),
        ]
    )


def _parts_text(solution):
    if "rods" not in solution:
        return []
    coupled = [[part["name"], *map(_number, _by_halves(part["force"] + part["torque"]))] for part in solution["coupled"]]
    rods = [[rod["name"], *map(_number, _without_rounding(rod["end_a"] + rod["end_b"]))] for rod in solution["rods"]]
    bodies = [
        [body["name"], *map(_number, _without_rounding(body["position"])), *map(_number, _degrees(body["quaternion"]))] for body in solution["bodies"]
    ]
    tables = (
        ("Of it, at each coupled point, rod (its end A) and body (its origin)", ["", "fx", "fy", "fz", "mx", "my", "mz"], coupled),
        ("Rods: ends A and B (m)", ["rod", "xa", "ya", "za", "xb", "yb", "zb"], rods),
        ("Bodies: origin (m); roll, pitch, yaw about the fixed axes (degrees)", ["body", "x", "y", "z", "roll", "pitch", "yaw"], bodies),
    )
    return [text for title, headers, rows in tables if rows for text in (title, table(headers, rows), "")]


def _degrees(quaternion):
    return np.degrees(roll_pitch_yaw(np.array([quaternion])))[0].round(9).tolist()


def _by_halves(wrench):
    """A wrench (6,) with zeros where only rounding is left, forces and moments each by their own size."""
    return _without_rounding(wrench[:3]) + _without_rounding(wrench[3:])


def _without_rounding(matrix):
    """The numbers with zeros where only rounding is left, for the eye."""
    matrix = np.array(matrix)
    return np.where(np.abs(matrix) < 1e-12 * np.abs(matrix).max(), 0.0, matrix).tolist()


def _number(value):
    return f"{value + 0.0:.6g}"
