//! A quantity by frequency, at arbitrary band centres.

use crate::error::SceneError;
use serde::{Deserialize, Serialize};

/// Values of a quantity at band centres; between them linear in the logarithm of frequency, outside constant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bands {
    /// Band centres, Hz, rising. Shape (band,).
    pub centres_hz: Vec<f32>,
    /// The quantity at each centre. Shape (band,).
    pub values: Vec<f32>,
}

impl Bands {
    /// The octave bands 125 Hz to 8 kHz, at which most tables are printed.
    pub const OCTAVES_HZ: [f32; 7] = [125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0];

    /// The same value at every frequency.
    pub fn constant(value: f32) -> Self {
        Self {
            centres_hz: vec![1000.0],
            values: vec![value],
        }
    }

    /// Values at the octaves 125 Hz to 8 kHz.
    pub fn octaves(values: [f32; 7]) -> Self {
        Self {
            centres_hz: Self::OCTAVES_HZ.to_vec(),
            values: values.to_vec(),
        }
    }

    /// The value at `frequency_hz`.
    pub fn at(&self, frequency_hz: f32) -> f32 {
        let above = self
            .centres_hz
            .partition_point(|centre| *centre < frequency_hz);
        match (above.checked_sub(1), self.values.get(above)) {
            (Some(below), Some(high)) => {
                let (f0, f1) = (self.centres_hz[below], self.centres_hz[above]);
                let t = crate::math::ln(frequency_hz / f0) / crate::math::ln(f1 / f0);
                self.values[below] + t * (high - self.values[below])
            }
            (None, Some(first)) => *first,
            (_, None) => self.values.last().copied().unwrap_or(0.0),
        }
    }

    /// Checks that centres rise, lengths agree and all values lie in `low..=high`.
    ///
    /// # Errors
    /// [`SceneError::Bands`] with what was found.
    pub fn check(&self, at: &str, low: f32, high: f32) -> Result<(), SceneError> {
        let rising = self.centres_hz.windows(2).all(|pair| pair[0] < pair[1])
            && self.centres_hz.first().is_some_and(|f| *f > 0.0);
        let in_range = self.values.iter().all(|value| (low..=high).contains(value));
        if !rising || !in_range || self.centres_hz.len() != self.values.len() {
            let what = format!(
                "centres {:?} Hz with values {:?}, allowed {low} to {high}",
                self.centres_hz, self.values
            );
            return Err(SceneError::Bands {
                at: at.to_owned(),
                what,
            });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_met_at_centres_and_lie_between_them() {
        let bands = Bands::octaves([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]);
        assert!((bands.at(1000.0) - 0.4).abs() < 1e-6);
        assert!((bands.at(1_414.213_6) - 0.45).abs() < 1e-5);
        assert!((bands.at(20.0) - 0.1).abs() < 1e-6 && (bands.at(20_000.0) - 0.7).abs() < 1e-6);
        assert!(
            Bands {
                centres_hz: vec![500.0, 250.0],
                values: vec![0.0, 0.0]
            }
            .check("x", 0.0, 1.0)
            .is_err()
        );
    }
}
