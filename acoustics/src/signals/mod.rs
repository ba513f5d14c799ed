//! Signals of sound sources: deterministic loops by name, at any rate.
//!
//! Every signal repeats after its loop without a seam, and has a root mean square of 1 Pa over the loop at 1 m: the caller
//! multiplies by [`pa_from_db_spl`](dwell_scene::units::pa_from_db_spl) of the source's level. Any sample can be read:
//! blocks of any size give the same signal.

mod appliances;
mod formants;
mod household;
mod loop_builder;
mod music;
mod speech;
mod table;
mod test_signals;

pub(crate) use formants::{VOWELS_HZ, formant_gain};
pub(crate) use loop_builder::{raised_cosine_envelope, raised_cosine_rise, resonance_gain};
pub use test_signals::{Sweep, maximum_length_sequence};

use crate::error::AcousticsError;
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use loop_builder::LoopBuilder;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The description of a signal.
#[derive(Clone, Copy, Debug)]
pub struct SignalInfo {
    /// The name, as a [`SoundEmitter`](dwell_scene::SoundEmitter) gives it.
    pub name: &'static str,
    /// Its sound in words.
    pub description: &'static str,
    /// Period, s.
    pub loop_s: f64,
    /// Typical level at 1 m, dB SPL.
    pub typical_level_db: f32,
    /// Source of that level.
    pub level_source: &'static str,
    paint: fn(&mut LoopBuilder),
}

/// Returns all signals, by name.
pub fn list() -> &'static [SignalInfo] {
    &table::ALL
}

/// Returns the description of the signal called `name`.
///
/// # Errors
/// [`AcousticsError::UnknownSignal`] lists the existing names.
pub fn info(name: &str) -> Result<&'static SignalInfo, AcousticsError> {
    let found = list().iter().find(|signal| signal.name == name);
    found.ok_or_else(|| AcousticsError::UnknownSignal {
        name: name.to_owned(),
        known: list().iter().map(|signal| signal.name).collect(),
    })
}

/// Refuses an unsupported sample rate.
pub(crate) fn check_rate(rate_hz: u32) -> Result<(), AcousticsError> {
    let rate = f64::from(rate_hz);
    crate::error::check_range("signals", "rate_hz", rate, (1e3, 192e3), "1000 to 192000")
}

type SharedLoop = Arc<OnceLock<Arc<[f32]>>>;

