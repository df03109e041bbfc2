"""`mooring recover`: a recording that was cut off, readable by ordinary readers again."""

import sys
import time

from .console import print_json, reading


def add_arguments(parser):
    parser.add_argument("file", metavar="FILE", help="recording: an MCAP file or a bag folder")
    parser.add_argument("-o", "--output", metavar="OUT", required=True,
                        help="new recording: NAME.mcap for a single file, any other name for a bag folder; must not exist")
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output, nothing else")


def run(args):
    from mooring_ros.recording.recover import recover

    with reading(args.file), _Progress() as progress:
        found = recover(args.file, args.output, progress)
    for remark in found.cut + found.damage:
        print(remark, file=sys.stderr)
    if args.json:
        print_json({"output": found.path, "messages": found.messages, "topics": found.topics, "attachments": found.attachments,
                    "duration": _duration(found), "copied": found.copied, "cut": found.cut, "damage": found.damage})
    elif found.copied:
        print(f"{args.file} is whole: {found.path} is a copy of it, {found.messages} messages")
    else:
        print(f"{found.path}: {found.messages} messages on {len(found.topics)} topics, {_duration(found):.3f} s, "
              f"{found.attachments} attachments")
    return 0


class _Progress:
    """A line on standard error that says how much of a file has been read; silent when that is no terminal."""

    def __init__(self):
        self._shown = sys.stderr.isatty()
        self._next = time.monotonic() + 0.2

    def __enter__(self):
        return self

    def __call__(self, done, total):
        if self._shown and time.monotonic() > self._next:
            self._next = time.monotonic() + 0.2
            sys.stderr.write(f"\r\x1b[Krecover: {100 * done / total:.0f} % of {total / 1e6:.1f} MB")
            sys.stderr.flush()

    def __exit__(self, *_):
        if self._shown:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()


def _duration(found):
    """s from the first to the last message."""
    return (found.end - found.start) * 1e-9 if found.messages else 0.0
