//! Snapshots: they continue bit for bit, hold no mesh, and damage is refused.

use crate::common::{Build, Piece, Run, forward};
use dwell_physics::{AgentControl, PhysicsConfig, PhysicsModel, PhysicsWorld, actions};
use dwell_scene::{AgentId, LawSpec, ObjectId, State};
use glam::{Quat, Vec3};
use std::sync::Arc;

/// A room with a heap, a door, two agents, one of which holds an object.
fn busy() -> (Run, ObjectId, AgentId) {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let (door, _) = build.wall_with_door(3.0, 6.0);
    for k in 0..24 {
        let at = Vec3::new(
            3.6 + 0.21 * (k % 4) as f32,
            0.3 + 0.22 * (k / 4) as f32,
            4.2 + 0.2 * (k % 3) as f32,
        );
        let turn = Quat::from_rotation_y(0.3 * k as f32);
        build.movable(
            &format!("block_{k}"),
            Piece::cuboid(Vec3::new(0.09, 0.06, 0.08), at).turned(turn),
        );
    }
    for k in 0..6 {
        let at = Vec3::new(1.0 + 0.3 * k as f32, 1.0 + 0.1 * k as f32, 5.0);
        build.movable(&format!("ball_{k}"), Piece::ball(0.1, at).of("rubber"));
    }
    let mug = build.movable(
        "mug",
        Piece::cuboid(Vec3::splat(0.04), Vec3::new(2.6, 0.04, 3.9)),
    );
    let mut run = build.run();
    let drag = LawSpec::new("drag", 1, &[("c_d", 0.5)]);
    run.state.laws.push(drag.with_target("ball_2"));
    run.world.apply_parameters(&mut run.state).unwrap();
    let agent = run.agent(Vec3::new(2.6, 0.0, 4.4), 0.0);
    run.agent(Vec3::new(1.0, 0.0, 4.0), 1.0);
    run.steps(5);
    let told = run.act(agent, actions::Pick::new(mug));
    assert!(told.success, "{}", told.sentence);
    let told = run.act(agent, actions::Open::new(door));
    assert!(told.success, "{}", told.sentence);
    (run, door, agent)
}

fn controls(step: usize) -> [AgentControl; 2] {
    [
        AgentControl {
            forward_m_s: 0.6,
            yaw_rate_rad_s: if step % 40 < 20 { 0.7 } else { -0.9 },
            ..AgentControl::default()
        },
        AgentControl {
            forward_m_s: 1.0,
            yaw_rate_rad_s: -0.5,
            ..AgentControl::default()
        },
    ]
}

#[test]
fn a_restored_world_continues_bit_for_bit_over_200_steps() {
    for before in [0, 7, 60] {
        let (mut run, ..) = busy();
        for step in 0..before {
            run.walk(1, &controls(step));
        }
        let physics = run.world.snapshot();
        let state = run.state.to_bytes(&run.house);
        // Into a world that has meanwhile diverged.
        let mut other = run.clone();
        other.walk(30, &[forward(2.0)]);
        other.state = State::from_bytes(&run.house, &state).unwrap();
        other.world.restore(&mut other.state, &physics).unwrap();
        assert!(
            other.world.snapshot() == physics,
            "a restored world has the snapshot it came from"
        );
        // Into a new world.
        let mut fresh = Run::over(run.house.clone(), PhysicsConfig::default());
        fresh.state = State::from_bytes(&run.house, &state).unwrap();
        fresh.world.restore(&mut fresh.state, &physics).unwrap();
        run.events.clear();
        for step in 0..200 {
            for world in [&mut run, &mut other, &mut fresh] {
                world.walk(1, &controls(before + step));
            }
            assert!(
                run.state == other.state && run.state == fresh.state,
                "state after {step} steps"
            );
            // The hash is of all that a snapshot holds.
            assert!(
                run.world.hash() == other.world.hash(),
                "layout after {step} steps"
            );
            assert!(
                run.world.hash() == fresh.world.hash(),
                "fresh layout after {step} steps"
            );
        }
        assert!(run.events.len() > 3);
        let told: Vec<_> = other
            .events
            .iter()
            .rev()
            .take(run.events.len())
            .rev()
            .collect();
        assert!(run.events.iter().eq(told), "the same events");
    }
}

