//! Far-field response of a receiver's channel.

use crate::bands::{BAND_COUNT, BandValues};
use crate::directivity::TabulatedPattern;
use crate::head::{HeadSet, PlacedEar};
use crate::receiver::{Receiver, ReceiverKind};
use glam::{Quat, Vec3};
use realfft::num_complex::Complex;

/// The response of a channel to a plane wave.
pub(crate) struct ChannelResponse {
    /// Gain of amplitude; negative where pressure is inverted. Shape (band,).
    pub(crate) gain: BandValues,
    /// Against the receiver's centre, s.
    pub(crate) delay: Delay,
}

/// Delay of a wave at a channel, re the receiver's centre, s.
pub(crate) enum Delay {
    None,
    Constant(f32),
    Banded(BandValues),
}

impl Delay {
    /// Returns the delay in each band, s.
    pub(crate) fn per_band(&self) -> BandValues {
        match self {
            Self::None => [0.0; BAND_COUNT],
            Self::Constant(delay_s) => [*delay_s; BAND_COUNT],
            Self::Banded(delay_s) => *delay_s,
        }
    }
}

/// One channel of a receiver.
#[derive(Clone, Debug)]
pub(crate) enum ReceiverChannel {
    /// Omnidirectional.
    Omni,
    /// An ear of a head.
    Ear(PlacedEar),
    /// A microphone off the centre, with its axis.
    Microphone {
        offset: Vec3,
        axis: Vec3,
        pattern: TabulatedPattern,
    },
    /// A spherical harmonic, by its number.
    Harmonic {
        acn: usize,
        receiver_from_world: Quat,
    },
}

impl ReceiverChannel {
    /// Returns the channels of a receiver, in order.
    pub(crate) fn all_of_receiver(
        receiver: &Receiver,
        heads: &HeadSet,
        speed_m_s: f64,
    ) -> Vec<Self> {
        let rotation = receiver.pose.rotation;
        match &receiver.kind {
            ReceiverKind::Omni => vec![Self::Omni],
            ReceiverKind::Binaural => heads.ears(None, rotation).map(Self::Ear).into(),
            ReceiverKind::Head(id) => heads.ears(Some(*id), rotation).map(Self::Ear).into(),
            ReceiverKind::Array(microphones) => microphones
                .iter()
                .map(|microphone| {
                    let pose = &microphone.array_from_microphone;
                    Self::Microphone {
                        offset: rotation * pose.position,
                        axis: rotation * (pose.rotation * Vec3::NEG_Z),
                        pattern: microphone.directivity.pattern(speed_m_s),
                    }
                })
                .collect(),
            ReceiverKind::Ambisonics { .. } => (0..receiver.channels())
                .map(|acn| Self::Harmonic {
                    acn,
                    receiver_from_world: rotation.inverse(),
                })
                .collect(),
        }
    }

    /// Returns the response to a wave from `towards`, unit length, world.
    pub(crate) fn response(&self, speed_m_s: f64, towards: Vec3) -> ChannelResponse {
        let (gain, delay) = match self {
            Self::Omni => ([1.0; BAND_COUNT], Delay::None),
            Self::Ear(ear) => {
                let (gain, delay) = ear.gain_and_delay(towards);
                (gain, Delay::Banded(delay))
            }
            Self::Microphone {
                offset,
                axis,
                pattern,
            } => (
                pattern.gain(axis.dot(towards)),
                Delay::Constant(-offset.dot(towards) / speed_m_s as f32),
            ),
            Self::Harmonic {
                acn,
                receiver_from_world,
            } => (
                [harmonic(*acn, *receiver_from_world * towards); BAND_COUNT],
                Delay::None,
            ),
        };
        ChannelResponse { gain, delay }
    }

    /// Returns whether its filters ring before the delay and need room for that.
    pub(crate) fn has_pre_ringing(&self) -> bool {
        matches!(self, Self::Ear(_))
    }

