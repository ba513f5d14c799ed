//! Targets of cargo-fuzz: one for each sample, and for the files that are read beside houses.
//!
//! The first byte of an input says which file of the target it stands for, the rest is that file's content.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock, PoisonError};

use dwell_acoustics::Recording;
use dwell_acoustics::hdf5::Hdf5;
use dwell_calibration::{CalibrationOptions, calibrate};
use dwell_semantics::language::Language;
use tempfile::TempDir;

use super::bodies::{exercise_house, read};
use super::samples::{NAMES, Sample, files_below, sample};

/// Targets beside those of [`NAMES`].
pub const OTHERS: [&str; 4] = ["bundle", "sound", "head", "sentence"];

/// Files with one ending that a corpus begins with. The studio has some hundred of them, all alike.
const SEEDS_AN_ENDING: usize = 8;
/// A first byte tells so many files apart.
const MOST_FILES: usize = 256;

/// Something that is fuzzed.
trait Target: Send {
    /// The undamaged files, with their names for people.
    fn files(&self) -> Vec<(String, Vec<u8>)>;
    /// Reads what stands for one of them.
    ///
    /// # Panics
    /// When something is wrong: that is what a fuzzer looks for.
    fn take(&self, file: usize, bytes: &[u8]);
}

impl Target for Sample {
    fn files(&self) -> Vec<(String, Vec<u8>)> {
        let of = |k| (self.path(k).display().to_string(), self.bytes(k).to_vec());
        (0..self.len()).map(of).collect()
    }

    fn take(&self, file: usize, bytes: &[u8]) {
        if let Ok((house, _)) = read(self, file, bytes) {
            exercise_house(house);
        }
    }
}

/// A WAV, FLAC or Ogg Vorbis file.
struct SoundFiles;

impl Target for SoundFiles {
    fn files(&self) -> Vec<(String, Vec<u8>)> {
        let of = |name: &str, bytes: &[u8]| (name.to_owned(), bytes.to_vec());
        let coded = [
            of(
                "a.flac",
                include_bytes!("../../../acoustics/tests/data/tone.flac"),
            ),
            of(
                "a.ogg",
                include_bytes!("../../../acoustics/tests/data/tone.ogg"),
            ),
        ];
        let plain = [8, 16, 24, 32].map(|bits| (format!("{bits}.wav"), ramp(bits)));
        coded.into_iter().chain(plain).collect()
    }

