"""`metadata.yaml` of a rosbag2 folder."""
import os
from dataclasses import dataclass, field

import yaml

VERSION = 9             # what rosbag2 of ROS 2 Jazzy writes
STATE_KEY = 'mooring_ros.state'
OPEN, CLOSED, RECOVERED = 'open', 'closed', 'recovered'


@dataclass
class Topic:
    """One topic of a bag. qos_profiles: YAML text as in the channel's metadata."""

    name: str
    type_name: str
    qos_profiles: str
    count: int = 0
    type_hash: str = ''


@dataclass
class BagFile:
    """One storage file: its name in the folder, first and last log time (ns), messages by topic."""

    name: str
    start: int = 2**63 - 1
    end: int = 0
    topics: list = field(default_factory=list)

    @property
    def count(self):
        return sum(topic.count for topic in self.topics)


def metadata_text(files, state):
    """The YAML text for the given files (list of BagFile). state: OPEN while the bag is written, then CLOSED."""
    topics = {}
    for file in files:
        for topic in file.topics:
            seen = topics.setdefault((topic.name, topic.type_name), Topic(**{**vars(topic), 'count': 0}))
            seen.count += topic.count
    filled = [file for file in files if file.count]
    start = min((file.start for file in filled), default=0)
    end = max((file.end for file in filled), default=0)
    return yaml.safe_dump({'rosbag2_bagfile_information': {
        'version': VERSION,
        'storage_identifier': 'mcap',
        'duration': {'nanoseconds': end - start},
        'starting_time': {'nanoseconds_since_epoch': start},
        'message_count': sum(file.count for file in files),
        'topics_with_message_count': [_topic(topic) for topic in topics.values()],
        'compression_format': '',
        'compression_mode': '',
        'relative_file_paths': [file.name for file in files],
        'files': [{'path': file.name,
                   'starting_time': {'nanoseconds_since_epoch': file.start if file.count else 0},
                   'duration': {'nanoseconds': file.end - file.start if file.count else 0},
                   'message_count': file.count} for file in files],
        'custom_data': {STATE_KEY: state},
        'ros_distro': os.environ.get('ROS_DISTRO', 'jazzy'),
    }}, sort_keys=False)


def _topic(topic):
    return {'topic_metadata': {'name': topic.name, 'type': topic.type_name, 'serialization_format': 'cdr',
                               'offered_qos_profiles': _profiles(topic.qos_profiles),
                               'type_description_hash': topic.type_hash},
            'message_count': topic.count}


def _profiles(text):
    """What a channel of a recording says of its quality of service; nothing where that is no plain YAML."""
    try:
        return yaml.safe_load(text or '[]')
    except yaml.YAMLError:
        return []


def write_metadata(folder, files, state):
    """Replace FOLDER/metadata.yaml in one move, so that it is whole at any moment. Raises OSError."""
    path = os.path.join(folder, 'metadata.yaml')
    with open(path + '.new', 'w', encoding='utf-8') as file:
        file.write(metadata_text(files, state))
    os.replace(path + '.new', path)
