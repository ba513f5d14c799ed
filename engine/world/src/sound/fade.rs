//! Levels that change without a click.

use serde::{Deserialize, Serialize};

/// Duration of a change of level, s.
const RAMP_S: f64 = 0.005;

/// The amplitude at the beginning and at the end of the block that ended last.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct GainRamp {
    before: f32,
    now: f32,
}

impl GainRamp {
    pub(super) fn steady(amplitude: f32) -> Self {
        Self {
            before: amplitude,
            now: amplitude,
        }
    }

    /// Fades to `target` in the block that ends now.
    pub(super) fn update(&mut self, target: f32) {
        (self.before, self.now) = (self.now, target);
    }

    pub(super) fn is_silent(&self) -> bool {
        self.before == 0.0 && self.now == 0.0
    }

    /// Multiplies the block that ended last.
    pub(super) fn apply(&self, rate_hz: u32, block: &mut [f32]) {
        let length = ((RAMP_S * f64::from(rate_hz)) as usize).clamp(1, block.len().max(1));
        for (k, sample) in block.iter_mut().enumerate() {
            let share = ((k + 1) as f32 / length as f32).min(1.0);
            // Exact at both ends.
            *sample *= if self.before == self.now {
                self.now
            } else {
                self.before * (1.0 - share) + self.now * share
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_changes_within_five_milliseconds_and_in_small_steps() {
        let mut fade = GainRamp::steady(1.0);
        let mut block = vec![1.0; 800];
        fade.apply(16_000, &mut block);
        assert!(block.iter().all(|x| *x == 1.0));
        fade.update(0.0);
        fade.apply(16_000, &mut block);
        let largest = block.windows(2).map(|w| (w[1] - w[0]).abs());
        assert!(largest.fold(1.0 - block[0], f32::max) < 0.0126);
        assert!(block[78] > 0.0 && block[79..].iter().all(|x| *x == 0.0));
        assert!(!fade.is_silent());
        fade.update(0.0);
        assert!(fade.is_silent());
    }
}
