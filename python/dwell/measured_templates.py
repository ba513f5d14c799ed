"""What maps of ``dwell measure import`` look like, for each kind of measurement."""

from __future__ import annotations

from typing import Any

CsvRow = dict[str, Any]

#: What ``--init`` prints. Keys that do not apply are left out; ``null`` is "not known". Times in
#: milliseconds have ``seconds_per_unit`` 0.001, lengths in millimetres ``metres_per_unit`` 0.001,
#: angles in degrees ``radians_per_unit`` 0.017453292519943295.
TEMPLATE: CsvRow = {
    "kind": "pose_trajectory",
    "title": "what was measured, in a line",
    "licence": "of the data",
    "notes": "",
    "up": "z",
    "g_m_s2": None,
    "body": {
        "name": "cube",
        "mass_kg": 0.37,
        "half_extents_m": [0.0524, 0.0524, 0.0524],
        "inertia_kg_m2": None,
    },
    "board": {"friction": 0.18, "restitution": 0.125},
    "poses": {"rate_hz": 148.0, "angular_velocity": "body", "filtering": ""},
    "table": {
        "file": "data.parquet",
        "episode": "toss",
        "split_group": None,
        "t_s": "t_s",
        "seconds_per_unit": 1.0,
        "metres_per_unit": 1.0,
        "radians_per_unit": 1.0,
        "position": ["px", "py", "pz"],
        "quaternion_xyzw": ["qx", "qy", "qz", "qw"],
        "velocity": ["vx", "vy", "vz"],
        "angular_velocity": ["wx", "wy", "wz"],
    },
    "starts": {
        "file": "index.csv",
        "episode": "toss",
        "sample": "eval_start_k",
        "velocity": ["ic_vx", "ic_vy", "ic_vz"],
        "angular_velocity": ["ic_wx", "ic_wy", "ic_wz"],
    },
}
#: The same for flights of balls, one height or all three coordinates.
FLIGHT: CsvRow = {
    "kind": "trajectory",
    "title": "what was measured, in a line",
    "licence": "of the data",
    "notes": "",
    "g_m_s2": None,
    "bodies": {
        "file": "index.csv",
        "episode": "episode",
        "name": "ball",
        "mass_kg": "mass_kg",
        "diameter_m": "diameter_m",
    },
    "table": {
        "file": "data.parquet",
        "episode": "episode",
        "split_group": None,
        "t_s": "t_s",
        "seconds_per_unit": 1.0,
        "metres_per_unit": 1.0,
        "channels": {"y": "height_m"},
    },
}

#: The same for drives of a robot on two wheels; the ticks are counts since the sample before.
DRIVE: CsvRow = {
    "kind": "drive",
    "title": "what was measured, in a line",
    "licence": "of the data",
    "notes": "",
    "base": {
        "wheel_radius_m": 0.042,
        "wheel_base_m": 0.2,
        "rate_hz": 20.0,
        "ticks_per_turn": 2796.8,
    },
    "episodes": {
        "file": "index.csv",
        "episode": "episode",
        "split_group": "set",
        "conditions": "path",
    },
    "table": {
        "file": "data.parquet",
        "episode": "episode",
        "t_s": "t_s",
        "seconds_per_unit": 1.0,
        "metres_per_unit": 1.0,
        "radians_per_unit": 1.0,
        "position": ["x", "y"],
        "heading_rad": "theta",
        "ticks_left": "ticks_left",
        "ticks_right": "ticks_right",
    },
}

#: The template of each kind.
TEMPLATES: dict[str, CsvRow] = {"pose_trajectory": TEMPLATE, "trajectory": FLIGHT, "drive": DRIVE}
