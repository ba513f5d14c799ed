"""Builds a flat, furnishes it, adds a mesh of one's own and a voice, and changes it afterwards."""

import tempfile
from pathlib import Path

import dwell

FACES = "1 2 3 4/5 8 7 6/1 5 6 2/2 6 7 3/3 7 8 4/4 8 5 1"

flat = dwell.HouseBuilder("flat", style="nordic")
flat.room("living room", (0.0, 0.0, 5.0, 4.0), walls=("plaster", (226, 230, 222)))
flat.room("kitchen", (5.1, 0.0, 8.0, 4.0), floor="ceramic_tile")
flat.door("living room", "kitchen", leaf="none", width_m=1.2)
flat.door("living room", side="south", name="front door")
flat.window("living room", "north", width_m=2.0).window("kitchen", "east")
flat.add("sofa", (2.5, 0.0, 3.3), yaw_deg=180).add("coffee_table", (2.5, 0.0, 2.2), name="table")
flat.add_lamp((2.5, 2.6, 2.0), power_w=60)

with tempfile.TemporaryDirectory() as folder:
    # A mesh of one's own: a cube of 10 cm.
    corners = [(x, y, z) for y in (0, 1) for x, z in ((0, 0), (1, 0), (1, 1), (0, 1))]
    rows = [f"v {x} {y} {z}" for x, y, z in corners] + [f"f {face}" for face in FACES.split("/")]
    mesh = Path(folder, "cube.obj")
    mesh.write_text("\n".join(rows) + "\n")
    flat.add_file(mesh, on="table", name="cube", scale=0.1, mass_kg=0.4, substance="steel")
    house = flat.build()

for room in house.rooms():
    print(f"{room['name']}: {room['area_m2']:.2f} m2")

with house.edit() as edit:
    edit.move("table", by=(0.2, 0.0, -0.3))  # the cube comes along
    edit.re_material(room="living room", side="floor", substance="carpet", srgb=(120, 130, 150))
    edit.add_emitter("speech", (6.5, 1.5, 2.0), level_db=60, name="voice")
world = dwell.World(edit.house)
world.place_agent((4.0, 0.0, 2.0), -90.0)
for _ in range(10):
    world.step()
cube = next(thing for thing in world.objects() if thing["name"] == "cube")
print(f"the cube stands at {[round(x, 2) for x in cube['center']]}")
print(f"the voice is heard: {abs(world.listen(1600)).max():.4f} Pa at most")
