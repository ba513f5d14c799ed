"""Opens a house and reads what is in it."""

import dwell

house = dwell.House.open("builtin:apartment")
info = house.info()
print(f"{house.name}: {len(info['rooms'])} rooms, {info['objects']} objects")
for room in info["rooms"]:
    print(f"  {room['kinds'][0]}: {room['area_m2']:.1f} m2, {room['objects']} objects")
print(house.describe("room")[1])
