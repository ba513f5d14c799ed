//! The state of a running world: plain data, one per world.

mod address;
mod agent;
mod agent_address;
mod body;
mod body_fields;
mod bounds;
mod canonical;
mod joint;
mod law_address;
mod listing;
mod locomotion;
mod mass;
mod names;
mod numeric_field;
mod overrides;
mod parameter;
mod part;
mod person;
mod relations;
mod snapshot;

pub use address::Address;
pub use agent::{AgentState, BaseState};
pub use body::AgentBody;
pub use joint::JointParameters;
pub use locomotion::{DifferentialDrive, HolonomicBase, LeggedLocomotion, Locomotion};
pub use parameter::Parameter;
pub use person::{
    Gesture, PersonBody, PersonColors, PersonGait, PersonState, PointingGesture, ReachGesture,
    ResolvedPersonColors, Side,
};
pub use relations::{Contact, SupportDirection};

use crate::articulation::JointCommand;
use crate::house::House;
use crate::ids::{AgentId, IdVec, JointId, ObjectId, PartId};
use crate::law::LawSpec;
use crate::space::Pose;
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Openness from which a joint switches its object on: a tap runs instead of dripping.
const SWITCHES_AT: f32 = 0.1;

/// The state of a world. Physics writes it, the world owns it, every engine reads it; it holds no mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Simulated time since the start, s.
    pub time_s: f64,
    /// Control steps since the start.
    pub step: u64,

    // ---- integrated
    /// `world_from_part` of every part. Shape (part,).
    pub part_pose: IdVec<PartId, Pose>,
    /// Velocity of every part. Shape (part,).
    pub part_velocity: IdVec<PartId, Velocity>,
    /// Position of every joint, rad or m. Shape (joint,).
    pub joint_position: IdVec<JointId, f32>,
    /// Velocity of every joint, rad/s or m/s. Shape (joint,).
    pub joint_velocity: IdVec<JointId, f32>,
    /// The command to each joint's motor, or to the hand on it. Shape (joint,).
    pub joint_command: IdVec<JointId, JointCommand>,
    /// The agents.
    pub agents: IdVec<AgentId, AgentState>,
    /// Those of the agents that are persons. In bytes they follow everything else, and take none where there are none.
    #[serde(skip)]
    pub persons: BTreeMap<AgentId, PersonState>,

    // ---- set by actions
    /// True for objects that are switched on; objects without a switch stay `false`. Shape (object,).
    pub switched_on: IdVec<ObjectId, bool>,
    /// The agent that holds each object. Shape (object,).
    pub held_by: IdVec<ObjectId, Option<AgentId>>,

    // ---- set from outside
    /// Parameters that differ from the house's.
    pub overrides: BTreeMap<Address, f64>,
    /// Laws that are installed, in order.
    pub laws: Vec<LawSpec>,

    // ---- derived by physics in the last step
    /// Pairs of things that touch, each once, sorted.
    pub contacts: Vec<Contact>,
}

/// Linear and angular velocity in world space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Velocity {
    /// Of the part's origin, m/s.
    pub linear: Vec3,
    /// rad/s.
    pub angular: Vec3,
}

impl State {
    /// The initial state of `house`: everything at its pose in the file, at rest, no agents.
    pub fn new(house: &House) -> Self {
        let (parts, joints, objects) = (house.parts.len(), house.joints.len(), house.objects.len());
        Self {
            time_s: 0.0,
            step: 0,
            part_pose: house
                .parts
                .iter()
                .map(|part| part.world_from_part)
                .collect(),
            part_velocity: IdVec::filled(Velocity::default(), parts),
            joint_position: house.joints.iter().map(|joint| joint.initial).collect(),
            joint_velocity: IdVec::filled(0.0, joints),
            joint_command: IdVec::filled(JointCommand::Off, joints),
            agents: IdVec::new(),
            persons: BTreeMap::new(),
            switched_on: house
                .objects
                .iter()
                .map(|object| object.switch.unwrap_or(false))
                .collect(),
            held_by: IdVec::filled(None, objects),
            overrides: BTreeMap::new(),
            laws: Vec::new(),
            contacts: Vec::new(),
        }
    }

    /// Returns the openness of an object: the largest of its joints that open; `None` when it has none.
    pub fn openness(&self, house: &House, object: ObjectId) -> Option<f32> {
        house
            .joints_of(object)
            .filter(|joint| house.joints[*joint].is_openable())
            .map(|joint| house.joints[joint].openness(self.joint_position[joint]))
            .reduce(f32::max)
    }

    /// Updates objects whose joints are their switches: on where such a joint is open, off where all are closed.
    pub fn update_switches(&mut self, house: &House) {
        let switches = || {
            house
                .joints
                .iter_ids()
                .filter(|(_, joint)| joint.toggles_switch)
        };
        for (_, joint) in switches() {
            self.switched_on[joint.object] = false;
        }
        for (id, joint) in switches() {
            self.switched_on[joint.object] |= joint.openness(self.joint_position[id]) > SWITCHES_AT;
        }
    }

    /// Returns whether an object is on: switched on, or without a switch.
    pub fn is_on(&self, house: &House, object: ObjectId) -> bool {
        house.objects[object].switch.is_none() || self.switched_on[object]
    }
}
