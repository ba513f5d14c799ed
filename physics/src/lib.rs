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
mod agents;
pub mod bases;
mod body;
mod config;
mod contact;
mod convert;
mod edit;
mod engine;
mod error;
mod inertia;
mod joints;
mod laid;
pub mod laws;
mod limits;
mod lost;
mod model;
mod motors;
mod parameters;
mod placement;
mod report;
mod reset;
mod resting;
mod settling;
mod snapshot;
mod softness;
mod start;
mod step;
mod workspace;
mod world;

pub use actions::{Action, ActionCode, ActionOutcome, Grasp, Notice, Pointed, Target};
pub use agents::AgentControl;
pub use config::{ContactFriction, PhysicsConfig};
pub use contact::{ContactEvent, ContactKind, ContactPhase, MergedEvents, Toucher};
pub use error::PhysicsError;
pub use model::PhysicsModel;
pub use placement::AgentPlacement;
pub use report::{FrozenObject, MovedAgent, MovedObject, PassingJoint, StartReport};
pub use reset::{BodyState, JointState};
pub use resting::PairCounts;
pub use world::PhysicsWorld;
