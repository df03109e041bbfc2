"""Nodes whose graphs together hold every topic there can be."""
from collections import ChainMap

import pytest
from graph import ROOT, graph

from benchmarks.domains import free_domain


@pytest.fixture(scope="session")
def whole_graph(tmp_path_factory):
    """(published, subscribed, answered) of a node with Odometry, of one with everything else switched on, and of two with several platforms."""
    folder = tmp_path_factory.mktemp("graph")
    first = graph(folder, free_domain())
    second = graph(folder, free_domain(), input="pose_twist", full_scale=True, use_sim_time=True, scale=50.0)
    pair = {"scene": ROOT / "config" / "scenes" / "oc4_pair.txt", "platforms": "[body1, body2]"}
    graphs = [first, second, graph(folder, free_domain(), **pair), graph(folder, free_domain(), **pair, input="pose_twist")]
    published, subscribed, answered = zip(*graphs)
    return dict(ChainMap(*published)), dict(ChainMap(*subscribed)), set().union(*answered)
