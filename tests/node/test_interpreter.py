"""The interpreter while a session runs, and after it."""
import gc
import sys

from mooring_ros.node import interpreter


def test_a_session_has_an_interpreter_without_collections_and_with_quick_threads_and_hands_it_back_as_it_was():
    usual = sys.getswitchinterval()
    interpreter.be_punctual()
    try:
        assert not gc.isenabled() and gc.get_freeze_count() > 0 and sys.getswitchinterval() < usual
    finally:
        interpreter.be_usual()
    assert gc.isenabled() and gc.get_freeze_count() == 0 and sys.getswitchinterval() == usual
