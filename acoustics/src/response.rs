//! What a receiver hears of an impulse.

use crate::echogram::Echogram;
use serde::{Deserialize, Serialize};

/// Pressure over time at a receiver, for a source that makes an impulse of 1 Pa at 1 m.
///
/// Convolved with a source's pressure at 1 m (Pa), it gives the pressure at the receiver (Pa). Sample 0 is the moment of the
/// impulse: there is no hidden delay.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ImpulseResponse {
    /// How many channels there are: 1 for a microphone, 2 (left, right) for a head.
    pub channels: usize,
    /// Samples a second.
    pub rate_hz: u32,
    /// The pressure. Shape (channel, sample), one channel after the other; empty where nothing is heard.
    pub samples: Vec<f32>,
    /// The energies it was made from.
    pub echogram: Echogram,
}

impl ImpulseResponse {
    /// Samples of one channel.
    pub fn len(&self) -> usize {
        self.samples.len() / self.channels.max(1)
    }

    /// Whether nothing is heard.
    pub fn is_empty(&self) -> bool {
        self.samples.is_empty()
    }

    /// The samples of channel `channel`; none beyond the last.
    pub fn channel(&self, channel: usize) -> &[f32] {
        let length = self.len();
        self.samples
            .get(channel * length..(channel + 1) * length)
            .unwrap_or(&[])
    }

    /// Duration, s.
    pub fn duration_s(&self) -> f64 {
        self.len() as f64 / f64::from(self.rate_hz.max(1))
    }
}
