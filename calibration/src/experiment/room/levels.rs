//! Features of an impulse response: levels in bands and windows of time.

use crate::bundle::MeasuredResponse;
use dwell_acoustics::Echogram;
use dwell_acoustics::bands::{BAND_COUNT, FilterBank, NOMINAL_CENTRES_HZ};

/// Edges of the windows after the direct sound, s.
pub(super) const EDGES_S: [f64; 10] = [
    -0.004, 0.004, 0.008, 0.013, 0.02, 0.03, 0.045, 0.07, 0.11, 0.17,
];
/// The windows.
pub(super) const WINDOWS: usize = EDGES_S.len() - 1;
/// The lowest band whose filter is short enough for the windows: 250 Hz.
pub(super) const FIRST_BAND: usize = 2;
/// Overlap of the filters, as `power_shares` means it.
const OVERLAP: f64 = 1.0;
/// Length of the filters' smear that is followed, to each side, s.
const SMEAR_S: f64 = 0.03;
/// Energy under the strongest window of a band that counts as nothing.
const FLOOR: f64 = 1e-5;
/// The onset is where the response first reaches this part of its peak.
const ONSET: f32 = 0.2;

/// The bands that a response at `rate_hz` holds whole.
pub(super) fn bands(rate_hz: u32) -> std::ops::Range<usize> {
    let whole =
        |centre: &&f32| f64::from(**centre) * std::f64::consts::SQRT_2 < 0.5 * f64::from(rate_hz);
    FIRST_BAND..NOMINAL_CENTRES_HZ.iter().filter(whole).count()
}

/// Returns the arrival time of the direct sound, s from the first sample: the first sample near the peak, refined to a fraction of a
/// sample by the parabola through the largest of the next few.
pub(super) fn onset_s(response: &MeasuredResponse) -> f64 {
    let samples = &response.samples;
    let peak = samples.iter().fold(0.0_f32, |peak, s| peak.max(s.abs()));
    let first = samples
        .iter()
        .position(|s| s.abs() >= ONSET * peak)
        .unwrap_or(0);
    let end = (first + 4).min(samples.len());
    let top = (first..end)
        .max_by(|a, b| samples[*a].abs().total_cmp(&samples[*b].abs()))
        .unwrap_or(first);
    let at = |k: usize| f64::from(samples.get(k).copied().unwrap_or(0.0).abs());
    let shift = if top > 0 {
        let (a, b, c) = (at(top - 1), at(top), at(top + 1));
        let bend = a - 2.0 * b + c;
        if bend < 0.0 {
            (0.5 * (a - c) / bend).clamp(-0.5, 0.5)
        } else {
            0.0
        }
    } else {
        0.0
    };
    (top as f64 + shift) / f64::from(response.rate_hz)
}

/// Levels of a response, dB, by band, then window.
pub(super) fn measured_db(response: &MeasuredResponse) -> Vec<f64> {
    let rate = f64::from(response.rate_hz);
    let onset = onset_s(response);
    // The part after the last window costs time and says nothing.
    let needed = ((onset + EDGES_S[WINDOWS] + SMEAR_S) * rate) as usize + 1;
    let samples = &response.samples[..needed.min(response.samples.len())];
    let split = FilterBank::new(rate, samples.len(), OVERLAP).split(samples);
    let mut levels = Vec::new();
    for band in bands(response.rate_hz) {
        let energies: Vec<f64> = EDGES_S
            .windows(2)
            .map(|edges| {
                let place = |edge: f64| {
                    (((onset + edge) * rate).round().max(0.0) as usize).min(samples.len())
                };
                let window = &split[band][place(edges[0])..place(edges[1])];
                window.iter().map(|s| f64::from(*s).powi(2)).sum()
            })
            .collect();
        levels.extend(decibels(&energies));
    }
    levels
}

fn decibels(energies: &[f64]) -> impl Iterator<Item = f64> {
    let floor = FLOOR * energies.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    energies.iter().map(move |e| 10.0 * (e + floor).log10())
}

/// The smear of an impulse by the filters of the bands: the share of its energy that has come until a time.
pub(super) struct FilterRingingModel {
    rate_hz: u32,
    /// From -`SMEAR_S` on, a value a sample. Shape (band, sample).
    shares: Vec<Vec<f64>>,
}

impl FilterRingingModel {
    pub(super) fn new(rate_hz: u32) -> Self {
        let half = (SMEAR_S * f64::from(rate_hz)) as usize;
        let mut impulse = vec![0.0; 2 * half + 1];
        impulse[half] = 1.0;
        let split = FilterBank::new(f64::from(rate_hz), impulse.len(), OVERLAP).split(&impulse);
        let shares = split
            .iter()
            .map(|band| {
                let total: f64 = band.iter().map(|s| f64::from(*s).powi(2)).sum();
                let mut sum = 0.0;
                band.iter()
                    .map(|s| {
                        sum += f64::from(*s).powi(2) / total.max(f64::MIN_POSITIVE);
                        sum
                    })
                    .collect()
            })
            .collect();
        Self { rate_hz, shares }
    }

