//! Sound files, read once until they are written anew, and shared by all worlds over a house.

use crate::error::WorldError;
use dwell_acoustics::recordings::MAX_FILE_BYTES;
use dwell_acoustics::signals::Signal;
use dwell_acoustics::{AcousticsError, Recording};
use dwell_houses::{DataRoot, FileLocation, HousesError};
use dwell_scene::{House, SoundFileId, interrupt};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::SystemTime;
use xxhash_rust::xxh3::Xxh3;

/// Number of samples that are kept; beyond it all are dropped, and those that are played again are read again: 256 MiB.
const MOST_KEPT: usize = 1 << 26;

/// When a file was written last, and its length, bytes.
type FileStamp = (SystemTime, u64);

/// A decoded file.
#[derive(Clone, Debug)]
struct LoadedSound {
    signal: Signal,
    hash: u64,
    /// `None` where the system does not tell: such a file is read again each time.
    stamp: Option<FileStamp>,
}

/// Decoded files by root, path and rate.
type LoadedSounds = BTreeMap<(String, String, u32), LoadedSound>;

/// The house's own sounds, by number and rate. They sound in every block, so none is dropped.
#[derive(Debug, Default)]
struct HouseSounds {
    signals: BTreeMap<(SoundFileId, u32), Signal>,
    /// Number of all samples.
    samples: usize,
}

#[derive(Debug, Default)]
pub(crate) struct RecordingCache {
    known: Mutex<LoadedSounds>,
    own: Mutex<HouseSounds>,
    /// Set once the house's own sounds are known to be valid.
    are_sounds: OnceLock<()>,
}

fn hash_samples(samples: &[f32]) -> u64 {
    let mut sum = Xxh3::new();
    for sample in samples {
        sum.update(&sample.to_le_bytes());
    }
    sum.digest()
}

fn file_stamp(path: &Path) -> Option<FileStamp> {
    let meta = fs::metadata(path).ok()?;
    Some((meta.modified().ok()?, meta.len()))
}

impl RecordingCache {
    /// The file at `name` below `root` at `rate_hz`, and the check sum of its samples; read again once it was written anew.
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
        let root = DataRoot::new(folder)?;
        let path = DataRoot::resolve("", name).map_err(|_| HousesError::PathLeavesRoot {
            at: FileLocation::file(name),
            path: name.to_owned(),
            root: root.folder().to_owned(),
        })?;
        let stamp = file_stamp(&root.folder().join(&path));
        if let Some(found) = known.get(&key)
            && stamp.is_some()
            && found.stamp == stamp
        {
            return Ok((found.signal.clone(), found.hash));
        }
        let bytes = root.read(&path, MAX_FILE_BYTES)?;
        let signal = Recording::decode(name, &bytes)?.signal(rate_hz)?;
        let hash = hash_samples(signal.samples());
        known.remove(&key);
        let kept: usize = known.values().map(|kept| kept.signal.samples().len()).sum();
        if kept + signal.samples().len() > MOST_KEPT {
            known.clear();
        }
        let found = LoadedSound {
            signal: signal.clone(),
            hash,
            stamp,
        };
        known.insert(key, found);
        Ok((signal, hash))
    }

    /// Decodes every sound file that something in the house plays; once, where all are valid.
    ///
    /// # Errors
    /// [`WorldError::Acoustics`] for what is no sound, with the file and what plays it.
    pub(crate) fn check_house(&self, house: &House) -> Result<(), WorldError> {
        if self.are_sounds.get().is_some() {
            return Ok(());
        }
        let mut seen = BTreeSet::new();
        for emitter in &house.emitters {
            let Some(id) = emitter.sound_file.filter(|id| seen.insert(*id)) else {
                continue;
            };
            interrupt::unwind_if_cancelled();
            let (file, object) = (&house.sound_files[id], &house.objects[emitter.object]);
            let name = format!("{}, played by {:?}", file.name, object.name);
            Recording::decode(&name, &file.bytes)?;
        }
        self.are_sounds.get_or_init(|| ());
        Ok(())
    }

    /// A sound file of the house at `rate_hz`.
    ///
    /// # Errors
    /// [`WorldError::Acoustics`] for what is no sound, and where all that sound have more than [`MOST_KEPT`] samples together.
    pub(crate) fn house_sound_file(
        &self,
        house: &House,
        id: SoundFileId,
        rate_hz: u32,
    ) -> Result<Signal, WorldError> {
        let mut own = self.own.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = own.signals.get(&(id, rate_hz)) {
            return Ok(found.clone());
        }
        let file = &house.sound_files[id];
        let signal = Recording::decode(&file.name, &file.bytes)?.signal(rate_hz)?;
        let samples = own.samples + signal.samples().len();
        if samples > MOST_KEPT {
            return Err(WorldError::Acoustics(AcousticsError::SoundFile {
                name: file.name.clone(),
                what: format!(
                    "samples with those of the house's other sound files at {rate_hz} Hz"
                ),
                found: samples.to_string(),
                allowed: format!("at most {MOST_KEPT}"),
            }));
        }
        own.samples = samples;
        own.signals.insert((id, rate_hz), signal.clone());
        Ok(signal)
    }
}