#[test]
fn the_same_calls_give_the_same_bits_on_any_thread() {
    let play = || {
        let (mut run, ..) = busy();
        for step in 0..120 {
            run.walk(1, &controls(step));
        }
        (run.hash(), run.events)
    };
    let here = play();
    let there: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..2).map(|_| scope.spawn(play)).collect();
        threads
            .into_iter()
            .map(|thread| thread.join().unwrap())
            .collect()
    });
    for other in there {
        assert!(here == other);
    }
}

/// A clone is a fork: it continues alike and leaves the original alone.
#[test]
fn a_clone_continues_alike() {
    let (mut run, ..) = busy();
    run.walk(20, &controls(0));
    let mut fork = run.clone();
    for step in 0..60 {
        run.walk(1, &controls(step));
    }
    for step in 0..60 {
        fork.walk(1, &controls(step));
    }
    assert!(run.hash() == fork.hash());
}

#[test]
fn damaged_and_foreign_bytes_are_refused_and_nothing_changes() {
    let (mut run, ..) = busy();
    run.walk(10, &controls(0));
    let bytes = run.world.snapshot();
    let before = run.hash();
    let mut key = dwell_scene::random::RandomKey::root(3).stream();
    for _ in 0..200 {
        let mut damaged = bytes.clone();
        let at = key.below(damaged.len());
        damaged[at] ^= 1 << key.below(8);
        assert!(run.world.restore(&mut run.state, &damaged).is_err());
    }
    for length in [0, 3, 20, 32, 33, bytes.len() / 2, bytes.len() - 1] {
        assert!(run.world.restore(&mut run.state, &bytes[..length]).is_err());
    }
    let mut later = run.state.clone();
    let root = run
        .house
        .objects
        .ids()
        .last()
        .map(|id| run.root(id))
        .unwrap();
    later.part_pose[root].position.x += 1e-3;
    let message = run
        .world
        .restore(&mut later, &bytes)
        .unwrap_err()
        .to_string();
    assert!(message.contains("another moment"), "{message}");
    let mut foreign = Build::room([4.0, 3.0, 4.0]).run();
    let message = foreign
        .world
        .restore(&mut foreign.state, &bytes)
        .unwrap_err()
        .to_string();
    assert!(message.contains("house"), "{message}");
    assert!(before == run.hash());
}

/// Names and counts are the same; one has another size, one another mass.
#[test]
fn a_snapshot_of_a_house_with_other_bodies_is_foreign() {
    let run = |half: f32, substance: &'static str| {
        let mut build = Build::room([4.0, 3.0, 4.0]);
        let piece = Piece::cuboid(Vec3::splat(half), Vec3::new(2.0, 1.0, 2.0));
        build.movable("block", piece.of(substance));
        build.run()
    };
    let bytes = run(0.1, "oak").world.snapshot();
    let mut same = run(0.1, "oak");
    same.world.restore(&mut same.state, &bytes).unwrap();
    for (side, substance) in [(0.11, "oak"), (0.1, "steel")] {
        let mut other = run(side, substance);
        let refused = other.world.restore(&mut other.state, &bytes);
        let message = refused.unwrap_err().to_string();
        assert!(message.contains("another house"), "{message}");
    }
}

