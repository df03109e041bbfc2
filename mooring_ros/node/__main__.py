"""`mooring_node`: the process around the node.

Exit status: 0 after SIGINT, SIGTERM or SIGHUP (the usual end of a node), or after a lifecycle shutdown; 2 for arguments or parameters that are wrong.
A scene that cannot be loaded does not end the process: the node stays unconfigured, says so in its log and diagnostics, and
can be given another scene.
"""
import signal
import sys

import rclpy
from rclpy.exceptions import (InvalidParameterTypeException, InvalidParameterValueException, InvalidNodeNameException,
                              InvalidNamespaceException)
from rclpy.executors import ExternalShutdownException
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args

from mooring_ros.node.loop import Loop
from mooring_ros.node.mooring_node import MooringNode

USAGE = """usage: mooring_node [--ros-args -p scene:=FILE [-p NAME:=VALUE ...] [--params-file FILE] [-r FROM:=TO ...]]

Answers the platform's motion on platform/odom with mooring forces on ~/wrench. Parameters, topics and services: see the README."""

_WRONG_ARGUMENTS = (rclpy_implementation.RCLError, rclpy_implementation.RCLInvalidROSArgsError, rclpy_implementation.UnknownROSArgsError,
                    InvalidParameterTypeException, InvalidParameterValueException, InvalidNodeNameException, InvalidNamespaceException)


class _Signals:
    """SIGINT, SIGTERM and SIGHUP (the terminal is gone) ask the loop to end. Before there is anything to close, they end the process at once."""

    def __init__(self):
        self.stop = False
        self.at_once = True
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            if number != signal.SIGHUP or signal.getsignal(number) != signal.SIG_IGN:      # which is what nohup asks for
                signal.signal(number, self._handle)

    def _handle(self, number, frame):
        first, self.stop = not self.stop, True
        if self.at_once and first:
            raise KeyboardInterrupt

    @staticmethod
    def ignore():
        """For the end of the process: Python gives up handlers while it still has things to do, and a further signal would end it with another status."""
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.SIG_IGN)


def main(arguments=None):
    """Run the node until it is told to end; returns the exit status."""
    arguments = sys.argv if arguments is None else [sys.argv[0], *arguments]
    signals = _Signals()
    try:
        rest = remove_ros_args(arguments)[1:]
        if set(rest) & {"-h", "--help"}:
            print(USAGE)
            return 0
        if rest:
            return _usage(f"unknown argument {rest[0]}, expected --ros-args ...; see --help")
        rclpy.init(args=arguments, signal_handler_options=SignalHandlerOptions.NO)
        node = MooringNode()
    except _WRONG_ARGUMENTS as error:
        rclpy.try_shutdown()
        return _usage(" ".join(str(error).split()))
    except KeyboardInterrupt:
        rclpy.try_shutdown()
        return 0
    executor = EventsExecutor()
    executor.add_node(node)
    loop = Loop(executor, node)
    try:
        _start(node)
        signals.at_once = False
        while not signals.stop and rclpy.ok():
            loop.turn()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        signals.at_once = False
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()
        signals.ignore()
    return 0


def _usage(words):
    print(f"mooring_node: {words}", file=sys.stderr)
    return 2


def _start(node):
    if not node.get_parameter("autostart").value:
        return
    if node.trigger_configure() == TransitionCallbackReturn.SUCCESS:
        node.trigger_activate()


if __name__ == "__main__":
    sys.exit(main())
