"""Output paths, checked before the work starts."""

import os
from pathlib import Path

from .console import UsageError


def check_output(path, *inputs, suffix=None):
    """Refuse an output that could not be written, is a folder, or is one of the inputs. Raises UsageError."""
    path = Path(path)
    if suffix and path.suffix.lower() != suffix:
        raise UsageError(f"{path}: cannot be the output, expected a name that ends in {suffix}")
    if path.is_dir():
        raise UsageError(f"{path}: is a folder, expected a file name for the output")
    for given in inputs:
        if given is not None and same_file(path, given):
            raise UsageError(f"{path}: the output is an input as well, expected another name")
    folder = path.parent
    if not folder.is_dir():
        raise UsageError(f"{path}: the folder {folder} does not exist, expected an existing folder for the output")
    if not os.access(folder, os.W_OK | os.X_OK) or (path.exists() and not os.access(path, os.W_OK)):
        raise UsageError(f"{path}: cannot be written, expected a folder and a file with permission to write")


def same_file(one, other):
    """Whether two paths mean the same file, there or not."""
    try:
        return os.path.samefile(one, other)
    except OSError:
        return os.path.realpath(one) == os.path.realpath(other)
