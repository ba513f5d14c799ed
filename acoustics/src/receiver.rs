//! Sources and receivers of sound.

use crate::directivity::Directivity;
use crate::error::{AcousticsError, check_finite, check_range};
use crate::head::HeadId;
use dwell_scene::Pose;
use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

/// Most microphones of an array.
pub const MAX_MICROPHONES: usize = 128;
/// Highest order of ambisonics.
const HIGHEST_ORDER: u8 = 3;

/// The pose and directivity of a sound source.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SoundSourcePose {
    /// Its pose (forward -Z), m.
    pub pose: Pose,
    /// Its directivity; its level is that on its axis.
    pub directivity: Directivity,
}

impl SoundSourcePose {
    /// A source at `position` that radiates equally in all directions.
    pub const fn omni(position: Vec3) -> Self {
        Self {
            pose: Pose {
                position,
                rotation: Quat::IDENTITY,
            },
            directivity: Directivity::Omni,
        }
    }

    /// A directional source.
    pub const fn directional(pose: Pose, directivity: Directivity) -> Self {
        Self { pose, directivity }
    }

    /// Returns its position, m.
    pub const fn position(&self) -> Vec3 {
        self.pose.position
    }

    /// Returns the direction of its axis, unit length.
    pub fn axis(&self) -> Vec3 {
        self.pose.rotation * Vec3::NEG_Z
    }

    /// Checks that its position is finite and its directivity in range.
    pub(crate) fn check(&self) -> Result<(), AcousticsError> {
        check_finite("the source", self.pose.position)?;
        check_unit_rotation("the source", self.pose.rotation)?;
        self.directivity.check()
    }
}

/// One microphone of an array.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Microphone {
    /// Its pose in the array (forward -Z), m.
    pub array_from_microphone: Pose,
    /// Its directivity.
    pub directivity: Directivity,
}

impl Microphone {
    /// An omnidirectional microphone.
    pub const fn omni(position: Vec3) -> Self {
        Self {
            array_from_microphone: Pose {
                position,
                rotation: Quat::IDENTITY,
            },
            directivity: Directivity::Omni,
        }
    }
}

/// The kind of a receiver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ReceiverKind {
    /// A small omnidirectional microphone: one channel.
    Omni,
    /// Two ears on the scene's built-in sphere (forward -Z, left -X): channel 0 left, channel 1 right.
    Binaural,
    /// Two ears on a head that was added to the scene: channel 0 left, channel 1 right.
    Head(HeadId),
    /// Microphones around a centre: a channel each, in their order. All are in one sound field, so that their differences
    /// are those of a real array, early and late.
    Array(Vec<Microphone>),
    /// Spherical harmonics at one point: (order + 1)² channels, ACN order, SN3D weights, x to the front (-Z), y to the left
    /// (-X), z up.
    Ambisonics {
        /// 0 to 3.
        order: u8,
    },
}

/// A microphone, an array or a head.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Receiver {
    /// Its centre and its axes (forward -Z), m.
    pub pose: Pose,
    /// Its kind.
    pub kind: ReceiverKind,
}

impl Receiver {
    /// A microphone at `position`.
    pub const fn omni(position: Vec3) -> Self {
        Self {
            pose: Pose {
                position,
                rotation: Quat::IDENTITY,
            },
            kind: ReceiverKind::Omni,
        }
    }

    /// A head at a pose, such as [`AgentState::world_from_head`](dwell_scene::AgentState::world_from_head).
    pub const fn binaural(world_from_head: Pose) -> Self {
        Self {
            pose: world_from_head,
            kind: ReceiverKind::Binaural,
        }
    }

    /// Another head than the built-in one at a pose; [`AcousticScene::add_head`](crate::AcousticScene::add_head) adds it to
    /// the scene.
    pub const fn with_head(head: HeadId, world_from_head: Pose) -> Self {
        Self {
            pose: world_from_head,
            kind: ReceiverKind::Head(head),
        }
    }

