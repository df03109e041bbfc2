"""`./run demo`: a moored floater in waves, simulator and mooring node as two ROS 2 processes, recorded, replayed and reported.

Exit status: 0 done; 1 the run failed, or its replay differs; 2 bad usage or bad input; 130 on Ctrl-C (143 on SIGTERM), with every file closed
and no process left.
"""

import argparse
import signal
import sys

from mooring_ros.demo import coupling, demo_report, numbers, replay
from mooring_ros.demo.history import read_history
from mooring_ros.demo.options import add_sea_arguments, sea_state
from mooring_ros.demo.places import default_scene, make_output
from mooring_ros.demo.progress import Progress
from mooring_ros.demo.waves import Waves
from mooring_ros.offline.arguments import add_model_arguments
from mooring_ros.offline.console import table
from mooring_ros.recording.errors import RecordingError
from mooring_ros.scene import SceneError, load_scene


def main(argv=None):
    """Entry point; returns the exit status."""
    options = _parser().parse_args(argv)
    received = []
    before = {number: signal.signal(number, lambda number, _: received.append(number)) for number in (signal.SIGINT, signal.SIGTERM)}
    folder = None
    try:
        scene = load_scene(options.scene)
        folder = make_output(options.out)
        return _demo(options, scene, folder, lambda: bool(received))
    except KeyboardInterrupt:
        _complain("interrupted" + (f"; what was recorded is in {folder}" if folder else ""))
        return 128 + (received[0] if received else signal.SIGINT)
    except SceneError as error:
        print(error, file=sys.stderr)
        return 2
    except coupling.RunFailed as error:
        _complain(str(error))
        return 2 if error.status == 2 else 1
    except (replay.ReplayFailed, RecordingError) as error:
        _complain(str(error))
        return 1
    except OSError as error:
        _complain(f"{error.filename or folder}: {error.strerror or error}")
        return 2 if folder is None else 1
    except ValueError as error:
        _complain(str(error))
        return 2 if folder is None else 1
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _demo(options, scene, folder, interrupted):
    variables = coupling.environment()
    progress = Progress(options.duration)
    _say(f"ROS_DOMAIN_ID={variables['ROS_DOMAIN_ID']}, results in {folder}")
    run = coupling.run(options, options.scene, scene.environment.depth, folder, variables, progress, interrupted)
    start = run.summary["start_stamp"]
    history = read_history(run.recording, start)
    _say("replaying the recording offline")
    comparison = replay.compare(history.answers, replay.replay(options.scene, run.recording, folder, variables, interrupted), start)
    waves = Waves(sea_state(options), scene.environment.depth)
    report = folder / "report.html"
    demo_report.write(report, scene, waves, history, run.summary, comparison)
    print(_results(history, run.summary, comparison))
    print(f"\nrecording  {run.recording}\nreport     {report}")
    return 0 if comparison.identical else 1


def _results(history, summary, comparison):
    tensions = table(["fairlead tension (kN)", "mean", "std", "least", "greatest"], numbers.tension_rows(history.answers))
    motions = table(["motion", "mean", "least", "greatest"], numbers.motion_rows(history.poses, ("surge", "heave", "pitch")))
    speed = f"{numbers.real_time_factor(summary):.1f} times real time, lost steps: {summary['lost']} of {summary['sent']}"
    return f"{tensions}\n\n{motions}\n\n{speed}\nreplayed offline: {numbers.replay_words(comparison)}"


class _Parser(argparse.ArgumentParser):
    def error(self, message):
        """One line, not the whole usage."""
        self.exit(2, f"demo: {message} (see demo --help)\n")


def _parser():
    parser = _Parser(prog="demo", allow_abbrev=False, description="A moored floater in waves: two ROS 2 processes, a recording and a report.")
    add_sea_arguments(parser)
    parser.add_argument("--scene", default=str(default_scene()), metavar="FILE", help="MoorDyn v2 file of the moorings (default: the chains of the VolturnUS-S)")
    parser.add_argument("--out", metavar="DIR", help="new or empty folder for the results (default: out/demo-<date-time>)")
    add_model_arguments(parser)
    return parser


def _say(text):
    print(text, file=sys.stderr, flush=True)


def _complain(text):
    print(f"demo: {text}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
