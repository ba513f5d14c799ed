//! Measured impulse responses of a head.

use crate::error::AcousticsError;
use crate::head::Ear;
use glam::DVec3;
use std::collections::BTreeMap;
use xxhash_rust::xxh3::Xxh3;

/// Most directions of a measurement.
const MOST_DIRECTIONS: usize = 20_000;
/// Fewest samples of a response, and most.
const SAMPLES: std::ops::RangeInclusive<usize> = 16..=65_536;
/// Most numbers of all responses together: 1 GiB.
const MOST_NUMBERS: usize = 1 << 28;
/// Distance below which directions are one, as chords: 0.05 degrees.
pub(super) const SAME_DIRECTION_CHORD: f64 = 8.7e-4;

/// Impulse responses from places around a head to its ears, in an anechoic room; the input of
/// [`Head::measured`](super::super::Head::measured).
///
/// Only directions count: sources are taken as distant. Of places in one direction the farthest is used.
///
/// Processing:
/// - **Level**: one gain for both ears and all directions, such that from 200 to 500 Hz, where a head is small, the energy
///   over all directions is that at a sphere. So a source of 1 Pa at 1 m gives at an ear the pressure at the head's centre
///   without the head, times the head's response; the gain of the measurement's loudspeaker and microphones drops out. Their
///   response remains, except below 160 Hz, where such loudspeakers fail and a head has no effect: one filter of minimum phase
///   for both ears and all directions makes the mean level there that at 200 to 500 Hz (by at most 26 dB); the remaining
///   difference is noise, and is faded out down to 80 Hz, below which the head only delays, as it does from 160 to 320 Hz.
/// - **Time**: one delay for both ears and all directions is removed, such that the remaining one is that of a sphere around
///   the head's centre; the sphere's radius is fitted.
/// - **Between directions**: each response is split into its delay and a remainder, both are interpolated over the triangle
///   around the direction (delay, modulus and phase of the remainder), and measured directions are reproduced exactly.
/// - **Unmeasured directions** (none within 25 degrees) have the response of a sphere of the fitted radius, with the level and
///   delay by which the nearest measured directions differ from it.
/// - **Above half of its sample rate** modulus and phase stay as they are at 0.46 of it.
#[derive(Clone, Debug, PartialEq)]
pub struct HrirMeasurement {
    /// Positions of the sources in head space (forward -Z, left -X, up +Y), m. Shape (direction,); 4 to 20,000.
    pub sources: Vec<DVec3>,
    /// The responses, Pa. Shape (direction, ear, sample), flat; 16 to 65,536 samples.
    pub responses: Vec<f32>,
    /// Delays before the responses, samples. Shape (direction, ear), or empty for none.
    pub delays_samples: Vec<f64>,
    /// Samples a second, Hz; 8,000 to 384,000.
    pub rate_hz: f64,
}

/// The responses measured from one direction.
pub(super) struct MeasuredDirection<'a> {
    /// Unit length.
    pub(super) direction: DVec3,
    /// Shape (ear,).
    pub(super) responses: [&'a [f32]; 2],
    /// s. Shape (ear,).
    pub(super) delay_s: [f64; 2],
}

/// Samples below this fraction of the peak come before a response, and not this late, s: half of the window of the onset.
const QUIET: f32 = 1e-3;
const LATEST_S: f64 = 0.02;

fn refuse<T>(why: String) -> Result<T, AcousticsError> {
    Err(AcousticsError::Head(why))
}

impl HrirMeasurement {
    fn samples(&self) -> usize {
        self.responses.len() / (2 * self.sources.len()).max(1)
    }

    /// Returns a hash of its contents.
    pub(crate) fn hash(&self) -> u64 {
        let mut hash = Xxh3::new();
        hash.update(b"measured");
        hash.update(&self.rate_hz.to_le_bytes());
        hash.update(&(self.sources.len() as u64).to_le_bytes());
        for source in &self.sources {
            for x in source.to_array() {
                hash.update(&x.to_le_bytes());
            }
        }
        for x in &self.responses {
            hash.update(&x.to_le_bytes());
        }
        hash.update(&(self.samples() as u64).to_le_bytes());
        // Missing delays are zero delays.
        if self.delays_samples.iter().any(|x| *x != 0.0) {
            for x in &self.delays_samples {
                hash.update(&x.to_le_bytes());
            }
        }
        hash.digest()
    }

