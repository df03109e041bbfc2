"""Services and parameters of the node. They need request ids that only an rmw gives, so these go through rclpy."""
import os
import time

from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rcl_interfaces.srv import SetParameters
from std_srvs.srv import Trigger

TRANSITIONS = {"configure": Transition.TRANSITION_CONFIGURE, "activate": Transition.TRANSITION_ACTIVATE,
               "deactivate": Transition.TRANSITION_DEACTIVATE, "cleanup": Transition.TRANSITION_CLEANUP}


class Services:
    """Asks the node under the name `node` on a domain. Everything raises TimeoutError when there is no answer."""

    def __init__(self, domain, node="mooring"):
        os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
        import rclpy
        from rclpy.experimental.events_executor import EventsExecutor

        self._node_name = node
        self._context = rclpy.Context()
        self._context.init(domain_id=domain)
        self._node = rclpy.create_node("fault_services", context=self._context)
        self._executor = EventsExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._clients = {}

    def trigger(self, name, timeout=30.0):
        """(success, message) of ~/NAME."""
        answer = self._call(name, Trigger, Trigger.Request(), timeout)
        return answer.success, answer.message

    def transition(self, label, timeout=60.0):
        """Whether a lifecycle transition succeeded; label: its name, or a number of none."""
        request = ChangeState.Request()
        request.transition.id = TRANSITIONS.get(label, label)
        return self._call("change_state", ChangeState, request, timeout).success

    def state(self, timeout=10.0):
        """Label of the lifecycle state."""
        return self._call("get_state", GetState, GetState.Request(), timeout).current_state.label

    def set(self, name, value):
        """(success, reason) of a change of one parameter."""
        from rclpy.parameter import Parameter

        request = SetParameters.Request(parameters=[Parameter(name, value=value).to_parameter_msg()])
        result = self._call("set_parameters", SetParameters, request, 10.0).results[0]
        return result.successful, result.reason

    def close(self):
        """End the client."""
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()

    def _call(self, name, service_type, request, timeout):
        end = time.monotonic() + timeout
        client = self._clients.get(name)
        if client is None:
            client = self._clients[name] = self._node.create_client(service_type, f"{self._node_name}/{name}")
        self._until(client.service_is_ready, end, f"there is no service {name}")
        future = client.call_async(request)
        self._until(future.done, end, f"the service {name} does not answer")
        return future.result()

    def _until(self, condition, end, words):
        while not condition():
            if time.monotonic() > end:
                raise TimeoutError(words)
            self._executor.spin_once(timeout_sec=0.02)
