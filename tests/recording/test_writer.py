import errno
import os
import shutil
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest
import yaml
from mcap.reader import make_reader

from mooring_ros.recording import RecordingError
from mooring_ros.recording.attached import AttachedScene
from mooring_ros.recording.qos import Qos
from mooring_ros.recording.reader import Recording
from mooring_ros.recording.writer import RecordingWriter

from .conftest import read_with_mcap, read_with_rosbags

TEXT = 'std_msgs/msg/String'


def wait_for(condition, seconds=10):
    """Poll until a condition of the writer's thread holds."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, 'the recorder did not get there'
        time.sleep(0.01)


def test_single_file_is_read_by_mcap_and_rosbags(tmp_path, record, sample_messages):
    writer = record(tmp_path / 'run.mcap')
    assert (writer.written, writer.lost, writer.error) == (200, 0, None)
    for found in (read_with_mcap(writer.path), read_with_rosbags(tmp_path / 'run.mcap')):
        assert len(found) == 200
        first = {topic: message for topic, time, message in found if time == 0}
        assert list(first) == list(sample_messages)
        assert first['/platform/odom'].pose.pose.position.x == 1.25
        assert list(first['/mooring/line_tensions'].data) == [1.0, 2.5]
        assert first['/mooring/line_tensions'].layout.dim[1].label == 'end'
        assert list(first['/mooring/lines'].effort) == [1e6]
        assert first['/diagnostics'].status[0].values[0].value == 'b'
        assert bytes(first['/mooring/nodes'].data) == b'\0\0\x80?'
        assert first['/mooring/markers'].markers[0].points[0].x == 1.0


def test_bag_folder_is_read_by_rosbags_with_its_metadata(tmp_path, record):
    writer = record(tmp_path / 'run')
    assert writer.path == str(tmp_path / 'run') and writer.file == str(tmp_path / 'run' / 'run_0.mcap')
    assert len(read_with_rosbags(tmp_path / 'run')) == 200
    information = yaml.safe_load((tmp_path / 'run' / 'metadata.yaml').read_text())['rosbag2_bagfile_information']
    assert information['message_count'] == 200 and information['duration']['nanoseconds'] == 19_000_000
    assert information['relative_file_paths'] == ['run_0.mcap'] and information['storage_identifier'] == 'mcap'
    assert {topic['message_count'] for topic in information['topics_with_message_count']} == {20}
    assert information['custom_data'] == {'mooring_ros.state': 'closed'}


def test_profile_parameters_and_scene_are_in_the_file(tmp_path, record):
    with open(record(tmp_path / 'run.mcap').file, 'rb') as file:
        reader = make_reader(file)
        assert reader.get_header().profile == 'ros2' and reader.get_header().library.startswith('mooring_ros')
        assert [(a.name, a.media_type, a.data) for a in reader.iter_attachments()] == [
            ('chain.txt', 'text/plain', b'LINES\n'), ('depths.txt', 'text/plain;role=scene-file', b'2 2\n')]
        metadata = {record.name: record.metadata for record in reader.iter_metadata()}
        assert metadata['mooring_ros'] == {'dt': '0.01', 'scene': '"chain.txt"', 'limits.jump': '[1, 2]'}
        summary = reader.get_summary()
    assert {schema.encoding for schema in summary.schemas.values()} == {'ros2msg'}
    assert {channel.message_encoding for channel in summary.channels.values()} == {'cdr'}


@pytest.mark.parametrize('compression', ['zstd', 'lz4', 'none'])
def test_every_compression_comes_back(tmp_path, record, compression):
    writer = record(tmp_path / 'run.mcap', compression=compression)
    assert len(read_with_mcap(writer.file)) == len(read_with_rosbags(tmp_path / 'run.mcap')) == 200


def test_quality_of_service_is_kept(tmp_path):
    with RecordingWriter(tmp_path / 'run', {}) as writer:
        writer.declare('/a', TEXT, Qos(depth=3, reliability='best_effort', durability='transient_local'))
        writer.write('/a', TEXT, b'\0\1\0\0\1\0\0\0\0', 5)
    with open(writer.file, 'rb') as file:
        channel, = make_reader(file).get_summary().channels.values()
    profile, = yaml.safe_load(channel.metadata['offered_qos_profiles'])
    assert (profile['depth'], profile['reliability'], profile['durability']) == (3, 'best_effort', 'transient_local')
    assert len(read_with_rosbags(tmp_path / 'run')) == 1


@pytest.mark.parametrize('name', ['run.mcap', 'run'])
def test_an_existing_recording_is_never_touched(tmp_path, record, name):
    first = record(tmp_path / name, rounds=1)
    before = open(first.file, 'rb').read()
    second, third = record(tmp_path / name, rounds=2), record(tmp_path / name, rounds=2)
    assert open(first.file, 'rb').read() == before
    stem, suffix = os.path.splitext(name)
    assert [os.path.basename(writer.path) for writer in (second, third)] == [f'{stem}_2{suffix}', f'{stem}_3{suffix}']
    assert len(read_with_rosbags(tmp_path / f'{stem}_2{suffix}')) == 20


def test_an_empty_folder_is_used_and_a_full_one_is_not(tmp_path, record):
    (tmp_path / 'empty').mkdir()
    (tmp_path / 'full').mkdir()
    (tmp_path / 'full' / 'notes.txt').write_text('mine')
    assert record(tmp_path / 'empty', rounds=1).path == str(tmp_path / 'empty')
    assert record(tmp_path / 'full', rounds=1).path == str(tmp_path / 'full_2')


def test_a_place_that_cannot_be_written_is_refused(tmp_path):
    (tmp_path / 'file').write_text('')
    with pytest.raises(RecordingError, match='cannot create the recording'):
        RecordingWriter(tmp_path / 'file' / 'run.mcap', {})


def test_parameters_of_numpy_come_back_as_numbers(tmp_path):
    with RecordingWriter(tmp_path / 'run.mcap', {'a': np.float64(0.1), 'b': np.arange(3), 'c': tmp_path, 'd': True, 'e': 'text'}) as writer:
        pass
    assert Recording(writer.path).parameters == {'a': 0.1, 'b': [0, 1, 2], 'c': str(tmp_path), 'd': True, 'e': 'text'}


def test_a_scene_and_the_files_it_was_read_from_are_attachments_with_their_bytes(tmp_path):
    scene = AttachedScene('chain.txt', 'Ketten für Ålesund\r\n', (('sea/depths.txt', '2 2\n'), ('stiffness\\a.txt', 'é\n')))
    with RecordingWriter(tmp_path / 'run.mcap', {}, scene) as writer:
        pass
    assert Recording(writer.path).scene == scene
    with open(writer.path, 'rb') as file:
        found = {each.name: each.data for each in make_reader(file).iter_attachments()}
    assert found == {'chain.txt': 'Ketten für Ålesund\r\n'.encode(), 'sea/depths.txt': b'2 2\n', 'stiffness\\a.txt': 'é\n'.encode()}


def test_one_topic_has_one_type(tmp_path):
    with RecordingWriter(tmp_path / 'run.mcap', {}) as writer:
        writer.write('/a', TEXT, b'\0\1\0\0\1\0\0\0\0', 5)
        with pytest.raises(RecordingError, match='recorded as std_msgs/msg/String'):
            writer.write('/a', 'nav_msgs/msg/Odometry', b'', 5)
        with pytest.raises(RecordingError, match='not installed'):
            writer.write('/b', 'std_msgs/msg/Nonsense', b'', 5)


def test_times_out_of_range_do_not_stop_the_recording(tmp_path):
    with RecordingWriter(tmp_path / 'run.mcap', {}) as writer:
        for log_time in (-5, 2**70, 7):
            writer.write('/a', TEXT, b'\0\1\0\0\1\0\0\0\0', log_time)
    assert [entry.log_time for entry in Recording(writer.path).messages()] == [0, 2**63 - 1, 7]


def test_what_does_not_fit_in_the_queue_is_counted_and_leaves_a_gap_in_the_sequence(tmp_path, monkeypatch):
    real, blocked = os.pwrite, []
    monkeypatch.setattr(os, 'pwrite', lambda *args: (_ for _ in ()).throw(OSError(errno.ENOSPC, 'full')) if blocked else real(*args))
    writer = RecordingWriter(tmp_path / 'run.mcap', {}, queue_limit_bytes=10_000)
    blocked.append(True)
    writer.write('/a', TEXT, bytes(1000), 0)
    wait_for(lambda: writer.error)
    for number in range(1, 101):
        writer.write('/a', TEXT, bytes(1000), number)
    assert writer.lost == 101 - 1 - 8
    blocked.clear()
    wait_for(lambda: not writer.error)
    writer.write('/a', TEXT, bytes(1000), 101)
    writer.close()
    found = list(Recording(writer.path).messages())
    assert len(found) == writer.written == 10 and writer.written + writer.lost == 102
    assert [entry.sequence for entry in found] == [*range(9), 101]


def test_a_full_disk_loses_only_what_comes_meanwhile_and_the_recording_goes_on(tmp_path, monkeypatch):
    """The disk takes half of a write and then refuses, several times; the file ends with a whole record all the time."""
    real, state = os.pwrite, {'full': False}

    def pwrite(descriptor, data, offset):
        if not state['full']:
            return real(descriptor, data, offset)
        if len(data) > 100:
            return real(descriptor, data[:len(data) // 2], offset)
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, 'pwrite', pwrite)
    writer = RecordingWriter(tmp_path / 'run.mcap', {}, chunk_size=4000)
    sent = 0
    for _ in range(3):
        for full in (False, True):
            state['full'] = full
            for _ in range(50):
                writer.write('/a', TEXT, os.urandom(500), sent)
                sent += 1
            if full:
                wait_for(lambda: writer.error)
                assert 'No space left' in writer.error
                times = [entry.log_time for entry in Recording(writer.file).messages()]
                assert times == list(range(writer.written))
            else:
                wait_for(lambda: writer.written == sent)
    state['full'] = False
    writer.close()
    assert (writer.written, writer.lost, writer.error) == (sent, 0, None)
    assert [time for _, time, _ in read_with_mcap_raw(writer.file)] == list(range(sent))


def read_with_mcap_raw(path):
    with open(path, 'rb') as file:
        return [(channel.topic, message.log_time, message.data) for _, channel, message in make_reader(file).iter_messages()]


def test_closing_on_a_full_disk_keeps_what_was_written_and_says_so(tmp_path, monkeypatch):
    real, blocked = os.pwrite, []
    monkeypatch.setattr(os, 'pwrite', lambda *args: (_ for _ in ()).throw(OSError(errno.ENOSPC, 'full')) if blocked else real(*args))
    writer = RecordingWriter(tmp_path / 'run', {})
    writer.write('/a', TEXT, bytes(100), 0)
    wait_for(lambda: writer.written == 1)
    blocked.append(True)
    for number in range(1, 11):
        writer.write('/a', TEXT, bytes(100), number)
    assert writer.close()
    assert (writer.written, writer.lost) == (1, 10) and 'mooring recover' in writer.error
    assert [entry.log_time for entry in Recording(tmp_path / 'run').messages()] == [0]
    information = yaml.safe_load((tmp_path / 'run' / 'metadata.yaml').read_text())['rosbag2_bagfile_information']
    assert information['custom_data'] == {'mooring_ros.state': 'open'}


def test_a_file_that_is_removed_while_it_is_written_is_an_error_that_names_it(tmp_path):
    writer = RecordingWriter(tmp_path / 'run', {})
    writer.write('/a', TEXT, bytes(100), 0)
    wait_for(lambda: writer.written == 1)
    shutil.rmtree(tmp_path / 'run')
    writer.write('/a', TEXT, bytes(100), 1)
    wait_for(lambda: writer.error)
    assert 'run_0.mcap' in writer.error and 'removed' in writer.error
    writer.write('/a', TEXT, bytes(100), 2)
    assert writer.close() and writer.lost == 2 and not (tmp_path / 'run').exists()


def test_how_far_it_is_behind_grows_while_the_disk_takes_its_time_and_is_nothing_when_idle(tmp_path, monkeypatch):
    real, slow = os.pwrite, threading.Event()
    monkeypatch.setattr(os, 'pwrite', lambda *args: (slow.wait(), real(*args))[1])
    slow.set()
    with RecordingWriter(tmp_path / 'run.mcap', {}, flush_period=0.01) as writer:
        assert writer.behind == 0.0
        slow.clear()
        writer.write('/a', TEXT, bytes(100), 0)
        wait_for(lambda: writer.behind > 0.3)
        slow.set()
        wait_for(lambda: writer.behind == 0.0)
        assert writer.written == 1 and not writer.error


def run_child(program, *arguments):
    return subprocess.run([sys.executable, '-c', textwrap.dedent(program), *map(str, arguments)], capture_output=True, text=True, timeout=60)


def test_a_limit_of_the_operating_system_does_not_corrupt_the_file(tmp_path):
    """The same with the kernel refusing: a file size limit that is lifted again."""
    child = run_child('''
        import os, resource, signal, sys, time
        from mooring_ros.recording.writer import RecordingWriter
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, resource.RLIM_INFINITY))
        writer = RecordingWriter(sys.argv[1], {}, chunk_size=16_000)
        for number in range(400):
            writer.write('/a', 'std_msgs/msg/String', os.urandom(1000), number)
        end = time.monotonic() + 20
        while not writer.error and time.monotonic() < end:
            time.sleep(0.01)
        print(bool(writer.error), os.path.getsize(writer.file) <= 100_000)
        resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        writer.close()
        print(writer.written, writer.lost, writer.error)
    ''', tmp_path / 'run.mcap')
    assert child.stdout.split('\n')[:2] == ['True True', '400 0 None'], child.stderr
    assert [time for _, time, _ in read_with_mcap_raw(tmp_path / 'run.mcap')] == list(range(400))


def test_a_recording_that_nobody_closes_is_closed_when_the_program_ends(tmp_path):
    child = run_child('''
        import sys
        from mooring_ros.recording.writer import RecordingWriter
        writer = RecordingWriter(sys.argv[1], {})
        writer.write('/a', 'std_msgs/msg/String', bytes(9), 1)
    ''', tmp_path / 'run.mcap')
    assert child.returncode == 0, child.stderr
    assert len(read_with_mcap_raw(tmp_path / 'run.mcap')) == 1


def test_messages_after_close_are_counted_as_lost(tmp_path):
    writer = RecordingWriter(tmp_path / 'run.mcap', {})
    writer.close()
    writer.write('/a', TEXT, bytes(9), 1)
    assert (writer.written, writer.lost) == (0, 1) and writer.close()
