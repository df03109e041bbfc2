"""Whatever stands in a file: it loads as before, loads as a valid scene, or is refused at the right line."""

import math
import random
import re

import pytest

from mooring_ros.scene import RodEnd, SceneError, parse_scene

from .decks import FILES, FULL, PLAIN

JUNK = ["abc", "nan", "inf", "-1", "0", "1e400", "---", "#", "|", "1|2", "x.txt", "\u00b2", "(", "'", "P", "1."]
JUNK += ["END", "9" * 400, "", "%d", "R1A", "Body1"]
DECKS = {"plain": (PLAIN, {}), "full": (FULL, FILES)}


def numbers_of(value):
    if isinstance(value, int | float):
        yield value
    elif isinstance(value, tuple):
        for item in value:
            yield from numbers_of(item)
    elif hasattr(value, "__dataclass_fields__"):
        yield from numbers_of(tuple(vars(value).values()))


def sound(scene):
    """Every number of a scene is finite and every reference leads somewhere."""
    parts = (scene.environment, *scene.line_types, *scene.points, *scene.lines, *scene.rods, *scene.bodies)
    points, rods, bodies = ({part.id for part in parts} for parts in (scene.points, scene.rods, scene.bodies))
    ends = [end for line in scene.lines for end in (line.end_a, line.end_b)] + [failure.holder for failure in scene.failures]
    carriers = [part.body for part in (*scene.points, *scene.rods) if part.body is not None]
    lines = {line.id for line in scene.lines}
    return (
        all(map(math.isfinite, numbers_of(parts)))
        and all(end.rod in rods if isinstance(end, RodEnd) else end in points for end in ends)
        and bodies.issuperset(carriers)
        and all(lines.issuperset(failure.lines) and min(failure.time, failure.tension) < math.inf for failure in scene.failures)
    )


def words_of(text):
    return [match.span() for match in re.finditer(r"\S+", text)]


def physics(scene):
    return scene.line_types, scene.points, scene.lines, scene.environment, scene.rod_types, scene.rods, scene.bodies, scene.failures


@pytest.mark.parametrize("deck", DECKS)
def test_a_word_replaced_by_nonsense_is_harmless_or_refused_at_its_line(deck):
    plain, files = DECKS[deck]
    right = parse_scene(plain, "deck.txt", files.items())
    for start, end in words_of(plain):
        line = plain[:start].count("\n") + 1
        text = plain[:start] + "?junk?" + plain[end:]
        try:
            scene = parse_scene(text, "deck.txt", files.items())
        except SceneError as error:
            # A word of a heading can leave its section without a name, a name without its references.
            heading = text.split("\n")[line - 1].startswith(("---", "?junk?")) or "--- ?" in text
            name = plain[start:end] in ("chain", "rope", "cable", "nylon", "spar", "joint", "END", "WtrDpth", "---")
            assert error.line == line or heading or name, (text.split("\n")[line - 1], str(error))
        else:
            assert physics(scene) == physics(right), text.split("\n")[line - 1]


@pytest.mark.parametrize("deck", DECKS)
@pytest.mark.parametrize("seed", range(20))
def test_random_damage_is_refused_or_leaves_a_sound_scene(seed, deck):
    random_ = random.Random(seed)
    plain, files = DECKS[deck]
    for _ in range(60 if deck == "plain" else 30):
        texts = {"deck.txt": plain, **files}
        for _ in range(random_.randint(1, 3)):
            name = random_.choice(["deck.txt", "deck.txt", *texts])
            texts[name] = damaged(random_, texts[name])
        text = texts.pop("deck.txt")
        try:
            scene = parse_scene(text, "deck.txt", texts.items())
        except SceneError as error:
            assert error.file in ("deck.txt", *files) and "expected" in error.message
            assert 0 <= error.line <= len(re.split(r"\r\n|\r|\n", {"deck.txt": text, **texts}[error.file]))
        else:
            assert sound(scene)


def damaged(random_, text):
    kind = random_.randrange(4)
    if not text:
        return text
    if kind == 0 and words_of(text):  # a word
        start, end = random_.choice(words_of(text))
        return text[:start] + random_.choice(JUNK) + text[end:]
    if kind == 1:  # a line lost or doubled
        lines = text.split("\n")
        index = random_.randrange(len(lines))
        lines[index : index + 1] = [lines[index]] * random_.choice([0, 2])
        return "\n".join(lines)
    if kind == 2:  # a character
        index = random_.randrange(len(text))
        return text[:index] + chr(random_.choice([0, 9, 10, 13, 32, 45, 46, 101, 0x2028, 0x1F600])) + text[index + 1 :]
    return text[: random_.randrange(1, len(text) + 1)]  # cut off
