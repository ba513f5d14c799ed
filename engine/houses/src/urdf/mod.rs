//! URDF, the Unified Robot Description Format of ROS.
//!
//! Read by hand over an XML tree: the crates that read URDF (`urdf-rs` 0.10) give no places in the file and accept `nan` as
//! a number, and an error here must name the node and the field.

mod read;

use std::path::Path;

use dwell_scene::House;

use crate::error::HousesError;
use crate::report::LoadReport;
use crate::robot;

pub(crate) use read::read;

/// Returns whether `path` names a URDF file.
pub(crate) fn recognizes(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("urdf"))
}

/// Opens a robot on a ground of its own, its base fixed.
///
/// # Errors
/// Those of [`open_robot`](crate::open_robot).
pub fn open(path: &Path) -> Result<(House, LoadReport), HousesError> {
    let mut report = LoadReport::new();
    let robot = read(path, &mut report)?;
    Ok((robot::house_with_robot_only(&robot)?, report))
}
