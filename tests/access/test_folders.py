"""Where the graph may point a node: below the folders that it was started with, and nowhere else."""
import os

import pytest

from mooring_ros.node.access import Access, inside
from mooring_ros.scene import SceneError, load_scene


@pytest.fixture
def places(tmp_path, monkeypatch):
    """A folder `tank` in which the node was started, with a scene, and things outside; nothing is a temporary file."""
    monkeypatch.setattr("tempfile.gettempdir", lambda: str(tmp_path / "temporary"))
    for name in ("tank/scenes", "tank-private", "temporary"):
        (tmp_path / name).mkdir(parents=True)
    monkeypatch.chdir(tmp_path / "tank")
    return tmp_path


@pytest.mark.parametrize("path", ["../tank-private/a.txt", "/etc/passwd", "scenes/../../tank-private/a.txt", "~root/.profile", "../tank-privat"])
def test_a_path_that_leads_out_is_refused_and_the_reason_says_where_it_may_be(places, path):
    access = Access("scenes/a.txt")
    for name in ("scene", "recording.path"):
        with pytest.raises(ValueError, match=f"expected a file below {places}/tank, "):
            access.check(name, path)


@pytest.mark.parametrize("path", ["scenes/b.txt", "b.txt", "scenes/../b.txt", ""])
def test_a_path_below_is_allowed(places, path):
    Access().check("scene", path)
    Access().check("recording.path", path)


def test_a_link_is_followed(places):
    os.symlink(places / "tank-private", places / "tank" / "scenes" / "link")
    assert not inside("scenes/link/a.txt", Access().folders)


def test_what_it_was_started_with_may_be_anywhere_and_is_allowed_again(places):
    access = Access("/opt/scenes/a.txt", "/data/run.mcap")
    access.check("scene", "/opt/scenes/a.txt")
    access.check("scene", "/opt/scenes/b.txt")
    access.check("recording.path", "/data/run.mcap")
    assert access.folders_of("/opt/scenes/a.txt") is None and access.folders_of("/opt/scenes/b.txt") == access.folders
    with pytest.raises(ValueError):
        access.check("recording.path", "/dat/run.mcap")


def test_folders_that_are_named_replace_all_others(places):
    access = Access("scenes/a.txt", "", f"{places}/tank-private")
    access.check("scene", "../tank-private/a.txt")
    with pytest.raises(ValueError):
        access.check("scene", "scenes/b.txt")


@pytest.mark.parametrize("file", ["../../tank-private/depths.txt", "{}/tank-private/depths.txt", "link/depths.txt",
                                  "..\\\\..\\\\tank-private\\\\depths.txt"])
def test_a_scene_from_the_graph_names_no_file_outside_and_tells_nothing_of_it(places, file):
    (places / "tank-private" / "depths.txt").write_text("secret words\n")
    os.symlink(places / "tank-private", places / "tank" / "scenes" / "link")
    scene = places / "tank" / "scenes" / "b.txt"
    scene.write_text(SCENE.format(file.replace("\\\\", "\\").format(places)))
    with pytest.raises(SceneError, match="b.txt:16: .*lies outside of") as refused:
        load_scene(scene, Access().folders_of(str(scene)))
    assert "secret" not in str(refused.value)


SCENE = """\
One chain
--- LINE TYPES ---
Name  Diam  Mass/m  EA  BA/-zeta  EI  Cd  Ca  CdAx  CaAx
(-)  (m)  (kg/m)  (N)  (N-s/-)  (N-m2)  (-)  (-)  (-)  (-)
chain  0.05  50  2.0e7  -0.8  0  2.0  0.8  0.4  0.25
--- POINTS ---
ID  Type  X  Y  Z  Mass  Volume  CdA  Ca
(-)  (-)  (m)  (m)  (m)  (kg)  (m3)  (m2)  (-)
1  Fixed    300  0  -60  0  0  0  0
2  Coupled   20  0   -5  0  0  0  0
--- LINES ---
ID  LineType  AttachA  AttachB  UnstrLen  NumSegs  Outputs
(-)  (-)  (-)  (-)  (m)  (-)  (-)
1  chain  1  2  292  8  -
--- OPTIONS ---
{} SeafloorFile
"""
