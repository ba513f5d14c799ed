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

use std::io::Read as _;
use std::path::Path;

use dwell_scene::{House, file};

use crate::error::HousesError;
use crate::report::LoadReport;
use crate::robot;

pub(crate) use read::read;

/// Length of the head of a file that is searched to tell MuJoCo's XML from another's, bytes.
const HEAD: u64 = 4096;

/// Returns whether `path` names an XML file whose root is `<mujoco>`.
pub(crate) fn recognizes(path: &Path) -> bool {
    let is_xml = path
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("xml"));
    let head = || {
        let mut head = Vec::new();
        let file = file::open(path, u64::MAX).ok()?;
        file.take(HEAD).read_to_end(&mut head).ok()?;
        Some(head)
    };
    is_xml && head().is_some_and(|head| String::from_utf8_lossy(&head).contains("<mujoco"))
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
