"""Loads a house and reads what is in it: built in, from a seed, or from a file."""

import sys

import dwell

house = dwell.House.open(sys.argv[1] if len(sys.argv) > 1 else "builtin:apartment")
info = house.info()
print(f"{house.name}: {len(info['rooms'])} rooms, {info['objects']} objects")
for room in info["rooms"]:
    print(f"  {room['kinds'][0]}: {room['area_m2']:.1f} m2, {room['objects']} objects")
print(f"reported while reading: {info['report']['warnings'] or 'nothing'}")

# As many furnished houses as anyone wants, each from its number.
studio = dwell.House.open("seed:7?home=studio")
print(f"{studio.name}: {studio.info()['objects']} objects")
