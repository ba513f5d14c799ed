//! SUNCG's tables: categories, models, lights, sounds, votes. All optional, all below `metadata/` of the data root.

mod acceptability;
mod categories;
mod lights;
mod models;
mod rows;
mod sounds;

pub use acceptability::{AcceptabilityVotes, VoteTable};
pub use categories::{CategoryEntry, CategoryTable};
pub use lights::{LightTable, SuncgLight};
pub use models::{ModelEntry, ModelTable};
pub use sounds::{OneOrMany, SoundEntry, SoundTable};

use crate::data_root::DataRoot;
use crate::limits::MAX_TEXT_BYTES;
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// The bytes of the first of `paths` that exists; `None` with a warning when none does or it cannot be read.
pub(crate) fn read_table<'a>(
    root: &DataRoot,
    paths: &[&'a str],
    consequence: &str,
    report: &mut LoadReport,
) -> Option<(&'a str, Vec<u8>)> {
    let Some(path) = paths.iter().find(|path| root.exists(path)) else {
        let damage = WarningKind::MissingTable {
            path: paths[0].to_owned(),
            consequence: consequence.to_owned(),
        };
        report.warn(FileLocation::file(paths[0]), damage);
        return None;
    };
    match root.read(path, MAX_TEXT_BYTES) {
        Ok(bytes) => Some((path, bytes)),
        Err(error) => {
            let at = FileLocation::file(*path);
            unreadable(&at, error.reason(), consequence, report);
            None
        }
    }
}

/// Reports a table of which nothing could be read.
fn unreadable(at: &FileLocation, reason: String, consequence: &str, report: &mut LoadReport) {
    let damage = WarningKind::UnreadableTable {
        path: at.file.clone(),
        reason,
        consequence: consequence.to_owned(),
    };
    report.warn(at.clone(), damage);
}

/// The id of the model that a variant belongs to: `122` of `122_0`.
pub fn base_model(id: &str) -> &str {
    match id.rsplit_once('_') {
        // `s__1296` is a whole id: what stands before its number ends in an underscore.
        Some((base, variant)) if variant == "0" && !base.is_empty() && !base.ends_with('_') => base,
        _ => id,
    }
}
