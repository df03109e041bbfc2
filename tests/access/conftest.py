"""Two nodes whose graphs together hold every topic there can be."""
import os

import pytest
from graph import graph


@pytest.fixture(scope="session")
def whole_graph(tmp_path_factory):
    """(published, subscribed, answered) of a node with Odometry, and of one with everything else switched on."""
    folder, domain = tmp_path_factory.mktemp("graph"), os.getpid() * 7 % 90 + 100
    first = graph(folder, domain)
    second = graph(folder, domain + 1, input="pose_twist", full_scale=True, use_sim_time=True, scale=50.0)
    return {**first[0], **second[0]}, {**first[1], **second[1]}, first[2] | second[2]
