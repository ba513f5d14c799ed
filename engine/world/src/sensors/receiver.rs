//! The settings of receivers of sound, which all sensors of sound share.

use super::{SensorSetup, mount};
use crate::error::WorldError;
use crate::listener::{Listener, MountedReceiver};
use dwell_acoustics::{Directivity, Microphone, ReceiverKind};
use dwell_scene::math;
use dwell_scene::space::{Pose, rotation_from_forward};
use glam::{Quat, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f32::consts::TAU;

/// Radius of named arrays without another, m.
const RADIUS_M: f32 = 0.05;

/// The kinds of receivers by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum ReceiverName {
    /// Two ears: left, right.
    #[default]
    Binaural,
    /// One small microphone, equal in all directions.
    Mono,
    /// Spherical harmonics at one point, in `AmbiX` order and weights (ACN, SN3D): (order + 1)² channels.
    Ambisonics,
    /// Four microphones at the corners of a tetrahedron: left front up, right front down, left back down, right back up.
    Tetrahedral,
    /// Four microphones on a level circle: ahead, left, back, right.
    #[serde(rename = "circular_4")]
    Circular4,
    /// Eight microphones on a level circle, from ahead to the left.
    #[serde(rename = "circular_8")]
    Circular8,
    /// Four microphones on a level line, from left to right, at equal distances.
    #[serde(rename = "linear_4")]
    Linear4,
    /// Microphones where `microphones_m` says.
    Array,
}

/// A receiver of sound on an agent's head.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct ReceiverConfig {
    /// Its kind: `"binaural"` (default), `"mono"`, `"ambisonics"`, `"tetrahedral"`, `"circular_4"`, `"circular_8"`, `"linear_4"` or
    /// `"array"`.
    kind: ReceiverName,
    /// The order of ambisonics, 0 to 3; default 1.
    order: Option<u32>,
    /// The microphones of an `"array"`, a channel each: positions to the right, up, back of its centre, m, -10 to 10 each; 1 to 128.
    microphones_m: Option<Vec<[f32; 3]>>,
    /// Distance of the outermost microphones of a named array from its centre, m, 0.001 to 10; default 0.05.
    radius_m: Option<f32>,
    /// Of each microphone of an array: `"omni"` (default), `"cardioid"` or `"figure_of_eight"`, facing away from the centre, and ahead at
    /// the centre.
    directivity: Option<String>,
    /// Position of its centre relative to the middle of the head: to the right, up, back, m, -10 to 10 each; default none of them.
    position_m: [f32; 3],
    /// Its rotation relative to the head: yaw, degrees to the left, -360 to 360.
    yaw_deg: f32,
    /// Then up, degrees, -360 to 360.
    pitch_deg: f32,
    /// Then about its forward axis, degrees, counter-clockwise as it faces, -360 to 360.
    roll_deg: f32,
}

fn fault<T>(field: &'static str, found: String, allowed: &str) -> Result<T, WorldError> {
    Err(WorldError::Config {
        field,
        found,
        allowed: allowed.to_owned(),
    })
}

/// Returns `count` positions on a level circle, from ahead to the left.
fn circle(count: usize) -> Vec<Vec3> {
    let position = |k: usize| {
        let (sine, cosine) = math::sin_cos(TAU * k as f32 / count as f32);
        Vec3::new(-sine, 0.0, -cosine)
    };
    (0..count).map(position).collect()
}

impl ReceiverName {
    /// The positions of a named array with radius 1; `None` for what is none.
    fn layout(self) -> Option<Vec<Vec3>> {
        match self {
            Self::Binaural | Self::Mono | Self::Ambisonics | Self::Array => None,
            Self::Tetrahedral => {
                let corners = [
                    [-1.0, 1.0, -1.0],
                    [1.0, -1.0, -1.0],
                    [-1.0, -1.0, 1.0],
                    [1.0, 1.0, 1.0],
                ];
                let scale = 1.0 / 3.0_f32.sqrt();
                Some(
                    corners
                        .map(|corner| Vec3::from_array(corner) * scale)
                        .into(),
                )
            }
            Self::Circular4 => Some(circle(4)),
            Self::Circular8 => Some(circle(8)),
            Self::Linear4 => {
                let third = |k: u8| Vec3::X * (f32::from(k) * 2.0 / 3.0 - 1.0);
                Some((0..4).map(third).collect())
            }
        }
    }
}

