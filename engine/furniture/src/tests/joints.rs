//! Doors, drawers and lids.

use super::cases::{Case, every_draw};
use crate::model::ModelJoint;
use crate::shapes::axis_rotation;
use crate::testing::overlap::{ConvexPiece, max_depth};
use dwell_scene::{JointKind, Mobility, Pose};
use glam::Vec3;

/// Largest penetration of a moving part into its own body, m: seals and stops.
const TOLERANCE_M: f32 = 0.004;
/// Positions of a joint that are looked at.
const STEPS: usize = 8;

fn moved(joint: &ModelJoint, position: f32) -> Pose {
    let to_axis = Pose::from_position(joint.position);
    let motion = match joint.kind {
        JointKind::Hinge => Pose::new(Vec3::ZERO, axis_rotation(joint.axis, position)),
        JointKind::Slide => Pose::from_position(joint.axis * position),
    };
    to_axis * motion * to_axis.inverse()
}

#[test]
fn joints_move_parts_that_exist_and_open_from_zero() {
    every_draw(|case: &Case| {
        let mut faults = Vec::new();
        for joint in &case.model.joints {
            if joint.parent >= joint.child || joint.child >= case.model.parts.len() {
                faults.push(format!(
                    "{} joins {} to {}",
                    joint.name, joint.child, joint.parent
                ));
            }
            if joint.open <= 0.0 || (joint.axis.length() - 1.0).abs() > 1e-6 {
                faults.push(format!("{} opens by {}", joint.name, joint.open));
            }
        }
        // What stands loose may have a lid; its other parts all hang on it.
        let joints = case.model.joints.len();
        let fits = match case.model.mobility {
            Mobility::Fixed => joints == 0,
            Mobility::Articulated => joints > 0,
            Mobility::Movable => joints + 1 == case.model.parts.len(),
        };
        if !fits {
            faults.push(format!("{joints} joints of {:?}", case.model.mobility));
        }
        faults
    });
}

#[test]
fn everything_opens_without_meeting_its_own_body() {
    every_draw(|case: &Case| {
        let model = &case.model;
        let still = |part: usize| -> Vec<ConvexPiece> {
            let colliders = model.parts[part].colliders.iter();
            colliders
                .map(|c| ConvexPiece::new(c, &Pose::IDENTITY))
                .collect()
        };
        let mut faults = Vec::new();
        for joint in &model.joints {
            let others: Vec<ConvexPiece> = (0..model.parts.len())
                .filter(|part| *part != joint.child)
                .flat_map(still)
                .collect();
            for step in 0..=STEPS {
                let pose = moved(joint, joint.open * step as f32 / STEPS as f32);
                let colliders = model.parts[joint.child].colliders.iter();
                let pieces: Vec<ConvexPiece> =
                    colliders.map(|c| ConvexPiece::new(c, &pose)).collect();
                let into = max_depth(&pieces, &others, TOLERANCE_M);
                if into > TOLERANCE_M {
                    faults.push(format!(
                        "{} meets its body by {into} m at {step}/{STEPS}",
                        joint.name
                    ));
                    break;
                }
            }
        }
        faults
    });
}
