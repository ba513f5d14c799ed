//! Rigid bodies, joints and contacts; rapier stays behind this wall.
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

// Each module uses only those before it in this order: rapier and the house (convert, error, config, report, model, engine,
// body, inertia); interactions (joints, contact, bases, laws); the parts of a world (limits, start, dynamics, outcome,
// articulation, contact_record, agents, hands, actions); world, which joins them.
pub mod actions;
mod agents;
mod articulation;
pub mod bases;
mod body;
mod config;
mod contact;
mod contact_record;
mod convert;
mod dynamics;
mod engine;
mod error;
mod hands;
mod inertia;
mod joints;
pub mod laws;
mod limits;
mod model;
mod outcome;
mod report;
mod start;
mod world;

pub use actions::{HandAction, Target};
pub use agents::{AgentContacts, AgentControl, BodyContact};
pub use config::{ContactFriction, PhysicsConfig};
pub use contact::{ContactEntity, ContactEvent, ContactKind, ContactPhase, ExcessEventTotals};
pub use engine::PairCounts;
pub use error::PhysicsError;
pub use hands::{BOTH_HANDS, Grasp};
pub use model::PhysicsModel;
pub use outcome::{ActionOutcome, DelayedOutcome, OutcomeCode, PointedTarget};
pub use report::{FrozenObject, MovedAgent, MovedObject, PassThroughJoint, StartReport};
pub use world::{AgentPlacement, BodyState, JointState, PhysicsWorld};
