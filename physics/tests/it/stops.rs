//! Stops of joints hold, whatever hangs on them.

use crate::arms::awake;
use crate::common::{Build, Piece, Run, gravity};
use dwell_physics::PhysicsConfig;
use dwell_scene::{Collider, Joint, JointKind, Mobility, PartId, Pose};
use glam::Vec3;

/// Two bars of 0.3 m in a row along +X that swing about Z, between stops.
fn bars(masses_kg: [f32; 2], limits: [[f32; 2]; 2], start: [f32; 2]) -> Run {
    let mut build = Build::room([4.0, 4.0, 4.0]);
    let at = Vec3::new(2.0, 2.5, 2.0);
    let bar = |k: f32| Piece {
        collider: Collider::cuboid(Vec3::new(0.0, -0.02, -0.02), Vec3::new(0.3, 0.02, 0.02)),
        ..Piece::cuboid(Vec3::ONE, at + Vec3::X * (0.3 * k))
    };
    let object = build.object("bars", Mobility::Articulated, &[bar(0.0), bar(1.0)]);
    let parts: Vec<PartId> = build.data.objects[object].parts().collect();
    for k in 0..2 {
        build.data.parts[parts[k]].mass_kg = Some(masses_kg[k]);
        let place = if k == 0 { at } else { Vec3::X * 0.3 };
        build.data.joints.push(Joint {
            parent: (k == 1).then(|| parts[0]),
            parent_from_joint: Pose::from_position(place),
            limits: Some(limits[k]),
            initial: start[k],
            ..Joint::new(
                &format!("j{k}"),
                object,
                parts[k],
                JointKind::Hinge,
                Vec3::Z,
            )
        });
    }
    build.run_with(PhysicsConfig {
        control_rate_hz: 120.0,
        ..awake()
    })
}

/// Kinetic energy and that of height, J.
fn energy_j(run: &Run) -> f64 {
    let parts = run.house.parts.iter_ids();
    let height = parts.filter_map(|(id, part)| {
        let middle = run.state.part_pose[id].transform_point(Vec3::X * 0.15);
        Some(f64::from(part.mass_kg? * gravity() * middle.y))
    });
    run.world.kinetic_energy_j() + height.sum::<f64>()
}

/// Two passive bars swing into their stops, the lighter one carrying up to a hundred times its mass and the other way round:
/// no stop is passed by more than 1e-4 rad in any of 600 physics steps, and none gives energy back.
#[test]
fn no_stop_is_passed_whatever_it_carries() {
    let half_turn = [-2.0, 2.0];
    for (limits, start) in [
        ([half_turn, half_turn], [0.0, 0.0]),
        ([[-0.5, 2.0], half_turn], [0.5, 0.0]),
        ([[-2.5, 2.5], [-0.3, 0.3]], [0.5, 0.0]),
        ([half_turn, half_turn], [2.0, 2.0]),
        ([[-4.0, 2.0], [-4.0, 4.0]], [2.0, 2.0]),
    ] {
        for masses_kg in [
            [1.0, 1.0],
            [0.1, 1.0],
            [0.1, 3.0],
            [0.1, 10.0],
            [1.0, 0.1],
            [10.0, 0.1],
        ] {
            let mut run = bars(masses_kg, limits, start);
            let from = energy_j(&run);
            let (mut passed, mut gained) = (0.0_f32, 0.0_f64);
            for _ in 0..600 {
                run.steps(1);
                for (limits, q) in limits.iter().zip(run.state.joint_position.iter()) {
                    passed = passed.max(limits[0] - q).max(q - limits[1]);
                }
                gained = gained.max(energy_j(&run) - from);
            }
            println!(
                "{masses_kg:?} kg, {limits:?}: passed by {passed:.1e} rad, gained {gained:.1e} J"
            );
            assert!(passed < 1e-4, "{masses_kg:?} {limits:?}: {passed} rad");
            assert!(
                gained < 1e-3 * f64::from(masses_kg[0] + masses_kg[1]),
                "{gained} J"
            );
        }
    }
}
