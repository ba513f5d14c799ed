//! Robots by themselves: the choice of the reader by the file.

use std::path::Path;

use crate::error::HousesError;
use crate::report::LoadReport;
use crate::robot::Robot;

/// Opens a robot: a `.urdf`, or a `.xml` of MuJoCo. Meshes are read below the folder of the file, or below the folder of
/// its package when a `package.xml` stands up to three folders above it.
///
/// # Errors
/// [`HousesError`] with the file, the node and the field: [`HousesError::Syntax`] for what is no XML or not this format,
/// [`HousesError::Field`] for a loop, a mass that is not above 0, a number that is not finite, a mesh that is missing or of a
/// form that is not read, [`HousesError::PathLeavesRoot`] for a path out of the data root.
pub fn open_robot(path: &Path) -> Result<(Robot, LoadReport), HousesError> {
    let mut report = LoadReport::new();
    let robot = if crate::urdf::recognizes(path) {
        crate::urdf::read(path, &mut report)?
    } else if crate::mjcf::recognizes(path) {
        crate::mjcf::read(path, &mut report)?
    } else {
        let found = path.display().to_string();
        return Err(HousesError::UnknownHouse {
            house: found,
            allowed: "a path to a .urdf, or to a .xml of MuJoCo".to_owned(),
        });
    };
    Ok((robot, report))
}