    /// Multiplies a path's spectrum by this channel's response beyond [`Self::response`]'s gains, and returns the delay re the
    /// receiver's centre, s.
    pub(crate) fn apply_undelayed_response(
        &self,
        speed_m_s: f64,
        towards: Vec3,
        spectrum: &mut [Complex<f32>],
    ) -> f64 {
        match self {
            Self::Omni | Self::Harmonic { .. } => 0.0,
            Self::Ear(ear) => ear.apply_undelayed_response(towards, spectrum),
            Self::Microphone { offset, .. } => -f64::from(offset.dot(towards)) / speed_m_s,
        }
    }

    /// Returns the gains of a path's bands; those of ears are in [`Self::apply_undelayed_response`].
    pub(crate) fn path_gain(&self, towards: Vec3) -> BandValues {
        match self {
            Self::Omni | Self::Ear(_) => [1.0; BAND_COUNT],
            Self::Microphone { axis, pattern, .. } => pattern.gain(axis.dot(towards)),
            Self::Harmonic {
                acn,
                receiver_from_world,
            } => [harmonic(*acn, *receiver_from_world * towards); BAND_COUNT],
        }
    }
}

/// Returns real spherical harmonic number `acn` (up to 15) with SN3D weight towards a unit vector in the receiver's axes.
///
/// # Source
/// C. Nachbar, F. Zotter, E. Deleflie, A. Sontacchi, `AmbiX`, a suggested ambisonics format, Ambisonics Symposium 2011,
/// section 2.
fn harmonic(acn: usize, towards: Vec3) -> f32 {
    // Its x is to the front, y to the left, z up.
    let (x, y, z) = (-towards.z, -towards.x, towards.y);
    match acn {
        0 => 1.0,
        1 => y,
        2 => z,
        3 => x,
        4 => 3.0_f32.sqrt() * x * y,
        5 => 3.0_f32.sqrt() * y * z,
        6 => 0.5 * (3.0 * z * z - 1.0),
        7 => 3.0_f32.sqrt() * x * z,
        8 => 0.5 * 3.0_f32.sqrt() * (x * x - y * y),
        9 => 0.625_f32.sqrt() * y * (3.0 * x * x - y * y),
        10 => 15.0_f32.sqrt() * x * y * z,
        11 => 0.375_f32.sqrt() * y * (5.0 * z * z - 1.0),
        12 => 0.5 * z * (5.0 * z * z - 3.0),
        13 => 0.375_f32.sqrt() * x * (5.0 * z * z - 1.0),
        14 => 0.5 * 15.0_f32.sqrt() * z * (x * x - y * y),
        15 => 0.625_f32.sqrt() * x * (x * x - 3.0 * y * y),
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// SN3D: the squares of an order's harmonics sum to 1 everywhere, and different ones are orthogonal over the sphere with
    /// mean square 1 / (2 n + 1).
    #[test]
    fn harmonics_are_orthogonal_and_of_unit_power() {
        let n = 20_000;
        let directions: Vec<Vec3> = (0..n)
            .map(|k| crate::sphere_sequences::fibonacci_direction(k, n))
            .collect();
        for direction in &directions[..50] {
            for order in 0..4_usize {
                let power: f32 = (order * order..(order + 1) * (order + 1))
                    .map(|acn| harmonic(acn, *direction).powi(2))
                    .sum();
                assert!((power - 1.0).abs() < 1e-5, "{order}: {power}");
            }
        }
        for a in 0..16_usize {
            for b in 0..=a {
                let products = directions
                    .iter()
                    .map(|d| f64::from(harmonic(a, *d) * harmonic(b, *d)));
                let mean = products.sum::<f64>() / n as f64;
                let order = a.isqrt() as f64;
                let wanted = if a == b {
                    1.0 / (2.0 * order + 1.0)
                } else {
                    0.0
                };
                assert!((mean - wanted).abs() < 1e-3, "{a} {b}: {mean}");
            }
        }
        // Front, left, up.
        assert_eq!(harmonic(3, Vec3::NEG_Z), 1.0);
        assert_eq!(harmonic(1, Vec3::NEG_X), 1.0);
        assert_eq!(harmonic(2, Vec3::Y), 1.0);
    }
}
