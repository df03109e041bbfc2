"""`mooring replay`: recorded motion in, forces out, as fast as it goes.

Forces go out as computed: a live run's ramps, limits and holds (node/output.py) are not played again. Tensions never have any.
"""

import os

from mooring_ros.motion.frames import scale_in_words

from .arguments import add_model_arguments, add_topic_arguments, load_mooring, names_of, positive, remarks_on
from .console import UsageError, complain, print_json, reading
from .files import check_output, same_file

# The node's parameters when nobody says otherwise; 0 leaves the choice to the scene.
DEFAULTS = {
    "fidelity": "dynamic",
    "solver": "auto",
    "dt": 0.0,
    "segments": 0,
    "refine": 1.0,
    "input": "odometry",
    "convention": "enu",
    "twist_frame": "child",
    "wrench_frame": "world",
    "scale": 1.0,
    "density_ratio": 1.0,
    "full_scale": False,
}
MODEL = ("fidelity", "solver", "dt", "segments", "refine")
AXES_AND_SCALE = ("input", "convention", "twist_frame", "wrench_frame", "scale", "density_ratio", "full_scale")


def add_arguments(parser):
    parser.add_argument("scene", metavar="SCENE", help="MoorDyn v2 input file, or a recording that holds one")
    parser.add_argument(
        "motion",
        metavar="MOTION",
        help="CSV with a header t,x,y,z,roll,pitch,yaw (s, m, degrees) or t,x,y,z,qx,qy,qz,qw[,vx,vy,vz,wx,wy,wz] (twist in world axes); MCAP with "
        "Odometry, or PoseStamped and TwistStamped; a recording of the node replays bit for bit, with its own settings. Of several platforms each has "
        "these columns with its name before them (t,body1.x,…,body2.x,…), or these topics with its name in them",
    )
    parser.add_argument("-o", "--output", metavar="OUT.mcap", required=True, help="recording to write")
    parser.add_argument("--csv", metavar="OUT.csv", help="tensions and wrench as a table as well")
    add_model_arguments(parser)
    parser.add_argument(
        "--rate",
        type=positive,
        metavar="HZ",
        help="step and answer at this rate from the first sample on, with pose and twist from the cubic Hermite curve through the recorded "
        "ones (default: at the recorded samples)",
    )
    add_topic_arguments(parser)
    parser.add_argument(
        "--accuracy",
        action="store_true",
        help="estimate the error of these settings around the highest tension, by solving up to 60 s again on a finer mesh with half the step",
    )
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output, nothing else")


def run(args):
    check_output(args.output, args.scene, args.motion, suffix=".mcap")
    if args.csv:
        check_output(args.csv, args.scene, args.motion)
        if same_file(args.csv, args.output):
            raise UsageError(f"{args.csv}: both outputs have this name, expected two names")
    motion = _motion(args)
    settings = _settings(args, motion)
    mooring = load_mooring(args.scene, **{name: settings[name] or None for name in MODEL}, platforms=motion.platforms or None)
    for remark in (*remarks_on(mooring), *motion.remarks):
        complain(remark)
    scene_is_recorded = _compare_scenes(args.scene, mooring.scene, motion)

    from .replay_accuracy import Watched
    from .replay_work import replay

    watched = Watched() if args.accuracy else None
    done = replay(args, mooring, motion, settings, watched)
    chosen = {name: settings[name] for name in MODEL if settings[name]} | {"platforms": mooring.platforms}
    accuracy = watched.estimate(mooring.scene, chosen) if watched else None
    found = {
        "output": args.output,
        "csv": args.csv,
        "motion": motion.source,
        "answers": done.answers,
        "simulated": done.simulated,
        "elapsed": done.elapsed,
        "real_time_factor": done.speed,
        "uneven": {"answers": done.uneven[0], "first": done.uneven[1]},
        "settings": {name: settings[name] or None for name in MODEL},
        "identical": {"same": done.identical.same, "total": done.identical.total} if done.identical else None,
        "scene_is_recorded": scene_is_recorded,
        "scale": {name: settings[name] for name in ("scale", "density_ratio")},
        "accuracy": accuracy and accuracy.as_dict(),
    }
    print_json(found) if args.json else print(_text(found))
    return 0


