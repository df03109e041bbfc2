"""The one error of the recording room."""


class RecordingError(ValueError):
    """A recording that cannot be created, read or recovered; the text names the file and what was expected."""
