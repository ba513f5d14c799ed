//! Proprioception: an agent's own body, as it feels it.

use super::{
    AgentSensorSettings, Dtype, ObservationBuffer, ObservedAgent, Sensor, SensorContext,
    SensorKind, SensorSetup, SensorSpec,
};
use crate::error::WorldError;
use crate::schema;
use dwell_scene::space::Pose;

const ABOUT: &str = "The agent's own body after the last step: velocity ahead, to the left and up, m/s, and rate of turn to \
                     the left as its gyro reads it, rad/s; pitch of the view, rad, up positive; height of the eyes above the feet and how much it crouches, m; \
                     1 if it stands on something, 1 if its movement was cut short, 1 if its hand holds something, and the mass of that, kg; speeds of the left and right wheel, rad/s, \
                     0 without wheels; shape (13,).";

/// Number of elements.
const LENGTH: usize = 13;
/// The end of its range; speeds, angles and masses of agents stay far below.
const FULL_SCALE: f32 = 10_000.0;

pub(super) const KIND: SensorKind = SensorKind {
    name: "proprioception",
    about: ABOUT,
    build,
    settings: schema::fields_of::<AgentSensorSettings>,
    image: None,
    goal_part: None,
};

#[derive(Debug)]
struct ProprioceptionSensor(ObservedAgent);

fn build(value: &serde_json::Value, setup: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    Ok(Box::new(ProprioceptionSensor(ObservedAgent::build(
        KIND.name, value, setup,
    )?)))
}

impl Sensor for ProprioceptionSensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: self.0.name.clone(),
            shape: vec![LENGTH],
            dtype: Dtype::Float32,
            unit: "m/s, rad/s, rad, m, 1, kg",
            low: f64::from(-FULL_SCALE),
            high: f64::from(FULL_SCALE),
            about: ABOUT,
        }
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        let (Some(agent), ObservationBuffer::Float32(out)) = (self.0.state(seen), out) else {
            return;
        };
        let world_from_agent = Pose::from_position_yaw(agent.position, agent.yaw_rad);
        let velocity = world_from_agent.rotation.inverse() * agent.velocity;
        let held_kg = seen.world.physics().held_mass_kg(self.0.agent);
        let flag = |is: bool| f32::from(u8::from(is));
        let [left_rad_s, right_rad_s] = agent.base.wheel_rad_s;
        let felt: [f32; LENGTH] = [
            -velocity.z,
            -velocity.x,
            velocity.y,
            agent.gyro_rad_s,
            agent.pitch_rad,
            agent.eye_height_m(),
            agent.crouched_by_m,
            flag(agent.grounded),
            flag(agent.collided),
            flag(agent.holding.is_some()),
            held_kg,
            left_rad_s,
            right_rad_s,
        ];
        // Adding 0 leaves no negative zero.
        out.copy_from_slice(&felt.map(|value| value.clamp(-FULL_SCALE, FULL_SCALE) + 0.0));
    }
}
