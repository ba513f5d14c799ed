//! Effects of laws on the path from a source to a microphone.

use crate::air::Air;
use crate::bands::{self, BAND_COUNT, BandValues};
use crate::config::AcousticConfig;
use crate::directivity::TabulatedPattern;
use crate::echogram::{Echogram, PropagationPath};
use crate::receiver::{Receiver, SoundSourcePose};
use dwell_scene::math::sin_cos;
use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

/// All effects of laws on air and sources; the default changes nothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct PathEffects {
    /// Difference of the true from the stated air temperature, K.
    pub(super) temperature_error_k: f64,
    /// Difference of the true from the stated relative humidity, %.
    #[serde(default)]
    pub(super) humidity_error_pct: f64,
    /// Share of the air's absorption, 0 to 1.
    pub(super) air_absorption: f64,
    /// Level of all sources above the stated one, dB. Shape (band,).
    pub(super) source_db: BandValues,
    /// Rotation of sources against their stated orientation, degrees: yaw (to the left), pitch (up), in their own axes.
    pub(super) source_rotation_deg: [f32; 2],
    /// Exponent of their patterns above 1.
    pub(super) source_sharpness: f32,
    /// Attenuation behind sources at 1 kHz, besides their patterns, dB.
    pub(super) source_beam_db: f32,
    /// Offset of receivers from their stated position, m, in their own axes.
    pub(super) receiver_offset_m: [f32; 3],
    /// Rotation of receivers, degrees: yaw (to the left), pitch (up), roll (to the left), in their own axes.
    pub(super) receiver_rotation_deg: [f32; 3],
}

/// Returns the rotation about the vertical (to the left), then about the sideways axis (up), then about the axis to the back.
fn rotation_from_euler_deg([yaw_deg, pitch_deg, roll_deg]: [f32; 3]) -> Quat {
    let about = |axis: Vec3, degrees: f32| {
        let (s, c) = sin_cos(0.5 * degrees.to_radians());
        Quat::from_xyzw(axis.x * s, axis.y * s, axis.z * s, c)
    };
    about(Vec3::Y, yaw_deg) * about(Vec3::X, pitch_deg) * about(Vec3::Z, roll_deg)
}

impl Default for PathEffects {
    fn default() -> Self {
        Self {
            temperature_error_k: 0.0,
            humidity_error_pct: 0.0,
            air_absorption: 1.0,
            source_db: [0.0; BAND_COUNT],
            source_rotation_deg: [0.0; 2],
            source_sharpness: 0.0,
            source_beam_db: 0.0,
            receiver_offset_m: [0.0; 3],
            receiver_rotation_deg: [0.0; 3],
        }
    }
}

impl PathEffects {
    /// Returns the settings with the true air, kept within the range of [`Air::check`].
    pub(crate) fn effective_config(&self, stated: &AcousticConfig) -> AcousticConfig {
        let temperature_c = stated.air.temperature_c + self.temperature_error_k;
        let humidity_pct = stated.air.humidity_pct + self.humidity_error_pct;
        AcousticConfig {
            air: Air {
                temperature_c: temperature_c.clamp(-40.0, 60.0),
                humidity_pct: humidity_pct.clamp(0.0, 100.0),
                ..stated.air
            },
            ..*stated
        }
    }

    /// Returns the energy decay in air, 1/m, with this share. Shape (band,).
    pub(crate) fn air_decay_per_m(&self, whole: [f64; BAND_COUNT]) -> [f64; BAND_COUNT] {
        whole.map(|m| self.air_absorption * m)
    }

    /// Returns the share of the air's absorption, 0 to 1.
    pub(crate) fn air_absorption_share(&self) -> f64 {
        self.air_absorption
    }

    /// Returns the direction of a source's axis, unit length, and its gains around it, in air with `speed_m_s`.
    pub(crate) fn source_axis_and_pattern(
        &self,
        source: &SoundSourcePose,
        speed_m_s: f64,
    ) -> (Vec3, TabulatedPattern) {
        let pattern = source.directivity.pattern(speed_m_s);
        let axis = match self.source_rotation_deg {
            [0.0, 0.0] => source.axis(),
            [yaw_deg, pitch_deg] => {
                source.pose.rotation
                    * (rotation_from_euler_deg([yaw_deg, pitch_deg, 0.0]) * Vec3::NEG_Z)
            }
        };
        if self.source_sharpness == 0.0 && self.source_beam_db == 0.0 {
            return (axis, pattern);
        }
        let behind_db: BandValues = std::array::from_fn(|band| {
            let ratio = bands::exact_centre_hz(band) / 1000.0;
            self.source_beam_db * (2.0 * ratio / (1.0 + ratio)) as f32
        });
        let pattern = pattern.map_gains(|cosine, gain| {
            std::array::from_fn(|band| {
                let own = gain[band];
                let sharp = if self.source_sharpness == 0.0 || own == 0.0 {
                    own
                } else {
                    own * libm::powf(own.abs(), self.source_sharpness)
                };
                let down_db = 0.5 * (1.0 - cosine) * behind_db[band];
                sharp * libm::powf(10.0, -down_db / 20.0)
            })
        });
        (axis, pattern)
    }

    /// Returns a receiver at its true pose.
    pub(crate) fn true_receiver(&self, receiver: &Receiver) -> Receiver {
        let mut placed = receiver.clone();
        let rotation = receiver.pose.rotation;
        if self.receiver_offset_m != [0.0; 3] {
            placed.pose.position += rotation * Vec3::from_array(self.receiver_offset_m);
        }
        if self.receiver_rotation_deg != [0.0; 3] {
            placed.pose.rotation = rotation * rotation_from_euler_deg(self.receiver_rotation_deg);
        }
        placed
    }

    /// Applies sources' effects to all energies.
    pub(crate) fn apply_to_echogram(&self, echogram: &mut Echogram) {
        if self.source_db == [0.0; BAND_COUNT] {
            return;
        }
        self.apply_to_paths(&mut echogram.paths);
        let gain = self.source_gain();
        for bin in &mut echogram.tail.bins {
            for (energy, gain) in bin.iter_mut().zip(gain) {
                *energy *= f64::from(gain);
            }
        }
    }

    /// Applies sources' effects to the energies of early paths.
    pub(crate) fn apply_to_paths(&self, paths: &mut [PropagationPath]) {
        if self.source_db == [0.0; BAND_COUNT] {
            return;
        }
        let gain = self.source_gain();
        for path in paths {
            for (energy, gain) in path.energy.iter_mut().zip(gain) {
                *energy *= gain;
            }
        }
    }

    fn source_gain(&self) -> BandValues {
        self.source_db.map(|db| libm::powf(10.0, db / 10.0))
    }
}
