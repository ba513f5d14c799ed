//! SUNCG's tables: categories, models, lights, sounds, votes. All optional, all below `metadata/` of the data root.

mod categories;
mod lights;
mod models;
mod rows;
mod sounds;
mod votes;

pub use categories::{CategoryEntry, CategoryTable};
pub use lights::{LightFile, LightTable};
pub use models::{ModelEntry, ModelTable};
pub use sounds::{OneOrMany, SoundEntry, SoundTable};
pub use votes::{VoteTable, Votes};

use crate::damage::Damage;
use crate::limits::MAX_TEXT_BYTES;
use crate::report::{At, Report};
use crate::root::DataRoot;

/// The bytes of the first of `paths` that exists; `None` with a warning when none does or it cannot be read.
pub(crate) fn read_table<'a>(
    root: &DataRoot,
    paths: &[&'a str],
    consequence: &str,
    report: &mut Report,
) -> Option<(&'a str, Vec<u8>)> {
    let Some(path) = paths.iter().find(|path| root.has_file(path)) else {
        let damage = Damage::MissingTable {
            path: paths[0].to_owned(),
            consequence: consequence.to_owned(),
        };
        report.warn(At::file(paths[0]), damage);
        return None;
    };
    match root.read(path, MAX_TEXT_BYTES) {
        Ok(bytes) => Some((path, bytes)),
        Err(error) => {
            let consequence = format!("{consequence} ({})", error.reason());
            report.warn(
                At::file(*path),
                Damage::MissingTable {
                    path: (*path).to_owned(),
                    consequence,
                },
            );
            None
        }
    }
}

/// The id of the model that a variant belongs to: `122` of `122_0`.
pub fn base_model(id: &str) -> &str {
    match id.rsplit_once('_') {
        // `s__1296` is a whole id: what stands before its number ends in an underscore.
        Some((base, variant)) if variant == "0" && !base.is_empty() && !base.ends_with('_') => base,
        _ => id,
    }
}