/// The house has a mesh of 200,000 triangles; the snapshot stays far smaller than its vertices.
#[test]
fn a_snapshot_holds_no_mesh() {
    let mut build = Build::room([4.0, 3.0, 4.0]);
    let cells = 316_u32;
    let mesh = {
        let mut mesh = dwell_scene::Mesh::default();
        for k in 0..(cells + 1) * (cells + 1) {
            let (i, j) = (k % (cells + 1), k / (cells + 1));
            mesh.positions.push(Vec3::new(
                i as f32 / cells as f32,
                0.2,
                j as f32 / cells as f32,
            ));
        }
        for i in 0..cells {
            for j in 0..cells {
                let a = j * (cells + 1) + i;
                mesh.triangles.push([a, a + cells + 1, a + 1]);
                mesh.triangles.push([a + 1, a + cells + 1, a + cells + 2]);
            }
        }
        mesh
    };
    let size = mesh.positions.len() * 12;
    let cloth = build.fixed(
        "cloth",
        Piece::cuboid(Vec3::splat(0.5), Vec3::new(1.0, 0.2, 1.0)),
    );
    let part = build.data.objects[cloth].first_part;
    build.data.parts[part].mesh = build.data.meshes.push(Arc::new(mesh));
    build.data.parts[part].colliders = vec![dwell_scene::Collider::ExactMesh];
    build.movable("ball", Piece::ball(0.02, Vec3::new(1.5, 0.3, 1.5)));
    let mut run = build.run();
    run.steps(20);
    let bytes = run.world.snapshot();
    assert!(
        bytes.len() < size / 20,
        "{} bytes of snapshot, {size} of vertices",
        bytes.len()
    );
}

#[test]
fn worlds_over_one_model_share_its_shapes() {
    let house = Build::room([4.0, 3.0, 4.0]).house();
    let model = Arc::new(PhysicsModel::new(house.clone()));
    let mut states = [State::new(&house), State::new(&house)];
    let worlds: Vec<_> = states
        .iter_mut()
        .map(|state| {
            PhysicsWorld::with_model(model.clone(), &PhysicsConfig::default(), state)
                .unwrap()
                .0
        })
        .collect();
    assert!(Arc::ptr_eq(worlds[0].model(), worlds[1].model()));
}

/// A snapshot with its state: at most 256 KiB and 2 KiB a body, for a furnished house, an arm of six links, and 500 things that
/// lie on a heap.
#[test]
fn snapshots_stay_within_their_size() {
    let size = |run: &Run| run.world.snapshot().len() + run.state.to_bytes(&run.house).len();
    let bound = |bodies: usize| (256 + 2 * bodies) * 1024;
    let (house, _) = dwell_houses::open("builtin:apartment").unwrap();
    let mut apartment = Run::over(Arc::new(house), PhysicsConfig::default());
    apartment.steps(20);
    let mut build = Build::room([6.0, 4.0, 6.0]);
    for k in 0..500_u16 {
        let (x, y, z) = (k % 8, k / 64, k / 8 % 8);
        let at = Vec3::new(f32::from(x), f32::from(y), f32::from(z)) * 0.13;
        let piece = Piece::cuboid(Vec3::splat(0.05), at + Vec3::new(2.5, 0.1, 2.5));
        build.movable(&format!("cube_{k}"), piece);
    }
    let mut heap = build.run();
    heap.steps(100);
    let mut build = Build::room([4.0, 3.0, 4.0]);
    let at = |k: u8| Vec3::new(1.0 + 0.2 * f32::from(k), 1.0, 2.0);
    let links: Vec<Piece> = (0..6)
        .map(|k| Piece::cuboid(Vec3::new(0.08, 0.03, 0.03), at(k)))
        .collect();
    let arm = build.object("arm", dwell_scene::Mobility::Movable, &links);
    let parts: Vec<_> = build.data.objects[arm].parts().collect();
    for (k, part) in parts.iter().enumerate() {
        let parent = k.checked_sub(1).map(|before| parts[before]);
        let from = parent.map_or(dwell_scene::Pose::from_position(at(0)), |_| {
            dwell_scene::Pose::from_position(Vec3::X * 0.1)
        });
        let to = Vec3::NEG_X * if k == 0 { 0.0 } else { 0.1 };
        let kind = dwell_scene::JointKind::Hinge;
        build.data.joints.push(dwell_scene::Joint {
            parent,
            parent_from_joint: from,
            child_from_joint: dwell_scene::Pose::from_position(to),
            ..dwell_scene::Joint::new(&format!("j{k}"), arm, *part, kind, Vec3::Z)
        });
    }
    let mut arm = build.run();
    arm.steps(20);
    for (name, run) in [("apartment", &apartment), ("heap", &heap), ("arm", &arm)] {
        let mut again = run.clone();
        again
            .world
            .restore(&mut again.state, &run.world.snapshot())
            .unwrap();
        assert!(
            again.hash() == run.hash(),
            "{name}: packed and unpacked it is the same"
        );
        let (found, bodies) = (size(run), run.report.bodies);
        println!(
            "  {name}: {bodies} bodies, {found} bytes of {}",
            bound(bodies)
        );
        assert!(
            bodies > 5 && found <= bound(bodies),
            "{name}: {found} bytes"
        );
    }
}

