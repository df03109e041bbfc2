"""Layouts of Foxglove and RViz show topics that a node really has, with the types that their panels take."""
import json
import re

import yaml
from graph import ROOT

VIEWERS = ROOT / "config" / "viewers"
RVIZ_TYPES = {"rviz_default_plugins/MarkerArray": "visualization_msgs/msg/MarkerArray",
              "rviz_default_plugins/PointCloud2": "sensor_msgs/msg/PointCloud2",
              "rviz_default_plugins/Odometry": "nav_msgs/msg/Odometry"}
# Fields that the plots draw, by type.
FIELDS = {"sensor_msgs/msg/JointState": r"effort\[\d\]|position\[\d\]", "geometry_msgs/msg/WrenchStamped": r"wrench\.(force|torque)\.[xyz]",
          "nav_msgs/msg/Odometry": r"pose\.pose\.position\.[xyz]", "diagnostic_msgs/msg/DiagnosticStatus": "message"}


def test_every_topic_and_service_of_the_foxglove_layout_is_there(whole_graph):
    published, subscribed, answered = whole_graph
    topics = {**published, **subscribed}
    panels = json.loads((VIEWERS / "foxglove.json").read_text(encoding="utf-8"))["configById"]
    shown = 0
    for panel in panels.values():
        for name in [*panel.get("topics", {}), *filter(None, [panel.get("topicToRender")])]:
            assert name in topics, name
            shown += 1
        for path in panel.get("paths", []):
            name, field = path["value"].split(".", 1)
            assert re.fullmatch(FIELDS[topics[name]], field), path["value"]
            shown += 1
        if "serviceName" in panel:
            assert panel["serviceName"] in answered, panel["serviceName"]
            shown += 1
    assert shown > 12


def test_every_panel_of_the_foxglove_layout_has_its_place():
    layout = json.loads((VIEWERS / "foxglove.json").read_text(encoding="utf-8"))

    def leaves(part):
        return [part] if isinstance(part, str) else leaves(part["first"]) + leaves(part["second"])

    assert sorted(leaves(layout["layout"])) == sorted(layout["configById"])


def test_every_topic_of_the_rviz_configuration_is_there_with_the_type_of_its_display(whole_graph):
    published, subscribed, _ = whole_graph
    displays = yaml.safe_load((VIEWERS / "mooring.rviz").read_text(encoding="utf-8"))["Visualization Manager"]["Displays"]
    assert len(displays) == 3
    for display in displays:
        assert {**published, **subscribed}[display["Topic"]["Value"]] == RVIZ_TYPES[display["Class"]]
