//! Energy over time, and the parameters of ISO 3382-1.

use serde::Serialize;
use std::f64::consts::LN_10;

/// Sampling interval of a decay curve, s.
const STEP_S: f64 = 1e-3;
/// Windows in the last third of a response, whose levels are extrapolated.
const WINDOWS: usize = 8;
/// Least slots of a window for a decay to be estimated.
const SLOTS_A_WINDOW: usize = 4;
/// Fall of the last third below which it may be noise, dB.
const FALL_DB: f64 = 2.0;
/// Least ratio of the energies of the first and the last third of a response that ends in noise.
const RANGE: f64 = 10.0;

/// Energies of one band over time: pulses and intervals of constant power.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EnergyCurve {
    /// Start, end (s) and energy of every interval; a pulse ends where it starts. Sorted by start.
    pieces: Vec<(f64, f64, f64)>,
}

/// Room-acoustic parameters of one band. `None` where nothing is heard, or the decay is too short for one: a response that
/// ends before it has fallen by 25 dB has no T20, one that ends before 35 dB no T30.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BandMetrics {
    /// Early decay time (0 to -10 dB), s for 60 dB.
    pub edt_s: Option<f64>,
    /// Reverberation time from -5 to -25 dB, s for 60 dB.
    pub t20_s: Option<f64>,
    /// Reverberation time from -5 to -35 dB, s for 60 dB.
    pub t30_s: Option<f64>,
    /// Clarity, energy before over after 50 ms, dB.
    pub c50_db: Option<f64>,
    /// Clarity at 80 ms, dB.
    pub c80_db: Option<f64>,
    /// Definition, the fraction of energy before 50 ms.
    pub d50: Option<f64>,
    /// Centre time, s.
    pub ts_s: Option<f64>,
    /// Strength re the same source at 10 m in the free field, dB.
    pub g_db: Option<f64>,
    /// Direct sound over everything else, dB.
    pub drr_db: Option<f64>,
}

impl EnergyCurve {
    /// An empty curve.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds `energy` between `start_s` and `end_s`, evenly spread. Energies that are not positive are ignored.
    pub fn add(&mut self, start_s: f64, end_s: f64, energy: f64) {
        if energy > 0.0 && energy.is_finite() {
            self.pieces.push((start_s, end_s.max(start_s), energy));
        }
    }

    /// Returns the total energy.
    pub fn total(&self) -> f64 {
        self.pieces.iter().map(|piece| piece.2).sum()
    }

    /// Returns the energy from `time_s` on: the backward integral.
    ///
    /// # Source
    /// M. R. Schroeder, JASA 37, 409 (1965).
    pub fn energy_after(&self, time_s: f64) -> f64 {
        let part = |(start, end, energy): &(f64, f64, f64)| {
            if *start >= time_s {
                *energy
            } else if *end <= time_s {
                0.0
            } else {
                energy * (end - time_s) / (end - start)
            }
        };
        self.pieces.iter().map(part).sum()
    }

    /// Returns the remaining energy from a time on, in dB re all, sampled every millisecond from `arrival_s` until it ends.
    /// Shape (time,): time since `arrival_s`, s, and level, dB.
    ///
    /// A response that ends while it still decays is extrapolated at the rate of its last third, so that the curve does not
    /// dive at the cut. A last third that does not fall is the noise of a recording: it is left as it is. Empty where
    /// neither can be determined, since all of the response falls too little.
    ///
    /// # Source
    /// ISO 3382-1:2009, clause 5.3.3 (the constant C).
    pub fn decay_db(&self, arrival_s: f64) -> Vec<(f64, f64)> {
        let end = self
            .pieces
            .iter()
            .map(|piece| piece.1)
            .fold(arrival_s, f64::max);
        let count = ((end - arrival_s) / STEP_S).ceil() as usize;
        // One backward sweep over pieces cut at the grid, instead of a sum for every time.
        let mut slots = vec![0.0; count + 1];
        for (start, stop, energy) in &self.pieces {
            let (start, stop) = ((start - arrival_s) / STEP_S, (stop - arrival_s) / STEP_S);
            if stop <= 0.0 && start < 0.0 {
                continue;
            }
            if stop - start < 1e-9 {
                slots[(start.max(0.0) as usize).min(count)] += energy;
                continue;
            }
            let first = start.max(0.0) as usize;
            let last = (stop.ceil() as usize).min(count + 1);
            for (k, slot) in slots.iter_mut().enumerate().take(last).skip(first) {
                let shared = (stop.min(k as f64 + 1.0) - start.max(k as f64)).max(0.0);
                *slot += energy * shared / (stop - start);
            }
        }
        slots.truncate(
            slots
                .iter()
                .rposition(|slot| *slot > 0.0)
                .map_or(0, |last| last + 1),
        );
        let Some(beyond) = extrapolated_tail_energy(&slots) else {
            return Vec::new();
        };
        let all = slots.iter().sum::<f64>() + beyond;
        let mut left = beyond;
        let mut curve = Vec::with_capacity(count);
        for (k, slot) in slots.iter().enumerate().rev() {
            left += slot;
            curve.push((k as f64 * STEP_S, 10.0 * libm::log10(left / all)));
        }
        curve.reverse();
        curve
    }

