"""The parameters of the nodes that several faults share."""

QUIET = {"accuracy.enabled": False}     # the estimate has a processor's share of its own, which shows nothing here

SETUPS = {
    "plain": QUIET,
    "age": {**QUIET, "limits.input_age": 0.5},
    "heartbeat": {**QUIET, "limits.heartbeat": 0.3},
    "settling": {**QUIET, "on_reset": "settle"},
}
