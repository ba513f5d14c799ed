"""Writes a task, a reward and a sensor in Python, and plays them."""

import gymnasium
import numpy as np

import dwell
from dwell.envs import DwellEnv


class FindTheTelephone(dwell.Task):
    """Go to where a telephone rings, and stop there."""

    sensors = ("audio",)

    def reset(self, world, rng):
        places = world.house.navigation().points(world.agents()[0]["position"])
        x, y, z = self.state["goal"] = places[rng.integers(len(places))].tolist()
        world.play("phone", at=(x, y + 1.0, z), loop=True)
        return dwell.TaskGoal("Find it.", self.way_m(world))

    def way_m(self, world):
        here = world.agents()[0]["position"]
        return world.house.navigation().distance(here, self.state["goal"])

    def judge(self, world, action, verdict):
        left_m = self.way_m(world)
        is_there = action == "stop" and left_m < 1.0
        return dwell.StepResult(10.0 * is_there, action == "stop", is_there, left_m)

    def expert(self, world):
        return world.toward(self.state["goal"]) or "stop"


class Hurry(dwell.Reward):
    def reward(self, world, action, verdict):
        return verdict.reward - 0.01


class Loudness(dwell.Sensor):
    name = "loudness_db"
    space = gymnasium.spaces.Box(-200.0, 200.0, (2,), np.float32)

    def observe(self, world, rng):
        return 10.0 * np.log10((world.listen(1600) ** 2).mean(axis=1) / 4e-10 + 1e-20)


env = DwellEnv(FindTheTelephone, sensors=["audio", Loudness], reward=Hurry)
observation, info = env.reset(seed=2)
done = False
while not done:
    observation, reward, done, _, info = env.step(env.expert_action())
print(
    f"success {info['success']}, spl {info['spl']:.2f}, {observation['loudness_db']} dB at the end"
)
