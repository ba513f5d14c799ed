//! `extras.dwell`: what our own files say of nodes and materials beyond glTF.

use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// The `extras` of a node or a material.
#[derive(Deserialize)]
pub(super) struct Extras<T> {
    pub(super) dwell: T,
}

/// Returns what `extras` say in `dwell`; the default where they say nothing, and, reported, where that cannot be read.
pub(super) fn dwell_extras<T: DeserializeOwned + Default>(
    extras: Option<&str>,
    at: &FileLocation,
    report: &mut LoadReport,
) -> T {
    let Some(text) = extras.filter(|text| text.contains("\"dwell\"")) else {
        return T::default();
    };
    serde_json::from_str(text).map_or_else(
        |error| {
            let what = format!(
                "extras.dwell is not read: {}",
                crate::plain_parse_error(&error)
            );
            report.warn(at.field("extras"), WarningKind::Simplified { what });
            T::default()
        },
        |extras: Extras<T>| extras.dwell,
    )
}