    /// Returns all parameters; times count from `arrival_s`, and `direct` is the energy of the direct sound.
    ///
    /// # Source
    /// ISO 3382-1:2009, clause 5 and annex A.
    pub fn metrics(&self, arrival_s: f64, direct: f64) -> BandMetrics {
        let all = self.energy_after(arrival_s);
        if all <= 0.0 {
            return BandMetrics::default();
        }
        let curve = self.decay_db(arrival_s);
        let late = |after_s: f64| self.energy_after(arrival_s + after_s);
        let clarity = |after_s: f64| {
            let late = late(after_s);
            (late > 0.0 && late < all).then(|| 10.0 * libm::log10((all - late) / late))
        };
        let moment: f64 = self
            .pieces
            .iter()
            .map(|(start, end, energy)| energy * (0.5 * (start + end) - arrival_s).max(0.0))
            .sum();
        BandMetrics {
            edt_s: reverberation_time_s(&curve, 0.0, -10.0),
            t20_s: reverberation_time_s(&curve, -5.0, -25.0),
            t30_s: reverberation_time_s(&curve, -5.0, -35.0),
            c50_db: clarity(0.05),
            c80_db: clarity(0.08),
            d50: Some(1.0 - late(0.05) / all),
            ts_s: Some(moment / all),
            g_db: Some(10.0 * libm::log10(all * 100.0)),
            drr_db: (direct > 0.0 && all - direct > 1e-12 * all)
                .then(|| 10.0 * libm::log10(direct / (all - direct))),
        }
    }
}

/// Returns the energy that a response of these energies, shape (slot,), the last above 0, would still have after its end;
/// `None` where that cannot be determined.
fn extrapolated_tail_energy(slots: &[f64]) -> Option<f64> {
    let end = slots.len();
    let width = end / (3 * WINDOWS);
    if width < SLOTS_A_WINDOW {
        return Some(0.0);
    }
    let window = |back: usize| -> f64 { slots[end - back * width..][..width].iter().sum() };
    let last: Vec<f64> = (1..=WINDOWS).rev().map(window).collect();
    if last.contains(&0.0) {
        // Single reflections, not a decay.
        return Some(0.0);
    }
    // The line fitted to the levels, in nepers of energy a window.
    let n = WINDOWS as f64;
    let middle = 0.5 * (n - 1.0);
    let level: Vec<f64> = last.iter().map(|energy| libm::log(*energy)).collect();
    let mean = level.iter().sum::<f64>() / n;
    let (mut up, mut down) = (0.0, 0.0);
    for (k, level) in level.iter().enumerate() {
        let x = k as f64 - middle;
        up += x * (level - mean);
        down += x * x;
    }
    let fall = -up / down;
    if fall * n >= FALL_DB * LN_10 / 10.0 {
        let end = libm::exp(mean - fall * (middle + 1.0));
        return Some(end / -libm::expm1(-fall));
    }
    let third = |k: usize| -> f64 { slots[k * end / 3..][..end / 3].iter().sum() };
    (third(0) >= RANGE * third(2)).then_some(0.0)
}

