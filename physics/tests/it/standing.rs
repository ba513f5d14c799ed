//! Robots with a free base: standing on a base, on legs, and in the air.

use crate::arms::{STRONG, arm_on, awake};
use crate::common::{Build, Piece, Run, gravity, pair};
use dwell_scene::{
    Collider, Joint, JointCommand, JointId, JointKind, Mobility, ObjectId, PartId, Pose, Servo,
    State,
};
use glam::Vec3;

/// Issue 3 for a robot that only stands: within 1e-3 rad for 10 s.
#[test]
fn a_robot_that_stands_on_its_base_holds_its_pose() {
    for pose in [
        [0.0_f32; 6],
        [0.5, 0.9, -1.2, 0.3, 0.4, 0.1],
        [1.2, 0.4, 0.5, -0.8, 0.9, -0.5],
    ] {
        let base = Piece::cuboid(Vec3::new(0.3, 0.15, 0.3), Vec3::new(2.0, 0.15, 2.0));
        let mut run = arm_on(Some(base.density(600.0)), 2.0, Some(STRONG)).run_with(awake());
        for (k, q) in pose.iter().enumerate() {
            run.state.joint_position[JointId(k as u32)] = *q;
            run.state.joint_command[JointId(k as u32)] = JointCommand::Position(*q);
        }
        run.world.adopt_state(&mut run.state).unwrap();
        let base = run.root(ObjectId(0));
        let mut worst = [0.0_f32; 6];
        let mut tilt: f32 = 0.0;
        for _ in 0..200 {
            run.steps(1);
            for (k, q) in pose.iter().enumerate() {
                let off = (run.state.joint_position[JointId(k as u32)] - q).abs();
                worst[k] = worst[k].max(off);
            }
            tilt = tilt.max((run.state.part_pose[base].rotation * Vec3::Y).x.abs());
        }
        println!("joints {worst:?} rad, base {tilt:.1e} rad");
        assert!(worst.iter().all(|off| *off < 1e-3), "{worst:?}");
    }
}

/// A body on four legs of aluminium, each of a thigh and a shank with a ball for a foot, and the pose in which it stands.
fn four_legs(servo: Servo) -> (Build, [f32; 8]) {
    let mut build = Build::room([4.0, 3.0, 4.0]);
    let (bone, foot, half) = (0.2_f32, 0.02_f32, 0.015_f32);
    let (hip, knee) = (0.6_f32, -1.1_f32);
    let height = bone * hip.cos() + bone * (hip + knee).cos() + foot;
    let trunk = Vec3::new(2.0, height, 2.0);
    let leg = Piece {
        collider: Collider::cuboid(Vec3::new(-half, -bone, -half), Vec3::new(half, 0.0, half)),
        ..Piece::cuboid(Vec3::ONE, trunk).density(2700.0)
    };
    // 13 kg in all.
    let mut pieces = vec![Piece::cuboid(Vec3::new(0.25, 0.05, 0.15), trunk).density(600.0)];
    pieces.extend(std::iter::repeat_n(leg, 8));
    let object = build.object("quadruped", Mobility::Movable, &pieces);
    let parts: Vec<PartId> = build.data.objects[object].parts().collect();
    let mut pose = [0.0; 8];
    for leg in 0..4 {
        let x = if leg % 2 == 0 { 0.2 } else { -0.2 };
        let z = if leg < 2 { 0.17 } else { -0.17 };
        let places = [(Vec3::new(x, 0.0, z), hip), (Vec3::NEG_Y * bone, knee)];
        for (joint, (at, angle)) in places.into_iter().enumerate() {
            let child = 1 + 2 * leg + joint;
            let parent = if joint == 0 { 0 } else { child - 1 };
            pose[child - 1] = angle;
            let name = format!("leg{leg}_{joint}");
            build.data.joints.push(Joint {
                parent: Some(parts[parent]),
                parent_from_joint: Pose::from_position(at),
                limits: Some([-2.0, 2.0]),
                initial: angle,
                servo: Some(servo),
                ..Joint::new(&name, object, parts[child], JointKind::Hinge, Vec3::Z)
            });
        }
        let shank = &mut build.data.parts[parts[2 + 2 * leg]];
        shank.colliders.push(Collider::Ball {
            center: Vec3::NEG_Y * bone,
            radius: foot,
        });
    }
    (build, pose)
}

/// The same for one whose legs carry it. Its motors compensate the weight on them; feet sink a tenth of a millimetre into
/// the floor when they are loaded, which bends the knees for as long as the motors need to respond.
#[test]
fn a_robot_that_stands_on_its_legs_holds_its_pose() {
    let (build, pose) = four_legs(STRONG);
    let mut run = build.run_with(awake());
    assert!(run.report.passing.is_empty(), "{:?}", run.report.passing);
    for (k, q) in pose.iter().enumerate() {
        run.state.joint_position[JointId(k as u32)] = *q;
        run.state.joint_command[JointId(k as u32)] = JointCommand::Position(*q);
    }
    run.world.adopt_state(&mut run.state).unwrap();
    let trunk = run.root(ObjectId(0));
    let from = run.state.part_pose[trunk];
    let (mut worst, mut at_last) = (0.0_f32, 0.0_f32);
    for step in 0..200 {
        run.steps(1);
        for (k, q) in pose.iter().enumerate() {
            let off = (run.state.joint_position[JointId(k as u32)] - q).abs();
            worst = worst.max(off);
            if step >= 40 {
                at_last = at_last.max(off);
            }
        }
    }
    let now = run.state.part_pose[trunk];
    let sunk = from.position - now.position;
    println!("worst {worst:.1e} rad, after 2 s {at_last:.1e} rad; moved by {sunk:?}");
    assert!(worst < 1e-3, "{worst}");
    assert!(at_last < 1e-4, "{at_last}");
    assert!(sunk.length() < 1e-3 && now.rotation.dot(from.rotation).abs() > 1.0 - 1e-6);
}

