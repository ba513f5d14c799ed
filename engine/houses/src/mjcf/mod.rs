//! MJCF: robots and houses of `MuJoCo`.
//!
//! `mjcf-rs` parses it: classes of defaults, angles and the many ways to write a rotation come resolved. Files it would
//! include are checked first, so that none lies out of the data root.

mod actuators;
mod default_classes;
mod finite_check;
mod geoms;
mod house;
mod includes;
mod read;
mod unread_elements;

use std::path::Path;

use dwell_scene::House;

use crate::error::HousesError;
use crate::report::LoadReport;
use crate::robot;

pub(crate) use read::read;

/// Returns whether `path` names an XML file: no other format has such.
pub(crate) fn recognizes(path: &Path) -> bool {
    let ending = path.extension();
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case("xml"))
}

/// Opens a house of several bodies (`docs/formats/mjcf.md`), or a robot on a ground of its own.
///
/// # Errors
/// Those of [`open_robot`](crate::open_robot); of a house, what cannot be read is left out and reported.
pub fn open(path: &Path) -> Result<(House, LoadReport), HousesError> {
    let mut report = LoadReport::new();
    let mut source = read::MjcfSource::load(path, &mut report)?;
    if house::is_house(&source) {
        let house = house::read(source, &mut report)?;
        return Ok((house, report));
    }
    let robot = source.first_robot(&mut report)?;
    Ok((robot::house_with_robot_only(&robot)?, report))
}
