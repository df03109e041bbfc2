"""MCAP recordings: written, read, recovered."""
from .errors import RecordingError

__all__ = ['RecordingError']
