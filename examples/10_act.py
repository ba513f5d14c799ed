"""Walks, looks, tries to take something, and is told why it failed."""

import dwell

world = dwell.World("builtin:apartment")
hallway = next(room for room in world.house.rooms() if "hallway" in room["kinds"])
world.place_agent(hallway["stand"], hallway["yaw_deg"])
for _ in range(5):
    world.do("move_forward")
closed = next(thing for thing in world.objects() if thing["openness"] == 0.0)
outcome = world.act("open", closed["name"])
print(outcome.success, outcome.code, outcome.sentence)
print(f"state {world.state_hash():016x} after {world.time_s:.2f} s")
