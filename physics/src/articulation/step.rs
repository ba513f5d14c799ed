//! The joints of a world in one physics step: efforts before it, and positions after it.

use super::WorldJoints;
use crate::dynamics::Dynamics;
use crate::joints::{
    self, ExternalWrench, JointLoad, JointResistance, JointStepInputs, LinkState, TreePrediction,
};
use dwell_scene::JointId;

/// The predicted motion of all kinematic trees in a physics step.
pub(crate) struct JointStepPrediction {
    /// `None` for a tree that is asleep or latched. Shape (tree,).
    predictions: Vec<Option<TreePrediction>>,
    /// Free bodies that are roots of trees and react to their joints.
    pub(crate) floating_roots: Vec<u32>,
}

impl WorldJoints {
    /// Passes the joints' positions to resistance laws.
    pub(crate) fn update_resistance_laws(&self, dynamics: &mut Dynamics) {
        if dynamics.laws.resistances.is_empty() {
            return;
        }
        for (joint, joint_coordinates) in self.joints.iter().zip(&self.joint_coordinates) {
            let position =
                joints::coordinates_at_step_start(&dynamics.engine, joint, *joint_coordinates)
                    .position as f32;
            for law in &mut dynamics.laws.resistances {
                law.effect.update_position(joint.id, position);
            }
        }
    }

    /// Gives rapier the efforts along all joints for the next physics step.
    pub(crate) fn apply_efforts(&self, dynamics: &mut Dynamics) -> JointStepPrediction {
        let engine = &mut dynamics.engine;
        for joint in &self.joints {
            joints::clear_efforts(engine, joint);
        }
        let laws = &dynamics.laws;
        let resist = |joint: JointId, load: &JointLoad, resistance: &mut JointResistance| {
            for law in &laws.resistances {
                law.effect.modify_resistance(joint, load, resistance);
            }
        };
        let dt_s = dynamics.settings.dt_s;
        let time_s = dynamics.tick as f64 * f64::from(dt_s);
        let push = |link: LinkState| {
            let link = LinkState { time_s, ..link };
            let pushes = laws.links.iter().map(|law| law.wrench(&link));
            pushes.fold(ExternalWrench::default(), ExternalWrench::sum)
        };
        let (pushing, resisting) = (!laws.links.is_empty(), !laws.resistances.is_empty());
        let drivers = JointStepInputs {
            joints: &self.joints,
            actuations: &self.actuations,
            joint_coordinates: &self.joint_coordinates,
            resistance_fn: if resisting { Some(&resist) } else { None },
            wrench_fn: if pushing { Some(&push) } else { None },
            dt_s,
        };
        let trees = self.trees.iter();
        let predictions = trees
            .map(|tree| joints::apply_efforts(engine, tree, &drivers))
            .collect();
        let trees = self.trees.iter();
        let floating_roots = trees
            .filter_map(|tree| tree.floating_root(engine, &self.joints))
            .collect();
        JointStepPrediction {
            predictions,
            floating_roots,
        }
    }

    /// Moves trees to their predicted positions after a physics step. Returns whether one was moved.
    pub(crate) fn correct_positions(
        &mut self,
        dynamics: &mut Dynamics,
        step: JointStepPrediction,
    ) -> bool {
        let (engine, coordinates) = (&mut dynamics.engine, &mut self.joint_coordinates);
        let mut placed = false;
        for (tree, prediction) in self.trees.iter().zip(step.predictions) {
            placed |= match prediction {
                Some(prediction) => joints::correct_tree_positions(
                    engine,
                    tree,
                    &self.joints,
                    prediction,
                    coordinates,
                ),
                None => joints::project_woken(engine, tree, &self.joints, coordinates),
            };
        }
        placed
    }
}
