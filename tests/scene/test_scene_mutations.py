"""Whatever stands in a file: it loads as before, loads as a valid scene, or is refused at the right line."""

import math
import random
import re

import pytest

from mooring_ros.scene import SceneError, parse_scene

from .decks import PLAIN

JUNK = ["abc", "nan", "inf", "-1", "0", "1e400", "---", "#", "|", "1|2", "x.txt", "\u00b2", "(", "'", "P", "1.", "END", "9" * 400, "", "%d", "R1A", "Body1"]


def sound(scene):
    """Every number of a scene is finite and every reference leads somewhere."""
    numbers = [scene.environment.depth, scene.environment.gravity, scene.environment.water_density, *scene.environment.current]
    for item in (*scene.line_types, *scene.points, *scene.lines):
        numbers += [value for value in vars(item).values() if isinstance(value, int | float)]
    ids = {point.id for point in scene.points}
    return all(map(math.isfinite, numbers)) and all({line.end_a, line.end_b} <= ids for line in scene.lines)


def words_of(text):
    return [match.span() for match in re.finditer(r"\S+", text)]


def test_a_word_replaced_by_nonsense_is_harmless_or_refused_at_its_line():
    for start, end in words_of(PLAIN):
        line = PLAIN[:start].count("\n") + 1
        text = PLAIN[:start] + "?junk?" + PLAIN[end:]
        try:
            scene = parse_scene(text, "deck.txt")
        except SceneError as error:
            # A word of a heading can leave its section without a name, a name without its references.
            heading = text.split("\n")[line - 1].startswith(("---", "?junk?")) or "--- ?" in text
            name = PLAIN[start:end] in ("chain", "rope", "END", "WtrDpth", "---")
            assert error.line == line or heading or name, (text.split("\n")[line - 1], str(error))
        else:
            plain = parse_scene(PLAIN, "deck.txt")
            assert (scene.line_types, scene.points, scene.lines, scene.environment) == (plain.line_types, plain.points, plain.lines, plain.environment), (
                text.split("\n")[line - 1]
            )


@pytest.mark.parametrize("seed", range(20))
def test_random_damage_is_refused_or_leaves_a_sound_scene(seed):
    random_ = random.Random(seed)
    for _ in range(60):
        text = PLAIN
        for _ in range(random_.randint(1, 3)):
            kind = random_.randrange(4)
            if kind == 0:  # a word
                start, end = random_.choice(words_of(text))
                text = text[:start] + random_.choice(JUNK) + text[end:]
            elif kind == 1:  # a line lost or doubled
                lines = text.split("\n")
                index = random_.randrange(len(lines))
                lines[index : index + 1] = [lines[index]] * random_.choice([0, 2])
                text = "\n".join(lines)
            elif kind == 2:  # a character
                index = random_.randrange(len(text))
                text = text[:index] + chr(random_.choice([0, 9, 10, 13, 32, 45, 46, 101, 0x2028, 0x1F600])) + text[index + 1 :]
            else:  # cut off
                text = text[: random_.randrange(1, len(text))]
        try:
            scene = parse_scene(text, "deck.txt")
        except SceneError as error:
            assert str(error).startswith("deck.txt:") and "expected" in error.message
            assert 0 <= error.line <= len(re.split(r"\r\n|\r|\n", text))
        else:
            assert sound(scene)
