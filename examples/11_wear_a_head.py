"""Two heads hear one hiss; give a SOFA file to hear with a measured one."""

import sys

import dwell
from dwell import measures

heads = {"adult": dwell.Head.spherical(0.0875), "child": dwell.Head.spherical(0.07)}
if len(sys.argv) > 1:
    heads["measured"] = dwell.Head.from_sofa(sys.argv[1])
    print(heads["measured"].summary)

room = dwell.House.shoebox((6.0, 3.0, 5.0), absorption=0.6)
scene = dwell.AcousticScene(room, rate_hz=48_000, rays=1000)
hiss, place = (1.2, 1.2, 2.6), (4.6, 1.2, 3.3)
for name, head in heads.items():
    # Facing -Z: what hisses is on the left.
    found = measures.binaural_metrics(scene.impulse_response(hiss, place, head=head), scene.rate_hz)
    print(f"{name}: {1e6 * found['itd_s']:.0f} us earlier and {found['ild_db']:.1f} dB louder left")

world = dwell.World(room, sound_head=heads["child"])
world.place_agent((4.6, 0.0, 3.3))
world.listen(16_000)  # from now on ears keep a second
world.play("white", at=hiss, loop=True)
for _ in range(20):
    world.step()
left, right = (float((ear**2).mean()) ** 0.5 for ear in world.listen(16_000))
print(f"the child hears {left:.4f} Pa left, {right:.4f} Pa right")