impl ReceiverConfig {
    /// Refuses what belongs to another kind.
    fn check_fields(&self) -> Result<(), WorldError> {
        let kind = serde_json::to_string(&self.kind).unwrap_or_default();
        if let Some(order) = self.order {
            if self.kind != ReceiverName::Ambisonics {
                let found = format!("{order} with the kind {kind}");
                return fault("receiver.order", found, "given with \"ambisonics\" alone");
            }
            if order > 3 {
                return fault("receiver.order", order.to_string(), "0 to 3");
            }
        }
        let is_array = self.kind == ReceiverName::Array;
        match &self.microphones_m {
            Some(all) if !is_array => {
                let found = format!("{} positions with the kind {kind}", all.len());
                return fault(
                    "receiver.microphones_m",
                    found,
                    "given with \"array\" alone",
                );
            }
            None if is_array => {
                let found = "missing".to_owned();
                return fault("receiver.microphones_m", found, "1 to 128 positions");
            }
            Some(all) if !(1..=dwell_acoustics::MAX_MICROPHONES).contains(&all.len()) => {
                let found = format!("{} positions", all.len());
                return fault("receiver.microphones_m", found, "1 to 128 positions");
            }
            Some(all) if !all.iter().flatten().all(|part| part.abs() <= 10.0) => {
                let found = format!("{all:?}");
                return fault(
                    "receiver.microphones_m",
                    found,
                    "-10 to 10 m along each axis",
                );
            }
            _ => {}
        }
        let is_named = self.kind.layout().is_some();
        match self.radius_m {
            Some(radius_m) if !is_named => {
                let found = format!("{radius_m} with the kind {kind}");
                return fault("receiver.radius_m", found, "given with named arrays alone");
            }
            Some(radius_m) if !(0.001..=10.0).contains(&radius_m) => {
                return fault("receiver.radius_m", radius_m.to_string(), "0.001 to 10 m");
            }
            _ => {}
        }
        match &self.directivity {
            Some(name) if !is_named && !is_array => {
                let found = format!("{name:?} with the kind {kind}");
                return fault("receiver.directivity", found, "given with arrays alone");
            }
            Some(name) if !["omni", "cardioid", "figure_of_eight"].contains(&name.as_str()) => {
                let allowed = "\"omni\", \"cardioid\", \"figure_of_eight\"";
                return fault("receiver.directivity", format!("{name:?}"), allowed);
            }
            _ => {}
        }
        if !self.position_m.iter().all(|part| part.abs() <= 10.0) {
            let found = format!("{:?}", self.position_m);
            return fault("receiver.position_m", found, "-10 to 10 m along each axis");
        }
        for (field, angle) in [
            ("receiver.yaw_deg", self.yaw_deg),
            ("receiver.pitch_deg", self.pitch_deg),
            ("receiver.roll_deg", self.roll_deg),
        ] {
            if !(-360.0..=360.0).contains(&angle) {
                return fault(field, angle.to_string(), "-360 to 360 degrees");
            }
        }
        Ok(())
    }

    /// The microphones of an array.
    fn microphones(&self) -> Vec<Microphone> {
        let radius_m = self.radius_m.unwrap_or(RADIUS_M);
        let named = self.kind.layout();
        let named = named.map(|all| all.into_iter().map(|unit| unit * radius_m).collect());
        let given = self.microphones_m.iter().flatten().copied();
        let positions: Vec<Vec3> = named.unwrap_or_else(|| given.map(Vec3::from_array).collect());
        let directivity = self.directivity.as_deref().and_then(Directivity::named);
        let microphone = |position: Vec3| Microphone {
            array_from_microphone: Pose::new(position, rotation_outwards(position)),
            directivity: directivity.clone().unwrap_or_default(),
        };
        positions.into_iter().map(microphone).collect()
    }

