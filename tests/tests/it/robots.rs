//! A robot in a house: its motors move it, eyes see it where kinematics say, words and snapshots know it.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use dwell::{Engines, World, WorldConfig};
use dwell_houses::with_robot;
use dwell_render::{Camera, Frame, ImageChannels, View};
use dwell_scene::parallel::Threads;
use dwell_scene::{House, JointCommand, JointId, Pose, ShoeboxMaterials, space};
use glam::{DQuat, DVec3, Vec3};
use std::f32::consts::FRAC_PI_2;
use std::sync::Arc;

const BASE: Vec3 = Vec3::new(2.0, 0.0, 2.0);

fn world() -> World {
    let room = House::shoebox([4.0, 3.0, 4.0], &ShoeboxMaterials::default()).unwrap();
    let house = with_robot(
        &room,
        &dwell_tests::arm(),
        "arm",
        Pose::from_position(BASE),
        true,
    )
    .unwrap();
    World::new(Engines::new(Arc::new(house)), &WorldConfig::default()).unwrap()
}

fn joint(world: &World, name: &str) -> JointId {
    let joints = world.house().joints.iter_ids();
    joints
        .filter(|(_, joint)| joint.name == name)
        .map(|(id, _)| id)
        .next()
        .unwrap()
}

/// Independent kinematics: a point of the fore arm's frame in the room.
fn on_fore(turn: f32, elbow: f32, point: DVec3) -> Vec3 {
    let p = DVec3::new(0.0, 0.0, 0.1)
        + DQuat::from_rotation_z(turn.into())
            * (DVec3::new(0.0, 0.0, 0.3) + DQuat::from_rotation_y(elbow.into()) * point);
    // Forward +X is -Z, left +Y is -X, up +Z is +Y.
    BASE + DVec3::new(-p.y, p.z, -p.x).as_vec3()
}

#[test]
fn eyes_see_the_links_where_kinematics_say() {
    let mut world = world();
    let arm = world.house().object_named("arm").unwrap();
    let id = world.house().entity_of_object(arm).0;
    let camera = Camera::orthographic(400, 400, 2.0, 2.0).unwrap();
    let eye = Pose::new(
        Vec3::new(2.0, 2.5, 2.0),
        space::rotation_from_yaw_pitch(0.0, -FRAC_PI_2),
    );
    for (turn, elbow) in [(0.0, 0.0), (0.8, 0.3), (-1.9, -0.4)] {
        for (name, value) in [("turn", turn), ("elbow", elbow)] {
            let command = JointCommand::Position(value);
            world.command_joint(joint(&world, name), command).unwrap();
        }
        for _ in 0..80 {
            world.step(&[]).unwrap();
        }
        let mut frame = Frame::new(&camera, ImageChannels::ALL);
        let renderer = world.engines().cpu_renderer().unwrap();
        let (views, mut frames) = ([View::new(camera, eye)], [frame.as_mut()]);
        renderer
            .render(
                world.rays(),
                world.state(),
                &views,
                &mut frames,
                Threads::default(),
            )
            .unwrap();
        let pixel = |point: Vec3| {
            let (at, depth) = camera
                .project(eye.inverse().transform_point(point))
                .unwrap();
            (at.y as usize * 400 + at.x as usize, depth)
        };
        // The upper side of the fore arm, near its elbow and near its hand.
        for along in [0.06, 0.15] {
            let (k, depth) = pixel(on_fore(turn, elbow, DVec3::new(along, 0.0, 0.025)));
            assert_eq!(frame.instance[k], id, "{turn} {elbow} {along}");
            // A pixel is 5 mm wide; the steepest arm here falls 0.42 times that.
            assert!(
                (frame.depth[k] - depth).abs() < 4e-3,
                "{} {depth}",
                frame.depth[k]
            );
        }
        // Beside it and beyond its fingers is the floor.
        for (along, aside) in [(0.4, 0.0), (0.12, 0.12), (0.12, -0.12)] {
            let (k, _) = pixel(on_fore(turn, elbow, DVec3::new(along, aside, 0.0)));
            assert_ne!(frame.instance[k], id, "{turn} {elbow} {along} {aside}");
        }
    }
}

