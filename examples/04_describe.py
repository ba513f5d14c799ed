"""Says what is in a house, in words that are checked against it, and asks for things in it."""

import json

import dwell

house = dwell.House.open("builtin:apartment")
print(house.describe("house")[0].splitlines()[0])
print(house.describe("room")[0])
caption = house.describe("object")[0]
for span in caption.spans:
    print(caption[span["start"] : span["end"]], span["ids"], span["rooms"])

graph = json.loads(house.describe("graph")[0])
print({name: len(rows) for name, rows in graph.items() if isinstance(rows, list)})

for line in house.describe("instructions", seed=1)[:3]:
    print(json.loads(line)["text"])

# A world is described as it stands now: something was taken away from where it lay.
world = dwell.World(house)
thing = next(thing for thing in world.objects() if thing["pickable"] and thing["on"])
before = set(world.describe("object"))
world.set_body(thing["name"], position=world.house.rooms()[0]["stand"])
for _ in range(40):
    world.step()
now = sorted(set(world.describe("object")) - before)[0]
print(f"{thing['name']} was moved; now it is said: {now}")
