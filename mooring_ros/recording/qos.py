"""Quality-of-service profiles as rosbag2 keeps them (YAML, metadata version 9)."""
from dataclasses import dataclass

import yaml

INFINITE = {'sec': 9223372036, 'nsec': 854775807}


@dataclass(frozen=True)
class Qos:
    """What a topic was offered with; a player publishes it so again."""

    depth: int = 10
    reliability: str = 'reliable'       # or 'best_effort'
    durability: str = 'volatile'        # or 'transient_local'


def profile(qos):
    """The mapping that rosbag2 writes for one profile."""
    return {'history': 'keep_last', 'depth': qos.depth, 'reliability': qos.reliability, 'durability': qos.durability,
            'deadline': dict(INFINITE), 'lifespan': dict(INFINITE), 'liveliness': 'automatic',
            'liveliness_lease_duration': dict(INFINITE), 'avoid_ros_namespace_conventions': False}


def profiles_text(qos):
    """`offered_qos_profiles` of a channel: a YAML list with one profile."""
    return yaml.safe_dump([profile(qos)], sort_keys=False)
