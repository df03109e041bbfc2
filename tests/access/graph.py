"""The topics and services of a running node, as another DDS library sees them."""
import contextlib
import os
import subprocess
import sys
import time
from pathlib import Path

import rosless

ROOT = Path(__file__).parents[2]
SCENE = ROOT / "config" / "scenes" / "oc4.txt"
START = 240.0       # s, cold compilation included


@contextlib.contextmanager
def running_node(folder, domain, **parameters):
    """A mooring node with these parameters (dots written as __), ended at exit."""
    given = {"scene": str(SCENE), **{name.replace("__", "."): value for name, value in parameters.items()}}
    arguments = [part for name, value in given.items() for part in ("-p", f"{name}:={str(value).lower() if isinstance(value, bool) else value}")]
    with open(folder / f"node_{domain}.log", "wb") as log:
        process = subprocess.Popen([sys.executable, "-m", "mooring_ros.node", "--ros-args", *arguments], cwd=folder, stdout=log, stderr=log,
                                   env={**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")]),
                                        "ROS_DOMAIN_ID": str(domain), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"})
    try:
        yield process
    finally:
        process.terminate()
        process.wait(20.0)


def graph(folder, domain, **parameters):
    """(published, subscribed, answered): topic -> type of a node that is active; the names of its services."""
    node = rosless.Node(domain=domain)
    with running_node(folder, domain, **parameters) as process:
        end = time.monotonic() + START
        while True:
            seen = node.graph()
            subscribed = {topic.name: topic.type_name for topic in seen.topics if topic.subscribers}
            if any(name.startswith("/platform") for name in subscribed):
                break
            assert process.poll() is None and time.monotonic() < end, (folder / f"node_{domain}.log").read_text(encoding="utf-8")
            time.sleep(0.1)
        time.sleep(0.7)     # what was made after the subscription
        seen = node.graph()
    return ({topic.name: topic.type_name for topic in seen.topics if topic.publishers},
            {topic.name: topic.type_name for topic in seen.topics if topic.subscribers},
            {topic.name.removesuffix("Request") for topic in seen.services if topic.name.endswith("Request") and topic.subscribers})
