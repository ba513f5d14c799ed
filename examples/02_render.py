"""Renders colour, depth and ids from a good view of the kitchen."""

import dwell

house = dwell.House.open("builtin:apartment")
kitchen = next(room for room in house.rooms() if "kitchen" in room["kinds"])
world = dwell.World(house, agents=0)
images = world.render(
    position=kitchen["eye"],
    yaw_deg=kitchen["yaw_deg"],
    camera=dwell.Camera(160, 120, fov_deg=90.0),
    channels=["rgb", "depth", "instance"],
)
nearest = images["depth"].min()
things = {thing["id"]: thing["name"] for thing in world.objects()}
seen = sorted({things[i] for i in images["instance"].ravel().tolist() if i in things})
print(f"{images['rgb'].shape} pixels, nearest surface at {nearest:.2f} m")
print(f"{len(seen)} objects in view: {', '.join(seen[:8])}, ...")
