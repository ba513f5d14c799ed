//! Laws: physical effects that the basic model lacks.
//!
//! A law acts in one engine, where it is one file, a [`Law`], and one line in that engine's [`LawRegistry`]. All that laws
//! have in common stands here: what is known about each ([`LawInfo`]), how one is asked for ([`LawSpec`]), its numbers
//! with their defaults ([`LawValues`]), what its target names, checks, and installing. How a law acts is the engine's own.

mod info;
mod install;
mod registry;
mod spec;
mod target;
mod values;

pub use info::{EngineKind, LawInfo, LawRegime, ParamInfo};
pub use install::check_and_canonicalize;
pub use registry::{ActiveLaw, Law, LawRegistry};
pub use spec::LawSpec;
pub use target::{is_joint_named, is_part_named};
pub use values::LawValues;
