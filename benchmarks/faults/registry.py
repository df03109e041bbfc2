"""The list of faults."""
from typing import Callable, NamedTuple

FAULTS = []


class Fault(NamedTuple):
    """act(rig) does it, and raises Wrong when the node does what it must not. node: name in setups.SETUPS, None where `act` starts its own
    (act(folder), which returns its rig).

    recovery: what is documented, in words. quick: whether it belongs to the tests.
    """

    name: str
    what: str
    recovery: str
    node: str | None
    quick: bool
    act: Callable


def fault(what, recovery, node="plain", quick=True):
    """Decorator: put a function on the list, under its name."""
    def put(act):
        FAULTS.append(Fault(act.__name__, what, recovery, node, quick, act))
        return act
    return put