    /// The share of an impulse's energy that has come `t_s` after it.
    fn cumulative_energy(&self, band: usize, t_s: f64) -> f64 {
        let shares = &self.shares[band];
        let place = (t_s + SMEAR_S) * f64::from(self.rate_hz);
        if place <= 0.0 {
            return 0.0;
        }
        let k = place.floor() as usize;
        match (shares.get(k), shares.get(k + 1)) {
            (Some(a), Some(b)) => a + (place - k as f64) * (b - a),
            _ => 1.0,
        }
    }

    /// Levels of an echogram, dB, by band, then window, as [`measured_db`] has them, with all times `stretch` times as long, and
    /// with `more_decay_per_m` (1/m, by band) on every way besides the air's.
    pub(super) fn simulated_db(
        &self,
        echogram: &Echogram,
        stretch: f64,
        more_decay_per_m: &[f64; BAND_COUNT],
    ) -> Vec<f64> {
        let direct_s = echogram.direct_length_m / echogram.speed_m_s;
        let mut arrivals: Vec<(f64, [f64; BAND_COUNT])> = echogram
            .paths
            .iter()
            .map(|path| {
                (
                    echogram.delay_s(path) - direct_s,
                    path.energy.map(f64::from),
                )
            })
            .collect();
        let bin_s = echogram.tail.bin_s;
        let bins = echogram.tail.bins.iter().enumerate();
        arrivals.extend(bins.map(|(k, bin)| ((k as f64 + 0.5) * bin_s - direct_s, *bin)));
        if more_decay_per_m.iter().any(|m| *m != 0.0) {
            for (t_s, energy) in &mut arrivals {
                let way_m = (*t_s + direct_s) * echogram.speed_m_s;
                for (energy, m) in energy.iter_mut().zip(more_decay_per_m) {
                    *energy *= libm::exp(-m * way_m);
                }
            }
        }
        for (t_s, _) in &mut arrivals {
            *t_s *= stretch;
        }
        let mut levels = Vec::new();
        for band in bands(self.rate_hz) {
            let mut energies = [0.0; WINDOWS];
            for (t_s, energy) in &arrivals {
                if energy[band] == 0.0 || *t_s > EDGES_S[WINDOWS] + SMEAR_S {
                    continue;
                }
                let mut before = self.cumulative_energy(band, EDGES_S[0] - t_s);
                for (window, edge) in EDGES_S[1..].iter().enumerate() {
                    let after = self.cumulative_energy(band, edge - t_s);
                    energies[window] += energy[band] * (after - before);
                    before = after;
                }
            }
            levels.extend(decibels(&energies));
        }
        levels
    }
}

/// Returns the random deviation of a level, dB: with B T degrees of freedom the energy of overlapping arrivals spreads by 1/sqrt(B T)
/// of itself.
///
/// # Source
/// M. R. Schroeder, JASA 45, 1077 (1969): statistics of band-limited decays.
pub(super) fn level_sd_db(band: usize, window: usize) -> f64 {
    let width_hz = f64::from(NOMINAL_CENTRES_HZ[band]) * std::f64::consts::FRAC_1_SQRT_2;
    let length_s = EDGES_S[window + 1] - EDGES_S[window];
    10.0 / std::f64::consts::LN_10 / (width_hz * length_s).max(1.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_acoustics::PropagationPath;
    use glam::Vec3;

    /// Two echoes far enough apart not to interfere: the levels of their samples equal those of their energies.
    #[test]
    fn levels_of_samples_equal_levels_of_energies() {
        let rate_hz = 16_000;
        let mut samples = vec![0.0; 4000];
        samples[160] = 0.5;
        samples[160 + 400] = 0.25;
        let response = MeasuredResponse {
            source_m: [0.0; 3],
            receiver_m: [0.0; 3],
            rate_hz,
            samples,
        };
        let speed = 343.2;
        let path = |delay_s: f64, energy: f32| PropagationPath {
            planes: vec![],
            diffraction_points: Vec::new(),
            length_m: delay_s * speed,
            energy: [energy; BAND_COUNT],
            arrival: Vec3::X,
            departure: Vec3::X,
            walls: 0,
            inverted: false,
        };
        let echogram = Echogram {
            paths: vec![path(0.01, 0.25), path(0.035, 0.0625)],
            direct_length_m: 0.01 * speed,
            speed_m_s: speed,
            ..Echogram::default()
        };
        let (a, b) = (
            measured_db(&response),
            FilterRingingModel::new(rate_hz).simulated_db(&echogram, 1.0, &[0.0; BAND_COUNT]),
        );
        assert_eq!(a.len(), bands(rate_hz).len() * WINDOWS);
        for band in 0..bands(rate_hz).len() {
            // Direct sound and echo; sources differ by a constant in each band.
            let (first, echo) = (band * WINDOWS, band * WINDOWS + 4);
            let offset = a[first] - b[first];
            assert!(
                (a[echo] - b[echo] - offset).abs() < 0.3,
                "band {band}: {} {}",
                a[echo] - offset,
                b[echo]
            );
        }
    }
}
