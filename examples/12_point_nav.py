"""Writes PointNav: go to a point that is told as distance and angle, and stop there."""

import gymnasium
import numpy as np

import dwell
from dwell.envs import DwellEnv


class PointNav(dwell.Task):
    """Observes where its goal is: distance, m, and angle, rad, positive to the left."""

    sensors = ("depth",)
    max_steps = 500

    def __init__(self, near_m=0.3):
        """Succeeds within ``near_m`` of its goal."""
        self.near_m = near_m
        low, high = np.float32([[0.0, -np.pi], [1000.0, np.pi]])
        self.spaces = {"goal": gymnasium.spaces.Box(low, high)}

    def reset(self, world, rng):
        places = world.house.navigation().points(world.agents()[0]["position"])
        self.state["goal"] = places[rng.integers(len(places))].tolist()
        self.state["left_m"] = self.way_m(world)
        return dwell.TaskGoal(distance_m=self.state["left_m"])

    def way_m(self, world):
        here = world.agents()[0]["position"]
        return world.house.navigation().distance(here, self.state["goal"])

    def observe(self, world, rng):
        agent = world.agents()[0]
        right, _, back = np.subtract(self.state["goal"], agent["position"])
        angle = np.arctan2(-right, -back) - agent["yaw_rad"]
        wrapped = np.arctan2(np.sin(angle), np.cos(angle))
        return {"goal": np.float32([np.hypot(right, back), wrapped])}

    def judge(self, world, action, verdict):
        before_m, left_m = self.state["left_m"], self.way_m(world)
        self.state["left_m"] = before_m if left_m is None else left_m
        success = verdict.terminated and self.state["left_m"] < self.near_m
        reward = before_m - self.state["left_m"] - 0.01 + 2.5 * success
        return dwell.StepResult(reward, verdict.terminated, success, self.state["left_m"])

    def expert(self, world):
        return world.toward(self.state["goal"]) or "stop"


env = DwellEnv(PointNav, houses="seed:0..3")
observation, info = env.reset(seed=1)
done, total = False, 0.0
while not done:
    observation, reward, done, _, info = env.step(env.expert_action())
    total += reward
distance_m, angle = observation["goal"]
print(
    f"success {info['success']}, spl {info['spl']:.2f}, reward {total:.2f}, {distance_m:.2f} m left"
)
