"""The recorder: rosbag2-compatible MCAP, written by a thread of its own."""
import collections
import json
import os
import threading
import time
from importlib.metadata import PackageNotFoundError, version

from mcap.well_known import MessageEncoding, Profile, SchemaEncoding
from mcap.writer import CompressionType, Writer

from mooring_ros.motion.frames import scale_in_words

from . import bag_metadata, naming
from .attached import attachments
from .errors import RecordingError
from .qos import Qos, profiles_text
from .schema import schema_text
from .sink import Sink

METADATA_NAME = 'mooring_ros'       # the MCAP Metadata record with the parameters, each value as JSON
SCALE_NAME = 'mooring_ros_scale'    # another one, which says in words at which scale the messages are
COMPRESSIONS = {'zstd': CompressionType.ZSTD, 'lz4': CompressionType.LZ4, 'none': CompressionType.NONE}
MESSAGE_OVERHEAD = 200              # bytes that a queued message takes beside its data
POLL = 0.02                         # s, how often the thread looks at its queue
RETRY = 0.5                         # s between two tries on a disk that refuses
FLUSH = 0.4                         # s: what a kill may cost; each chunk has its place in the file's index, which stays in memory
YIELD_EVERY = 8                     # messages between two offers of the interpreter to other threads
LATEST = 2**63 - 1


def library_name():
    try:
        return f'mooring_ros {version("mooring_ros")}'
    except PackageNotFoundError:
        return 'mooring_ros'


