"""The whole thing once: an agent sees, touches, hears and talks in a house; a page tells of it."""

from dwell.demo.run import run

__all__ = ["run"]
