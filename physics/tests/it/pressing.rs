//! A robot that presses on itself.
//!
//! Regression: contacts between links of one robot were once taken for ground, and of such a pair only the half that pushes
//! down was felt. A motor that pressed on its own body from above then computed that nothing stopped it.

use crate::arms::awake;
use crate::common::{Build, Piece, Run};
use dwell_scene::{Joint, JointCommand, JointId, JointKind, Mobility, PartId, Pose, Servo};
use glam::{DVec3, Quat, Vec3};

const AT: Vec3 = Vec3::new(2.0, 2.0, 2.0);
/// Half edges of the three cubes, m.
const BODY: f32 = 0.1;
const SLIDE: f32 = 0.03;
const FINGER: f32 = 0.05;
/// Between body and finger at the start, m.
const GAP: f32 = 0.02;
const STIFFNESS_N_M: f32 = 2000.0;
const PRESS_N: f32 = 30.0;
const FRICTION: f32 = 0.5;

/// A body that floats without weight; on it a slide along `way`, and on that a finger before the body's face, which slides along the
/// face.
fn grip(way: Vec3) -> Run {
    let mut build = Build::room([4.0, 4.0, 4.0]);
    let finger = BODY + FINGER + GAP;
    let turned = Quat::from_rotation_arc(Vec3::X, way);
    let pieces = [(BODY, 0.0), (SLIDE, 0.4), (FINGER, finger)]
        .map(|(half, along)| Piece::cuboid(Vec3::splat(half), AT + way * along).turned(turned));
    let object = build.object("grip", Mobility::Movable, &pieces);
    let parts: Vec<PartId> = build.data.objects[object].parts().collect();
    let servo = Some(Servo {
        stiffness: STIFFNESS_N_M,
        damping: 60.0,
        max_effort: 500.0,
        ..Servo::default()
    });
    for (k, (name, at, axis)) in [("press", 0.4, Vec3::X), ("aside", finger - 0.4, Vec3::Z)]
        .into_iter()
        .enumerate()
    {
        build.data.joints.push(Joint {
            parent: Some(parts[k]),
            parent_from_joint: Pose::from_position(Vec3::X * at),
            servo,
            ..Joint::new(name, object, parts[k + 1], JointKind::Slide, axis)
        });
    }
    let mut run = build.run_with(awake());
    assert!(run.report.passing.is_empty(), "{:?}", run.report.passing);
    let house = run.house.clone();
    for (address, value) in [
        ("world/gravity_m_s2", 0.0),
        ("pair/wood~wood/friction", FRICTION),
    ] {
        let address = address.parse().unwrap();
        run.state
            .set_parameter(&house, &address, value.into())
            .unwrap();
    }
    run.world.apply_parameters(&mut run.state).unwrap();
    run
}

/// Linear momentum of the cubes, whose origins are their middles, kg·m/s.
fn momentum(run: &Run) -> DVec3 {
    let object = run.house.object_named("grip").unwrap();
    let halves = [BODY, SLIDE, FINGER];
    let own = run.house.objects[object].parts().zip(halves);
    own.map(|(part, half)| {
        let mass = 500.0 * f64::from(2.0 * half).powi(3);
        run.state.part_velocity[part].linear.as_dvec3() * mass
    })
    .sum()
}

/// Whichever way it presses, a motor commanded 15 mm into the body presses with its stiffness times that: friction holds
/// the finger against 0.85 of `mu F` and lets it slip at 1.15. And nothing pushes the robot: the finger's force returns
/// through the slide.
#[test]
fn a_robot_presses_on_itself_as_hard_any_way_and_goes_nowhere() {
    let tilted = Vec3::new(0.6, 0.8, 0.0);
    for way in [Vec3::X, -Vec3::Z, Vec3::Y, -Vec3::Y, tilted, -tilted] {
        let mut run = grip(way);
        let [press, aside] = [JointId(0), JointId(1)];
        let told = -GAP - PRESS_N / STIFFNESS_N_M;
        run.state.joint_command[press] = JointCommand::Position(told);
        run.state.joint_command[aside] = JointCommand::Effort(0.0);
        run.steps(20);
        let pressed = run.state.joint_position[press];
        assert!((pressed + GAP).abs() < 1e-3, "{way}: {pressed}");
        let from = run.state.joint_position[aside];
        run.state.joint_command[aside] = JointCommand::Effort(0.85 * FRICTION * PRESS_N);
        let mut worst = 0.0_f64;
        for _ in 0..20 {
            run.steps(1);
            worst = worst.max(momentum(&run).length());
        }
        let held = run.state.joint_position[aside] - from;
        run.state.joint_command[aside] = JointCommand::Effort(1.15 * FRICTION * PRESS_N);
        run.steps(3);
        let slipped = run.state.joint_position[aside] - from - held;
        println!("{way}: {worst:.1e} kg m/s, held {held:.1e} m, slipped {slipped:.1e} m");
        // A thousandth of the 30 N s of one side.
        assert!(worst < 0.03, "{way}: {worst}");
        // A sticking finger creeps a little at first; a free one goes four metres.
        assert!(held.abs() < 0.01, "{way}: {held}");
        // 2 N at 0.5 kg for 0.15 s, and what had crept.
        assert!(slipped > 0.04, "{way}: {slipped}");
    }
}
