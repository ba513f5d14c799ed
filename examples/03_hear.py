"""Computes an impulse response in the living room and its measures."""

import dwell

house = dwell.House.open("builtin:apartment")
room = next(room for room in house.rooms() if "living room" in room["kinds"])
x, y, z = room["eye"]
scene = dwell.AcousticScene(house, rays=500)
response = scene.impulse_response((x, y, z), (x + 0.6, y, z - 0.6), ears=True)
print(f"{response.shape[0]} ears, {response.shape[1] / scene.rate_hz:.2f} s")
for band in scene.metrics((x, y, z), (x + 0.6, y, z - 0.6))[1:5]:
    print({key: value for key, value in band.items() if value is not None})
