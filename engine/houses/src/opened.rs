//! Results of readers of houses.

use crate::error::HousesError;
use crate::report::LoadReport;
use dwell_scene::House;

/// A house and the damage that was survived on the way to it.
pub type Opened = Result<(House, LoadReport), HousesError>;
