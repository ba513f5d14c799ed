//! Impulse responses at a receiver.

use crate::echogram::Echogram;
use crate::synthesis::CachedGains;
use serde::{Deserialize, Serialize};

/// Pressure over time at a receiver, for a source that makes an impulse of 1 Pa at 1 m.
///
/// Convolved with a source's pressure at 1 m (Pa), it gives the pressure at the receiver (Pa). Sample 0 is the time of the
/// impulse: there is no hidden delay.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ImpulseResponse {
    /// Number of channels: 1 for a microphone, 2 (left, right) for a head.
    pub channels: usize,
    /// Samples a second.
    pub rate_hz: u32,
    /// The pressure. Shape (channel, sample), one channel after the other; empty without energy.
    pub samples: Vec<f32>,
    /// The energies it was made from.
    pub echogram: Echogram,
    /// Gains that correct the level of its noise: the same for every orientation of the receiver.
    #[serde(skip)]
    pub(crate) noise_gains: CachedGains,
}

impl ImpulseResponse {
    /// Samples of one channel.
    pub fn len(&self) -> usize {
        self.samples.len() / self.channels.max(1)
    }

    /// Returns whether it is silent.
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

#[cfg(test)]
mod tests {
    use crate::{AcousticConfig, AcousticScene, Receiver, SoundSourcePose};
    use dwell_scene::Pose;
    use dwell_scene::parallel::Threads;
    use dwell_scene::random::RandomKey;
    use dwell_scene::rays::RayScene;
    use glam::Vec3;
    use std::sync::Arc;

    /// A head that turned hears what a head that arrived so turned hears, to the bit.
    #[test]
    fn a_turned_head_hears_what_one_that_came_so_hears() {
        let house = Arc::new(dwell_houses::open("builtin:apartment").unwrap().0);
        let rays = RayScene::new(house.clone());
        let scene = AcousticScene::new(house, AcousticConfig::rl()).unwrap();
        let (place, key) = (Vec3::new(2.0, 1.5, 2.0), RandomKey::root(4));
        let source = SoundSourcePose::omni(place + 0.5 * Vec3::X);
        let echogram = scene
            .echogram(&rays, &source, place, key, Threads::ONE)
            .unwrap();
        for order in [None, Some(1)] {
            let head = |yaw| {
                let pose = Pose::from_position_yaw(place, yaw);
                order.map_or_else(
                    || Receiver::binaural(pose),
                    |order| Receiver::ambisonics(pose, order),
                )
            };
            let before = scene.response_before_microphones(echogram.clone(), &head(0.0), None, key);
            let turned = scene.rotated_response(&before, &head(1.0), key);
            assert!(turned.samples.iter().any(|x| *x != 0.0) && turned.samples != before.samples);
            assert_eq!(
                turned,
                scene.response_before_microphones(echogram.clone(), &head(1.0), None, key)
            );
            assert!(turned.noise_gains.are_shared_with(&before.noise_gains));
        }
        // A receiver without channels.
        let nobody = Receiver::array(Pose::from_position(place), Vec::new());
        assert!(
            scene
                .response_before_microphones(echogram, &nobody, None, key)
                .samples
                .is_empty()
        );
    }
}
