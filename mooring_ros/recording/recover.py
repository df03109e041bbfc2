"""A recording that was cut off, made readable for ordinary readers again."""
import itertools
import os
import shutil
from dataclasses import dataclass, field

from mcap.records import Attachment, Channel, Header, Message, Metadata, Schema
from mcap.well_known import Profile
from mcap.writer import CompressionType, Writer

from . import bag_metadata
from .bag_files import bag_files
from .errors import RecordingError
from .records import Cut, Damage, read_records, read_summary
from .writer import library_name


@dataclass
class Recovered:
    """What a recovery found. cut, damage: in words, file and byte named; copied: nothing was wrong, the files are copies."""

    path: str
    messages: int = 0
    topics: dict = field(default_factory=dict)          # topic -> messages
    attachments: int = 0
    cut: list = field(default_factory=list)
    damage: list = field(default_factory=list)
    copied: bool = False
    start: int | None = None                            # ns, first and last log time
    end: int | None = None


def recover(path_in, path_out, progress=None):
    """Rewrite a recording so that every reader reads it, with everything in it that can be read.

    path_in: an MCAP file or a bag folder. path_out: `NAME.mcap` for a single file (a bag of several files becomes one), else a
    folder with metadata.yaml; it must not exist. A recording that has nothing wrong is copied.
    progress(bytes read, bytes in all) is called now and then, for each file anew. Returns a Recovered. Raises RecordingError for bad input or when the output cannot be written; the output is removed then.
    """
    path_out = os.fspath(path_out)
    sources = bag_files(path_in)
    if os.path.lexists(path_out):
        raise RecordingError(f'{path_out}: exists already, expected a new name')
    single = path_out.endswith('.mcap')
    if single:
        jobs = [(sources, path_out)]
    else:
        name = os.path.basename(os.path.normpath(path_out))
        jobs = [([source], os.path.join(path_out, f'{name}_{number}.mcap')) for number, source in enumerate(sources)]
    result = Recovered(path_out)
    try:
        os.makedirs(os.path.dirname(os.path.abspath(path_out)) if single else path_out, exist_ok=True)
        files = [_rewrite(group, target, result, progress) for group, target in jobs]
        result.copied = not result.cut and not result.damage and all(len(group) == 1 for group, _ in jobs)
        if result.copied:
            for (source,), target in jobs:
                shutil.copyfile(source, target)
        if not single:
            state = bag_metadata.CLOSED if result.copied else bag_metadata.RECOVERED
            bag_metadata.write_metadata(path_out, files, state)
    except OSError as error:
        _remove(path_out)
        raise RecordingError(f'{error.filename or path_out}: {error.strerror or error}') from error
    except BaseException:
        _remove(path_out)
        raise
    return result


def _remove(path):
    if os.path.isdir(path):
        shutil.rmtree(path, ignore_errors=True)
    elif os.path.exists(path):
        os.remove(path)


def _rewrite(sources, target, result, progress):
    """Everything readable of the source files into one new file. Returns its bag_metadata.BagFile."""
    bag = bag_metadata.BagFile(os.path.basename(target))
    with open(target, 'xb') as stream:
        copy = _Copy(Writer(stream, chunk_size=256 * 1024, compression=CompressionType.ZSTD), bag, result)
        copy.writer.start(profile=Profile.ROS2, library=library_name())
        for source in sources:
            copy.take(source, progress)
        copy.writer.finish()
    return bag


class _Copy:
    """One new file; schemas and channels are numbered anew, and once."""

    def __init__(self, writer, bag, result):
        self.writer = writer
        self._bag = bag
        self._result = result
        self._schemas = {}          # (name, encoding, data) -> new id
        self._channels = {}         # (topic, encoding, schema, metadata) -> new id
        self._topics = {}           # new channel id -> bag_metadata.Topic

    def take(self, source, progress):
        schemas, channels, headed = {0: (0, '')}, {}, False
        summary = read_summary(source)
        # What is described again at the end stands in for a description in a damaged chunk.
        described = [*summary.schemas.values(), *summary.channels.values()] if summary else []
        for record in itertools.chain(described, read_records(source, progress=progress)):
            if isinstance(record, Message):
                self._message(source, record, channels)
            elif isinstance(record, Header):
                headed = True
                if record.profile != Profile.ROS2:
                    raise RecordingError(f'{source}: MCAP profile {record.profile!r}, expected {Profile.ROS2!r}')
            elif isinstance(record, Schema):
                schemas[record.id] = self._schema(record), record.name
            elif isinstance(record, Channel):
                channels[record.id] = self._channel(record, schemas)
            elif isinstance(record, Attachment):
                self._result.attachments += 1
                self.writer.add_attachment(record.create_time, record.log_time, record.name, record.media_type, record.data)
            elif isinstance(record, Metadata):
                self.writer.add_metadata(record.name, record.metadata)
            elif isinstance(record, Cut):
                self._result.cut.append(f'{source}: cut off at byte {record.offset}: {record.reason}')
            elif isinstance(record, Damage):
                self._result.damage.append(f'{source}: damaged at byte {record.offset}: {record.reason}')
        if not headed:
            raise RecordingError(f'{source}: cut off before its header, nothing in it can be read')

    def _schema(self, schema):
        key = schema.name, schema.encoding, schema.data
        if key not in self._schemas:
            self._schemas[key] = self.writer.register_schema(*key)
        return self._schemas[key]

    def _channel(self, channel, schemas):
        schema_id, type_name = schemas.get(channel.schema_id, (0, ''))
        key = channel.topic, channel.message_encoding, schema_id, tuple(channel.metadata.items())
        if key not in self._channels:
            new = self.writer.register_channel(*key[:3], dict(channel.metadata))
            self._channels[key] = new
            self._topics[new] = bag_metadata.Topic(channel.topic, type_name, channel.metadata.get('offered_qos_profiles', ''),
                                                   type_hash=channel.metadata.get('topic_type_hash', ''))
            self._bag.topics.append(self._topics[new])
        return self._channels[key]

    def _message(self, source, message, channels):
        channel = channels.get(message.channel_id)
        if channel is None:
            text = f'{source}: messages of channel {message.channel_id}, which is nowhere described, are left out'
            if text not in self._result.damage:
                self._result.damage.append(text)
            return
        self.writer.add_message(channel, message.log_time, message.data, message.publish_time, message.sequence)
        topic, result = self._topics[channel], self._result
        topic.count += 1
        self._bag.start = min(self._bag.start, message.log_time)
        self._bag.end = max(self._bag.end, message.log_time)
        result.messages += 1
        result.topics[topic.name] = result.topics.get(topic.name, 0) + 1
        result.start = message.log_time if result.start is None else min(result.start, message.log_time)
        result.end = message.log_time if result.end is None else max(result.end, message.log_time)
