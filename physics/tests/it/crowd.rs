//! Many things at once.

use crate::common::{Build, Piece, gravity};
use dwell_scene::random::RandomKey;
use glam::{Quat, Vec3};

/// 500 random things fall into a room: every number stays finite, nothing leaves, and the heap comes to rest.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn five_hundred_random_things_stay_finite_and_inside() {
    let mut build = Build::room([8.0, 12.0, 8.0]);
    let mut random = RandomKey::root(11).stream();
    let substances = [
        "wood",
        "steel",
        "rubber",
        "porcelain",
        "books",
        "plastic",
        "textile",
        "cast_iron",
        "oak",
    ];
    let things: Vec<_> = (0..500)
        .map(|k| {
            let at = Vec3::new(
                1.0 + 6.0 * random.uniform_f32(),
                0.4 + 11.0 * random.uniform_f32(),
                1.0 + 6.0 * random.uniform_f32(),
            );
            let half = Vec3::new(
                random.range(0.02, 0.2),
                random.range(0.02, 0.2),
                random.range(0.02, 0.2),
            );
            let piece = if k % 3 == 0 {
                Piece::ball(half.x, at)
            } else {
                Piece::cuboid(half, at)
            };
            let turn = Quat::from_axis_angle(random.direction(), random.range(0.0, 3.0));
            let substance = random.choose(&substances).unwrap();
            build.movable(
                &format!("thing_{k}"),
                piece
                    .of(substance)
                    .density(random.range(50.0, 4000.0))
                    .turned(turn),
            )
        })
        .collect();
    let mut run = build.run();
    let fell: f64 = things
        .iter()
        .map(|id| {
            let part = &run.house.parts[run.root(*id)];
            let mass = part.density_kg_m3 * part.colliders[0].volume_m3().unwrap();
            f64::from(mass * gravity() * run.position(*id).y)
        })
        .sum();
    let mut fastest = 0.0_f32;
    for _ in 0..120 {
        run.steps(1);
        fastest = fastest.max(run.world.max_speed_m_s());
        for id in &things {
            let pose = run.state.part_pose[run.root(*id)];
            let p = pose.position;
            assert!(pose.is_valid() && run.velocity(*id).is_finite());
            let inside = p.x > -0.01
                && p.x < 8.01
                && p.z > -0.01
                && p.z < 8.01
                && p.y > -0.01
                && p.y < 12.01;
            assert!(inside, "{id:?} at {p}");
        }
    }
    // A fall of 12 m ends at 15 m/s; what something heavy hits flies off at up to 1 + e times that, or spins.
    assert!(fastest < 45.0, "{fastest} m/s");
    // All that is left after 6 s are balls that spin on the spot, where nothing resists.
    let left = things
        .iter()
        .map(|id| run.velocity(*id).length())
        .fold(0.0, f32::max);
    let energy = run.world.kinetic_energy_j();
    println!("  {left} m/s, {energy} of {fell} J");
    assert!(left < 1.0, "{left} m/s");
    assert!(energy < 2e-4 * fell, "{energy} of {fell} J");
}
