//! Who listens, and with what: the ears of agents, and other receivers on their heads.

use crate::error::WorldError;
use dwell_acoustics::{HeadId, Receiver, ReceiverKind};
use dwell_scene::{AgentId, Pose};
use serde::{Deserialize, Serialize};

/// A receiver on an agent's head.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MountedReceiver {
    /// Its kind.
    pub kind: ReceiverKind,
    /// Its pose relative to the head, which is at the eyes' height, upright and turned with the body; m.
    pub head_from_receiver: Pose,
}

/// An agent that listens with one of its receivers. All its receivers are in one sound field; equal ones are one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Listener {
    /// The agent.
    pub agent: AgentId,
    /// Its receiver; `None`: its two ears, on the head that the world's settings name.
    pub receiver: Option<MountedReceiver>,
}

impl Listener {
    /// An agent's two ears.
    pub const fn ears(agent: AgentId) -> Self {
        Self {
            agent,
            receiver: None,
        }
    }

    /// Returns the number of channels.
    pub fn channels(&self) -> usize {
        self.receiver_at(Pose::IDENTITY, None).channels()
    }

    /// Checks every range; `head`: the head that the world's settings name.
    ///
    /// # Errors
    /// [`WorldError::Acoustics`] names what is out of range, or another head than the world's.
    pub(crate) fn check(&self, head: Option<HeadId>) -> Result<(), WorldError> {
        let receiver = self.receiver_at(Pose::IDENTITY, head);
        receiver.check()?;
        match receiver.kind {
            ReceiverKind::Head(id) if head != Some(id) => {
                Err(dwell_acoustics::AcousticsError::UnknownHead { id: id.0 }.into())
            }
            _ => Ok(()),
        }
    }

    /// The receiver of an agent whose head is at `world_from_head`; `head`: the head on which ears are, `None` for a sphere.
    pub(crate) fn receiver_at(&self, world_from_head: Pose, head: Option<HeadId>) -> Receiver {
        match (&self.receiver, head) {
            (Some(mounted), _) => Receiver {
                pose: world_from_head * mounted.head_from_receiver,
                kind: mounted.kind.clone(),
            },
            (None, Some(head)) => Receiver::with_head(head, world_from_head),
            (None, None) => Receiver::binaural(world_from_head),
        }
    }

    /// Returns a text that is equal for equal receivers alone; empty for ears.
    pub(crate) fn receiver_key(&self) -> String {
        let text = self.receiver.as_ref().map(serde_json::to_string);
        // Plain data can always be written as JSON.
        text.and_then(Result::ok).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn a_receiver_is_where_it_is_mounted_and_has_its_channels() {
        let head = Pose::from_position_yaw(Vec3::new(1.0, 1.5, 2.0), std::f32::consts::FRAC_PI_2);
        let ears = Listener::ears(AgentId(0));
        assert_eq!(ears.receiver_at(head, None), Receiver::binaural(head));
        assert_eq!((ears.channels(), ears.receiver_key()), (2, String::new()));
        let ahead = Pose::from_position(Vec3::new(0.0, 0.0, -0.5));
        let mounted = |kind| Listener {
            receiver: Some(MountedReceiver {
                kind,
                head_from_receiver: ahead,
            }),
            ..ears.clone()
        };
        let wide = mounted(ReceiverKind::Ambisonics { order: 2 });
        // It looks along -X, where ahead is.
        let position = wide.receiver_at(head, None).pose.position;
        assert!((position - Vec3::new(0.5, 1.5, 2.0)).length() < 1e-6);
        assert_eq!(wide.channels(), 9);
        assert!(
            wide.check(None).is_ok()
                && mounted(ReceiverKind::Ambisonics { order: 4 })
                    .check(None)
                    .is_err()
        );
        assert!(
            mounted(ReceiverKind::Array(Vec::new()))
                .check(None)
                .is_err()
        );
        assert!(mounted(ReceiverKind::Head(HeadId(7))).check(None).is_err());
        assert_ne!(
            wide.receiver_key(),
            mounted(ReceiverKind::Omni).receiver_key()
        );
    }
}
