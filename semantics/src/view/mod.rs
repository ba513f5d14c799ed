//! What a viewer sees, and how things are referred to for whoever sees them.

mod refer;
mod strategy;
mod survey;

pub use refer::refer_in_view;
pub use strategy::{ReferStrategy, refer_by_survey, refer_to};
pub use survey::{Sighting, ViewSurvey};
