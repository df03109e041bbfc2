"""Which MCAP files make up a recording: a single file, or a rosbag2 folder."""
import os
import re

import yaml

from .errors import RecordingError


def bag_files(path):
    """Paths of the MCAP files of a recording, in order.

    path: an MCAP file or a bag folder. The order is that of metadata.yaml; files that it does not name (a run that was killed)
    follow by number. Raises RecordingError for a path that is not there, or a bag that is not MCAP.
    """
    path = os.fspath(path)
    if not os.path.exists(path):
        raise RecordingError(f'{path}: no such file or folder, expected an MCAP file or a bag folder')
    if not os.path.isdir(path):
        if path.endswith('.db3'):
            raise RecordingError(f'{path}: an SQLite bag, expected MCAP (`ros2 bag convert` makes one of it)')
        return [path]
    listed = _listed(os.path.join(path, 'metadata.yaml'))
    present = sorted((name for name in os.listdir(path) if name.endswith('.mcap')), key=_by_number)
    missing = [name for name in listed if name not in present]
    if missing:
        raise RecordingError(f'{path}/metadata.yaml: names {missing[0]!r}, which is not there')
    names = listed + [name for name in present if name not in listed]
    if not names:
        raise RecordingError(f'{path}: no MCAP file in this folder, expected a bag folder')
    return [os.path.join(path, name) for name in names]


def _listed(path):
    """Names of the storage files according to metadata.yaml; none where it is missing."""
    try:
        with open(path, encoding='utf-8') as file:
            information = (yaml.safe_load(file) or {}).get('rosbag2_bagfile_information') or {}
    except FileNotFoundError:
        return []
    except (OSError, AttributeError, UnicodeDecodeError) as error:
        raise RecordingError(f'{path}: {error}, expected rosbag2 metadata') from error
    except yaml.YAMLError as error:
        line = getattr(getattr(error, 'problem_mark', None), 'line', 0) + 1
        raise RecordingError(f'{path}:{line}: not YAML, expected rosbag2 metadata') from error
    storage = information.get('storage_identifier', 'mcap')
    if storage != 'mcap':
        raise RecordingError(f'{path}: storage is {storage!r}, expected mcap (`ros2 bag convert` makes one of it)')
    if (information.get('compression_mode') or 'none').lower() != 'none':
        raise RecordingError(f'{path}: compressed outside MCAP ({information["compression_mode"]}), '
                             'expected plain MCAP files (`ros2 bag convert` makes them)')
    return [os.path.basename(name) for name in information.get('relative_file_paths') or []]


def _by_number(name):
    return [int(part) if part.isdigit() else part for part in re.split(r'(\d+)', name)]
