"""Steps many environments at once, and writes descriptions of many houses."""

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import gymnasium

import dwell  # registers the environments

COUNT = 8
batch = gymnasium.make_vec(
    "dwell/InstructionFollowing-v1",
    num_envs=COUNT,
    houses="seed:0..1?home=studio",
    sensors={"rgb": {"width": 64, "height": 64}, "instruction_tokens": {}},
)
observation, _ = batch.reset(seed=0)
start = time.perf_counter()
for _ in range(25):
    # The arrays are the environments' own: what must outlive the next step is copied.
    observation, reward, terminated, truncated, info = batch.step(batch.action_space.sample())
rate = 25 * COUNT / (time.perf_counter() - start)
print({name: value.shape for name, value in observation.items()}, f"{rate:.0f} steps/s")
batch.close()

# Bulk jobs are commands: they show progress, write atomically, and go on where they stopped.
with tempfile.TemporaryDirectory() as folder:
    out = Path(folder, "rooms.jsonl")
    command = [sys.executable, "-m", "dwell", "describe", "seed:0..2?home=studio"]
    subprocess.run([*command, "--level", "room", "--out", out], check=True)
    rows = [json.loads(line) for line in out.read_text("utf-8").splitlines()]
print(f"{len(rows)} descriptions by dwell {dwell.__version__}; the first has {sorted(rows[0])}")
