"""The file under an MCAP writer: bytes are collected, then put on the disk all or not at all."""
import os


class Sink:
    """A write-only stream for `mcap.writer.Writer` on a file descriptor that it owns.

    `write` never touches the disk. `commit` puts everything collected so far on it; when the disk refuses, the file
    is cut back to its last good length, so that it always ends with a whole record, and the bytes are kept
    for the next try.
    """

    def __init__(self, descriptor):
        self._descriptor = descriptor
        self._pending = bytearray()
        self.committed = 0              # bytes in the file

    @property
    def pending(self):
        """Bytes that wait for a commit."""
        return len(self._pending)

    def write(self, data):
        self._pending += data
        return len(data)

    def tell(self):
        return self.committed + len(self._pending)

    def flush(self):
        """For the MCAP writer, which flushes after each chunk; the disk is written by `commit`."""

    def commit(self):
        """Hand all that waits to the operating system. Raises OSError; the file is then as after the last commit."""
        done = 0
        view = memoryview(self._pending)
        try:
            while done < len(view):
                done += os.pwrite(self._descriptor, view[done:], self.committed + done)
        except OSError:
            if done:
                os.ftruncate(self._descriptor, self.committed)
            raise
        finally:
            view.release()
        self.committed += done
        self._pending = bytearray()

    @property
    def removed(self):
        """Whether the file has no name any more: what is written is gone when it is closed."""
        return os.fstat(self._descriptor).st_nlink == 0

    def discard(self):
        """Give up what waits for a commit."""
        self._pending = bytearray()

    def close(self):
        os.close(self._descriptor)
