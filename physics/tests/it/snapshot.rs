//! Snapshots: they continue bit for bit, hold no mesh, and damage is refused.

use crate::common::{Build, Piece, Run, forward};
use dwell_physics::{Action, AgentControl, PhysicsConfig, PhysicsModel, PhysicsWorld};
use dwell_scene::{AgentId, LawSpec, ObjectId, State};
use glam::{Quat, Vec3};
use std::sync::Arc;

/// A room with a heap, a door, two agents, one of which holds something.
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
    run.state.laws.push(LawSpec {
        id: "drag".into(),
        version: 1,
        target: Some("ball_2".into()),
        params: [("c_d".to_owned(), 0.5)].into(),
    });
    run.world.apply_parameters(&mut run.state).unwrap();
    let agent = run.agent(Vec3::new(2.6, 0.0, 4.4), 0.0);
    run.agent(Vec3::new(1.0, 0.0, 4.0), 1.0);
    run.steps(5);
    let told = run.act(agent, Action::pick(mug));
    assert!(told.success, "{}", told.sentence);
    let told = run.act(agent, Action::open(door));
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
        // Into a world that has gone another way meanwhile.
        let mut other = run.clone();
        other.walk(30, &[forward(2.0)]);
        other.state = State::from_bytes(&run.house, &state).unwrap();
        other.world.restore(&mut other.state, &physics).unwrap();
        assert!(
            other.world.snapshot() == physics,
            "a restored world has the snapshot it came from"
        );
        // Into a world that was just made.
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
            assert!(
                run.world.snapshot() == other.world.snapshot(),
                "layout after {step} steps"
            );
            assert!(
                run.world.snapshot() == fresh.world.snapshot(),
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
    let mut key = dwell_scene::random::Key::root(3).stream();
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
            PhysicsWorld::over(model.clone(), &PhysicsConfig::default(), state)
                .unwrap()
                .0
        })
        .collect();
    assert!(Arc::ptr_eq(worlds[0].model(), worlds[1].model()));
}
