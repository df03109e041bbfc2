"""A recorder that is killed with SIGKILL at random moments: at most the last second is lost, the rest can be read."""
import os
import random
import signal
import struct
import subprocess
import sys
import textwrap

import pytest
from mcap.exceptions import McapError
from mcap.records import Message
from mcap.stream_reader import StreamReader

from mooring_ros.recording.recover import recover

from .conftest import read_with_mcap, read_with_rosbags

# 3 kills by default; MOORING_ROS_KILLS=20 for the long form.
KILLS = int(os.environ.get('MOORING_ROS_KILLS', '3'))
ALLOWED_LOSS = 1_000_000_000

# Writes 2 kB a message, 1000 messages a second, and says on its standard output what it has handed over.
CHILD = '''
    import os, struct, sys, time
    from mooring_ros.recording.attached import AttachedScene
    from mooring_ros.recording.writer import RecordingWriter
    writer = RecordingWriter(sys.argv[1], {'dt': 0.01}, AttachedScene('chain.txt', 'LINES'))
    text = lambda: b'\\0\\1\\0\\0' + struct.pack('<I', 2001) + os.urandom(100).hex().encode() + b'x' * 1800 + b'\\0'
    writer.declare('/a', 'std_msgs/msg/String')
    start, sent = time.monotonic(), 0
    while True:
        while sent < 1000 * (time.monotonic() - start):
            writer.write('/a', 'std_msgs/msg/String', text(), time.time_ns())
            sent += 1
        os.write(1, struct.pack('<Qq', time.time_ns(), sent))
        time.sleep(0.002)
'''


def killed_run(path, seconds):
    """Start the recorder, kill it after so many seconds of writing; returns (time of the last message handed over in ns, their number)."""
    child = subprocess.Popen([sys.executable, '-c', textwrap.dedent(CHILD), str(path)], stdout=subprocess.PIPE)
    try:
        first = child.stdout.read(16)
        assert len(first) == 16
        begin = last = int.from_bytes(first[:8], 'little')
        while last - begin < seconds * 1e9:
            record = child.stdout.read(16)
            last = int.from_bytes(record[:8], 'little')
        child.send_signal(signal.SIGKILL)
        rest = record + child.stdout.read()
    finally:
        child.kill()
        child.wait()
    final = rest[len(rest) // 16 * 16 - 16:][:16]
    return int.from_bytes(final[:8], 'little'), int.from_bytes(final[8:], 'little')


def stream_read(path):
    """Log times by mcap's own StreamReader, which reads on until the cut."""
    times = []
    with open(path, 'rb') as file:
        try:
            for record in StreamReader(file).records:
                if isinstance(record, Message):
                    times.append(record.log_time)
        except (McapError, struct.error):      # which one depends on where the cut is
            pass
    return times


@pytest.mark.parametrize('number', range(KILLS))
def test_a_killed_recorder_loses_at_most_a_second(tmp_path, number):
    folder = number % 2 == 1
    path = tmp_path / ('run' if folder else 'run.mcap')
    file = path / 'run_0.mcap' if folder else path
    seconds = random.Random(number).uniform(0.3, 3.0)
    last_sent, sent = killed_run(path, seconds)

    before = stream_read(file)
    assert before, f'nothing to read after {seconds:.2f} s'
    assert last_sent - before[-1] < ALLOWED_LOSS

    out = tmp_path / ('out' if folder else 'out.mcap')
    found = recover(path, out)
    assert found.messages >= len(before) and found.messages > sent - 1000
    by_mcap = read_with_mcap(out / 'out_0.mcap' if folder else out)
    by_rosbags = read_with_rosbags(out)
    assert len(by_mcap) == len(by_rosbags) == found.messages
    assert [time for _, time, _ in by_mcap][:len(before)] == before
    assert all(len(message.data) == 2000 for _, _, message in by_rosbags)
    assert found.attachments == 1
