"""The quick ones of `./run bench faults`: none gives a wrong wrench, each is told with its cause, and the node goes on as documented.

How soon it is told depends on how busy the machine is: the benchmark holds it against half a second.
"""
import pytest

from benchmarks.faults import campaign, rig as rigs
from benchmarks.faults.registry import FAULTS
from benchmarks.faults.rig import Rig
from benchmarks.faults.setups import SETUPS

QUICK = sorted((fault for fault in FAULTS if fault.quick), key=lambda fault: fault.node or "")


@pytest.fixture(autouse=True)
def patience(monkeypatch):
    monkeypatch.setattr(rigs, "SHOWN_WITHIN", 10.0)


@pytest.fixture(scope="module")
def shared():
    """The rig of the node that the last fault ran on, by the name of its setup."""
    rigs_by_node = {}
    yield rigs_by_node
    for rig in rigs_by_node.values():
        rig.__exit__()


@pytest.mark.parametrize("fault", QUICK, ids=lambda fault: fault.name)
def test_a_fault_gives_no_wrong_wrench_is_told_with_its_cause_and_ends_as_documented(fault, shared, tmp_path):
    if fault.node is None:
        fault.act(str(tmp_path))
        return
    rig = shared.get(fault.node)
    if rig is None or not rig.process.alive:
        for other in shared.values():       # one node at a time
            other.__exit__()
        shared.clear()
        rig = shared[fault.node] = Rig(SETUPS[fault.node]).__enter__()
    else:
        rig.fresh()
    fault.act(rig)
    rig.judged()


def test_the_campaign_has_more_than_twenty_five_kinds_each_with_its_recovery():
    assert len({fault.name for fault in FAULTS}) == len(FAULTS) > 25
    assert all(fault.what and fault.recovery and callable(fault.act) for fault in FAULTS)
    assert {fault.node for fault in FAULTS} - {None} == set(campaign.SETUPS)
