"""What /diagnostics says of the recording, by its state."""
from types import SimpleNamespace

import pytest
from builtin_interfaces.msg import Time

from mooring_ros.node.diagnostics import ERROR, OK, WARN, Diagnostics, fingerprint


def recorder(error=None, lost=0, behind=0.1):
    return SimpleNamespace(path="run.mcap", written=7, error=error, lost=lost, behind=behind)


@pytest.mark.parametrize("state, level, words", [
    (recorder(), OK, "7 messages"),
    (recorder(behind=1.5), WARN, "1.5 s behind, the disk is slow"),
    (recorder(lost=3, behind=1.5), ERROR, "3 messages lost"),
    (recorder(error="run.mcap: No space left on device", lost=3), ERROR, "run.mcap: No space left on device"),
    (None, OK, "off"),
])
def test_the_worst_is_told_and_a_disk_that_owes_more_than_a_second_is_a_warning(state, level, words):
    message = Diagnostics("/mooring").array(0.0, Time(), "inactive", recorder=state)
    (status,) = [status for status in message.status if status.name == "mooring: recording"]
    assert (status.level, status.message) == (level, words)


def test_what_happens_to_the_recording_is_told_at_once_and_a_message_more_is_not():
    quiet = fingerprint(None, "inactive", recorder=recorder())
    assert quiet == fingerprint(None, "inactive", recorder=recorder(behind=0.3))
    for news in (recorder(error="full"), recorder(lost=1), recorder(behind=1.1)):
        assert fingerprint(None, "inactive", recorder=news) != quiet
    assert fingerprint(None, "inactive", recorder=recorder(), publishers=2) != fingerprint(None, "inactive", recorder=recorder(), publishers=1)
