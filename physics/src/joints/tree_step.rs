//! The joints of a tree that may move, before and after a step.

use super::chain::FreeJointChain;
use super::joint_state::{JointKinematics, JointReading};
use super::tree::KinematicTree;
use super::{PhysicsJoint, child_at};
use crate::engine::RapierWorld;

/// Speed below which a body or a joint counts as still, m/s and rad/s: a tenth of a millimetre in the half second after
/// which rapier lets it sleep.
const REST_SPEED: f32 = 2e-4;
/// Largest distance of a joint from a stop on which it lies, rad or m.
const STOP_TOLERANCE: f64 = 1e-4;
/// Largest distance of a body in place from where its joint puts it, m and rad.
const PLACE_TOLERANCE: f32 = 2e-5;

/// A tree in a step: made before it, and reused after it.
#[derive(Clone, Debug)]
pub(crate) struct TreeStep {
    /// The joints that may move, by their indices in the tree. Shape (freedom,).
    pub(super) free: Vec<usize>,
    /// Shape (freedom,).
    pub(super) readings: Vec<JointReading>,
    pub(super) chain: FreeJointChain,
}

impl TreeStep {
    /// `joint_coordinates`: the coordinates of each of the world's joints. Returns `None` for a tree that is asleep or latched.
    pub(super) fn of(
        engine: &RapierWorld,
        tree: &KinematicTree,
        joints: &[PhysicsJoint],
        joint_coordinates: &[JointKinematics],
    ) -> Option<Self> {
        let moves = |k: &usize| {
            let child = joints[tree.joints[*k]].child_handle;
            let body = engine.bodies.get(child);
            body.is_some_and(|body| body.is_dynamic() && !body.is_sleeping())
        };
        let free: Vec<usize> = (0..tree.joints.len()).filter(moves).collect();
        if free.is_empty() {
            return None;
        }
        let read = |k: &usize| {
            let place = tree.joints[*k];
            JointReading::at_step_start(engine, &joints[place], joint_coordinates[place])
        };
        Some(Self {
            readings: free.iter().map(read).collect(),
            chain: FreeJointChain::of(engine, tree, &free, joints),
            free,
        })
    }

    /// Reads the joints again, after the step. Returns their state before.
    pub(super) fn update_readings(
        &mut self,
        engine: &RapierWorld,
        tree: &KinematicTree,
        joints: &[PhysicsJoint],
    ) -> Vec<JointReading> {
        let pairs = self.free.iter().zip(&self.readings);
        let now = pairs.map(|(k, reading)| reading.at_step_end(engine, &joints[tree.joints[*k]]));
        let now: Vec<JointReading> = now.collect();
        std::mem::replace(&mut self.readings, now)
    }

    /// Returns whether nothing of a tree moves and its bodies are at their joints' positions. It is then left to rapier,
    /// which lets it sleep: setting a pose, however near, keeps a body awake. `before`: the joints before the step.
    ///
    /// What joints did in the step counts, not their velocities, and at a stop not even that: a lid that lies on its stop is
    /// pressed into it by what forces and contacts do not cancel in a step, and is put back by the next one.
    pub(super) fn is_at_rest(
        &self,
        engine: &RapierWorld,
        tree: &KinematicTree,
        joints: &[PhysicsJoint],
        before: &[JointReading],
    ) -> bool {
        let most = f64::from(REST_SPEED * engine.step_s());
        let moves = |((joint, before), now): ((&&PhysicsJoint, &JointReading), &JointReading)| {
            let lies_on = |stop: f64| {
                let off = (now.position - stop)
                    .abs()
                    .max((before.position - stop).abs());
                off < STOP_TOLERANCE
            };
            (now.position - before.position).abs() > most && !joint.stops().into_iter().any(lies_on)
        };
        let free = self.joints(tree, joints);
        let still = |handle| {
            let body = engine.bodies.get(handle);
            body.is_none_or(|body| {
                body.linvel().length() < REST_SPEED && body.angvel().length() < REST_SPEED
            })
        };
        let stands = |(joint, now): (&&PhysicsJoint, &JointReading)| {
            let Some(body) = engine.bodies.get(joint.child_handle) else {
                return true;
            };
            let (place, says) = (
                body.position(),
                child_at(engine, joint, now.position as f32),
            );
            let off = (place.translation - says.translation).length();
            let turn = (place.rotation.inverse() * says.rotation).xyz().length();
            off < PLACE_TOLERANCE && turn < PLACE_TOLERANCE
        };
        let mut pairs = free.iter().zip(before).zip(&self.readings);
        still(tree.root()) && !pairs.any(moves) && free.iter().zip(&self.readings).all(stands)
    }

    /// rad or m. Shape (freedom,).
    pub(super) fn positions(&self) -> Vec<f64> {
        self.readings.iter().map(|r| r.position).collect()
    }

    /// rad/s or m/s. Shape (freedom,).
    pub(super) fn velocities(&self) -> Vec<f64> {
        self.readings.iter().map(|r| r.velocity).collect()
    }

    /// Returns the free joints. Shape (freedom,).
    pub(super) fn joints<'a>(
        &self,
        tree: &KinematicTree,
        joints: &'a [PhysicsJoint],
    ) -> Vec<&'a PhysicsJoint> {
        let place = |k: &usize| &joints[tree.joints[*k]];
        self.free.iter().map(place).collect()
    }
}
