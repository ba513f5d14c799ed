//! Distance and direction of the goal from where the agent is.

use super::{
    AgentSensorSettings, Dtype, ObservationBuffer, ObservedAgent, Sensor, SensorContext,
    SensorKind, SensorSetup, SensorSpec,
};
use crate::episode::GoalField;
use crate::error::WorldError;
use crate::schema;
use dwell_scene::math::{atan2, wrap_angle};

const ABOUT: &str = "The goal from where the agent is: horizontal distance, m, and angle from straight ahead, rad, positive to the left; shape (2,).";

/// The longest distance, m.
const FARTHEST_M: f32 = 1000.0;

pub(super) const KIND: SensorKind = SensorKind {
    name: "pointgoal_with_gps_compass",
    about: ABOUT,
    build,
    settings: schema::fields_of::<AgentSensorSettings>,
    image: None,
    goal_part: Some(GoalField::Position),
};

#[derive(Debug)]
struct PointGoalSensor(ObservedAgent);

fn build(value: &serde_json::Value, setup: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    Ok(Box::new(PointGoalSensor(ObservedAgent::build(
        KIND.name, value, setup,
    )?)))
}

impl Sensor for PointGoalSensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: self.0.name.clone(),
            shape: vec![2],
            dtype: Dtype::Float32,
            unit: "m, rad",
            low: f64::from(-std::f32::consts::PI),
            high: f64::from(FARTHEST_M),
            about: ABOUT,
        }
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        let ObservationBuffer::Float32(out) = out else {
            return;
        };
        // A task in Python may ask for something else: nothing of an earlier episode stays.
        out.fill(0.0);
        if let (Some(agent), Some(goal)) = (self.0.state(seen), seen.episode.goal.position) {
            let away = goal - agent.position;
            let distance_m = (away.x * away.x + away.z * away.z).sqrt();
            // Straight ahead at yaw 0 is -z, and yaw grows to the left.
            let angle_rad = wrap_angle(atan2(-away.x, -away.z) - agent.yaw_rad);
            out.copy_from_slice(&[distance_m.min(FARTHEST_M), angle_rad]);
        }
    }
}
