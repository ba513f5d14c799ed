//! Robots: the common part of URDF and MJCF, and the placement of a robot in a house.
//!
//! Files have +Z up and +X forward. The base's frame in a house is dwell's: +Y up, and the robot faces -Z, as an agent at
//! yaw 0 does. Frames of links stay as the file has them.

mod assemble;
mod check;
mod files;
mod masses;
mod material_names;
mod model;
mod scale;
mod shape;
mod stl;

pub use model::Robot;

pub(crate) use assemble::{add, dwell_from_robot, house_with_robot_only, texture};
pub(crate) use check::check;
pub(crate) use files::RobotFileLoader;
pub(crate) use material_names::MaterialNames;
pub(crate) use model::{
    LinkInertia, LinkShape, RobotJoint, RobotJointKind, RobotLink, ShapeGeometry,
};

use dwell_scene::{House, Pose};

use crate::error::HousesError;
use crate::object_name::check_is_name;
use crate::report::FileLocation;

/// A house with a robot in it. `name` must be free; `fixed_base` fixes its base, else the base is a body that
/// stands and falls. Meshes are shared with the house.
///
/// Links that are fixed to each other are one part, by the name of the one nearest to the base: it has the mass, centre and inertia of
/// all of them together, and these have addresses (`part/ROBOT/LINK/mass_kg`); those behind the fixed joints have none of their own.
/// Nor have they a friction of their own: what touches any of its collision shapes touches the part's first material, that of the first
/// shape that is seen of the named link, or of the next that has one.
///
/// # Errors
/// [`HousesError::Spec`] for a name of blanks alone, or with control characters; [`HousesError::Scene`] for one that is taken, a pose that is not rigid, or a robot out of the scene's ranges.
pub fn with_robot(
    house: &House,
    robot: &Robot,
    name: &str,
    world_from_base: Pose,
    fixed_base: bool,
) -> Result<House, HousesError> {
    check_is_name("name", name)?;
    let mut data = house.data().clone();
    let world_from_root = world_from_base * assemble::dwell_from_robot();
    assemble::add(
        &mut data,
        robot,
        name,
        world_from_root,
        fixed_base,
        &mut MaterialNames::default(),
    );
    House::new(data).map_err(HousesError::scene(&FileLocation::file(&robot.source)))
}