/// Returns the time for 60 dB along the line fitted to the levels between `high` and `low` (least squares), s.
fn reverberation_time_s(curve: &[(f64, f64)], high: f64, low: f64) -> Option<f64> {
    // The curve must continue below, or its own end bends the line.
    curve.last().filter(|(_, level)| *level < low)?;
    let inside = || {
        curve
            .iter()
            .filter(|(_, level)| (low..=high).contains(level))
    };
    let n = inside().count() as f64;
    if n < 3.0 {
        return None;
    }
    let mean_t = inside().map(|(t, _)| t).sum::<f64>() / n;
    let mean_l = inside().map(|(_, l)| l).sum::<f64>() / n;
    let covariance: f64 = inside().map(|(t, l)| (t - mean_t) * (l - mean_l)).sum();
    let variance: f64 = inside().map(|(t, _)| (t - mean_t) * (t - mean_t)).sum();
    let per_second = covariance / variance;
    (per_second < 0.0).then(|| -60.0 / per_second)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An exponential decay has closed forms for all of them.
    #[test]
    fn an_exponential_decay_gives_its_own_time() {
        let t60 = 0.7;
        let rate = 6.0 * std::f64::consts::LN_10 / t60;
        let mut curve = EnergyCurve::new();
        let width = 0.004;
        for k in 0..500 {
            let (start, end) = (0.02 + f64::from(k) * width, 0.02 + f64::from(k + 1) * width);
            let energy = libm::exp(-rate * (start - 0.02)) - libm::exp(-rate * (end - 0.02));
            curve.add(start, end, energy);
        }
        let found = curve.metrics(0.02, 0.0);
        for time in [found.edt_s, found.t20_s, found.t30_s] {
            assert!((time.unwrap() / t60 - 1.0).abs() < 5e-3, "{time:?}");
        }
        let c50 = 10.0 * libm::log10(libm::exp(rate * 0.05) - 1.0);
        assert!((found.c50_db.unwrap() - c50).abs() < 0.02);
        assert!((found.d50.unwrap() - (1.0 - libm::exp(-rate * 0.05))).abs() < 1e-3);
        assert!((found.ts_s.unwrap() - 1.0 / rate).abs() < 1e-3);
        assert_eq!(found.drr_db, None);
    }

    #[test]
    fn a_pulse_and_its_echo_have_their_ratio() {
        let mut curve = EnergyCurve::new();
        curve.add(0.01, 0.01, 4.0);
        curve.add(0.10, 0.10, 1.0);
        let found = curve.metrics(0.01, 4.0);
        assert!((found.c80_db.unwrap() - 10.0 * libm::log10(4.0)).abs() < 1e-9);
        assert!((found.drr_db.unwrap() - 10.0 * libm::log10(4.0)).abs() < 1e-9);
        assert!((found.ts_s.unwrap() - 0.018).abs() < 1e-12);
        assert!((found.g_db.unwrap() - 10.0 * libm::log10(500.0)).abs() < 1e-9);
        assert_eq!(found.t30_s, None);
    }

    fn exponential(t60: f64, end_s: f64) -> EnergyCurve {
        let rate = 6.0 * std::f64::consts::LN_10 / t60;
        let mut curve = EnergyCurve::new();
        let width = 0.004;
        for k in 0..(end_s / width) as usize {
            let (start, end) = (k as f64 * width, (k + 1) as f64 * width);
            curve.add(
                start,
                end,
                libm::exp(-rate * start) - libm::exp(-rate * end),
            );
        }
        curve
    }

    /// Wherever an exponential decay is cut: its own time, or none.
    #[test]
    fn a_decay_that_is_cut_has_its_own_time_or_none() {
        let t60 = 10.0;
        for (end_s, has_edt, has_t20, has_t30) in [
            (0.5, false, false, false),
            (1.0, false, false, false),
            (2.0, true, false, false),
            (4.0, true, false, false),
            (4.5, true, true, false),
            (6.1, true, true, true),
            (20.0, true, true, true),
        ] {
            let found = exponential(t60, end_s).metrics(0.0, 0.0);
            for (time, has) in [
                (found.edt_s, has_edt),
                (found.t20_s, has_t20),
                (found.t30_s, has_t30),
            ] {
                assert_eq!(time.is_some(), has, "{end_s}: {found:?}");
                assert!(
                    time.is_none_or(|time| (time / t60 - 1.0).abs() < 5e-3),
                    "{end_s}: {time:?}"
                );
            }
        }
    }

    /// Steady noise at the end of a recording is no decay.
    #[test]
    fn noise_at_the_end_stays_noise() {
        let mut curve = exponential(0.5, 2.0);
        let quiet = curve.decay_db(0.0).len();
        curve.add(0.0, 2.0, 1e-6);
        let found = curve.decay_db(0.0);
        assert_eq!(found.len(), quiet);
        assert!(found.last().is_some_and(|(_, level)| *level < -80.0));
        let t30 = curve.metrics(0.0, 0.0).t30_s;
        assert!(
            t30.is_some_and(|t30| (t30 / 0.5 - 1.0).abs() < 0.02),
            "{t30:?}"
        );
    }

    #[test]
    fn silence_has_no_numbers() {
        assert_eq!(EnergyCurve::new().metrics(0.0, 0.0), BandMetrics::default());
    }
}
