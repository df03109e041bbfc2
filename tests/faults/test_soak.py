"""The short form of `./run bench soak`."""
import pytest

from benchmarks.faults.soak import soak, verdicts

GOOD = {"missing": 0, "doubled": 0, "finite": True, "not recorded": {}, "replay": {"same": 9, "total": 9}, "status": 0, "drift": 1e-7,
        "growth (%)": 0.2}


def test_two_seconds_at_200_hz_lose_nothing_and_replay_bit_for_bit(tmp_path):
    found = soak(tmp_path, 2.0 / 60.0, 200.0)
    assert found["sent"] == 400 and verdicts(found, quick=True) == []


@pytest.mark.parametrize("change, words", [
    ({"missing": 1}, "1 wrenches missing"), ({"doubled": 2}, "2 doubled"), ({"finite": False}, "finite: False"),
    ({"not recorded": {"/mooring/wrench": 1}}, "not recorded"), ({"replay": {"same": 8, "total": 9}}, "differs"),
    ({"replay": {"same": 0, "total": 0}}, "differs"), ({"status": -9}, "status -9"), ({"drift": -1e-4}, "rate"), ({"growth (%)": 1.5}, "memory grew"),
])
def test_each_thing_that_is_not_as_wanted_is_said(change, words):
    assert verdicts(GOOD) == []
    (said,) = verdicts({**GOOD, **change})
    assert words in said
