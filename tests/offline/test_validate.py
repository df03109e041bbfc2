"""`mooring validate`: pairs, figures, strict JSON and a report that stands by itself."""

import re

import numpy as np
import pytest

TIMES = np.arange(0.0, 60.0, 0.05)
FAIRLEAD, ANCHOR = "line1.fairlead_tension", "line1.anchor_tension"


def wave(delay=0.0, gain=1.0, offset=0.0):
    return (1.0 + offset) * 1.0e6 + gain * 2.0e5 * np.sin(2.0 * np.pi * (TIMES - delay) / 10.0)


def write(path, **series):
    names = [name.replace("__", ".") for name in series]
    rows = np.column_stack([TIMES, *series.values()])
    path.write_text("\n".join([",".join(["time", *names]), *(",".join(map(repr, row)) for row in rows.tolist())]) + "\n")
    return path


@pytest.fixture
def pair(tmp_path):
    """A result that is late by 0.3 s, 2 % high in its mean and 5 % in its amplitude, and its reference."""
    result = write(tmp_path / "result.csv", line1__fairlead_tension=wave(0.3, 1.05, 0.02), line1__anchor_tension=wave(), wrench__fx=wave())
    reference = write(tmp_path / "reference.csv", line1__fairlead_tension=wave(), line1__anchor_tension=wave(), wrench__fx=wave())
    return result, reference


def test_the_figures_are_those_the_histories_were_made_with(pair, mooring):
    found = mooring("validate", *pair, "--json").json()
    fairlead, anchor = found["pairs"]
    assert (fairlead["result"], fairlead["reference"]) == (FAIRLEAD, FAIRLEAD)
    assert fairlead["mean_difference_percent"] == pytest.approx(2.0, abs=1e-9)
    assert fairlead["std_difference_percent"] == pytest.approx(5.0, abs=1e-9)
    assert fairlead["lag"] == pytest.approx(0.3, abs=1e-3)
    assert fairlead["correlation"] == pytest.approx(np.cos(2.0 * np.pi * 0.03), abs=1e-9)
    amplitude = abs(1.05 * np.exp(-2j * np.pi * 0.03) - 1.0) * 2.0e5
    assert fairlead["rms_difference"] == pytest.approx(np.hypot(2.0e4, amplitude / np.sqrt(2.0)), rel=1e-9)
    assert fairlead["peak_difference"] == pytest.approx(2.0e4 + amplitude, rel=1e-3)
    assert anchor["rms_difference"] == 0.0 and anchor["correlation"] == 1.0
    assert found["time"]["samples"] == len(TIMES)
    assert found["unpaired"] == {"result": ["wrench.fx"], "reference": ["wrench.fx"]}


def test_what_is_not_defined_is_null_and_never_nan(tmp_path, mooring):
    result = write(tmp_path / "a.csv", line1__fairlead_tension=wave())
    reference = write(tmp_path / "b.csv", line1__fairlead_tension=0.0 * wave())
    (found,) = mooring("validate", result, reference, "--json").json()["pairs"]
    for key in ("mean_difference_percent", "std_difference_percent", "rms_percent_of_std", "lag", "correlation"):
        assert found[key] is None
    assert "–" in mooring("validate", result, reference).out


@pytest.mark.parametrize("words", [["--map", f"{FAIRLEAD}=T1", f"{ANCHOR}=T2"], ["--map", f"{FAIRLEAD}=T1", "--map", f"{ANCHOR}=T2"]])
@pytest.mark.parametrize("first", [True, False])
def test_names_that_differ_pair_by_mapping_given_once_or_often(pair, tmp_path, mooring, words, first):
    other = write(tmp_path / "other.csv", T1=wave(), T2=wave())
    given = ["validate", *words, pair[0], other, "--json"] if first else ["validate", pair[0], other, *words, "--json"]
    found = mooring(*given).json()["pairs"]
    assert [(each["result"], each["reference"]) for each in found] == [(FAIRLEAD, "T1"), (ANCHOR, "T2")]


def test_the_text_has_a_row_for_each_pair_and_says_how_they_were_brought_together(pair, mooring):
    outcome = mooring("validate", *pair)
    assert outcome.status == 0
    assert re.search(rf"^{re.escape(FAIRLEAD)} +\+2 +\+5 ", outcome.out, re.MULTILINE)
    assert "same sample times, nothing interpolated" in outcome.out


def test_the_report_is_one_file_that_needs_no_network(pair, tmp_path, mooring):
    outcome = mooring("validate", *pair, "-o", tmp_path / "report.html", "--json")
    assert outcome.status == 0 and len(outcome.json()["pairs"]) == 2
    text = (tmp_path / "report.html").read_text()
    assert not re.search(r"https?:|@import|url\((?!#)|src=", text)
    assert text.count("<svg") == 3 and FAIRLEAD in text and "+2" in text


def test_a_replay_can_be_held_against_another(scene, motion, mooring, tmp_path):
    mooring("replay", scene, motion, "-o", tmp_path / "coarse.mcap", "--segments", "7")
    mooring("replay", scene, motion, "-o", tmp_path / "fine.mcap", "--csv", tmp_path / "fine.csv")
    for reference in ("fine.mcap", "fine.csv"):
        found = mooring("validate", tmp_path / "coarse.mcap", tmp_path / reference, "--json").json()
        assert len(found["pairs"]) == 4
        assert all(pair["correlation"] > 0.9 and 0.0 < abs(pair["mean_difference_percent"]) < 10.0 for pair in found["pairs"])
