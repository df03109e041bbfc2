"""Errors of the mooring computation."""


class MooringError(RuntimeError):
    """A computation that cannot be completed: a step that would blow up, statics that do not converge."""
