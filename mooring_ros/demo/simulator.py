"""The floater simulator as a ROS 2 process: node `floater`, in lockstep with a mooring node.

`python -m mooring_ros.demo.simulator [options] [--ros-args …]`. It publishes `platform/odom` in simulated time and takes
`mooring/wrench`; a step is made when the answer to the last sample is there. Exit status: 0 done; 1 the mooring node is missing or
silent, or the motion ran away; 2 bad usage; 130 stopped by Ctrl-C or SIGTERM.
"""

import argparse
import json
import signal
import sys
import time
from dataclasses import asdict, dataclass

import rclpy
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args

from mooring_ros.coupling import Coupling, LinkError, Stopped
from mooring_ros.demo.floater import Floater
from mooring_ros.demo.hull import volturnus_s
from mooring_ros.demo.integrator import Integrator
from mooring_ros.demo.options import add_sea_arguments, sea_state
from mooring_ros.demo.waves import Excitation, Waves
from mooring_ros.offline.arguments import positive

_REPORT_EVERY = 0.2  # s of wall time between progress reports


@dataclass
class Summary:
    """What became of a run. Stamps in ns, times in s, round trips (from sending a sample to having its wrench) in ms.

    start_stamp belongs to simulated time 0. ballast (6,): what trims the floater under the moorings, N and N·m.
    """

    start_stamp: int
    step: float
    steps: int
    sent: int
    answered: int
    lost: int
    doubled: int
    late: int
    wall_time: float
    ballast: list
    round_trips: list


def run(coupling, integrator, steps, report=lambda time: None):
    """Couple for so many steps; the floater begins at rest, trimmed under the moorings' first answer.

    coupling: Coupling of the integrator's step; report: called now and then with the simulated time.
    Returns the Summary. Raises LinkError, Stopped, ArithmeticError.
    """
    integrator.floater.trim(coupling.begin(integrator.pose))
    started, next_report = time.perf_counter(), 0.0
    start_stamp, round_trips = None, []
    for number in range(steps + 1):
        coupling.exchange(integrator.pose, integrator.twist)
        start_stamp = coupling.stamp if start_stamp is None else start_stamp
        if coupling.round_trip is not None:
            round_trips.append(1e3 * coupling.round_trip)
        if time.perf_counter() >= next_report or number == steps:
            next_report = time.perf_counter() + _REPORT_EVERY
            report(integrator.time)
        if number < steps:
            integrator.advance(coupling.wrench)
    return Summary(
        start_stamp, integrator.step, steps, **asdict(coupling.counts), wall_time=time.perf_counter() - started,
        ballast=integrator.floater.ballast.tolist(), round_trips=[round(value, 4) for value in round_trips],
    )


def main(argv=None):
    """Entry point; returns the exit status."""
    arguments = sys.argv if argv is None else ["simulator", *argv]
    options = _parse(remove_ros_args(arguments)[1:])
    stopping = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stopping.append(True))
    rclpy.init(args=arguments, signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node("floater")
    step = 1.0 / options.rate
    coupling = Coupling(step, timeout=options.timeout, patience=options.patience, node=node, stop=lambda: bool(stopping))
    try:
        waves = Waves(sea_state(options), options.depth)
        integrator = Integrator(Floater(), Excitation(waves, volturnus_s()), step)
        steps = max(1, round(options.duration * options.rate))
        if not options.json:
            print(f"waiting for a mooring node on {coupling.topics}", flush=True)
        summary = run(coupling, integrator, steps, _reporter(options))
        if options.summary:
            with open(options.summary, "w", encoding="utf-8") as file:
                json.dump(asdict(summary), file)
        return 0
    except (LinkError, ArithmeticError, OSError) as error:
        print(f"floater: {error}", file=sys.stderr, flush=True)
        return 1
    except Stopped:
        return 130
    finally:
        coupling.close()
        node.destroy_node()
        rclpy.try_shutdown()


def _reporter(options):
    def report(time):
        if options.json:
            print(json.dumps({"time": time}), flush=True)
        else:
            print(f"{time:.1f} of {options.duration:g} s", flush=True)

    return report


def _parse(argv):
    parser = argparse.ArgumentParser(prog="mooring_ros.demo.simulator", description="A floater in waves, in lockstep with a mooring node.")
    add_sea_arguments(parser)
    parser.add_argument("--depth", type=positive, default=200.0, metavar="M", help="water depth in m (default: 200)")
    parser.add_argument("--timeout", type=positive, default=60.0, metavar="S", help="how long to wait for the mooring node, in s (default: 60)")
    parser.add_argument("--patience", type=positive, default=5.0, metavar="S", help="how long to wait for an answer, in s (default: 5)")
    parser.add_argument("--summary", metavar="FILE", help="write what became of the run here, as JSON")
    parser.add_argument("--json", action="store_true", help="progress as JSON lines")
    return parser.parse_args(argv)


if __name__ == "__main__":
    sys.exit(main())
