"""What the comparisons with the peers stand on: motions, meshes, kept runs, fronts."""

import numpy as np
import pytest

from benchmarks import farm_deck, peer_cache, peer_cases, tables
from benchmarks.motions import Sines


def test_a_sum_of_sines_has_the_velocity_of_its_places_and_starts_at_rest():
    motion = Sines(2.0, 1.0, 1.5, period=8.0)
    times = np.linspace(0.01, motion.end, 200)
    _, velocity = motion.displacement(times)
    h = 1e-5
    difference = (motion.displacement(times + h)[0] - motion.displacement(times - h)[0]) / (2.0 * h)
    np.testing.assert_allclose(velocity, difference, atol=1e-8)
    place, rate = motion.displacement(np.zeros(1))
    assert not place.any() and not rate.any()


def test_the_farm_is_what_its_script_writes():
    assert farm_deck.FILE.read_text(encoding="utf-8") == farm_deck.text()


@pytest.mark.parametrize("case", peer_cases.CASES, ids=lambda case: case.name)
def test_a_case_is_in_still_water_and_refined_line_by_line(case):
    coarse, fine = case.scene(), case.scene(2)
    assert coarse.environment.waves is None
    assert [n.segments for n in fine.lines] == [2 * n.segments for n in coarse.lines]
    assert peer_cases.fairleads(coarse)
    assert case.platform().end > case.platform().start > 0.0


def test_a_kept_run_is_made_once_and_again_for_another_key(tmp_path, monkeypatch):
    monkeypatch.setattr(peer_cache, "FOLDER", tmp_path)
    made = []

    def make():
        made.append(len(made))
        return {"force": np.array([1.0, 2.0]) + len(made)}

    first = peer_cache.kept("numpy", "deck", make)
    again = peer_cache.kept("numpy", "deck", make)
    other = peer_cache.kept("numpy", "deck at another step", make)
    assert made == [0, 1]
    assert first["force"].tolist() == again["force"].tolist() == [2.0, 3.0]
    assert other["force"].tolist() == [3.0, 4.0]


def test_a_table_takes_the_place_of_the_one_before():
    text = "a\n<!-- x -->\nold\n<!-- /x -->\nb\n"
    assert tables.refresh(text, "x", "new") == "a\n<!-- x -->\nnew\n<!-- /x -->\nb\n"
