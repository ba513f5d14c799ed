//! The figure of a person: joints and pieces, as a pure function of what stands in a state.
//!
//! A figure is drawn only; in physics a person is the capsule of its agent. Its eyes, while it stands and looks ahead, are
//! where the agent's camera is, so that the rest of it stands a little behind the middle of the capsule.

mod arm;
mod leg;
mod meshes;
mod pieces;
pub mod proportions;
mod skeleton;
mod stride;

pub use meshes::{PersonMesh, person_meshes};
pub use pieces::{PERSON_PIECES, PersonPiece, person_pieces};
pub use skeleton::{ArmJoints, LegJoints, PersonSkeleton, grasp_point, skeleton_of};
pub use stride::{WALK_RATIO, advance_persons};
