//! Where houses come from: one folder a format, the built-in house, textures, [`open`].

mod atomic;
pub mod authoring;
mod build;
mod building;
pub mod builtin;
mod damage;
mod error;
mod formats;
pub mod generate;
pub mod gltf;
pub mod habitat;
mod limits;
mod loss;
pub mod measured;
pub mod mjcf;
pub mod native;
mod nearest;
pub mod obj;
pub mod procthor;
mod report;
mod robot;
mod root;
pub mod suncg;
pub mod urdf;
mod writers;
mod xml;

pub use damage::{Damage, Unmapped};
pub use error::HousesError;
pub use formats::{Format, Opened, formats, open, open_with, seed_range};
pub use loss::Loss;
pub use nearest::nearest;
pub use report::{At, Report, Warning};
pub use robot::{Robot, open_robot, with_robot};
pub use root::DataRoot;
pub use writers::{Writer, Written, WrittenInto, writer, writers};
