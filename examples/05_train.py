"""Steps the gymnasium environment with its expert, then four of them at once."""

import gymnasium

import dwell  # registers the environments

env = gymnasium.make("dwell/InstructionFollowing-v0", sensors=["rgb", "instruction"])
observation, info = env.reset(seed=7)
print(observation["instruction"])
terminated = truncated = False
while not (terminated or truncated):
    action = env.unwrapped.expert_action()
    observation, reward, terminated, truncated, info = env.step(action)
print(f"success {info['success']}, spl {info['spl']:.2f}")
env.close()

batch = gymnasium.make_vec("dwell/InstructionFollowing-v0", num_envs=4, sensors=["rgb"])
observation, _ = batch.reset(seed=0)
for _ in range(3):
    observation, reward, *_ = batch.step(batch.action_space.sample())
print(observation["rgb"].shape, reward.round(3).tolist(), dwell.__version__)
batch.close()
