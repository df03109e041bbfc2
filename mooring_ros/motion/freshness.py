"""Whether a pose was measured, or is the last one sent again: some camera drivers do so while the platform is out of sight."""

_NOISY = 100        # poses in a row without an equal pair: the source has noise, so equal ones are no measurement


class Freshness:
    """Watches the poses of one source, good and refused ones. new: whether the last differs from the one before."""

    def __init__(self):
        self.new = True
        self._last, self._different = None, 0

    def frozen(self, pose):
        """Take a finite pose (7,) as it came; returns whether it is the last one again, bit for bit, of a source that has noise."""
        self.new, self._last = pose != self._last, pose
        if self.new:
            self._different += 1
            return False
        if self._different >= _NOISY:
            return True
        self._different = 0
        return False