/// The gripper closes: one finger is driven, the other follows.
#[test]
fn both_fingers_close_together() {
    let mut world = world();
    let (left, right) = (joint(&world, "left_slide"), joint(&world, "right_slide"));
    world
        .command_joint(left, JointCommand::Position(0.02))
        .unwrap();
    for _ in 0..40 {
        world.step(&[]).unwrap();
    }
    let q = &world.state().joint_position;
    assert!(
        (q[left] - 0.02).abs() < 1e-3 && (q[right] - q[left]).abs() < 5e-4,
        "{} {}",
        q[left],
        q[right]
    );
    let refused = world
        .command_joint(right, JointCommand::Position(0.0))
        .unwrap_err();
    assert!(refused.to_string().contains("follows"), "{refused}");
}

/// An impossible command or joint position is refused with its reason, and changes nothing.
#[test]
fn wrong_commands_and_poses_of_joints_are_refused() {
    let mut world = world();
    let (left, turn) = (joint(&world, "left_slide"), joint(&world, "turn"));
    let before = world.hash();
    let nan = f32::NAN;
    for (id, command, part) in [
        (JointId(99), JointCommand::Off, "no joint 99; there are"),
        (left, JointCommand::Effort(nan), "no finite number"),
        (turn, JointCommand::Position(nan), "no finite number"),
        (
            turn,
            JointCommand::Velocity(f32::INFINITY),
            "no finite number",
        ),
    ] {
        let refused = world.command_joint(id, command).unwrap_err().to_string();
        assert!(refused.contains(part), "{refused}");
    }
    for (joints, part) in [
        (vec![(JointId(99), 0.0, 0.0)], "no joint 99; there are"),
        (
            vec![(turn, 0.1, 0.0), (JointId(99), 0.0, 0.0)],
            "no joint 99",
        ),
        (vec![(turn, nan, 0.0)], "finite numbers"),
        (vec![(turn, 0.0, f32::INFINITY)], "finite numbers"),
    ] {
        let refused = world.set_joints(&joints).unwrap_err().to_string();
        assert!(refused.contains(part), "{refused}");
    }
    assert_eq!(world.hash(), before);
}

/// A door has no motor: a hand takes it to positions, and knows neither velocities nor efforts.
#[test]
fn a_door_takes_positions_only() {
    let mut world = World::new(dwell_tests::apartment(), &WorldConfig::default()).unwrap();
    let lid = joint(&world, "lid");
    for command in [JointCommand::Velocity(1.0), JointCommand::Effort(1.0)] {
        let refused = world.command_joint(lid, command).unwrap_err().to_string();
        assert!(refused.contains("no motor"), "{refused}");
    }
    let open = world.house().joints[lid].open;
    world
        .command_joint(lid, JointCommand::Position(open))
        .unwrap();
    for _ in 0..100 {
        world.step(&[]).unwrap();
    }
    let stands = world.state().joint_position[lid];
    assert!((stands - open).abs() < 0.05, "{stands} of {open}");
}

/// Set at rest with motors that hold the pose, the robot of a file stays within 1e-3 rad for 10 s; and a fork from a snapshot
/// gives the same bits, with a parameter changed on the way.
#[test]
fn a_robot_of_a_file_holds_its_pose_and_forks_alike() {
    let mut world = world();
    let (turn, elbow) = (joint(&world, "turn"), joint(&world, "elbow"));
    world
        .set_joints(&[(turn, 0.5, 0.0), (elbow, 0.7, 0.0)])
        .unwrap();
    assert_eq!(world.state().joint_position[elbow], 0.7);
    for (id, value) in [(turn, 0.5), (elbow, 0.7)] {
        world
            .command_joint(id, JointCommand::Position(value))
            .unwrap();
    }
    for _ in 0..200 {
        world.step(&[]).unwrap();
        let q = &world.state().joint_position;
        assert!(
            (q[turn] - 0.5).abs() < 1e-3 && (q[elbow] - 0.7).abs() < 1e-3,
            "{} {}",
            q[turn],
            q[elbow]
        );
    }
    world
        .set_parameter(&"joint/arm/elbow/length_m".parse().unwrap(), 0.35)
        .unwrap();
    let saved = world.snapshot();
    let go_on = |world: &mut World| {
        world
            .command_joint(elbow, JointCommand::Velocity(-0.5))
            .unwrap();
        for _ in 0..20 {
            world.step(&[]).unwrap();
        }
        world.hash()
    };
    let first = go_on(&mut world);
    world.restore(&saved).unwrap();
    assert_eq!(go_on(&mut world), first);
}
