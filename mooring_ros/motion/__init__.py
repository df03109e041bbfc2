"""Platform motion: frames and conventions, the gate that keeps bad input out, twist from poses. numpy only, no ROS."""

from .convention_check import ConventionCheck, Verdict
from .frames import Adapter, scale_in_words, twist_axes
from .gate import Gate, Limits, Motion, Sample, Velocity
from .pairing import Pairs
from .prediction import Predictor, carry_on
from .velocity import OnlineTwist, twist_from_poses

__all__ = ["Adapter", "ConventionCheck", "Gate", "Limits", "Motion", "OnlineTwist", "Pairs", "Predictor", "Sample", "Velocity", "Verdict", "carry_on",
           "scale_in_words", "twist_axes", "twist_from_poses"]
