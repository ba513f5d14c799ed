//! The repairs made when a world started.

use dwell_scene::{AgentId, JointId, ObjectId};
use serde::Serialize;

/// An object that overlapped something at the start and was moved free.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MovedObject {
    /// The object.
    pub object: ObjectId,
    /// The deepest overlap that was found, m.
    pub overlap_m: f32,
    /// Distance it was moved, m.
    pub distance_m: f32,
}

/// An object that could not be freed within the bound and is frozen for good.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FrozenObject {
    /// The object.
    pub object: ObjectId,
    /// The remaining overlap, m.
    pub overlap_m: f32,
    /// The name of the thing that it overlaps most.
    pub with: String,
}

/// A joint's leaf that overlaps other things at the start: it passes through them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PassThroughJoint {
    /// The joint.
    pub joint: JointId,
    /// The names of the things it passes through, sorted.
    pub through: Vec<String>,
}

/// An agent that would have overlapped something at the start and was put at a free place.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MovedAgent {
    /// The agent.
    pub agent: AgentId,
    /// Distance it was moved, m.
    pub distance_m: f32,
}

/// The overlaps found and the repairs made when a world started.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct StartReport {
    /// Rigid bodies that can move.
    pub bodies: usize,
    /// Collision pieces that never move.
    pub static_pieces: usize,
    /// Joints.
    pub joints: usize,
    /// Pairs of a body and another piece that overlapped by more than the tolerance.
    pub overlaps: usize,
    /// Objects that were moved to free them.
    pub moved: Vec<MovedObject>,
    /// Objects that were frozen.
    pub frozen: Vec<FrozenObject>,
    /// Leaves that pass through things that they overlap.
    pub passing: Vec<PassThroughJoint>,
    /// Moving objects without collision pieces of their own, which got convex pieces of their visible mesh.
    pub stand_ins: Vec<ObjectId>,
    /// Agents that were put at a free place.
    pub agents: Vec<MovedAgent>,
}
