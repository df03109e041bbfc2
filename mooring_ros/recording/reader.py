"""Recordings, read: finished or cut off, ours or of others."""
import collections
import json
from typing import NamedTuple

from mcap.records import Attachment, Channel, Header, Message, Metadata, Schema

from .attached import attached_scene
from .bag_files import bag_files
from .errors import RecordingError
from .records import Cut, Damage, read_records, read_summary
from .writer import METADATA_NAME

PROFILE = 'ros2'
SCHEMA_ENCODINGS = ('ros2msg', 'ros2idl')       # the messages are CDR with both


class Entry(NamedTuple):
    """One message. Times: integer ns. data: CDR bytes. sequence: counts a topic's messages; ours has a gap where one was lost."""

    topic: str
    type_name: str
    log_time: int
    publish_time: int
    data: bytes
    sequence: int = 0


class Recording:
    """A recording, opened for reading.

    path: an MCAP file or a rosbag2 folder.
    Attributes: `attachments` (dict of name -> Attachment), `metadata` (dict of record name -> dict), `library` (who wrote it),
    `cut` (None, or in words where and why the file ends too early), `damage` (list of str; filled while messages are read).
    Raises RecordingError: no MCAP, empty, wrong profile.
    """

    def __init__(self, path):
        self.path = path
        self.files = bag_files(path)
        self.attachments = {}
        self.metadata = {}
        self.library = ''
        self.cut = None
        self.damage = []
        for file in self.files:
            self._survey(file)

    def _survey(self, file):
        profile = None
        for record in read_records(file, chunks=False):
            if isinstance(record, Header):
                profile, self.library = record.profile, record.library
            elif isinstance(record, Attachment):
                self.attachments[record.name] = record
            elif isinstance(record, Metadata):
                self.metadata[record.name] = record.metadata
            elif isinstance(record, Cut):
                self.cut = f'{file}: cut off at byte {record.offset}: {record.reason}'
        if profile is None:
            raise RecordingError(f'{file}: cut off before its header, nothing in it can be read')
        if profile != PROFILE:
            raise RecordingError(f'{file}: MCAP profile {profile!r}, expected {PROFILE!r}')

    @property
    def parameters(self):
        """dict of the node's parameters when this is a recording of ours, else None."""
        values = self.metadata.get(METADATA_NAME)
        if values is None:
            return None
        try:
            return {name: json.loads(text) for name, text in values.items()}
        except ValueError as error:
            raise RecordingError(f'{self.path}: metadata {METADATA_NAME!r}: {error}, expected JSON values') from error

    @property
    def scene(self):
        """The AttachedScene when this is a recording of ours that has one, else None."""
        return attached_scene(self.path, self.attachments.values()) if METADATA_NAME in self.metadata else None

    def topics(self):
        """dict of topic -> (type name, count of messages). Of a file that was cut off, everything is read for it."""
        found = {}
        for file in self.files:
            for topic, type_name, count in _summary(file) or _count(file):
                before = found.get(topic, (type_name, 0))[1]
                found[topic] = type_name, before + count
        return found

    def messages(self, topics=None):
        """Yield an Entry for each message of the given topics (all when None), in the order of the file.

        Raises RecordingError for a message that is not CDR with a ROS 2 schema.
        """
        for file in self.files:
            summary = read_summary(file)
            # What is described again at the end stands in for a description in a damaged chunk.
            schemas, channels = (dict(summary.schemas), dict(summary.channels)) if summary else ({}, {})
            wanted = {}
            for record in read_records(file):
                if isinstance(record, Message):
                    if record.channel_id not in wanted:
                        wanted[record.channel_id] = self._wanted(file, record, channels, schemas, topics)
                    if wanted[record.channel_id]:
                        topic, type_name = wanted[record.channel_id]
                        yield Entry(topic, type_name, record.log_time, record.publish_time, record.data, record.sequence)
                elif isinstance(record, Channel):
                    channels[record.id] = record
                elif isinstance(record, Schema):
                    schemas[record.id] = record
                elif isinstance(record, Damage):
                    self.damage.append(f'{file}: damaged at byte {record.offset}: {record.reason}')

    def _wanted(self, file, message, channels, schemas, topics):
        """(topic, type name) of a message's channel, or None when it is not asked for."""
        channel = channels.get(message.channel_id)
        if channel is None:
            self.damage.append(f'{file}: messages of channel {message.channel_id}, which is nowhere described, are left out')
            return None
        if topics is not None and channel.topic not in topics:
            return None
        schema = schemas.get(channel.schema_id)
        encoding = schema.encoding if schema else ''
        if encoding not in SCHEMA_ENCODINGS or channel.message_encoding != 'cdr':
            raise RecordingError(f'{file}: topic {channel.topic!r} has schema encoding {encoding!r} and message encoding '
                                 f'{channel.message_encoding!r}, expected {" or ".join(SCHEMA_ENCODINGS)} and cdr')
        return channel.topic, schema.name


def _summary(file):
    """[(topic, type name, count)] from a file's summary, or None where it has none."""
    summary = read_summary(file)
    if summary is None or summary.statistics is None:
        return None
    counts = summary.statistics.channel_message_counts
    return [(channel.topic, summary.schemas[channel.schema_id].name if channel.schema_id in summary.schemas else '',
             counts.get(channel.id, 0)) for channel in summary.channels.values()]


def _count(file):
    schemas, channels, counts = {}, {}, collections.Counter()
    for record in read_records(file):
        if isinstance(record, Message):
            counts[record.channel_id] += 1
        elif isinstance(record, Channel):
            channels[record.id] = record
        elif isinstance(record, Schema):
            schemas[record.id] = record
    return [(channel.topic, schemas[channel.schema_id].name if channel.schema_id in schemas else '', counts[channel.id])
            for channel in channels.values()]