    fn take(&self, _: usize, bytes: &[u8]) {
        match Recording::decode("a sound", bytes) {
            Ok(sound) => {
                assert!(sound.samples().iter().all(|sample| sample.is_finite()));
                let signal = sound.signal(16_000);
                assert!(signal.is_err() || signal.is_ok_and(|x| !x.samples().is_empty()));
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
}

/// A measured head: an HDF5 file.
struct HeadFiles;

impl Target for HeadFiles {
    fn files(&self) -> Vec<(String, Vec<u8>)> {
        let earliest = include_bytes!("../../../acoustics/tests/data/earliest.sofa");
        let latest = include_bytes!("../../../acoustics/tests/data/latest.sofa");
        vec![
            ("earliest.sofa".to_owned(), earliest.to_vec()),
            ("latest.sofa".to_owned(), latest.to_vec()),
        ]
    }

    fn take(&self, _: usize, bytes: &[u8]) {
        let Ok(file) = Hdf5::open(bytes.to_vec()) else {
            return;
        };
        for name in [
            "Data.IR",
            "SourcePosition",
            "Data.SamplingRate",
            "ListenerView",
        ] {
            let told = file.attribute_text(Some(name), "Units");
            assert!(told.is_ok() || told.is_err_and(|error| !error.to_string().is_empty()));
            if let Ok(numbers) = file.numbers(name) {
                assert_eq!(
                    numbers.values.len(),
                    numbers.shape.iter().product::<usize>()
                );
            }
        }
        let _ = file.attribute_text(None, "SOFAConventions");
    }
}

/// Sentences of a stranger.
struct Sentences;

impl Target for Sentences {
    fn files(&self) -> Vec<(String, Vec<u8>)> {
        let texts = [
            "The small brown wooden chair is next to a table that is in the kitchen.",
            "Pick up the mug on the table, then put the mug in the second bedroom.",
            "How many red and blue chairs but not near the bed are there?",
        ];
        let of = |text: &&str| ((*text).to_owned(), text.as_bytes().to_vec());
        texts.iter().map(of).collect()
    }

    fn take(&self, _: usize, bytes: &[u8]) {
        let text = String::from_utf8_lossy(bytes);
        match Language::english().read(&text) {
            // What was read can be said, and means the same again.
            Ok(reading) => {
                if let Some(said) = Language::english().say(&reading.forms[0], None) {
                    let again = Language::english().read(&said.text);
                    assert!(again.is_ok_and(|again| again.forms.contains(&reading.forms[0])));
                }
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
}

/// A WAV file of 64 samples, integers, 16 kHz, one channel.
fn ramp(bits: u16) -> Vec<u8> {
    let width = u32::from(bits / 8);
    let length = 64 * width;
    let mut bytes = b"RIFF".to_vec();
    bytes.extend((36 + length).to_le_bytes());
    bytes.extend(b"WAVEfmt ");
    bytes.extend(16_u32.to_le_bytes());
    for half in [1_u16, 1] {
        bytes.extend(half.to_le_bytes());
    }
    for word in [16_000, 16_000 * width] {
        bytes.extend(word.to_le_bytes());
    }
    for half in [bits / 8, bits] {
        bytes.extend(half.to_le_bytes());
    }
    bytes.extend(b"data");
    bytes.extend(length.to_le_bytes());
    bytes.extend((0..length).map(|k| k as u8));
    bytes
}

/// The bundle of measured throws that `dwell demo` shows.
struct MeasuredBundle {
    folder: TempDir,
    files: Vec<(PathBuf, Vec<u8>)>,
}

impl MeasuredBundle {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder for a moment");
        let written = dwell_calibration::example::write(folder.path(), 1);
        written.expect("a folder of our own can be written to");
        let read = |path: PathBuf| {
            let bytes = fs::read(&path).expect("it was just written");
            (path, bytes)
        };
        let files = files_below(folder.path()).into_iter().map(read).collect();
        Self { folder, files }
    }
}

impl Target for MeasuredBundle {
    fn files(&self) -> Vec<(String, Vec<u8>)> {
        let of = |(path, bytes): &(PathBuf, Vec<u8>)| {
            let name = path.strip_prefix(self.folder.path()).unwrap_or(path);
            (name.display().to_string(), bytes.clone())
        };
        self.files.iter().map(of).collect()
    }

    fn take(&self, file: usize, bytes: &[u8]) {
        let (path, sound) = &self.files[file];
        fs::write(path, bytes).expect("a folder of our own can be written to");
        // What is read after all is stopped before the work begins.
        let read = calibrate(
            self.folder.path(),
            &CalibrationOptions::default(),
            &mut |fraction, _| fraction <= 0.0,
        );
        fs::write(path, sound).expect("a folder of our own can be written to");
        let stopped = read.expect_err("it is stopped, if not refused");
        assert!(!stopped.to_string().is_empty());
    }
}

fn target(name: &str) -> Box<dyn Target> {
    match name {
        "bundle" => Box::new(MeasuredBundle::new()),
        "sound" => Box::new(SoundFiles),
        "head" => Box::new(HeadFiles),
        "sentence" => Box::new(Sentences),
        _ if NAMES.contains(&name) => Box::new(sample(name)),
        _ => panic!("no target {name:?}; there are {NAMES:?} and {OTHERS:?}"),
    }
}

/// Undamaged inputs of a target, with names for files.
///
/// # Panics
/// When there is no target of that name.
pub fn seeds(name: &str) -> Vec<(String, Vec<u8>)> {
    let mut seen: Vec<String> = Vec::new();
    let mut found = Vec::new();
    for (k, (path, bytes)) in target(name)
        .files()
        .into_iter()
        .take(MOST_FILES)
        .enumerate()
    {
        let ending = path.rsplit('.').next().unwrap_or_default().to_owned();
        if seen.iter().filter(|other| **other == ending).count() < SEEDS_AN_ENDING {
            seen.push(ending);
            let input = [&[k as u8][..], &bytes].concat();
            found.push((path.replace(['/', '\\'], "_"), input));
        }
    }
    found
}

/// Fills the corpus that libFuzzer was given with the target's seeds, if it is a folder and empty: so no target begins with nothing.
///
/// # Panics
/// When there is no target of that name, or the folder cannot be written to.
pub fn seed_corpus(name: &str) {
    let mut words = std::env::args().skip(1);
    let Some(corpus) = words.find(|word| !word.starts_with('-')) else {
        return;
    };
    let corpus = Path::new(&corpus);
    let empty = fs::read_dir(corpus).is_ok_and(|mut entries| entries.next().is_none());
    if empty {
        for (file, bytes) in seeds(name) {
            fs::write(corpus.join(file), bytes).expect("a corpus can be written to");
        }
    }
}

/// The body of a target of cargo-fuzz.
///
/// # Panics
/// When something is wrong: that is what a fuzzer looks for.
pub fn fuzz(name: &'static str, bytes: &[u8]) {
    type Shared = (usize, Mutex<Box<dyn Target>>);
    static TARGET: OnceLock<Shared> = OnceLock::new();
    let (count, target) = TARGET.get_or_init(|| {
        let target = target(name);
        (target.files().len().min(MOST_FILES), Mutex::new(target))
    });
    let Some((which, content)) = bytes.split_first() else {
        return;
    };
    let target = target.lock().unwrap_or_else(PoisonError::into_inner);
    target.take(usize::from(*which) % count, content);
}
