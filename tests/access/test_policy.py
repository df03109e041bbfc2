"""The SROS2 policy allows what a node uses, and nothing else."""
import fnmatch
import xml.etree.ElementTree as ElementTree

import pytest
from graph import ROOT

POLICY = ROOT / "config" / "sros2_policy.xml"


def allowed(enclave):
    """(kind, right) -> names as DDS knows them, of the one profile of an enclave.

    kind: topics or services; right: publish, subscribe, reply, request.
    """
    profiles = ElementTree.parse(POLICY).getroot().findall(f"./enclaves/enclave[@path='/{enclave}']/profiles/profile")
    assert [(profile.get("ns"), profile.get("node")) for profile in profiles] == [("/", enclave)]
    found = {}
    for part in profiles[0]:
        assert len(part.attrib) == 1 and set(part.attrib.values()) == {"ALLOW"}
        (right, _), = part.attrib.items()
        found[part.tag, right] = {_full(name.text, enclave) for name in part}
        assert len(found[part.tag, right]) == len(part)
    return found


def _full(name, node):
    return f"/{node}{name[1:]}" if name.startswith("~") else name if name.startswith("/") else f"/{name}"


def without_match(patterns, names):
    """Patterns that no name fits, and names that no pattern fits."""
    return ({pattern for pattern in patterns if not fnmatch.filter(names, pattern)},
            {name for name in names if not any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns)})


@pytest.mark.parametrize("kind, right, index", [("topics", "publish", 0), ("topics", "subscribe", 1), ("services", "reply", 2)])
def test_the_nodes_rights_are_exactly_what_it_uses(whole_graph, kind, right, index):
    patterns = allowed("mooring")[kind, right]
    # Jazzy's rclpy nodes follow /parameter_events only with use_sim_time, by a name of their own.
    unused, forbidden = without_match(patterns, set(whole_graph[index]))
    assert not forbidden, f"the node uses what the policy does not allow: {forbidden}"
    assert unused <= {"/parameter_events"}, f"the policy allows what the node never uses: {unused}"


def test_no_other_enclave_may_speak_for_the_node():
    said = {"/mooring/wrench", "/mooring/state", "/diagnostics", "/mooring/fairleads/*/wrench"}
    for enclave in ("simulator", "operator", "onlooker"):
        rights = allowed(enclave)
        assert not said & rights["topics", "publish"]
        assert ("services", "reply") not in rights


def test_only_the_simulator_moves_the_platform_and_only_the_operator_may_command():
    for enclave in ("mooring", "operator", "onlooker"):
        assert not {name for name in allowed(enclave)["topics", "publish"] if name.startswith("/platform") or name.endswith("unstretched_lengths")}
    assert ("services", "request") not in allowed("simulator") and ("services", "request") not in allowed("onlooker")


@pytest.mark.parametrize("enclave", ["simulator", "operator", "onlooker"])
def test_what_others_may_use_is_there_to_be_used(whole_graph, enclave):
    published, subscribed, answered = whole_graph
    common = {"/parameter_events", "/rosout", "/clock"}
    rights = allowed(enclave)
    assert not without_match(rights["topics", "subscribe"] - common, {**published, **subscribed})[0]
    assert not without_match(rights["topics", "publish"] - common, set(subscribed))[0]
    assert not without_match(rights.get(("services", "request"), set()), answered)[0]
