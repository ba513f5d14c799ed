//! From energies to pressure.

mod fractional;
pub(crate) mod minimum_phase;
mod noise;
mod smooth;

use crate::bands::FilterBank;
use crate::config::AcousticConfig;
use crate::echogram::{Echogram, Path};
use crate::head::{Ear, SphericalHead};
use crate::receiver::Receiver;
use dwell_scene::random::Key;
use fractional::Taps;
use minimum_phase::PathFilters;
use std::sync::OnceLock;

/// Paths whose filters are computed, the strongest first; all beyond carry less than these together.
const MOST_PATHS: usize = 200;
/// What is left of the energy where an impulse response may end: -70 dB.
const END: f64 = 1e-7;
/// How early the filters of ears begin before the delay, s: room for their ringing.
const EAR_LEAD_S: f64 = 0.001;

/// Tables for one sample rate, shared by all worlds.
#[derive(Debug)]
pub(crate) struct Synthesizer {
    rate_hz: f64,
    filters: PathFilters,
    head: SphericalHead,
    longest: usize,
    /// Filter banks for a quarter, half and all of the longest response, made when first needed.
    banks: [OnceLock<FilterBank>; 3],
}

impl Synthesizer {
    pub(crate) fn new(config: &AcousticConfig) -> Self {
        let rate_hz = f64::from(config.rate_hz);
        let filters = PathFilters::new(rate_hz);
        let speed = config.air.speed_of_sound_m_s();
        Self {
            head: SphericalHead::new(config.head_radius_m, speed, rate_hz, filters.bins()),
            longest: ((config.max_duration_s + 0.05) * rate_hz) as usize,
            banks: [const { OnceLock::new() }; 3],
            filters,
            rate_hz,
        }
    }

    /// What a head does to sound.
    pub(crate) fn head(&self) -> &SphericalHead {
        &self.head
    }

    fn bank(&self, length: usize) -> &FilterBank {
        let quarters = (4 * length).div_ceil(self.longest.max(1));
        let (place, span) = match quarters {
            0 | 1 => (0, self.longest.div_ceil(4)),
            2 => (1, self.longest.div_ceil(2)),
            _ => (2, self.longest),
        };
        self.banks[place].get_or_init(|| FilterBank::new(self.rate_hz, span.max(length), 1.0))
    }

    /// Samples that an echogram fills: until 1e-7 of its energy is left, at most the configured duration.
    fn length(&self, echogram: &Echogram) -> usize {
        let sum = |energy: &[f64]| energy.iter().sum::<f64>();
        let total = sum(&echogram.total());
        if total <= 0.0 {
            return 0;
        }
        let mut left = 0.0;
        let mut bins = echogram.tail.bins.len();
        while bins > 0 {
            left += sum(&echogram.tail.bins[bins - 1].energy);
            if left > END * total {
                break;
            }
            bins -= 1;
        }
        let tail_s = bins as f64 * echogram.tail.bin_s;
        let early_s = echogram
            .paths
            .iter()
            .map(|path| echogram.delay_s(path))
            .fold(0.0, f64::max);
        // 20 ms for the filters of the last arrivals.
        ((tail_s.max(early_s) + 0.02) * self.rate_hz).ceil() as usize
    }

    /// Pressure at the receiver, Pa for an impulse of 1 Pa at 1 m. Shape (channel, sample), flat.
    ///
    /// Sample 0 is the moment of the impulse; a free path of d metres arrives d/c later with the amplitude 1/d.
    pub(crate) fn render(&self, echogram: &Echogram, receiver: &Receiver, key: Key) -> Vec<f32> {
        let length = self.length(echogram);
        let channels = receiver.channels();
        let mut out = vec![0.0; channels * length];
        if length == 0 {
            return out;
        }
        let ears = match receiver {
            Receiver::Omni { .. } => vec![None],
            Receiver::Binaural { world_from_head } => Ear::BOTH
                .iter()
                .map(|ear| Some(world_from_head.rotation * ear.axis_in_head()))
                .collect(),
        };
        noise::add(
            &noise::Noise {
                echogram,
                rate_hz: self.rate_hz,
                length,
                head: &self.head,
                bank: self.bank(length),
            },
            &ears,
            key,
            &mut out,
        );
        // Zero-phase bands ring before their pulses: nothing may be heard before the straight way is over.
        let quiet = (echogram.direct_length_m / echogram.speed_m_s - EAR_LEAD_S) * self.rate_hz;
        let quiet = (quiet.max(0.0) as usize).min(length);
        for channel in out.chunks_exact_mut(length) {
            channel[..quiet].fill(0.0);
        }
        self.add_paths(echogram, &ears, length, &mut out);
        out
    }

    fn add_paths(
        &self,
        echogram: &Echogram,
        ears: &[Option<glam::Vec3>],
        length: usize,
        out: &mut [f32],
    ) {
        let mut strongest: Vec<&Path> = echogram.paths.iter().collect();
        if strongest.len() > MOST_PATHS {
            let power = |path: &Path| path.energy.iter().sum::<f32>();
            strongest.sort_by(|a, b| power(b).total_cmp(&power(a)));
            strongest.truncate(MOST_PATHS);
        }
        let mut fft = self.filters.fft();
        for path in strongest {
            let (spectrum, amplitude) = self.filters.spectrum(&path.energy);
            let arrival_s = path.length_m.max(crate::images::NEAREST_M) / echogram.speed_m_s;
            for (ear, channel) in ears.iter().zip(out.chunks_exact_mut(length)) {
                let mut shaded = spectrum.clone();
                let (mut delay_s, mut lead) = (arrival_s, 0);
                if let Some(axis) = ear {
                    let cosine = f64::from(axis.dot(path.arrival));
                    self.head.shade(cosine, &mut shaded);
                    delay_s += self.head.delay_s(cosine);
                    lead = (EAR_LEAD_S * self.rate_hz) as usize;
                }
                let response = PathFilters::impulse_response(&mut fft, &mut shaded, lead);
                let taps = Taps::new(delay_s * self.rate_hz);
                taps.add(channel, &response, lead, amplitude);
            }
        }
    }
}
