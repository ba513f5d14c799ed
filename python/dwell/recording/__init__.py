"""Worlds as recordings for the Rerun viewer: what ``dwell view`` and the demo show there."""

from dwell.recording.contents import record_agents, record_episode, record_house, record_replay
from dwell.recording.viewer import Recording, sdk

__all__ = ["Recording", "record_agents", "record_episode", "record_house", "record_replay", "sdk"]