    /// An array of microphones at a pose.
    pub const fn array(world_from_array: Pose, microphones: Vec<Microphone>) -> Self {
        Self {
            pose: world_from_array,
            kind: ReceiverKind::Array(microphones),
        }
    }

    /// Ambisonics of an order from 0 to 3 at a pose.
    pub const fn ambisonics(pose: Pose, order: u8) -> Self {
        Self {
            pose,
            kind: ReceiverKind::Ambisonics { order },
        }
    }

    /// Its centre, m.
    pub const fn position(&self) -> Vec3 {
        self.pose.position
    }

    /// Returns the number of its channels.
    pub fn channels(&self) -> usize {
        match &self.kind {
            ReceiverKind::Omni => 1,
            ReceiverKind::Binaural | ReceiverKind::Head(_) => 2,
            ReceiverKind::Array(microphones) => microphones.len(),
            ReceiverKind::Ambisonics { order } => (usize::from(*order) + 1).pow(2),
        }
    }

    /// Returns its rotation; the identity for a microphone.
    pub fn rotation(&self) -> Quat {
        match self.kind {
            ReceiverKind::Omni => Quat::IDENTITY,
            _ => self.pose.rotation,
        }
    }

    /// Returns the positions of an array's microphones, m; `None` for a receiver at one point.
    pub(crate) fn microphone_positions(&self) -> Option<Vec<Vec3>> {
        let ReceiverKind::Array(microphones) = &self.kind else {
            return None;
        };
        let positions = microphones.iter().map(|microphone| {
            let position = microphone.array_from_microphone.position;
            self.pose.transform_point(position)
        });
        Some(positions.collect())
    }

    /// Returns the distance of its furthest channel from its centre, m.
    pub(crate) fn radius_m(&self) -> f64 {
        let ReceiverKind::Array(microphones) = &self.kind else {
            return 0.0;
        };
        let far = microphones
            .iter()
            .map(|microphone| microphone.array_from_microphone.position.length());
        f64::from(far.fold(0.0, f32::max))
    }

    /// Returns whether rotating it needs no new rays: all its channels are at one point.
    pub(crate) fn is_coincident(&self) -> bool {
        !matches!(self.kind, ReceiverKind::Array(_))
    }

    /// Checks that its position is finite and all its parts are in range.
    ///
    /// # Errors
    /// [`AcousticsError`] names what is not.
    pub fn check(&self) -> Result<(), AcousticsError> {
        const AT: &str = "receiver";
        check_finite("the receiver", self.pose.position)?;
        check_unit_rotation("the receiver", self.pose.rotation)?;
        match &self.kind {
            ReceiverKind::Omni | ReceiverKind::Binaural | ReceiverKind::Head(_) => Ok(()),
            ReceiverKind::Ambisonics { order } => check_range(
                AT,
                "order",
                f64::from(*order),
                (0.0, f64::from(HIGHEST_ORDER)),
                "0 to 3",
            ),
            ReceiverKind::Array(microphones) => {
                let most = MAX_MICROPHONES as f64;
                let count = microphones.len() as f64;
                check_range(AT, "microphones", count, (1.0, most), "1 to 128")?;
                microphones.iter().try_for_each(|microphone| {
                    check_finite("a microphone", microphone.array_from_microphone.position)?;
                    check_unit_rotation("a microphone", microphone.array_from_microphone.rotation)?;
                    microphone.directivity.check()
                })
            }
        }
    }
}

/// Checks that a rotation is one.
fn check_unit_rotation(what: &'static str, rotation: Quat) -> Result<(), AcousticsError> {
    if rotation.is_finite() && (rotation.length_squared() - 1.0).abs() < 1e-2 {
        return Ok(());
    }
    Err(AcousticsError::Rotation {
        what,
        found: rotation.to_array(),
    })
}