/// Returns the slot of a loop.
fn shared_loop(info: &SignalInfo, rate_hz: u32) -> SharedLoop {
    static LOOPS: Mutex<BTreeMap<(&'static str, u32), SharedLoop>> = Mutex::new(BTreeMap::new());
    let mut loops = LOOPS.lock().unwrap_or_else(PoisonError::into_inner);
    loops.entry((info.name, rate_hz)).or_default().clone()
}

/// Returns whether a signal exists and has not been opened yet: opening it takes up to a second.
pub fn needs_synthesis(name: &str, rate_hz: u32) -> bool {
    info(name).is_ok_and(|info| shared_loop(info, rate_hz).get().is_none())
}

/// Makes loops before they are opened, several at once; unknown names are ignored.
pub fn presynthesize(names: &[&str], rate_hz: u32, threads: Threads) {
    threads.map(names.len(), |k| Signal::open(names[k], rate_hz).is_ok());
}

/// One loop of a signal, or a recording, prepared for one rate.
#[derive(Clone, Debug)]
pub struct Signal {
    samples: Arc<[f32]>,
}

impl Signal {
    /// Opens the signal called `name` at `rate_hz` samples a second, 1,000 to 192,000. Loops are made once a process and rate, and shared.
    ///
    /// # Errors
    /// [`AcousticsError::UnknownSignal`], [`AcousticsError::Range`] for the rate.
    pub fn open(name: &str, rate_hz: u32) -> Result<Self, AcousticsError> {
        let info = info(name)?;
        check_rate(rate_hz)?;
        let made = shared_loop(info, rate_hz);
        // Not under the lock, so that several are made at once.
        let samples = made.get_or_init(|| {
            let key = RandomKey::root(0).child("signals").child(info.name);
            let mut canvas = LoopBuilder::new(f64::from(rate_hz), info.loop_s, key);
            (info.paint)(&mut canvas);
            canvas.normalized().into()
        });
        Ok(Self {
            samples: samples.clone(),
        })
    }

    pub(crate) fn from_samples(samples: Arc<[f32]>) -> Self {
        Self { samples }
    }

    /// Returns the samples of one loop, root mean square 1 Pa. Shape (sample,).
    pub fn samples(&self) -> &[f32] {
        &self.samples
    }

    /// Writes the samples from `start_sample` on, Pa at 1 m for a level of 94 dB SPL, repeating the loop.
    pub fn read(&self, start_sample: u64, out: &mut [f32]) {
        let length = self.samples.len();
        let mut place = (start_sample % length as u64) as usize;
        let mut done = 0;
        while done < out.len() {
            let count = (length - place).min(out.len() - done);
            out[done..done + count].copy_from_slice(&self.samples[place..place + count]);
            done += count;
            place = 0;
        }
    }

    /// Writes the samples from `start_sample` on as [`Signal::read`], once: silence after the last.
    pub fn read_once(&self, start_sample: u64, out: &mut [f32]) {
        let length = self.samples.len();
        let start = usize::try_from(start_sample).map_or(length, |start| start.min(length));
        let count = (length - start).min(out.len());
        out[..count].copy_from_slice(&self.samples[start..start + count]);
        out[count..].fill(0.0);
    }
}

/// Writes the samples from `start_sample` on of the signal called `name`: root mean square 1 Pa at 1 m over its loop.
///
/// # Errors
/// As [`Signal::open`].
///
/// # Determinism
/// The samples depend on name, rate and position alone.
pub fn synthesize(
    name: &str,
    rate_hz: u32,
    start_sample: u64,
    out: &mut [f32],
) -> Result<(), AcousticsError> {
    Signal::open(name, rate_hz)?.read(start_sample, out);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn power(samples: &[f32]) -> f64 {
        samples.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>() / samples.len() as f64
    }

    #[test]
    #[ignore = "long: make test runs one of eight shares of these, make test-all all"]
    fn every_signal_is_finite_and_has_one_pascal_at_any_rate() {
        for signal in list() {
            for rate_hz in [8_000, 16_000, 44_100] {
                let samples = Signal::open(signal.name, rate_hz).unwrap();
                assert_eq!(
                    samples.samples().len(),
                    (signal.loop_s * f64::from(rate_hz)) as usize
                );
                assert!(
                    samples.samples().iter().all(|x| x.is_finite()),
                    "{}",
                    signal.name
                );
                let found = power(samples.samples());
                assert!(
                    (found - 1.0).abs() < 1e-4,
                    "{} at {rate_hz}: {found}",
                    signal.name
                );
            }
        }
        let names: Vec<_> = list().iter().map(|signal| signal.name).collect();
        assert!(names.is_sorted());
    }

    #[test]
    fn blocks_of_any_size_give_the_same_samples() {
        for name in ["radio", "clock", "speech"] {
            let mut whole = vec![0.0; 40_000];
            synthesize(name, 16_000, 250_000, &mut whole).unwrap();
            let mut pieces = Vec::new();
            for size in [1, 799, 800, 3_000, 35_400] {
                let mut block = vec![0.0; size];
                synthesize(name, 16_000, 250_000 + pieces.len() as u64, &mut block).unwrap();
                pieces.extend(block);
            }
            assert_eq!(whole, pieces);
        }
    }

    #[test]
    fn what_is_made_at_once_is_what_is_opened_alone() {
        const RATE_HZ: u32 = 9_000;
        let names = ["fan", "television", "gramophone", "clock"];
        assert!(needs_synthesis("clock", RATE_HZ) && !needs_synthesis("gramophone", RATE_HZ));
        presynthesize(&names, RATE_HZ, Threads::new(4));
        assert!(!needs_synthesis("clock", RATE_HZ));
        let opened = Signal::open("television", RATE_HZ).unwrap();
        let info = info("television").unwrap();
        let key = RandomKey::root(0).child("signals").child("television");
        let mut alone = LoopBuilder::new(f64::from(RATE_HZ), info.loop_s, key);
        (info.paint)(&mut alone);
        assert_eq!(opened.samples(), alone.normalized());
    }

    /// At the seam of a loop the step is no larger than steps inside it.
    #[test]
    #[ignore = "long: make test runs one of eight shares of these, make test-all all"]
    fn loops_have_no_seam() {
        for signal in list() {
            let opened = Signal::open(signal.name, 16_000).unwrap();
            let samples = opened.samples();
            let largest = samples
                .windows(2)
                .map(|w| (w[1] - w[0]).abs())
                .fold(0.0, f32::max);
            let seam = (samples[0] - samples[samples.len() - 1]).abs();
            assert!(seam <= largest, "{}: {seam} > {largest}", signal.name);
        }
    }

    #[test]
    fn signals_differ_and_unknown_names_are_answered_with_the_known() {
        let opened: Vec<Signal> = list()
            .iter()
            .map(|signal| Signal::open(signal.name, 8_000).unwrap())
            .collect();
        for (k, a) in opened.iter().enumerate() {
            for b in &opened[..k] {
                let n = a.samples().len().min(b.samples().len());
                let together: f64 = (0..n)
                    .map(|i| f64::from(a.samples()[i]) * f64::from(b.samples()[i]))
                    .sum::<f64>()
                    / n as f64;
                assert!(together.abs() < 0.95);
            }
        }
        let message = synthesize("gramophone", 16_000, 0, &mut [])
            .unwrap_err()
            .to_string();
        assert!(
            message.contains("gramophone") && message.contains("television"),
            "{message}"
        );
    }
}
