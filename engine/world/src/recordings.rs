//! Sound files, read once and shared by all worlds over a house.

use crate::error::WorldError;
use dwell_acoustics::Recording;
use dwell_acoustics::recordings::MOST_BYTES;
use dwell_acoustics::signals::Signal;
use dwell_houses::{At, DataRoot, HousesError};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use xxhash_rust::xxh3::Xxh3;

/// Samples that are kept; beyond it all are forgotten, and those that are played again are read again: 256 MiB.
const MOST_KEPT: usize = 1 << 26;

/// By root, path and rate.
type Known = BTreeMap<(String, String, u32), (Signal, u64)>;

#[derive(Debug, Default)]
pub(crate) struct Recordings {
    known: Mutex<Known>,
}

fn print(samples: &[f32]) -> u64 {
    let mut sum = Xxh3::new();
    for sample in samples {
        sum.update(&sample.to_le_bytes());
    }
    sum.digest()
}

impl Recordings {
    /// The file at `name` below `root` at `rate_hz`, and the check sum of its samples.
    pub(crate) fn open(
        &self,
        root: Option<&str>,
        name: &str,
        rate_hz: u32,
    ) -> Result<(Signal, u64), WorldError> {
        let Some(folder) = root else {
            return Err(WorldError::Config {
                field: "sound_root",
                found: format!("not set, and the sound file {name:?} asked for"),
                allowed: "the folder below which sound files are".to_owned(),
            });
        };
        let key = (folder.to_owned(), name.to_owned(), rate_hz);
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known.get(&key) {
            return Ok(found.clone());
        }
        let root = DataRoot::new(folder)?;
        let path = DataRoot::resolve("", name).map_err(|_| HousesError::PathLeavesRoot {
            at: At::file(name),
            path: name.to_owned(),
            root: root.folder().to_owned(),
        })?;
        let bytes = root.read(&path, MOST_BYTES)?;
        let signal = Recording::decode(name, &bytes)?.signal(rate_hz)?;
        let found = (signal.clone(), print(signal.samples()));
        let kept: usize = known.values().map(|(s, _)| s.samples().len()).sum();
        if kept + signal.samples().len() > MOST_KEPT {
            known.clear();
        }
        known.insert(key, found.clone());
        Ok(found)
    }
}