    /// Returns one row for each direction, in the order of the sources.
    pub(super) fn measured_directions(&self) -> Result<Vec<MeasuredDirection<'_>>, AcousticsError> {
        self.check()?;
        let samples = self.samples();
        let mut kept: Vec<(f64, MeasuredDirection<'_>)> = Vec::new();
        // By cells as wide as the least distance of directions, so that only neighbouring cells are searched.
        let cell = |d: DVec3| (d / SAME_DIRECTION_CHORD).floor().as_i64vec3().to_array();
        let mut known: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
        for (k, source) in self.sources.iter().enumerate() {
            let distance_m = source.length();
            let direction = *source / distance_m;
            let response = |ear: usize| {
                let first = (2 * k + ear) * samples;
                &self.responses[first..first + samples]
            };
            let delay_s = |ear: usize| {
                let delay = self.delays_samples.get(2 * k + ear);
                delay.copied().unwrap_or(0.0) / self.rate_hz
            };
            let row = MeasuredDirection {
                direction,
                responses: [response(0), response(1)],
                delay_s: [delay_s(0), delay_s(1)],
            };
            let [x, y, z] = cell(direction);
            let around = (0..27).map(|n| [x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1]);
            let mut near = around.filter_map(|place| known.get(&place)).flatten();
            let same =
                near.find(|j| kept[**j].1.direction.distance(direction) < SAME_DIRECTION_CHORD);
            match same.copied() {
                Some(j) if kept[j].0 >= distance_m => {}
                // It keeps the place of the first, so that the cells stay right.
                Some(j) => {
                    let place = kept[j].1.direction;
                    kept[j] = (
                        distance_m,
                        MeasuredDirection {
                            direction: place,
                            ..row
                        },
                    );
                }
                None => {
                    known.entry([x, y, z]).or_default().push(kept.len());
                    kept.push((distance_m, row));
                }
            }
        }
        if kept.len() < 4 {
            return refuse(format!(
                "{} different directions; at least 4 are needed",
                kept.len()
            ));
        }
        Ok(kept.into_iter().map(|(_, row)| row).collect())
    }

    fn check(&self) -> Result<(), AcousticsError> {
        let (directions, samples) = (self.sources.len(), self.samples());
        if !(4..=MOST_DIRECTIONS).contains(&directions) {
            return refuse(format!("{directions} directions; allowed are 4 to 20000"));
        }
        if self.responses.len() != 2 * directions * samples {
            return refuse(format!(
                "{} samples do not share out among {directions} directions and 2 ears",
                self.responses.len()
            ));
        }
        if !SAMPLES.contains(&samples) || self.responses.len() > MOST_NUMBERS {
            return refuse(format!(
                "{samples} samples a response; allowed are 16 to 65536, and 268435456 in all"
            ));
        }
        if !(8_000.0..=384_000.0).contains(&self.rate_hz) {
            return refuse(format!(
                "a sample rate of {} Hz; allowed are 8000 to 384000",
                self.rate_hz
            ));
        }
        let delays = self.delays_samples.len();
        if delays != 0 && delays != 2 * directions {
            return refuse(format!(
                "{delays} delays; one for each direction and ear would be {}",
                2 * directions
            ));
        }
        let is_short = |x: &f64| x.abs() <= self.rate_hz;
        if let Some(delay) = self.delays_samples.iter().find(|x| !is_short(x)) {
            return refuse(format!(
                "a delay of {delay} samples; allowed is up to a second"
            ));
        }
        for (k, source) in self.sources.iter().enumerate() {
            let distance_m = source.length();
            if !(1e-3..1e6).contains(&distance_m) {
                return refuse(format!(
                    "source {k} is at {source}; allowed are 0.001 to 1000000 m from the head's centre"
                ));
            }
        }
        for (k, response) in self.responses.chunks_exact(samples).enumerate() {
            let (direction, ear) = (k / 2, Ear::BOTH[k % 2]);
            let at = format!("the {ear:?} ear's response from direction {direction}");
            if response.iter().any(|x| !x.is_finite() || x.abs() > 1e9) {
                return refuse(format!("{at} has values that are not finite"));
            }
            if response.iter().all(|x| x.abs() < 1e-12) {
                return refuse(format!("{at} is silent"));
            }
            let peak = response.iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
            let begins = response.iter().position(|x| x.abs() > QUIET * peak);
            let begins_s = begins.unwrap_or(0) as f64 / self.rate_hz;
            if begins_s > LATEST_S {
                return refuse(format!(
                    "{at} begins after {begins_s:.3} s; allowed are 0.02 s, and the rest as a delay"
                ));
            }
        }
        Ok(())
    }
}
