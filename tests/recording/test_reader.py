import pytest
from mcap.writer import CompressionType, Writer

from mooring_ros.recording import RecordingError
from mooring_ros.recording.reader import Recording
from mooring_ros.recording.records import Damage, read_records


def write_mcap(path, profile='ros2', schema_encoding='ros2msg', message_encoding='cdr', messages=5, **options):
    with open(path, 'wb') as file:
        writer = Writer(file, **options)
        writer.start(profile=profile, library='somebody else')
        schema = writer.register_schema('std_msgs/msg/String', schema_encoding, b'string data\n') if schema_encoding else 0
        channel = writer.register_channel('/a', message_encoding, schema)
        for number in range(messages):
            writer.add_message(channel, number, b'\0\1\0\0\1\0\0\0\0', number + 1)
        writer.finish()
    return path


def test_messages_come_with_topic_type_times_and_bytes_in_order(tmp_path, record, sample_messages):
    recording = Recording(record(tmp_path / 'run.mcap').path)
    found = list(recording.messages())
    assert [entry.topic for entry in found] == list(sample_messages) * 20
    assert [entry.log_time for entry in found] == [number * 1_000_000 for number in range(20) for _ in sample_messages]
    assert found[0].type_name == 'nav_msgs/msg/Odometry'
    assert recording.topics()['/mooring/lines'] == ('sensor_msgs/msg/JointState', 20)
    assert {entry.topic for entry in recording.messages(['/note'])} == {'/note'}


def test_parameters_and_scene_come_back(tmp_path, record):
    recording = Recording(record(tmp_path / 'run').path)
    assert recording.parameters == {'dt': 0.01, 'scene': 'chain.txt', 'limits.jump': [1, 2]}
    assert recording.scene == ('chain.txt', 'LINES\n', (('depths.txt', '2 2\n'),))
    assert recording.cut is None and not recording.damage


@pytest.mark.parametrize('options', [{'use_chunking': False}, {'compression': CompressionType.NONE}, {'compression': CompressionType.LZ4},
                                     {'schema_encoding': 'ros2idl'}, {'use_statistics': False}])
def test_files_of_other_writers_are_read(tmp_path, options):
    recording = Recording(write_mcap(tmp_path / 'other.mcap', **options))
    assert [entry.publish_time for entry in recording.messages()] == [1, 2, 3, 4, 5]
    assert recording.topics() == {'/a': ('std_msgs/msg/String', 5)}
    assert recording.parameters is None and recording.scene is None


@pytest.mark.parametrize('content, message', [
    (b'', 'is empty'), (b't,x,y,z\n0,1,2,3\n', 'not an MCAP file'), (b'\x89MCAP', 'cut off inside its first bytes'),
    (b'\x89MCAP0\r\n', 'cut off before its header')])
def test_what_is_no_recording_is_refused(tmp_path, content, message):
    path = tmp_path / 'x.mcap'
    path.write_bytes(content)
    with pytest.raises(RecordingError, match=f'{path}: .*{message}'):
        Recording(path)


@pytest.mark.parametrize('profile', ['', 'ros1'])
def test_a_wrong_profile_is_refused(tmp_path, profile):
    with pytest.raises(RecordingError, match=f"profile '{profile}', expected 'ros2'"):
        Recording(write_mcap(tmp_path / 'x.mcap', profile=profile))


@pytest.mark.parametrize('options', [{'schema_encoding': 'protobuf'}, {'schema_encoding': ''}, {'message_encoding': 'json'}])
def test_unknown_encodings_are_refused_when_the_topic_is_read(tmp_path, options):
    recording = Recording(write_mcap(tmp_path / 'x.mcap', **options))
    assert list(recording.messages(['/another'])) == []
    with pytest.raises(RecordingError, match="topic '/a' .*expected ros2msg or ros2idl and cdr"):
        list(recording.messages())


def test_folders_that_are_no_mcap_bag_are_refused(tmp_path):
    with pytest.raises(RecordingError, match='no such file or folder'):
        Recording(tmp_path / 'missing')
    with pytest.raises(RecordingError, match='no MCAP file in this folder'):
        Recording(tmp_path)
    metadata = tmp_path / 'metadata.yaml'
    metadata.write_text('rosbag2_bagfile_information: {storage_identifier: sqlite3}\n')
    with pytest.raises(RecordingError, match='expected mcap'):
        Recording(tmp_path)
    metadata.write_text('rosbag2_bagfile_information: {relative_file_paths: [gone.mcap]}\n')
    with pytest.raises(RecordingError, match="'gone.mcap', which is not there"):
        Recording(tmp_path)
    metadata.write_text('a: 1\nb: [\n')
    with pytest.raises(RecordingError, match=r'metadata.yaml:\d: not YAML'):
        Recording(tmp_path)


def test_a_bag_of_several_files_is_read_in_their_order(tmp_path):
    for number in (2, 10, 1):
        write_mcap(tmp_path / f'run_{number}.mcap', messages=number)
    assert [len(list(Recording(file).messages())) for file in Recording(tmp_path).files] == [1, 2, 10]
    assert len(list(Recording(tmp_path).messages())) == 13


def test_a_chunk_that_is_damaged_inside_is_left_out_and_reported(tmp_path, record):
    path = tmp_path / 'run.mcap'
    record(path, compression='none', chunk_size=4000, rounds=10)
    whole = list(Recording(path).messages())
    content = bytearray(path.read_bytes())
    place = content.index(b'hello', len(content) // 3)
    content[place] ^= 1
    path.write_bytes(content)
    recording = Recording(path)
    rest = list(recording.messages())
    assert 0 < len(rest) < len(whole) and set(rest) < set(whole)
    assert len(recording.damage) == 1 and 'checksum' in recording.damage[0]
    assert any(isinstance(item, Damage) for item in read_records(path))
