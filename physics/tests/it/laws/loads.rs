//! Loads on a joint's gear besides weight: friction in proportion to them holds what would slip without.
//!
//! Under `K_c + K_l |m - e|` a joint without a motor's effort stays while `|e| <= K_c / (1 - K_l)`. Once only weight counted as e,
//! and everything else slipped beyond `K_c`.

use super::spec;
use crate::common::{Build, Piece, Run, gravity};
use dwell_physics::{JointState, PhysicsConfig};
use dwell_scene::{
    Joint, JointCommand, JointId, JointKind, LawSpec, Mobility, PartId, Pose, Servo, State,
};
use glam::Vec3;

const AT: Vec3 = Vec3::new(2.0, 2.0, 2.0);
const COULOMB: f64 = 0.05;
const LOAD: f64 = 0.5;

fn friction(joint: &str, coulomb: f64) -> Vec<LawSpec> {
    let numbers = [("coulomb", coulomb), ("load", LOAD)];
    vec![spec("joint_friction", Some(joint), &numbers)]
}

fn start(build: Build, laws: Vec<LawSpec>, gravity_m_s2: Option<f64>) -> Run {
    let house = build.house();
    let mut state = State::new(&house);
    if let Some(value) = gravity_m_s2 {
        let address = "world/gravity_m_s2".parse().unwrap();
        state.set_parameter(&house, &address, value).unwrap();
    }
    state.laws = laws;
    let config = PhysicsConfig {
        sleeping: false,
        ..PhysicsConfig::default()
    };
    Run::from_state(house, config, state)
}

/// On a table that turns with w a slider is driven out with m w^2 r.
#[test]
fn what_turning_asks_of_a_slider_loads_its_friction() {
    let (mass, radius) = (500.0 * 0.06_f64.powi(3), 0.1);
    for (outward, holds) in [(0.045, true), (0.09, true), (0.11, false)] {
        let mut build = Build::room([4.0, 4.0, 4.0]);
        let table = Piece::cuboid(Vec3::new(0.5, 0.02, 0.5), AT).density(20_000.0);
        let slider = Piece::cuboid(Vec3::splat(0.03), AT + Vec3::new(0.1, 0.3, 0.0));
        let object = build.object("table", Mobility::Articulated, &[table, slider]);
        let parts: Vec<PartId> = build.data.objects[object].parts().collect();
        build.data.joints.push(Joint {
            parent_from_joint: Pose::from_position(AT),
            ..Joint::new("turn", object, parts[0], JointKind::Hinge, Vec3::Y)
        });
        build.data.joints.push(Joint {
            parent: Some(parts[0]),
            parent_from_joint: Pose::from_position(Vec3::new(0.1, 0.3, 0.0)),
            ..Joint::new("slide", object, parts[1], JointKind::Slide, Vec3::X)
        });
        let mut run = start(build, friction("slide", COULOMB), None);
        let speed = (outward / (mass * radius)).sqrt();
        let set = JointState {
            joint: JointId(0),
            position: 0.0,
            velocity: speed as f32,
        };
        run.world.set_joints(&mut run.state, &[set]).unwrap();
        run.steps(20);
        let out = run.state.joint_position[JointId(1)];
        println!("{outward} N outward: {out} m");
        assert_eq!(out.abs() < 1e-5, holds, "{outward}: {out}");
        assert!(holds || out > 5e-3, "{outward}: {out}");
    }
}

/// A motor that drives a second slider with `u` pushes the first one back with `u`.
#[test]
fn what_another_joint_gives_loads_the_friction_of_the_one_that_bears_it() {
    for (effort, holds) in [
        (0.045_f32, true),
        (0.09, true),
        (-0.09, true),
        (0.11, false),
    ] {
        let mut build = Build::room([4.0, 4.0, 4.0]);
        let carrier = Piece::cuboid(Vec3::splat(0.05), AT);
        let slider = Piece::cuboid(Vec3::splat(0.05), AT + Vec3::Y * 0.3);
        let object = build.object("pair", Mobility::Articulated, &[carrier, slider]);
        let parts: Vec<PartId> = build.data.objects[object].parts().collect();
        build.data.joints.push(Joint {
            parent_from_joint: Pose::from_position(AT),
            ..Joint::new("lower", object, parts[0], JointKind::Slide, Vec3::X)
        });
        build.data.joints.push(Joint {
            parent: Some(parts[0]),
            parent_from_joint: Pose::from_position(Vec3::Y * 0.3),
            servo: Some(Servo {
                max_effort: 10.0,
                ..Servo::default()
            }),
            ..Joint::new("upper", object, parts[1], JointKind::Slide, Vec3::X)
        });
        let mut run = start(build, friction("lower", COULOMB), Some(0.0));
        run.state.joint_command[JointId(1)] = JointCommand::Effort(effort);
        run.steps(20);
        let back = run.state.joint_position[JointId(0)];
        let way = run.state.joint_position[JointId(1)] + back;
        println!("{effort} N: carrier {back} m, slider {way} m");
        assert_eq!(back.abs() < 1e-5, holds, "{effort}: {back}");
        // Slipping, the load is u and what it takes to carry the slider along: (m + m K_l) a = u (1 - K_l) - K_c.
        let slips = (f64::from(effort) * (1.0 - LOAD) - COULOMB) / (0.5 * (1.0 + LOAD)) * 0.5;
        let off = (f64::from(-back) / slips - 1.0).abs();
        assert!(holds || off < 0.05, "{effort}: {back} {slips}");
        // u t^2 / 2 m.
        let expected = effort / 0.5 * 0.5;
        assert!((way / expected - 1.0).abs() < 0.02, "{way} {expected}");
    }
}

/// A light lift under a heavy crate: the crate's weight comes through contact alone.
#[test]
fn what_lies_on_a_lift_loads_its_friction() {
    let weight = f64::from(gravity()) * (4.0 + 0.25);
    for (share, holds) in [(1.3, true), (0.9, false)] {
        let mut build = Build::room([4.0, 4.0, 4.0]);
        let lift = Piece::cuboid(Vec3::new(0.25, 0.01, 0.1), AT).density(125.0);
        let object = build.object("lift", Mobility::Articulated, &[lift]);
        let part = build.data.objects[object].first_part;
        build.data.joints.push(Joint {
            parent_from_joint: Pose::from_position(AT),
            ..Joint::new("rail", object, part, JointKind::Slide, Vec3::Y)
        });
        let crate_ = Piece::cuboid(Vec3::splat(0.1), AT + Vec3::Y * 0.1105);
        build.movable("crate", crate_);
        let coulomb = share * (1.0 - LOAD) * weight;
        let mut run = start(build, friction("rail", coulomb), None);
        run.steps(20);
        let from = run.state.joint_position[JointId(0)];
        run.steps(20);
        let sunk = run.state.joint_position[JointId(0)] - from;
        println!("{coulomb:.2} N of friction under {weight:.2} N: {sunk} m");
        // In the first second the crate came to rest on it. What only friction holds creeps by millimetres under a thing of
        // sixteen times its mass; slipping would take it a metre down.
        assert_eq!(sunk.abs() < 1e-2, holds, "{share}: {sunk}");
        assert!(holds || sunk < -0.1, "{share}: {sunk}");
    }
}
