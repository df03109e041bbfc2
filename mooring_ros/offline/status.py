"""`mooring status`: a running node in a terminal: states, rates, delay, tensions, worst step. The one command that needs a ROS graph."""

import os
import sys
import time

from .arguments import positive
from .console import ComputationFailed, UsageError, print_json
from .status_text import status_text
from .status_view import View

_CLEAR = "\x1b[H\x1b[J"
_RATES_AFTER = 1.5  # s that --once listens after the first diagnostics, for the rates


def add_arguments(parser):
    parser.add_argument("--node", metavar="NAME", help="the node's full name (default: the one that /diagnostics tells of)")
    parser.add_argument("--once", action="store_true", help="say it once and end")
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output, nothing else; with it --once")
    parser.add_argument("--wait", type=positive, default=5.0, metavar="S", help="how long to wait for a node (default: %(default)g s)")
    parser.add_argument("--interval", type=positive, default=1.0, metavar="S", help="how often it is shown anew (default: %(default)g s)")


def run(args):
    node = args.node and "/" + args.node.strip("/")
    try:
        from .status_listener import Listener
    except ImportError as missing:
        raise UsageError(f"mooring status: {missing}; expected ROS 2, sourced or from wheels (./run mooring status)") from missing
    view = View(node)
    with Listener(view) as listener:
        if not listener.spin(args.wait, lambda: view.heard):
            raise ComputationFailed(_nobody(view, node, args.wait))
        if len(view.nodes) > 1 and node is None:
            names = ", ".join(sorted(view.nodes))
            raise UsageError(f"mooring status: {len(view.nodes)} nodes are running ({names}), expected --node with one of them")
        if args.once or args.json:
            listener.spin(_RATES_AFTER)
            picture = view.picture(time.monotonic())
            print_json(picture) if args.json else print(status_text(picture, sys.stdout.isatty()))
            return 0
        while True:
            listener.spin(args.interval)
            text = status_text(view.picture(time.monotonic()), sys.stdout.isatty())
            print(_CLEAR + text if sys.stdout.isatty() else text + "\n", flush=True)


def _nobody(view, node, wait):
    who = f"the node {node}" if node else "a mooring node"
    others = f"; heard: {', '.join(sorted(view.nodes))}" if view.nodes else ""
    domain, reach = os.environ.get("ROS_DOMAIN_ID", "0"), os.environ.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET")
    return (f"mooring status: nothing heard of {who} within {wait:g} s{others}; expected it to run with ROS_DOMAIN_ID={domain} within reach of "
            f"ROS_AUTOMATIC_DISCOVERY_RANGE={reach}")
