//! What moves and touches; rapier stays behind this wall.
//!
//! ```
//! use dwell_physics::{AgentControl, PhysicsConfig, PhysicsWorld};
//! use dwell_scene::{AgentBody, AgentState, House, ShoeboxMaterials, State};
//! use std::sync::Arc;
//!
//! let house = Arc::new(House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default())?);
//! let mut state = State::new(&house);
//! let (mut world, report) = PhysicsWorld::new(house, PhysicsConfig::default(), &mut state)?;
//! assert!(report.frozen.is_empty());
//! let start = glam::Vec3::new(3.0, 0.0, 2.5);
//! let agent = world.add_agent(&mut state, AgentState::new(AgentBody::default(), start, 0.0))?;
//! let forward = AgentControl { forward_m_s: 1.0, ..AgentControl::default() };
//! let mut events = Vec::new();
//! for _ in 0..20 {
//!     world.step(&mut state, &[forward], &mut events)?;
//! }
//! // One second at 1 m/s towards -Z.
//! assert!((state.agents[agent].position.z - 1.5).abs() < 1e-3);
//! # Ok::<(), dwell_physics::PhysicsError>(())
//! ```

mod actions;
mod agent_placement;
mod agents;
pub mod bases;
mod body;
mod config;
mod contact;
mod control_step;
mod convert;
mod dynamics;
mod engine;
mod error;
mod external_changes;
mod inertia;
mod joints;
pub mod laws;
mod limits;
mod model;
mod motors;
mod non_finite;
mod parameters;
mod report;
mod set_state;
mod settle_start;
mod sleeping;
mod snapshot;
mod start;
mod world;

pub use actions::{
    Action, ActionOutcome, DelayedOutcome, Grasp, OutcomeCode, PointedTarget, Target,
};
pub use agent_placement::AgentPlacement;
pub use agents::AgentControl;
pub use config::{ContactFriction, PhysicsConfig};
pub use contact::{ContactEntity, ContactEvent, ContactKind, ContactPhase, MergedEvents};
pub use engine::PairCounts;
pub use error::PhysicsError;
pub use model::PhysicsModel;
pub use report::{FrozenObject, MovedAgent, MovedObject, PassingJoint, StartReport};
pub use set_state::{BodyState, JointState};
pub use world::PhysicsWorld;
