"""`mooring`: the command line. Needs no ROS graph, but for `status`.

Exit status: 0 done; 1 the computation failed; 2 bad usage or bad input; 130 on Ctrl-C, with every output file closed and readable.
"""

import argparse
import os
import re
import signal
import sys
import threading

from . import check, recover, replay, static, status, trade, validate
from .console import ComputationFailed, UsageError, complain

COMMANDS = {
    "check": (check, "what a scene contains, what is switched on because of it, its largest stable step and its cost"),
    "static": (static, "the static solution: tensions, forces, platform stiffness"),
    "replay": (replay, "recorded motion in, forces out, as fast as it goes"),
    "validate": (validate, "two tension histories side by side"),
    "trade": (trade, "the speed-accuracy trade of a scene on this machine, and the setting to use"),
    "recover": (recover, "make a recording that was cut off readable again"),
    "status": (status, "a running node: states, rates, delay, tensions, worst step"),
}


def main(argv=None) -> int:
    """Run one command; argv as in sys.argv[1:]. Returns the exit status and writes what went wrong, in one line, to standard error."""
    if threading.current_thread() is threading.main_thread():
        # A shell that starts us in the background has SIGINT ignored; outputs must be closed on it all the same.
        signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        args = _parser().parse_args(_joined(sys.argv[1:] if argv is None else list(argv)))
    except SystemExit as stop:  # argparse: 2 for bad usage, 0 after --help
        return int(stop.code or 0)
    try:
        status = args.run(args)
        sys.stdout.flush()
        return status
    except KeyboardInterrupt:
        complain("mooring: interrupted")
        return 130
    except UsageError as error:
        complain(str(error))
        return 2
    except ComputationFailed as error:
        complain(str(error))
        return 1
    except BrokenPipeError:
        _drop_output()  # whoever read it has gone
        return 1
    except MemoryError as error:
        complain(f"mooring: not enough memory: {error}")
        return 1
    except OSError as error:
        complain(f"mooring: {error}")
        _drop_output()
        return 1


def _drop_output():
    """Keep the interpreter from complaining at exit about what could not be written."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


class _Parser(argparse.ArgumentParser):
    def error(self, message):
        """One line, not the whole usage."""
        self.exit(2, f"{self.prog}: {message} (see {self.prog} --help)\n")


def _parser():
    parser = _Parser(prog="mooring", description="Mooring forces, offline.", allow_abbrev=False)
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, (module, summary) in COMMANDS.items():
        command = commands.add_parser(name, help=summary, description=summary[0].upper() + summary[1:] + ".", allow_abbrev=False)
        module.add_arguments(command)
        command.set_defaults(run=module.run)
    return parser


def _joined(argv):
    """argv in the form that argparse understands: `--pose -1,0,…` would pass for an option, `--map A=B C=D` for one pair and a file."""
    joined, option = [], None
    for word in argv:
        if option == "--pose" and re.match(r"-[\d.]", word):
            joined[-1], option = f"--pose={word}", None
        elif option == "--map" and "=" in word and not word.startswith("-") and not os.path.exists(word):
            if joined[-1] == "--map":
                joined.pop()
            joined.append(f"--map={word}")
        else:
            joined.append(word)
            option = word
    return joined


if __name__ == "__main__":
    sys.exit(main())