class RecordingWriter:
    """Writes messages to a new MCAP recording without ever delaying the caller.

    path: `NAME.mcap`, or a folder name for a bag folder (`NAME/NAME_0.mcap` and `metadata.yaml`). An existing recording
        is never touched: `NAME_2`, `NAME_3`, ... is used instead; `self.path` says which.
    parameters: dict of name -> value (numbers, strings, booleans, lists), kept as an MCAP Metadata record; `scale` and `density_ratio` in words as another.
    scene: an AttachedScene, or None.
    chunk_size: bytes of a full chunk. flush_period: s, after which a chunk goes to the operating system in any case.
    queue_limit_bytes: what may wait for the disk; more than that is lost, and counted.

    Attributes, to be read at any time: `path`, `file` (the MCAP file), `written` (messages that the operating system has),
    `lost` (messages that are not in the file), `error` (str, what is wrong with the disk now, or None), `behind` (s).

    The thread is not daemonic; it closes the file when `close` is called or the main thread ends.
    Raises RecordingError when the recording cannot be created.
    """

    def __init__(self, path, parameters, scene=None, *, chunk_size=256 * 1024, compression='zstd',
                 queue_limit_bytes=64 * 1024 * 1024, flush_period=FLUSH):
        if compression not in COMPRESSIONS:
            raise RecordingError(f'compression {compression!r}: expected one of {", ".join(COMPRESSIONS)}')
        metadata = {METADATA_NAME: {str(key): json.dumps(value, default=_plain) for key, value in parameters.items()}}
        if 'scale' in parameters:
            metadata[SCALE_NAME] = {'messages': scale_in_words(parameters['scale'], parameters.get('density_ratio', 1.0)),
                                    'steps of the core, topics below full_scale/': 'full scale'}
        descriptor, self.file, self._folder = naming.create(path)
        self.path = self._folder or self.file
        self.error = None
        self.written = 0
        self._dropped = 0                   # refused by write(), under the lock
        self._given_up = 0                  # lost by the thread
        self._unwritten = 0                 # in the MCAP writer, not yet on the disk
        self._queue = collections.deque()
        self._bytes_in = 0                  # counted by the callers, under the lock
        self._bytes_out = 0                 # counted by the thread alone, so that no caller ever waits for it
        self._queue_limit = queue_limit_bytes
        self._lock = threading.Lock()
        self._stop = threading.Event()
        self._closed = False
        self._types = {}                    # topic -> type name
        self._given = {}                    # topic -> messages given to write(): a gap in the sequence tells a reader of a loss
        self._qos = {}                      # topic -> Qos
        self._schemas = {}                  # type name -> schema id
        self._channels = {}                 # topic -> channel id
        self._bag = bag_metadata.BagFile(os.path.basename(self.file))
        self._topics = {}                   # topic -> bag_metadata.Topic
        self._sink = Sink(descriptor)
        self._mcap = Writer(self._sink, chunk_size=chunk_size, compression=COMPRESSIONS[compression])
        self._flush_period = flush_period
        self._clean = time.monotonic()      # what was given before is on the disk
        self._start(metadata, attachments(scene) if scene else ())
        self._thread = threading.Thread(target=self._work, name='recording')
        self._thread.start()

    def _start(self, metadata, attached):
        now = time.time_ns()
        try:
            self._mcap.start(profile=Profile.ROS2, library=library_name())
            for name, values in metadata.items():
                self._mcap.add_metadata(name, values)
            for name, media_type, data in attached:
                self._mcap.add_attachment(create_time=now, log_time=now, name=name, media_type=media_type, data=data)
            self._sink.commit()
            if self._folder:
                bag_metadata.write_metadata(self._folder, [self._bag], bag_metadata.OPEN)
        except OSError as error:
            self._sink.close()
            raise RecordingError(f'{self.file}: cannot write the recording: {error.strerror or error}') from error

    @property
    def lost(self):
        """Messages that were given to `write` and are not in the recording."""
        return self._dropped + self._given_up

    @property
    def behind(self):
        """s for which the oldest message that is not on the disk has waited; a little more than `flush_period` is usual."""
        return time.monotonic() - self._clean if self._queue or self._unwritten else 0.0

    def declare(self, topic, type_name, qos=Qos()):
        """Make a topic known before its first message, with the quality of service it is offered with.

        Takes some ms for a new type, which the first `write` would take otherwise.
        Raises RecordingError for an unknown type, or another type than before.
        """
        known = self._types.get(topic)
        if known is None:
            schema_text(type_name)
            with self._lock:
                self._qos[topic] = qos
                self._given[topic] = 0
                self._types[topic] = type_name
        elif known != type_name:
            raise RecordingError(f'topic {topic!r} is recorded as {known}: cannot take {type_name} as well')

    def write(self, topic, type_name, cdr_bytes, log_time_ns, publish_time_ns=None):
        """Queue a message; never waits, and never raises for the disk's sake.

        cdr_bytes: the serialized message. Times: integer ns, brought into the range of MCAP (0 to 2^63 − 1) if outside;
        publish_time_ns None: the log time. Raises RecordingError as `declare` does.
        """
        if self._types.get(topic) != type_name:
            self.declare(topic, type_name)
        log_time = min(max(int(log_time_ns), 0), LATEST)
        publish_time = log_time if publish_time_ns is None else min(max(int(publish_time_ns), 0), LATEST)
        data = bytes(cdr_bytes)
        size = len(data) + MESSAGE_OVERHEAD
        with self._lock:
            sequence = self._given[topic]
            self._given[topic] = sequence + 1
            if self._closed or self._bytes_in - self._bytes_out + size > self._queue_limit:
                self._dropped += 1
                return
            self._bytes_in += size
            self._queue.append((topic, data, log_time, publish_time, sequence))

    def close(self, timeout=None):
        """Write what is queued, the index and metadata.yaml, and close the file. May be called again.

        timeout: s to wait for the disk, None for as long as it takes. Returns whether the file is closed.
        """
        with self._lock:
            self._closed = True
        self._stop.set()
        self._thread.join(timeout)
        return not self._thread.is_alive()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    # What follows runs in the thread.

    def _work(self):
        try:
            self._record()
            self._finish()
        except Exception as error:          # a fault of ours must not pass for a recording that goes on
            self.error = str(error) if isinstance(error, RecordingError) else f'{self.file}: the recorder stopped: {error!r}'
            with self._lock:
                self._closed = True
                self._given_up += len(self._queue) + self._unwritten
                self._queue.clear()
        finally:
            self._sink.close()

    def _record(self):
        due = time.monotonic() + self._flush_period
        retry = 0.0
        while not self._stop.wait(POLL) and threading.main_thread().is_alive():
            now = time.monotonic()
            if self.error and now < retry:
                continue
            if not self._queue and not self._unwritten:
                self._clean = now
            if (not self.error or self._commit()) and self._take():
                if now < due:
                    continue
                self._mcap.flush()
                if self._commit():
                    self._clean = now
                due = now + self._flush_period
            retry = time.monotonic() + RETRY

    def _take(self):
        """Move the queue into the MCAP writer; stops, and returns False, when the disk refuses a full chunk."""
        for number in range(len(self._queue)):
            topic, data, *times_and_sequence = self._queue.popleft()
            self._bytes_out += len(data) + MESSAGE_OVERHEAD
            self._add(topic, data, *times_and_sequence)
            if self._sink.pending and not self._commit():
                return False
            if number % YIELD_EVERY == 0:
                time.sleep(0)
        return True

    def _add(self, topic, data, log_time, publish_time, sequence):
        channel = self._channels.get(topic)
        if channel is None:
            channel = self._register(topic)
        entry = self._topics[topic]
        self._mcap.add_message(channel, log_time, data, publish_time, sequence & 0xffffffff)
        self._bag.start = min(self._bag.start, log_time)
        self._bag.end = max(self._bag.end, log_time)
        entry.count += 1
        self._unwritten += 1

    def _register(self, topic):
        type_name = self._types[topic]
        if type_name not in self._schemas:
            self._schemas[type_name] = self._mcap.register_schema(
                type_name, SchemaEncoding.ROS2, schema_text(type_name).encode())
        profiles = profiles_text(self._qos[topic])
        channel = self._mcap.register_channel(topic, MessageEncoding.CDR, self._schemas[type_name],
                                              {'offered_qos_profiles': profiles})
        self._channels[topic] = channel
        self._topics[topic] = bag_metadata.Topic(topic, type_name, profiles)
        self._bag.topics.append(self._topics[topic])
        return channel

    def _commit(self):
        """Put the sink's bytes on the disk. Returns False, with `error` set, when the disk refuses."""
        if self._sink.pending:
            try:
                self._sink.commit()
            except OSError as error:
                self.error = f'{self.file}: {error.strerror or error}'
                return False
        if self._sink.removed:
            raise RecordingError(f'{self.file}: the file was removed while it was written: this recording is lost')
        self.error = None
        self.written += self._unwritten
        self._unwritten = 0
        return True

    def _finish(self):
        complete = self._commit() and self._take()
        if complete:
            self._mcap.flush()
            complete = self._commit()
        if not complete:
            with self._lock:
                self._given_up += len(self._queue) + self._unwritten
                self._queue.clear()
            self._unwritten = 0
        else:
            self._mcap.finish()
            complete = self._commit()
        if not complete:
            self.error += '; the file ends without an index, `mooring recover` makes it readable'
        elif self._folder:
            try:
                bag_metadata.write_metadata(self._folder, [self._bag], bag_metadata.CLOSED)
            except OSError as error:
                self.error = f'{self._folder}/metadata.yaml: {error.strerror or error}'


def _plain(value):
    """Arrays as lists and paths as text, for JSON."""
    return value.tolist() if hasattr(value, 'tolist') else os.fspath(value)
