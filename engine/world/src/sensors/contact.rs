//! Contact: what an agent's body and the thing in its hand touch.

use super::{
    Dtype, ObservationBuffer, ObservedAgent, Sensor, SensorContext, SensorKind, SensorSetup,
    SensorSpec, parse_sensor_settings,
};
use crate::error::WorldError;
use crate::schema;
use dwell_scene::math;
use dwell_scene::space::yaw_from_forward;
use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f32::consts::TAU;

const ABOUT: &str = "What the body touches, by directions counter-clockwise from ahead as seen from above, and in the last row what the held \
                     thing touches: 1 or 0, and the force of things that press on it in the last physics step, N; walls, fixed \
                     things and other agents stop a body without a force; shape (sectors + 1, 2).";

/// The greatest force that is shown, N.
const FULL_SCALE_N: f32 = 10_000.0;
/// Most sectors.
const MOST_SECTORS: u32 = 64;

pub(super) const KIND: SensorKind = SensorKind {
    name: "contact",
    about: ABOUT,
    build,
    settings: schema::fields_of::<ContactConfig>,
    image: None,
    goal_part: None,
};

/// The settings of a contact sensor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct ContactConfig {
    /// The key in the observation; by default the sensor's kind.
    name: Option<String>,
    /// Which agent's body; by default that of the one whom the environment is about.
    agent: Option<u32>,
    /// Equal sectors around the body, 1 to 64, default 8; the middle of the first is straight ahead, the next is to its left.
    sectors: u32,
}

impl Default for ContactConfig {
    fn default() -> Self {
        Self {
            name: None,
            agent: None,
            sectors: 8,
        }
    }
}

#[derive(Debug)]
struct ContactSensor {
    body: ObservedAgent,
    sectors: usize,
}

fn build(value: &serde_json::Value, setup: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let config: ContactConfig = parse_sensor_settings(value)?;
    if !(1..=MOST_SECTORS).contains(&config.sectors) {
        return Err(WorldError::Config {
            field: "sectors",
            found: config.sectors.to_string(),
            allowed: format!("1 to {MOST_SECTORS}"),
        });
    }
    Ok(Box::new(ContactSensor {
        body: ObservedAgent {
            name: super::key(KIND.name, config.name)?,
            agent: setup.agent(config.agent)?,
        },
        sectors: config.sectors as usize,
    }))
}

/// Returns the sector of a direction, for an agent with heading `yaw_rad`.
fn sector(direction: Vec3, yaw_rad: f32, sectors: usize) -> usize {
    let left_rad = math::wrap_angle(yaw_from_forward(direction) - yaw_rad);
    let share = left_rad / TAU * sectors as f32;
    (share.round() as i64).rem_euclid(sectors as i64) as usize
}

impl Sensor for ContactSensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: self.body.name.clone(),
            shape: vec![self.sectors + 1, 2],
            dtype: Dtype::Float32,
            unit: "1, N",
            low: 0.0,
            high: f64::from(FULL_SCALE_N),
            about: ABOUT,
        }
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        let (Some(agent), ObservationBuffer::Float32(out)) = (self.body.state(seen), out) else {
            return;
        };
        out.fill(0.0);
        let felt = seen
            .world
            .physics()
            .touch(seen.world.state(), self.body.agent);
        let (rows, _) = out.as_chunks_mut::<2>();
        let Some((hand, around)) = rows.split_last_mut() else {
            return;
        };
        for touch in &felt.body {
            let [touches, force_n] =
                &mut around[sector(touch.direction, agent.yaw_rad, self.sectors)];
            *touches = 1.0;
            *force_n = (*force_n + touch.force_n).min(FULL_SCALE_N);
        }
        if let Some(force_n) = felt.held_force_n {
            *hand = [1.0, force_n.min(FULL_SCALE_N)];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::FRAC_PI_2;

    #[test]
    fn sectors_go_round_to_the_left_from_ahead() {
        let [ahead, left, behind, right] = [Vec3::NEG_Z, Vec3::NEG_X, Vec3::Z, Vec3::X];
        for (direction, expected) in [(ahead, 0), (left, 2), (behind, 4), (right, 6)] {
            assert_eq!(sector(direction, 0.0, 8), expected);
        }
        assert_eq!(sector(left, FRAC_PI_2, 8), 0);
        assert_eq!(sector(behind, 0.0, 1), 0);
        assert_eq!(sector(Vec3::new(0.3, 0.0, -1.0), 0.0, 8), 0);
        assert_eq!(sector(Vec3::new(0.6, 0.0, -1.0), 0.0, 8), 7);
    }
}
