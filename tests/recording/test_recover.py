import shutil

import pytest
import yaml
from rosbags.rosbag2 import ReaderError

from mooring_ros.offline import __main__ as command_line
from mooring_ros.recording import RecordingError
from mooring_ros.recording.reader import Recording
from mooring_ros.recording.recover import recover

from .conftest import read_with_mcap, read_with_rosbags
from .test_reader import write_mcap


@pytest.mark.parametrize('compression', ['zstd', 'lz4', 'none'])
def test_a_file_cut_anywhere_gives_a_readable_beginning_of_itself(tmp_path, record, compression):
    whole = tmp_path / 'whole.mcap'
    record(whole, rounds=150, compression=compression, chunk_size=100_000)
    content, messages = whole.read_bytes(), list(Recording(whole).messages())
    cut, out, counts = tmp_path / 'cut.mcap', tmp_path / 'out.mcap', []
    for tenths in range(1, 11):
        cut.write_bytes(content[:len(content) * tenths // 10 - 1])
        found = recover(cut, out)
        rest = list(Recording(out).messages())
        assert rest == messages[:len(rest)] and found.messages == len(rest)
        assert found.cut and not found.copied and Recording(out).cut is None
        assert list(Recording(cut).messages()) == rest
        assert len(read_with_mcap(out)) == len(rest)
        if rest:
            assert len(read_with_rosbags(out)) == len(rest)
        counts.append(len(rest))
        out.unlink()
    assert counts == sorted(counts) and counts[-1] == len(messages)


@pytest.mark.parametrize('compression', ['zstd', 'lz4', 'none'])
def test_whole_messages_of_a_cut_chunk_are_kept(tmp_path, record, compression):
    """One chunk holds everything; half of it is there."""
    path, out = tmp_path / 'run.mcap', tmp_path / 'out.mcap'
    record(path, rounds=800, compression=compression, chunk_size=10**9, flush_period=1e9)
    path.write_bytes(path.read_bytes()[:path.stat().st_size // 3])
    assert recover(path, out).messages > 0
    assert len(read_with_mcap(out)) > 0


def test_attachments_metadata_and_sequence_survive(tmp_path, record):
    path, out = tmp_path / 'run.mcap', tmp_path / 'out.mcap'
    record(path)
    path.write_bytes(path.read_bytes()[:-100])
    recover(path, out)
    before, after = Recording(path), Recording(out)
    assert after.parameters == before.parameters and after.scene == before.scene == ('chain.txt', 'LINES\n', (('depths.txt', '2 2\n'),))
    assert list(after.messages()) == list(before.messages())


def test_a_killed_bag_folder_becomes_a_readable_one(tmp_path, record):
    folder, out = tmp_path / 'run', tmp_path / 'again'
    file = tmp_path / 'run' / 'run_0.mcap'
    record(folder)
    file.write_bytes(file.read_bytes()[:-100])
    (folder / 'metadata.yaml').unlink()
    with pytest.raises((ReaderError, FileNotFoundError)):
        read_with_rosbags(folder)
    found = recover(folder, out)
    assert found.messages == 200 == len(read_with_rosbags(out)) == len(read_with_mcap(out / 'again_0.mcap'))
    information = yaml.safe_load((out / 'metadata.yaml').read_text())['rosbag2_bagfile_information']
    assert information['message_count'] == 200 and information['custom_data'] == {'mooring_ros.state': 'recovered'}


def test_a_bag_of_several_files_becomes_one_file_or_a_bag(tmp_path):
    bag = tmp_path / 'bag'
    bag.mkdir()
    for number in (1, 2):
        write_mcap(bag / f'b_{number}.mcap', messages=3 + number)
    (bag / 'b_2.mcap').write_bytes((bag / 'b_2.mcap').read_bytes()[:-10])
    assert recover(bag, tmp_path / 'one.mcap').messages == 9 == len(read_with_mcap(tmp_path / 'one.mcap'))
    assert recover(bag, tmp_path / 'folder').messages == 9 == len(read_with_rosbags(tmp_path / 'folder'))


def test_a_whole_recording_is_copied(tmp_path, record):
    record(tmp_path / 'run.mcap')
    found = recover(tmp_path / 'run.mcap', tmp_path / 'out.mcap')
    assert found.copied and (tmp_path / 'out.mcap').read_bytes() == (tmp_path / 'run.mcap').read_bytes()
    record(tmp_path / 'bag')
    shutil.rmtree(tmp_path / 'bag2', ignore_errors=True)
    assert recover(tmp_path / 'bag', tmp_path / 'bag2').copied
    assert len(read_with_rosbags(tmp_path / 'bag2')) == 200


def test_bad_input_is_refused_and_leaves_no_output(tmp_path, record):
    record(tmp_path / 'run.mcap')
    (tmp_path / 'text.mcap').write_text('no')
    for source, target, message in (('run.mcap', 'run.mcap', 'exists already'), ('text.mcap', 'out.mcap', 'not an MCAP'),
                                    ('missing.mcap', 'out.mcap', 'no such file'), ('text.mcap', 'out', 'not an MCAP')):
        with pytest.raises(RecordingError, match=message):
            recover(tmp_path / source, tmp_path / target)
    write_mcap(tmp_path / 'ros1.mcap', profile='ros1')
    with pytest.raises(RecordingError, match="expected 'ros2'"):
        recover(tmp_path / 'ros1.mcap', tmp_path / 'out.mcap')
    assert sorted(path.name for path in tmp_path.iterdir()) == ['ros1.mcap', 'run.mcap', 'text.mcap']


def test_the_command_says_what_it_found(tmp_path, record, capsys):
    path = tmp_path / 'run.mcap'
    record(path)
    assert command_line.main(['recover', str(path), '-o', str(tmp_path / 'copy.mcap')]) == 0
    assert 'is whole' in capsys.readouterr().out
    path.write_bytes(path.read_bytes()[:-50])
    assert command_line.main(['recover', str(path), '-o', str(tmp_path / 'out.mcap')]) == 0
    out, err = capsys.readouterr()
    assert '200 messages on 10 topics' in out and 'cut off at byte' in err
    assert command_line.main(['recover', str(path), '-o', str(tmp_path / 'out.mcap')]) == 2
    assert 'exists already' in capsys.readouterr().err
