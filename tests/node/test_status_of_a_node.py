"""`mooring status` beside a real node."""
import json
import os
import subprocess
import sys

from node_peer import node_and_peer


def test_the_command_tells_of_a_running_node(tmp_path):
    with node_and_peer(tmp_path) as (_, peer):
        peer.wait_for_node()
        for k in range(20):
            peer.ask(1.0 + 0.05 * k, 0.01 * k, 0.2)
        done = subprocess.run([sys.executable, "-m", "mooring_ros.offline", "status", "--json"], capture_output=True, text=True, timeout=60,
                              env={**os.environ, "ROS_DOMAIN_ID": str(peer.node.context.get_domain_id())})
    assert done.returncode == 0, done.stderr
    picture = json.loads(done.stdout)
    assert picture["node"] == "/mooring" and picture["statuses"]["state"]["values"]["state"] == "RUN"
    assert {"state", "input", "core", "timing", "accuracy", "recording"} <= set(picture["statuses"])
    assert picture["statuses"]["input"]["values"]["accepted"] == "20"
