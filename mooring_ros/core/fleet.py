"""Many moorings advanced in one call, without the interpreter between them.

Every mooring has its own state; those of equal scenes share their model, and all that one thread advances share its work space. The stepping
kernel is called through its address: what it does, and its bits, are those of a single mooring's.
"""

from typing import NamedTuple

import numpy as np
from numba.core import types

from .address import address_of, caller, tuple_at
from .cache import kernel, stage
from .explicit import DONE, run
from .model import Model, Scratch, State
from .packed import Fields, entry, packed
from .readings import Readings


@packed
class Member(NamedTuple):
    """One mooring of a fleet: what `explicit.run` needs of it, but for work space."""

    model: Model
    state: State
    table: np.ndarray  # (schemes, 3), schemes.step_table
    report: np.ndarray  # (5,)
    readings: Readings  # of one row


_FLOATS = tuple(types.Array(types.float64, ndim, "C") for ndim in (2, 1, 3, 3, 1))  # table, times, poses, twists, report
_RUN = types.UniTuple(types.int64, 2), (Fields(Model), Fields(State), Fields(Scratch), *_FLOATS, Fields(Readings))  # result and arguments of explicit.run
_member_at, _scratch_at, _run_at = tuple_at(Member), tuple_at(Scratch), caller(*_RUN)


def run_address(member, scratch):
    """Where the stepping kernel is in this process, compiled for what a Member and its Scratch look like."""
    for known in (member, scratch):
        known.address  # noqa: B018  (its layout must be known before anything is compiled)
    return address_of(run.dispatcher, *_RUN)


@entry
@kernel
def read_clocks(members, clocks):
    """Times (s) at which members (addresses) stand, into clocks (members,)."""
    for m in range(members.size):
        clocks[m] = _member_at(members[m]).state.clock[0]


@stage
def _show_member(shown, m, row, first_line, wrench, tension):
    for p in range(wrench.shape[2]):
        for k in range(6):
            wrench[row, m, p, k] = shown.wrench[0, p, k]
    for line in range(first_line[m], first_line[m + 1]):
        for side in range(2):
            tension[row, line, side] = shown.tension[0, line - first_line[m], side]


@entry
@kernel
def collect(members, first_line, wrench, tension):
    """What members (addresses) show, into one row: wrench (1, members, platforms, 6) N, N m; tension (1, all lines, 2) N, of anchors and fairleads."""
    for m in range(members.size):
        _show_member(_member_at(members[m]).readings, m, 0, first_line, wrench, tension)


@entry
@kernel
def advance_many(address, members, kinds, scratches, first, last, times, poses, twists, first_line, status, wrench, tension):
    """Advance members first to last - 1 through samples: times (k, 1), poses (members, k, 1, platforms, 7), twists (members, k, 1, platforms, 6).

    members (members,): addresses of Members; kinds (members,): which of `scratches`, addresses of Scratches, serves each. status (members, 2):
    members whose first one is not DONE are left alone; it gets a status code, and when that is another one the samples done before. wrench (k, members, platforms, 6) N, N m and
    tension (k, all lines, 2) N, of anchors and fairleads, get a row for each sample done; lines of member m begin at first_line[m].
    """
    for m in range(first, last):
        if status[m, 0] != DONE:
            continue
        member, scratch = _member_at(members[m]), _scratch_at(scratches[kinds[m]])
        shown = member.readings
        for j in range(times.shape[0]):
            code, _ = _run_at(
                address, member.model, member.state, scratch, member.table, times[j], poses[m, j], twists[m, j], member.report, shown
            )
            if code != DONE:
                status[m, 0], status[m, 1] = code, j  # samples done
                break
            _show_member(shown, m, j, first_line, wrench, tension)