/// A flipped bit is found wherever it is: every byte of the header, and of the body every one that a stride of a prime meets.
#[test]
fn a_flipped_bit_is_found_wherever_it_is() {
    let (mut run, ..) = busy();
    run.walk(10, &controls(0));
    let bytes = run.world.snapshot();
    let before = run.hash();
    let header = 0..32_usize.min(bytes.len());
    let body = (32..bytes.len()).step_by(97);
    let mut damaged = bytes.clone();
    for at in header.chain(body) {
        for bit in [0, 3, 7] {
            damaged[at] ^= 1 << bit;
            let refused = run.world.restore(&mut run.state, &damaged).unwrap_err();
            let why = refused.to_string();
            let named = ["begin with", "version", "house", "settings", "check sum"];
            assert!(
                named.iter().any(|word| why.contains(word)),
                "byte {at}: {why}"
            );
            damaged[at] ^= 1 << bit;
        }
    }
    // Longer and shorter than it was written.
    damaged.push(0);
    assert!(run.world.restore(&mut run.state, &damaged).is_err());
    assert!(before == run.hash());
    run.world.restore(&mut run.state, &bytes).unwrap();
    assert!(before == run.hash());
}

/// Taken while one hand holds by a spring, another firmly, a door swings, some bodies sleep and others fall: it goes on alike.
#[test]
fn holds_swings_and_sleep_go_on_bit_for_bit() {
    let (mut run, _, agent) = busy();
    let other = AgentId(1);
    let held = run
        .house
        .objects
        .ids()
        .find(|id| run.house.objects[*id].name == "ball_0")
        .unwrap();
    run.walk(30, &[]);
    run.act(agent, actions::Drop {});
    let beside = run.position(held);
    let Run { world, state, .. } = &mut run;
    world
        .place_agent(state, other, beside.with_y(0.0) + Vec3::Z * 0.6, 0.0)
        .unwrap();
    run.rays.update(&run.state);
    let spring = dwell_physics::Grasp::Spring {
        frequency_hz: 4.0,
        damping_ratio: 0.7,
    };
    let told = run.act(
        other,
        actions::Pick {
            target: held.into(),
            grasp: spring,
        },
    );
    assert!(told.success, "{}", told.sentence);
    let asleep = run.world.awake_count() < run.report.bodies;
    assert!(asleep, "{} awake", run.world.awake_count());
    for step in 0..6 {
        run.walk(1, &controls(step));
        let (physics, state) = (run.world.snapshot(), run.state.to_bytes(&run.house));
        let mut fresh = Run::over(run.house.clone(), PhysicsConfig::default());
        fresh.state = State::from_bytes(&run.house, &state).unwrap();
        fresh.world.restore(&mut fresh.state, &physics).unwrap();
        let mut original = run.clone();
        for later in 0..40 {
            original.walk(1, &controls(later));
            fresh.walk(1, &controls(later));
            assert!(
                original.hash() == fresh.hash(),
                "{step}, {later} steps later"
            );
            assert_eq!(original.world.awake_count(), fresh.world.awake_count());
        }
    }
}
