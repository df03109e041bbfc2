"""What the node has once for each platform, where it has several: topics in, and resets. Gates: motion/ensemble.py."""
from mooring_ros.motion.ensemble import OfPlatform
from mooring_ros.node.inputs import Inputs
from mooring_ros.node.resets import Resets


def refuse(values):
    """Raise ValueError for parameters (name -> value) that go with one platform only."""
    if values["platforms"] and values["platform_frame"]:
        raise ValueError(
            f"platform_frame is {values['platform_frame']!r}, expected none with several platforms: the first sample of each names its own")


def name_list(names):
    """Raise ValueError for what is no list of names that topics can have."""
    if not isinstance(names, (list, tuple)) or not all(isinstance(name, str) and name.isidentifier() for name in names):
        raise ValueError(f"platforms is {names!r}, expected names of coupled bodies, as [body1, body2]")


class AllResets:
    """`Resets` of several platforms: `each` of them, and all together."""

    def __init__(self, policy, count):
        self.each = [Resets(policy) for _ in range(count)]

    def clock_went_back(self):
        """/clock has jumped back."""
        for resets in self.each:
            resets.clock_went_back()

    @property
    def count(self):
        """Of the platform that has seen most."""
        return max(resets.count for resets in self.each)

    @property
    def cause(self):
        """Words for the last of that platform."""
        return max(self.each, key=lambda resets: resets.count).cause


class AllInputs:
    """`Inputs` of several platforms, below platforms/NAME; their samples are taken as OfPlatform."""

    def __init__(self, node, kind, twist_frame, ensemble, take):
        def taken(number):
            return lambda sample, *rest: take(None if sample is None else OfPlatform(number, sample), *rest)

        self._each = [Inputs(node, kind, twist_frame, gate, taken(number), f"platforms/{name}")
                      for number, (name, gate) in enumerate(zip(ensemble.names, ensemble.gates))]
        self.topics = {name: kind for inputs in self._each for name, kind in inputs.topics.items()}

    def destroy(self):
        """End all subscriptions."""
        for inputs in self._each:
            inputs.destroy()

    def publishers(self):
        """See `Inputs.publishers`."""
        return max(inputs.publishers() for inputs in self._each)

    def review(self):
        """See `Inputs.review`."""
        return [name for inputs in self._each for name in inputs.review()]