/// Motors inside a falling robot do not change its fall: its centre of mass gains g t and nothing aside. Landed, it comes
/// to rest on its legs.
#[test]
fn a_falling_robot_falls_as_a_stone_and_comes_to_rest() {
    let (mut build, pose) = four_legs(STRONG);
    let parts: Vec<PartId> = build.data.objects[ObjectId(0)].parts().collect();
    build.data.parts[parts[0]].world_from_part.position.y += 0.8;
    let mut run = build.run_with(awake());
    let (bar, ball) = (2700.0 * 0.03 * 0.03 * 0.2_f32, 2700.0 * 33.510e-6);
    // Mass of each part, and how far below its origin its centre is.
    let lumps: Vec<(f32, f32)> = (0..9)
        .map(|k| match k {
            0 => (9.0, 0.0),
            k if k % 2 == 1 => (bar, 0.1),
            _ => (bar + ball, (bar * 0.1 + ball * 0.2) / (bar + ball)),
        })
        .collect();
    let total: f32 = lumps.iter().map(|(mass, _)| mass).sum();
    let moves = |state: &State| -> Vec3 {
        let each = parts.iter().zip(&lumps).map(|(part, (mass, below))| {
            let velocity = state.part_velocity[*part];
            let arm = state.part_pose[*part].rotation * Vec3::NEG_Y * *below;
            (velocity.linear + velocity.angular.cross(arm)) * *mass
        });
        each.sum::<Vec3>() / total
    };
    for step in 1..=7 {
        for (k, q) in pose.iter().enumerate() {
            let aside = if (k + step) % 3 == 0 { 0.5 } else { -0.2 };
            run.state.joint_command[JointId(k as u32)] = JointCommand::Position(q + aside);
        }
        run.steps(1);
        let expected = Vec3::NEG_Y * gravity() * step as f32 * 0.05;
        let found = moves(&run.state);
        assert!((found - expected).length() < 2e-3, "{step}: {found}");
    }
    for (k, q) in pose.iter().enumerate() {
        run.state.joint_command[JointId(k as u32)] = JointCommand::Position(*q);
    }
    run.steps(120);
    let off = pose.iter().enumerate().map(|(k, q)| {
        let id = JointId(k as u32);
        (run.state.joint_position[id] - q).abs()
    });
    let off = off.fold(0.0, f32::max);
    let speed = run
        .state
        .joint_velocity
        .iter()
        .fold(0.0_f32, |m, v| m.max(v.abs()));
    let trunk = run.state.part_pose[parts[0]];
    println!(
        "landed at {:?}, joints off by {off:.1e} rad, {speed:.1e} rad/s",
        trunk.position
    );
    assert!(trunk.position.y > 0.3 && (trunk.rotation * Vec3::Y).y > 0.99);
    // Feet that landed apart push against each other as far as they do not slip: friction under a foot over the hip's
    // height, against the motor's stiffness. Not every foot carries a quarter.
    let slips = 1.5 * pair("wood", "parquet").0 * total * gravity() / 4.0 * 0.35 / STRONG.stiffness;
    assert!(off < slips && speed < 5e-3, "{off} {slips} {speed}");
}

/// A snapshot at any moment, in the air, landing and on its feet, continues with the same bits.
#[test]
fn a_robot_on_legs_continues_bit_for_bit_from_a_snapshot() {
    let (mut build, pose) = four_legs(STRONG);
    let trunk = build.data.objects[ObjectId(0)].first_part;
    build.data.parts[trunk].world_from_part.position.y += 0.1;
    let house = build.house();
    let mut run = Run::over(house.clone(), awake());
    let tell = |state: &mut State, step: usize| {
        for (k, q) in pose.iter().enumerate() {
            let aside = 0.1 * ((step + k) % 3) as f32;
            state.joint_command[JointId(k as u32)] = JointCommand::Position(q + aside);
        }
    };
    for step in 0..30 {
        if [2, 4, 20].contains(&step) {
            let (state, bytes) = (run.state.clone(), run.world.snapshot());
            let mut other = Run::over(house.clone(), awake());
            other.state = state;
            other.world.restore(&mut other.state, &bytes).unwrap();
            let mut there = run.clone();
            for later in step..step + 8 {
                tell(&mut there.state, later);
                there.steps(1);
                tell(&mut other.state, later);
                other.steps(1);
                assert!(there.hash() == other.hash(), "{step} {later}");
            }
        }
        tell(&mut run.state, step);
        run.steps(1);
    }
}
