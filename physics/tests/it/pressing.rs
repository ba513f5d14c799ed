//! A robot that presses on itself.
//!
//! What a link carried of its own robot was once taken for ground under it, and only the other half of the pair was felt: a robot
//! that floated was driven down by pressing on itself.

use crate::arms::awake;
use crate::common::{Build, Piece, Run};
use dwell_scene::{Articulation, JointCommand, JointId, JointKind, Mobility, PartId, Pose, Servo};
use glam::{DVec3, Quat, Vec3};

const AT: Vec3 = Vec3::new(2.0, 2.0, 2.0);
/// Half edges of the three cubes, m.
const BODY: f32 = 0.1;
const SLIDE: f32 = 0.03;
const FINGER: f32 = 0.05;

/// A body that floats without weight; on it a slide that moves along `way`, and on that, by a hinge with a stiff motor, a finger
/// before the body's face.
fn grip(way: Vec3) -> Run {
    let mut build = Build::room([4.0, 4.0, 4.0]);
    let finger = BODY + FINGER + 0.02;
    let turned = Quat::from_rotation_arc(Vec3::X, way);
    let pieces = [(BODY, 0.0), (SLIDE, 0.4), (FINGER, finger)]
        .map(|(half, along)| Piece::cuboid(Vec3::splat(half), AT + way * along).turned(turned));
    let object = build.object("grip", Mobility::Movable, &pieces);
    let parts: Vec<PartId> = build.data.objects[object].parts().collect();
    let servo = Some(Servo {
        stiffness: 2000.0,
        damping: 60.0,
        max_effort: 500.0,
        ..Servo::default()
    });
    build.data.joints.push(Articulation {
        parent: Some(parts[0]),
        parent_from_joint: Pose::from_position(Vec3::X * 0.4),
        servo,
        ..Articulation::new("slide", object, parts[1], JointKind::Slide, Vec3::X)
    });
    build.data.joints.push(Articulation {
        parent: Some(parts[1]),
        parent_from_joint: Pose::from_position(Vec3::X * (finger - 0.4)),
        servo,
        ..Articulation::new("finger", object, parts[2], JointKind::Hinge, Vec3::Z)
    });
    let mut run = build.run_with(awake());
    assert!(run.report.passing.is_empty(), "{:?}", run.report.passing);
    let weightless = "world/gravity_m_s2".parse().unwrap();
    let house = run.house.clone();
    run.state.set_parameter(&house, &weightless, 0.0).unwrap();
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

/// Whichever way it presses, nothing outside pushes it: what the finger presses with comes back through the slide. For two
/// seconds of 30 N, which alone would move it by 12 m.
#[test]
fn a_robot_that_presses_on_itself_goes_nowhere() {
    let tilted = Vec3::new(0.6, 0.8, 0.0);
    for way in [Vec3::X, -Vec3::Z, Vec3::Y, -Vec3::Y, tilted, -tilted] {
        let mut run = grip(way);
        run.state.joint_command[JointId(0)] = JointCommand::Effort(-30.0);
        run.state.joint_command[JointId(1)] = JointCommand::Position(0.0);
        run.steps(5);
        let pressed = run.state.joint_position[JointId(0)];
        // The way that was between them.
        assert!((pressed + 0.02).abs() < 2e-3, "{way}: {pressed}");
        let mut worst = 0.0_f64;
        for _ in 0..40 {
            run.steps(1);
            worst = worst.max(momentum(&run).length());
            let [q, turned] = [0, 1].map(|k| run.state.joint_position[JointId(k)]);
            assert!((q - pressed).abs() < 5e-4, "{way}: {q} {pressed}");
            assert!(turned.abs() < 2e-2, "{way}: {turned}");
        }
        println!("{way}: {worst:.1e} kg m/s, pressed at {pressed}");
        // A thousandth of the 60 N s of one side.
        assert!(worst < 0.06, "{way}: {worst}");
    }
}
