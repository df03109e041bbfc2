"""Poses as camera systems send them: what becomes of noise, bunched stamps, lost frames, and frames without the platform."""
import numpy as np
import pytest

from benchmarks import camera_frames as recorded
from mooring_ros.motion import Adapter, Gate, Limits, Velocity

PERIOD = 1.0 / recorded.RATE
SETTLED = 100           # frames after which a filter has forgotten its start


def gate(rate=recorded.RATE, bandwidth=12.0, scale=50.0, **limits):
    return Gate(Adapter(scale=scale), Limits(**limits), velocity=Velocity(rate, bandwidth))


def run(the_gate, made):
    """(Frame, Motion) of all that is admitted."""
    return [(frame, motion) for frame in made if (motion := the_gate.admit(frame.sample)) is not None]


def label_errors(admitted):
    """s, by how much frame times are off, their mean left out: how long the way takes at least, nobody can know."""
    first = admitted[0][1].time
    off = np.array([(motion.time - first) * 1e-9 - frame.time for frame, motion in admitted])[SETTLED:]
    return off - np.median(off)


def velocity_error(admitted):
    """m/s at the source's scale, rms, beside the true velocity at the time that the frame was taken."""
    off = [np.subtract(motion.twist[:3], 50.0 ** 0.5 * frame.twist[:3]) for frame, motion in admitted[SETTLED:]]
    return np.sqrt(np.mean(np.square(off))) / 50.0 ** 0.5


@pytest.mark.parametrize("disturbed", [lambda made: made, recorded.late, recorded.bunched, recorded.skipped],
                         ids=["as taken", "late", "bunched", "skipped"])
def test_velocities_of_noisy_poses_are_as_good_however_their_stamps_come(disturbed):
    made = recorded.frames()
    quiet = velocity_error(run(gate(), made))
    assert quiet < 0.01         # of 0.25 m/s; three differenced poses give 0.06
    the_gate = gate()
    admitted = run(the_gate, disturbed(made))
    assert len(admitted) == the_gate.received and velocity_error(admitted) < 1.3 * quiet


def test_frames_that_were_bunched_get_their_own_times_back():
    the_gate = gate()
    admitted = run(the_gate, recorded.bunched(recorded.frames()))
    assert np.abs(label_errors(admitted)).max() < 0.1 * PERIOD
    assert the_gate.frame_clock.late > 50 and the_gate.frame_clock.skipped == 0


def test_frames_after_lost_ones_get_their_own_times():
    the_gate = gate()
    admitted = run(the_gate, recorded.skipped(recorded.frames()))
    off = np.abs(label_errors(admitted))
    # where the platform turns round, one frame after a gap may be taken for a late one
    assert np.mean(off > 0.5 * PERIOD) < 0.01
    lost = round((admitted[-1][0].time - admitted[0][0].time) * recorded.RATE) + 1 - len(admitted)
    assert the_gate.frame_clock.skipped == lost > 60


def test_of_a_platform_at_rest_one_frame_after_a_gap_is_labelled_early_at_most():
    admitted = run(gate(), recorded.skipped(recorded.frames(moving=False)))
    off = np.abs(label_errors(admitted)) > 0.5 * PERIOD
    assert not (off[1:] & off[:-1]).any()


def test_without_a_rate_the_twists_of_bunched_stamps_are_refused_not_believed_and_the_next_frames_are_taken_again():
    the_gate = gate(rate=0.0)
    admitted = run(the_gate, recorded.bunched(recorded.frames()))
    assert the_gate.rejected["jump"] > 30 and "made of the poses" in the_gate.cause
    assert max(np.hypot(*motion.twist[:3:2]) for _, motion in admitted) < 10.0
    assert len(admitted) > 0.8 * the_gate.received


@pytest.mark.parametrize("said", [50.0, 220.0, 280.0])
def test_a_rate_that_is_not_the_sources_does_not_let_the_time_run_away(said):
    the_gate = gate(rate=said)
    admitted = run(the_gate, recorded.frames())
    off = np.array([(motion.time - motion.stamp) * 1e-9 for _, motion in admitted])
    assert np.abs(off[5:]).max() < 3.0 / said
    assert said > recorded.RATE or the_gate.rejected["early"] > 20 and "is that the rate?" in the_gate.cause


@pytest.mark.parametrize("said", [248.75, 251.25])
def test_a_rate_that_is_wrong_by_half_a_percent_costs_nothing(said):
    the_gate = gate(rate=said)
    admitted = run(the_gate, recorded.bunched(recorded.frames()))
    assert len(admitted) == the_gate.received and the_gate.frame_clock.skipped == 0
    assert np.abs(label_errors(admitted)).max() < 0.2 * PERIOD and velocity_error(admitted) < 0.01


def test_a_first_frame_that_came_late_is_put_right():
    made = recorded.frames()
    delays = np.zeros(len(made))
    delays[0] = 0.03
    made[0] = recorded.stamped(made, delays)[0]
    the_gate = gate()
    admitted = run(the_gate, made)
    off = np.abs([motion.time - motion.stamp for _, motion in admitted])
    assert off.max() < 0.5e9 * PERIOD and off[10:].max() < 0.01e9 * PERIOD
    assert the_gate.rejected["reordered"] == 7


