"""MCAP records in the order of the file, also of a file that was cut off anywhere."""
import io
import os
import struct
import zlib
from dataclasses import dataclass

import lz4.frame
import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.reader import make_reader
from mcap.records import Attachment, Channel, Header, Message, Metadata, Schema
from mcap.writer import MCAP0_MAGIC

from .errors import RecordingError

RECORD_HEAD = struct.Struct('<BQ')
CHUNK_HEAD = struct.Struct('<QQQII')        # start, end, uncompressed size, its CRC, length of the compression's name
PARSERS = {Opcode.HEADER: Header, Opcode.SCHEMA: Schema, Opcode.CHANNEL: Channel, Opcode.ATTACHMENT: Attachment,
           Opcode.METADATA: Metadata}
INDEX_RECORDS = {Opcode.MESSAGE_INDEX, Opcode.CHUNK_INDEX, Opcode.ATTACHMENT_INDEX, Opcode.METADATA_INDEX,
                 Opcode.STATISTICS, Opcode.SUMMARY_OFFSET}
LARGEST_MEMORY = 2**31                      # bytes of one record; more is damage, not data


@dataclass
class Cut:
    """Where and how a file ends too early. offset: of the first byte that is no whole record."""

    offset: int
    reason: str


@dataclass
class Damage:
    """A part inside the file that cannot be read. offset: of its record."""

    offset: int
    reason: str


def read_records(path, chunks=True, progress=None):
    """Yield Header, Schema, Channel, Message, Attachment and Metadata records of the data section, in order.

    A chunk is opened and its records are yielded; with `chunks` false, chunks are passed over without being read. A file that
    ends too early yields everything whole, also the whole messages of a chunk that is cut, and then one Cut.
    What is damaged inside yields a Damage in its place. progress(bytes read, bytes in all) is called now and then. Raises RecordingError for a file that is no MCAP file.
    """
    with open_file(path) as file:
        size = os.fstat(file.fileno()).st_size
        _check_magic(path, file, size)
        ended = False
        while True:
            offset = file.tell()
            if progress:
                progress(offset, size)
            head = file.read(RECORD_HEAD.size)
            if len(head) < RECORD_HEAD.size:
                yield Cut(offset, 'the file ends inside a record' if head else 'the file ends without a footer')
                return
            opcode, length = RECORD_HEAD.unpack(head)
            if opcode == 0 or length > LARGEST_MEMORY:
                yield Cut(offset, 'what follows is no record')
                return
            whole = offset + RECORD_HEAD.size + length <= size
            if opcode == Opcode.FOOTER:
                file.seek(length, os.SEEK_CUR)
                if file.read(len(MCAP0_MAGIC)) != MCAP0_MAGIC:
                    yield Cut(offset, 'the footer is cut')
                return
            if not whole:
                if opcode == Opcode.CHUNK and chunks:
                    yield from _chunk_records(file.read(), offset, whole=False)
                yield Cut(offset, 'the file ends inside a record')
                return
            ended = ended or opcode == Opcode.DATA_END
            if ended or opcode in INDEX_RECORDS or (opcode == Opcode.CHUNK and not chunks):
                file.seek(length, os.SEEK_CUR)          # the summary repeats what came before
            elif opcode == Opcode.CHUNK:
                yield from _chunk_records(file.read(length), offset, whole=True)
            else:
                yield from _parse(opcode, file.read(length), offset)


def open_file(path):
    try:
        return open(path, 'rb')
    except OSError as error:
        raise RecordingError(f'{path}: {error.strerror or error}, expected an MCAP file') from error


def _check_magic(path, file, size):
    if size == 0:
        raise RecordingError(f'{path}: the file is empty, expected an MCAP file')
    magic = file.read(len(MCAP0_MAGIC))
    if magic != MCAP0_MAGIC:
        cut = 'the file is cut off inside its first bytes' if MCAP0_MAGIC.startswith(magic) else 'not an MCAP file'
        raise RecordingError(f'{path}: {cut}, expected the MCAP magic bytes and a header')


def _parse(opcode, body, offset):
    """Yield the record of an opcode, if it is one that matters here."""
    if opcode == Opcode.MESSAGE:
        if len(body) < 22:
            yield Damage(offset, f'a message record of {len(body)} bytes')
        else:
            yield Message.read(ReadDataStream(io.BytesIO(body)), len(body))
    elif opcode in PARSERS:
        try:
            yield PARSERS[opcode].read(ReadDataStream(io.BytesIO(body)))
        except Exception as error:      # EndOfFile, struct.error, UnicodeDecodeError
            yield Damage(offset, f'{Opcode(opcode).name.lower()} record: {error!r}')


def _chunk_records(body, offset, whole):
    """Yield the records of a chunk; of a chunk that is cut or damaged, those that can be read."""
    try:
        _, _, size, crc, name_length = CHUNK_HEAD.unpack_from(body)
        start = CHUNK_HEAD.size + name_length
        compression = body[CHUNK_HEAD.size:start].decode()
        data, problem = _decompress(compression, body[start + 8:], size)
    except (struct.error, UnicodeDecodeError) as error:
        data, problem = b'', repr(error)
    if not problem and whole and crc and zlib.crc32(data) != crc:
        data, problem = b'', 'its checksum does not match'
    position = 0
    while position + RECORD_HEAD.size <= len(data):
        opcode, length = RECORD_HEAD.unpack_from(data, position)
        end = position + RECORD_HEAD.size + length
        if end > len(data):
            break
        yield from _parse(opcode, data[position + RECORD_HEAD.size:end], offset)
        position = end
    if whole and (problem or position < len(data)):
        yield Damage(offset, f'a chunk: {problem or "it ends inside a record"}')


def _decompress(compression, data, size):
    """(what could be decompressed, what is wrong or None)."""
    if compression == '':
        return data[:size], None if len(data) >= size else 'too short'
    if compression == 'zstd':
        decoder = zstandard.ZstdDecompressor().decompressobj()
    elif compression == 'lz4':
        decoder = lz4.frame.LZ4FrameDecompressor()
    else:
        return b'', f'unknown compression {compression!r}'
    done = bytearray()
    for start in range(0, len(data), 4096):         # in pieces: what comes before damage is kept
        if len(done) >= size:
            break
        try:
            done += decoder.decompress(data[start:start + 4096])
        except (zstandard.ZstdError, RuntimeError, EOFError) as error:
            return bytes(done), str(error)
    return bytes(done[:size]), None if len(done) >= size else 'too short'


def read_summary(path):
    """The mcap Summary at the end of a file, or None where it has none."""
    with open_file(path) as file:
        try:
            return make_reader(file).get_summary()
        except (McapError, struct.error, ValueError, OSError):
            return None


def is_mcap(path):
    """Whether a file begins as an MCAP file does. Raises OSError."""
    with open(path, 'rb') as file:
        return file.read(len(MCAP0_MAGIC)) == MCAP0_MAGIC
