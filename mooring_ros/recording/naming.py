"""Where a recording goes: never over an existing one."""
import errno
import itertools
import os

from .errors import RecordingError


def create(path):
    """Create the new, empty file of a recording.

    path: `NAME.mcap` for a single file; anything else is a bag folder `NAME/` with `NAME_0.mcap`. Missing parent
    folders are made. When the name is taken, the next free one of `NAME_2`, `NAME_3`, ... is used; an existing folder
    that is empty counts as free.
    Returns (file descriptor, path of the MCAP file, folder or None). Raises RecordingError when it cannot be created.
    """
    path = os.path.abspath(os.path.expanduser(os.fspath(path)))
    try:
        os.makedirs(os.path.dirname(path), exist_ok=True)
        stem, suffix = (path[:-5], path[-5:]) if path.endswith('.mcap') else (path, '')
        for number in itertools.count(1):
            candidate = f'{stem}{suffix}' if number == 1 else f'{stem}_{number}{suffix}'
            try:
                return _create_file(candidate) if suffix else _create_folder(candidate)
            except FileExistsError:
                continue
    except OSError as error:
        raise RecordingError(f'{path}: cannot create the recording: {error.strerror or error}') from error


def _create_file(path):
    return os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o666), path, None


def _create_folder(folder):
    try:
        os.mkdir(folder)
    except FileExistsError:
        if not os.path.isdir(folder) or os.listdir(folder):
            raise FileExistsError(errno.EEXIST, 'taken', folder) from None
    return *_create_file(os.path.join(folder, os.path.basename(folder) + '_0.mcap'))[:2], folder