@pytest.mark.parametrize("how", [float("nan"), 0.0], ids=["NaN", "zeros"])
def test_up_to_so_many_frames_without_the_platform_are_bridged_and_then_it_is_lost(how):
    made = recorded.occluded(recorded.frames(), 300, 12, how)
    the_gate = gate(lost_frames=10)
    answers = [the_gate.admit(frame.sample) for frame in made[:310]]
    bridged = answers[300:]
    assert all(motion.bridged for motion in bridged) and the_gate.bridged == 10 and not the_gate.lost
    for frame, motion in zip(made[300:], bridged):
        assert motion.stamp == frame.sample.stamp
        np.testing.assert_allclose(motion.pose[:3], 50.0 * frame.pose[:3], atol=50.0 * 1.5e-3)
    assert the_gate.admit(made[310].sample) is None and the_gate.lost
    assert sum(the_gate.rejected.values()) == 11
    assert the_gate.admit(made[311].sample) is None
    back = the_gate.admit(made[312].sample)
    assert not the_gate.lost and not back.bridged
    np.testing.assert_allclose(back.pose[:3], 50.0 * made[312].pose[:3], atol=50.0 * 1e-3)


def test_frames_without_the_platform_are_not_bridged_unless_asked_for():
    the_gate = gate()
    for frame in recorded.occluded(recorded.frames(1.0), 100, 3)[:103]:
        motion = the_gate.admit(frame.sample)
    assert motion is None and not the_gate.lost and the_gate.rejected["non_finite"] == 3


def test_a_good_velocity_is_found_again_after_a_long_pause():
    made = recorded.frames(8.0)
    the_gate = gate()
    run(the_gate, made[:500])
    admitted = run(the_gate, made[1500:])
    assert velocity_error(admitted) < 0.01


@pytest.mark.parametrize("rate, scale, bandwidth", [(250.0, 50.0, 1.2 * 50.0 ** 0.5), (60.0, 50.0, 4.0), (10.0, 1.0, 10.0 / 15.0), (200.0, 1.0, 1.2)])
def test_the_bandwidth_that_nobody_says_follows_the_waves_of_the_scale_but_not_past_a_fifteenth_of_the_rate(rate, scale, bandwidth):
    assert Velocity(rate).tracker(scale ** 0.5).bandwidth * scale ** 0.5 == pytest.approx(bandwidth)


def test_a_driver_that_sends_the_last_pose_again_has_lost_the_platform():
    made = recorded.frames(2.0)
    made[300:308] = [frame._replace(sample=frame.sample._replace(pose=made[299].sample.pose)) for frame in made[300:308]]
    the_gate = gate(lost_frames=5)
    answers = [the_gate.admit(frame.sample) for frame in made]
    assert the_gate.rejected["frozen"] == 8 and the_gate.bridged == 5 and "bit for bit" in the_gate.cause
    assert all(motion.bridged for motion in answers[300:305]) and answers[305:308] == [None] * 3
    assert all(motion and not motion.bridged for motion in answers[308:])


def test_a_source_without_noise_may_stand_still():
    the_gate = gate()
    admitted = run(the_gate, recorded.frames(2.0, noise=0.0, moving=False))
    assert len(admitted) == 500


def test_frames_of_a_bunch_with_the_same_stamp_are_told_apart_and_a_doubled_message_is_not_a_frame():
    coarse = [frame._replace(sample=frame.sample._replace(stamp=frame.sample.stamp // 1_000_000 * 1_000_000))
              for frame in recorded.bunched(recorded.frames())]
    assert len({frame.sample.stamp for frame in coarse}) < len(coarse) - 50
    the_gate = gate()
    admitted = run(the_gate, coarse)
    assert len(admitted) == len(coarse) and np.abs(label_errors(admitted)).max() < 0.3 * PERIOD
    assert the_gate.admit(coarse[-1].sample) is None and the_gate.rejected["repeated"] == 1


def test_stamps_are_put_right_where_twists_are_given_as_well():
    made = [frame._replace(sample=frame.sample._replace(twist=tuple(frame.twist.tolist()))) for frame in recorded.bunched(recorded.frames())]
    the_gate = Gate(Adapter("world", scale=50.0), velocity=Velocity(recorded.RATE))
    admitted = run(the_gate, made)
    assert len(admitted) == len(made) and np.abs(label_errors(admitted)).max() < 0.1 * PERIOD
    assert all(np.allclose(np.divide(motion.twist[:3], 50.0 ** 0.5), frame.twist[:3]) for frame, motion in admitted)


@pytest.mark.parametrize("leap", [0.1, 5.0, 3600.0, -3600.0])
@pytest.mark.parametrize("rate", [0.0, recorded.RATE])
def test_a_frame_without_the_platform_whose_stamp_leaps_is_not_bridged_and_shuts_out_nothing(leap, rate):
    made = recorded.frames(1.0, noise=0.0)
    lost = recorded.occluded(made, 120, 1)[120].sample
    the_gate = gate(rate=rate, lost_frames=10)
    run(the_gate, made[:120])
    last = the_gate.last
    assert the_gate.admit(lost._replace(stamp=lost.stamp + round(leap * 1e9))) is None and the_gate.last is last
    assert len(run(the_gate, made[120:])) == 130


def test_another_bodys_frames_without_numbers_are_not_bridged():
    made = recorded.frames(1.0)
    the_gate = gate(lost_frames=10)
    run(the_gate, made[:120])
    other = recorded.occluded(made, 120, 1)[120].sample._replace(frame="another")
    assert the_gate.admit(other) is None and the_gate.bridged == 0 and the_gate.rejected["frame"] == 1


def test_a_bandwidth_past_half_the_rate_is_refused_in_the_words_of_the_parameters():
    with pytest.raises(ValueError, match="input_bandwidth is 60 Hz, expected less than half of input_rate, 100 Hz"):
        gate(rate=100.0, bandwidth=60.0)


def test_frames_without_the_platform_are_bridged_in_a_bunch_as_well():
    made = recorded.occluded(recorded.bunched(recorded.frames(2.0)), 350, 4)
    assert made[352].sample.stamp - made[351].sample.stamp > 3e9 * PERIOD
    the_gate = gate(lost_frames=5)
    assert len(run(the_gate, made)) == len(made) and the_gate.bridged == 4
