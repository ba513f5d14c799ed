"""Steps the gymnasium environment: its expert follows an instruction."""

import gymnasium

import dwell  # registers the environments

env = gymnasium.make("dwell/InstructionFollowing-v1", sensors=["rgb", "depth", "instruction"])
observation, info = env.reset(seed=7)
print(observation["instruction"])
print({name: getattr(value, "shape", "text") for name, value in observation.items()})

steps, total = 0, 0.0
terminated = truncated = False
while not (terminated or truncated):
    action = env.unwrapped.expert_action()
    observation, reward, terminated, truncated, info = env.step(action)
    steps, total = steps + 1, total + reward
    if info["action_error"]:
        print(f"step {steps}: {info['action_error']}")
print(f"{steps} steps, return {total:.2f}, success {info['success']}, spl {info['spl']:.2f}")
env.close()
print(f"dwell {dwell.__version__}")
