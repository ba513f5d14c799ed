//! Energy over time, and the numbers of ISO 3382-1 that follow from it.

use serde::Serialize;

/// Energies of one band over time: pulses and stretches of constant power.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EnergyCurve {
    /// Start, end (s) and energy of every piece; a pulse ends where it starts. By start.
    pieces: Vec<(f64, f64, f64)>,
}

/// Room-acoustic parameters of one band. `None` where the decay is too short for one, or nothing is heard.
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

    /// Adds `energy` between `start_s` and `end_s`, evenly spread. Energies that are not positive are left out.
    pub fn add(&mut self, start_s: f64, end_s: f64, energy: f64) {
        if energy > 0.0 && energy.is_finite() {
            self.pieces.push((start_s, end_s.max(start_s), energy));
        }
    }

    /// All energy.
    pub fn total(&self) -> f64 {
        self.pieces.iter().map(|piece| piece.2).sum()
    }

    /// Energy from `time_s` on: the backward integral.
    ///
    /// # Source
    /// M. R. Schroeder, JASA 37, 409 (1965).
    pub fn after(&self, time_s: f64) -> f64 {
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

    /// Time from which `arrival_s` on the energy is left in dB re all, sampled every millisecond until it ends.
    /// Shape (time,): time since `arrival_s`, s, and level, dB.
    pub fn decay_db(&self, arrival_s: f64) -> Vec<(f64, f64)> {
        const STEP_S: f64 = 1e-3;
        let end = self
            .pieces
            .iter()
            .map(|piece| piece.1)
            .fold(arrival_s, f64::max);
        let count = ((end - arrival_s) / STEP_S).ceil() as usize;
        let all = self.after(arrival_s);
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
        let mut left = 0.0;
        let mut curve = Vec::with_capacity(count);
        for (k, slot) in slots.iter().enumerate().rev() {
            left += slot;
            if left > 0.0 {
                curve.push((k as f64 * STEP_S, 10.0 * libm::log10(left / all)));
            }
        }
        curve.reverse();
        curve
    }

    /// All parameters; times count from `arrival_s`, and `direct` is the energy of the direct sound.
    ///
    /// # Source
    /// ISO 3382-1:2009, clause 5 and annex A.
    pub fn metrics(&self, arrival_s: f64, direct: f64) -> BandMetrics {
        let all = self.after(arrival_s);
        if all <= 0.0 {
            return BandMetrics::default();
        }
        let curve = self.decay_db(arrival_s);
        let late = |after_s: f64| self.after(arrival_s + after_s);
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
            edt_s: slope(&curve, 0.0, -10.0),
            t20_s: slope(&curve, -5.0, -25.0),
            t30_s: slope(&curve, -5.0, -35.0),
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

/// Time for 60 dB along the straight line through the levels between `high` and `low` (least squares), s.
fn slope(curve: &[(f64, f64)], high: f64, low: f64) -> Option<f64> {
    // The curve must go on below, or its own end bends the line.
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

    #[test]
    fn silence_has_no_numbers() {
        assert_eq!(EnergyCurve::new().metrics(0.0, 0.0), BandMetrics::default());
    }
}
