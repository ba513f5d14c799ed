"""Gymnasium environments, registered as ``dwell/<Task>-v<version>``."""

from dwell.envs.recorder import ReplayRecorder, VectorReplayRecorder
from dwell.envs.registration import register_envs, register_task
from dwell.envs.single import DwellEnv
from dwell.envs.vector import DwellVectorEnv

__all__ = [
    "DwellEnv",
    "DwellVectorEnv",
    "ReplayRecorder",
    "VectorReplayRecorder",
    "register_envs",
    "register_task",
]

register_envs()
