"""Gymnasium environments, registered as ``dwell/<Task>-v<version>``."""

from dwell.envs.registration import register_envs
from dwell.envs.single import DwellEnv
from dwell.envs.vector import DwellVectorEnv

__all__ = ["DwellEnv", "DwellVectorEnv", "register_envs"]

register_envs()
