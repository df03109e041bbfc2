"""The parameters that act at once, put where they act."""
from mooring_ros.node.punctuality import GRADES, THRESHOLDS

HOLD_TIME = 1.0     # s, the ramp into HOLD and SAFE, and out of them, where ramp_time does not say


def apply(values, session, outputs, punctuality):
    """values: name -> value of all parameters."""
    limits, output, watch = session.gate.limits, session.output, session.watch
    for name in vars(limits):
        setattr(limits, name, values[f"limits.{name}"])
    to_inside = 1.0 / session.gate.adapter.force_factor
    output.force, output.force_rate = values["limits.force"] * to_inside, values["limits.force_rate"] * to_inside
    output.ramp_time, output.ramp_from = values["ramp_time"], values["ramp_from"]
    output.hold_time = values["ramp_time"] or HOLD_TIME
    watch.input_age, watch.lost_frames, watch.heartbeat = values["limits.input_age"], values["limits.lost_frames"], values["limits.heartbeat"]
    watch.input_rate = values["input_rate"]
    session.most_wound = values["limits.winch"]
    session.delay.mode, session.delay.seconds = values["delay.compensate"], values["delay.seconds"]
    outputs.visual_rate, outputs.stiffness.rate = values["visual_rate"], values["stiffness_rate"]
    punctuality.thresholds = {name: tuple(values[f"timing.threshold.{name}.{grade}"] for grade in GRADES) for name in THRESHOLDS}
