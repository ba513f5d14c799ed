"""Measurements of users: files of many formats into the bundle that calibration reads."""