    /// Checks every range, and returns who listens with what.
    ///
    /// # Errors
    /// [`WorldError::Config`] names the field.
    pub(super) fn build(
        &self,
        setup: SensorSetup<'_>,
        agent: Option<u32>,
    ) -> Result<Listener, WorldError> {
        let agent = setup.agent(agent)?;
        self.check_fields()?;
        let angles = [self.yaw_deg, self.pitch_deg, self.roll_deg];
        if *self == Self::default() {
            return Ok(Listener::ears(agent));
        }
        let kind = match (self.kind, setup.config.sound_head) {
            (ReceiverName::Binaural, Some(head)) => ReceiverKind::Head(head),
            (ReceiverName::Binaural, None) => ReceiverKind::Binaural,
            (ReceiverName::Mono, _) => ReceiverKind::Omni,
            (ReceiverName::Ambisonics, _) => ReceiverKind::Ambisonics {
                order: self.order.unwrap_or(1) as u8,
            },
            _ => ReceiverKind::Array(self.microphones()),
        };
        let listener = Listener {
            agent,
            receiver: Some(MountedReceiver {
                kind,
                head_from_receiver: mount(self.position_m, angles),
            }),
        };
        listener.check(setup.config.sound_head)?;
        Ok(listener)
    }
}

/// Returns the rotation of a microphone that faces away from the centre; ahead at the centre.
fn rotation_outwards(position: Vec3) -> Quat {
    rotation_from_forward(position).unwrap_or(Quat::IDENTITY)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::WorldConfig;
    use dwell_scene::AgentId;
    use serde_json::{Value, json};

    fn built(value: &Value) -> Result<Listener, WorldError> {
        let config = WorldConfig::default();
        let setup = SensorSetup {
            config: &config,
            agent: AgentId(0),
        };
        let receiver: ReceiverConfig = crate::parse_settings::parse_settings("receiver", value)?;
        receiver.build(setup, None)
    }

    #[test]
    fn kinds_have_their_channels_and_arrays_their_places() {
        for (settings, channels) in [
            (json!({}), 2),
            (json!({"yaw_deg": 90}), 2),
            (json!({"kind": "mono"}), 1),
            (json!({"kind": "ambisonics"}), 4),
            (json!({"kind": "ambisonics", "order": 3}), 16),
            (json!({"kind": "tetrahedral"}), 4),
            (json!({"kind": "circular_8", "directivity": "cardioid"}), 8),
            (
                json!({"kind": "array", "microphones_m": [[0, 0, 0], [0, 1, 0], [0, -1, 0]]}),
                3,
            ),
        ] {
            assert_eq!(built(&settings).unwrap().channels(), channels, "{settings}");
        }
        assert_eq!(built(&json!({})).unwrap(), Listener::ears(AgentId(0)));
        for name in [
            ReceiverName::Tetrahedral,
            ReceiverName::Circular4,
            ReceiverName::Circular8,
        ] {
            let all = name.layout().unwrap();
            assert!(all.iter().all(|unit| (unit.length() - 1.0).abs() < 1e-6));
            assert!(all.iter().sum::<Vec3>().length() < 1e-5);
        }
        let line = ReceiverName::Linear4.layout().unwrap();
        assert!((line[0] - Vec3::NEG_X).length() < 1e-6 && (line[3] - Vec3::X).length() < 1e-6);
        for position in [Vec3::X, Vec3::Y, Vec3::NEG_Y, Vec3::new(1.0, 2.0, -1.0)] {
            let faces = rotation_outwards(position) * Vec3::NEG_Z;
            assert!(
                (faces - position.normalize_or_zero()).length() < 1e-5,
                "{position}"
            );
        }
    }

    #[test]
    fn a_wrong_setting_is_refused_with_what_is_allowed() {
        for (settings, told) in [
            (
                json!({"order": 1}),
                "receiver.order is 1 with the kind \"binaural\"; allowed is given with \"ambisonics\" alone",
            ),
            (
                json!({"kind": "ambisonics", "order": 4}),
                "receiver.order is 4; allowed is 0 to 3",
            ),
            (
                json!({"kind": "array"}),
                "receiver.microphones_m is missing; allowed is 1 to 128 positions",
            ),
            (
                json!({"kind": "array", "microphones_m": []}),
                "receiver.microphones_m is 0 positions; allowed is 1 to 128 positions",
            ),
            (
                json!({"kind": "linear_4", "radius_m": 0.0}),
                "receiver.radius_m is 0; allowed is 0.001 to 10 m",
            ),
            (
                json!({"kind": "mono", "directivity": "cardioid"}),
                "receiver.directivity is \"cardioid\" with the kind \"mono\"; allowed is given with arrays alone",
            ),
        ] {
            assert_eq!(built(&settings).unwrap_err().to_string(), told);
        }
        let told = built(&json!({"kind": "stereo"})).unwrap_err().to_string();
        assert!(
            told.contains("stereo") && told.contains("circular_4"),
            "{told}"
        );
    }
}