def _motion(args):
    from .motion_file import load_motion

    with reading(args.motion):
        motion = load_motion(args.motion, args.topic, names_of(args.platforms))
    if args.rate and motion.schedule is not None:
        raise UsageError(
            f"{args.motion}: a recording of the node is replayed step by step, expected no --rate, or --topic NAME with it to take an input's motion alone"
        )
    return motion


def _settings(args, motion):
    """The node's parameters that this replay stands for: the recorded ones where there are any, and over them what the command line says."""
    recorded = motion.parameters or {}
    settings = {**DEFAULTS, **recorded}
    if motion.schedule is None:
        # The motion is at full scale in world axes now, whatever its source was; the answers are so, too.
        settings.update({name: DEFAULTS[name] for name in AXES_AND_SCALE})
    asked = {name: getattr(args, name) for name in MODEL if getattr(args, name) is not None}
    if motion.schedule is not None and any(value != settings[name] for name, value in asked.items()):
        complain(f"{args.motion}: recorded with {_listed(settings)}; with {_listed(asked)} the tensions will differ")
    settings.update(asked, scene=os.fspath(args.scene), platforms=list(motion.platforms))
    return settings


def _compare_scenes(path, scene, motion):
    """Whether the scene is the one in the recording; None when there is none. Says so when not."""
    if motion.scene is None:
        return None
    recorded, files = motion.scene, dict(scene.files)
    differing = [] if recorded.text == scene.text else [recorded.name]
    differing += [name for name, text in recorded.files if files.get(name) != text]
    if differing:
        complain(f"{path}: differs from the scene in the recording {motion.path} ({', '.join(differing)}); this one is used")
    return not differing


def _listed(settings):
    return ", ".join(f"{name} {settings[name] or 'chosen from the scene'}" for name in MODEL if name in settings)


def _text(found):
    text = [
        f"{found['output']}: {found['answers']} answers to {found['motion']}, {found['simulated']:.6g} s"
        f" in {found['elapsed']:.3g} s ({found['real_time_factor']:.3g} times real time once it runs)"
    ]
    if found["scale"] != {"scale": 1.0, "density_ratio": 1.0}:
        text.append(f"at {scale_in_words(**found['scale'])}, as recorded: forces, moments, lengths and times alike")
    if found["csv"]:
        text.append(f"{found['csv']}: the same as a table")
    if found["identical"]:
        text.append(f"identical: {found['identical']['same']} of {found['identical']['total']} recorded tension messages came out again, bit for bit")
    if found["uneven"]["answers"]:
        text.append(
            f"uneven: in {found['uneven']['answers']} of {found['answers']} answers, the first at {found['uneven']['first']:.6g} s, tensions jump from step to step "
            "however fine the steps: lines snap taut, and what single peaks are is a matter of chance"
        )
    if found["accuracy"]:
        text.append(_accuracy_text(found["accuracy"]))
    return "\n".join(text)


def _accuracy_text(found):
    if found["why"]:
        return f"accuracy: no estimate: {found['why']}"
    return (
        f"accuracy: tensions within {_two_digits(found['mean'])} % in the mean, {_two_digits(found['dynamic'])} % dynamic (rms over standard deviation), "
        f"{_two_digits(found['peak'])} % at the peak, worst {found['line']}, estimated from {found['begin']:.6g} to {found['end']:.6g} s by comparing {found['compared']}"
    )


def _two_digits(value):
    """A number with two digits, or all before its point: never 1e+02."""
    return f"{value:.2g}" if abs(value) < 99.5 else f"{value:.0f}"
