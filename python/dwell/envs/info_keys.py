"""The keys of infos."""

#: Keys of a step's answer that become ``info``; those of :data:`GOAL_KEYS` are NaN without a goal.
INFO_KEYS = (
    "success",
    "action_success",
    "collision",
    "distance_to_goal",
    "spl",
    "soft_spl",
    "path_length",
    "collisions",
)

#: What there is only where a task has a goal to go to.
GOAL_KEYS = ("distance_to_goal", "spl", "soft_spl")

#: What stays the same in an episode; what it asks for is there only where the task of the engine
#: has a goal, and ``goal_class`` where that goal is of a class.
EPISODE_KEYS = (
    "scene_id",
    "episode_id",
    "goal_kind",
    "goal_class",
    "goal_objects",
    "goal_rooms",
    "start_distance_to_goal",
)
