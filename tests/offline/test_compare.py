"""The figures of a comparison, against histories whose differences are known in closed form."""

import numpy as np
import pytest

from mooring_ros.offline.compare import common_base, compare, lag
from mooring_ros.offline.pairing import pair_names

PERIOD = 10.0
TIMES = np.arange(0.0, 60.0, 0.05)  # six whole periods


def wave(times, delay=0.0):
    return np.sin(2.0 * np.pi * (times - delay) / PERIOD)


def history(times, mean=1.0e6, amplitude=2.0e5, delay=0.0):
    return mean + amplitude * wave(times, delay)


def both(result, reference=None):
    reference = history(TIMES) if reference is None else reference
    return compare(common_base(TIMES, result, TIMES, reference))


def test_equal_histories_differ_in_nothing():
    found = both(history(TIMES))
    assert found.mean_difference_percent == found.std_difference_percent == found.rms_difference == found.peak_difference == 0.0
    assert found.correlation == pytest.approx(1.0, abs=1e-12)
    assert found.lag == pytest.approx(0.0, abs=1e-9)


def test_gain_shows_as_the_difference_of_the_standard_deviations():
    found = both(history(TIMES, amplitude=1.03 * 2.0e5))
    assert found.std_difference_percent == pytest.approx(3.0, abs=1e-9)
    assert found.mean_difference_percent == pytest.approx(0.0, abs=1e-9)
    assert found.rms_percent_of_std == pytest.approx(3.0, abs=1e-9)
    assert found.peak_difference == pytest.approx(0.03 * 2.0e5, rel=1e-6)


def test_offset_shows_as_the_difference_of_the_means():
    found = both(history(TIMES, mean=0.98e6))
    assert found.mean_difference_percent == pytest.approx(-2.0, abs=1e-9)
    assert found.std_difference_percent == pytest.approx(0.0, abs=1e-9)
    assert found.rms_difference == pytest.approx(0.02e6, rel=1e-12)


@pytest.mark.parametrize("delay", [0.3, -0.3, 0.512, 0.013, -2.0])
def test_lag_is_the_delay_of_the_result_between_samples_too(delay):
    found = both(history(TIMES, delay=delay))
    assert found.lag == pytest.approx(delay, abs=1e-3)
    assert found.correlation == pytest.approx(np.cos(2.0 * np.pi * delay / PERIOD), abs=1e-3)


def test_lag_is_found_under_gain_offset_and_different_sampling():
    times = np.arange(-1.0, 70.0, 0.0173)
    base = common_base(times, history(times, mean=5.0e5, amplitude=4.0e5, delay=0.4), TIMES, history(TIMES))
    assert compare(base).lag == pytest.approx(0.4, abs=2e-3)


def test_a_constant_has_neither_lag_nor_correlation_nor_relative_spread():
    found = both(history(TIMES), np.full(len(TIMES), 0.1))
    assert found.std_reference == 0.0
    assert found.std_difference_percent is None and found.rms_percent_of_std is None
    assert found.lag is None and found.correlation is None


def test_a_reference_of_zero_mean_has_no_relative_mean():
    assert both(history(TIMES), np.zeros(len(TIMES))).mean_difference_percent is None


def test_two_ramps_have_no_best_lag():
    assert lag(TIMES, TIMES.copy(), 3.0 * TIMES) is None


def test_the_coarser_sampling_is_the_common_base():
    fine = np.arange(2.0, 30.0, 0.01)
    base = common_base(fine, wave(fine), TIMES, wave(TIMES))
    assert np.array_equal(base.times, TIMES[(TIMES >= 2.0) & (TIMES <= fine[-1])])
    assert base.result == pytest.approx(wave(base.times), abs=1e-5)
    assert "reference" in base.method and "result interpolated linearly" in base.method


def test_the_same_samples_are_not_interpolated():
    values = history(TIMES)
    base = common_base(TIMES, values, TIMES, values)
    assert base.result is values and "nothing interpolated" in base.method


def test_no_overlap_in_time_is_an_error_with_both_spans():
    with pytest.raises(ValueError, match=r"no overlap in time: the result spans 0 to 59.95 s, the reference 100 to 159.95 s"):
        common_base(TIMES, wave(TIMES), TIMES + 100.0, wave(TIMES))


RESULT = ["line1.fairlead_tension", "line1.anchor_tension", "line2.fairlead_tension"]


def test_equal_names_pair():
    assert pair_names(RESULT, ["line2.fairlead_tension", "T9"]) == [("line2.fairlead_tension", "line2.fairlead_tension")]


def test_a_mapped_line_stands_for_both_of_its_ends():
    reference = ["Line7.fairlead_tension", "Line7.anchor_tension"]
    assert pair_names(RESULT, reference, [("line1", "Line7")]) == list(zip(RESULT[:2], reference))


def test_a_mapped_line_against_one_series_stands_for_its_fairlead():
    assert pair_names(RESULT, ["FairTen1"], [("line1", "FairTen1")]) == [("line1.fairlead_tension", "FairTen1")]


def test_a_mapped_name_does_not_pair_with_its_equal_as_well():
    pairs = pair_names(["a", "b"], ["a", "b"], [("a", "b")])
    assert pairs == [("a", "b")]


def test_names_without_a_partner_are_an_error_that_lists_them():
    with pytest.raises(ValueError, match=r"no names in common: the result has a; the reference has b; expected --map"):
        pair_names(["a"], ["b"])


def test_a_mapped_name_that_is_not_there_is_an_error_with_the_nearest():
    with pytest.raises(ValueError, match="the result has no 'line1.fairlead_tensoin', expected line1.fairlead_tension"):
        pair_names(RESULT, ["x"], [("line1.fairlead_tensoin", "x")])
