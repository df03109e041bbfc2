"""What keeps an exception from ending the process: rclpy swallows those of transitions, and lets all others through to the loop."""
import functools
import traceback

from rclpy.lifecycle import TransitionCallbackReturn


def transition(callback):
    """Of a lifecycle callback: what goes wrong is logged, and an error."""
    @functools.wraps(callback)
    def guarded(self, state):
        try:
            return callback(self, state)
        except Exception:
            self.get_logger().fatal(f"{callback.__name__} failed:\n{traceback.format_exc()}")
            return TransitionCallbackReturn.ERROR
    return guarded


def live(callback):
    """Of what happens while the node is active: an exception that nobody expected is a fault, and the output goes to the static wrench.

    An event that was waiting when the node was deactivated is nothing any more. The node has `active` and `fault(words)`.
    """
    @functools.wraps(callback)
    def guarded(self, *arguments):
        if not self.active:
            return None
        try:
            return callback(self, *arguments)
        except Exception as error:
            self.get_logger().fatal(f"{callback.__name__} failed:\n{traceback.format_exc()}", throttle_duration_sec=5.0)
            self.fault(f"{type(error).__name__} in {callback.__name__}: {error}")
    return guarded


def refuse_unknown_transitions(node):
    """Answer requests for transitions that there are none of in the present state with no success: rclpy would end the process."""
    service, machine = node._service_change_state, node._state_machine
    change = service.callback

    def checked(request, response):
        known = machine.available_transitions
        wanted = request.transition.label or request.transition.id
        if wanted in {label for _, label, *_ in known} | {number for number, *_ in known}:
            return change(request, response)
        node.get_logger().warning(f"there is no transition {wanted!r} from the state {machine.current_state[1]}, expected one of "
                                  + ", ".join(f"{label} ({number})" for number, label, *_ in known))
        response.success = False
        return response

    service.callback = checked
