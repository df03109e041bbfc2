"""Exceptions that nobody expected."""
from rclpy.lifecycle import TransitionCallbackReturn

from mooring_ros.node import guards


class Node:
    """As much of the node as the guards need."""

    def __init__(self, active=True):
        self.active = active
        self.said, self.faults = [], []

    def get_logger(self):
        return self

    def fatal(self, words, **_):
        self.said.append(words)

    def fault(self, words):
        self.faults.append(words)

    @guards.live
    def take(self, sample):
        return 10 // sample

    @guards.transition
    def on_configure(self, state):
        return TransitionCallbackReturn.SUCCESS if state else {}["gone"]


def test_an_exception_on_the_way_of_a_sample_is_a_fault_with_its_cause_and_its_place_in_the_log():
    node = Node()
    assert node.take(5) == 2 and not node.faults
    assert node.take(0) is None
    assert node.faults == ["ZeroDivisionError in take: integer division or modulo by zero"] and "test_guards.py" in node.said[0]


def test_what_was_waiting_when_the_node_was_deactivated_is_nothing_any_more():
    node = Node(active=False)
    assert node.take(0) is None and node.take(5) is None and not node.faults and not node.said


def test_an_exception_in_a_transition_is_an_error_of_it_with_its_place_in_the_log():
    node = Node()
    assert node.on_configure(True) == TransitionCallbackReturn.SUCCESS
    assert node.on_configure(False) == TransitionCallbackReturn.ERROR and "KeyError" in node.said[0]
