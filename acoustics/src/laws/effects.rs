//! What laws change of the way from a source to a microphone.

use crate::air::Air;
use crate::bands::{BAND_COUNT, Banded};
use crate::config::AcousticConfig;
use crate::echogram::Echogram;
use serde::{Deserialize, Serialize};

/// All that laws do to air and sources; the default changes nothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Effects {
    /// How much warmer the air is than it is said to be, K.
    pub(super) warmer_k: f64,
    /// The share of the air's absorption that there is, 0 to 1.
    pub(super) air_absorption: f64,
    /// Level of all sources above what it is said to be, dB. Shape (band,).
    pub(super) source_db: Banded,
}

impl Default for Effects {
    fn default() -> Self {
        Self {
            warmer_k: 0.0,
            air_absorption: 1.0,
            source_db: [0.0; BAND_COUNT],
        }
    }
}

impl Effects {
    /// The settings with the air as it is, kept within what [`Air::check`] allows.
    pub(crate) fn config(&self, stated: &AcousticConfig) -> AcousticConfig {
        let temperature_c = stated.air.temperature_c + self.warmer_k;
        AcousticConfig {
            air: Air {
                temperature_c: temperature_c.clamp(-40.0, 60.0),
                ..stated.air
            },
            ..*stated
        }
    }

    /// Energy decay in air, 1/m, as far as there is any. Shape (band,).
    pub(crate) fn air_decay_per_m(&self, whole: [f64; BAND_COUNT]) -> [f64; BAND_COUNT] {
        whole.map(|m| self.air_absorption * m)
    }

    /// The energies of sources as they are.
    pub(crate) fn at_source(&self, echogram: &mut Echogram) {
        if self.source_db == [0.0; BAND_COUNT] {
            return;
        }
        let gain = self.source_db.map(|db| libm::powf(10.0, db / 10.0));
        for path in &mut echogram.paths {
            for (energy, gain) in path.energy.iter_mut().zip(gain) {
                *energy *= gain;
            }
        }
        for bin in &mut echogram.tail.bins {
            for (energy, gain) in bin.iter_mut().zip(gain) {
                *energy *= f64::from(gain);
            }
        }
    }
}
