//! Results of readers of houses.

use crate::error::HousesError;
use crate::report::LoadReport;
use dwell_scene::House;

/// A house with the report of its survived damage.
pub type OpenResult = Result<(House, LoadReport), HousesError>;
