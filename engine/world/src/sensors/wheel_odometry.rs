//! Wheel odometry: a base's pose estimated from its wheels alone.

use super::{
    AgentSensorSettings, Dtype, ObservationBuffer, ObservedAgent, Sensor, SensorContext,
    SensorKind, SensorSetup, SensorSpec,
};
use crate::error::WorldError;
use crate::schema;
use dwell_scene::math;

const ABOUT: &str = "Where the base believes to be from its wheels and nominal geometry, since it was placed: metres \
                     forward, metres to the left, radians to the left in (-pi, pi]; zeros without wheels; shape (3,).";

/// Largest distance that is shown, m.
const FURTHEST_M: f64 = 1000.0;

pub(super) const KIND: SensorKind = SensorKind {
    name: "wheel_odometry",
    about: ABOUT,
    build,
    settings: schema::fields_of::<AgentSensorSettings>,
    image: None,
    goal_part: None,
};

#[derive(Debug)]
struct WheelOdometrySensor(ObservedAgent);

fn build(value: &serde_json::Value, setup: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    Ok(Box::new(WheelOdometrySensor(ObservedAgent::build(
        KIND.name, value, setup,
    )?)))
}

impl Sensor for WheelOdometrySensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: self.0.name.clone(),
            shape: vec![3],
            dtype: Dtype::Float32,
            unit: "m, m, rad",
            low: -FURTHEST_M,
            high: FURTHEST_M,
            about: ABOUT,
        }
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        if let (Some(agent), ObservationBuffer::Float32(out)) = (self.0.state(seen), out) {
            let [forward, left, heading] = agent.base.odometry;
            let shown = |way: f64| way.clamp(-FURTHEST_M, FURTHEST_M) as f32;
            let turns = (heading / std::f64::consts::TAU).round();
            let heading = (heading - turns * std::f64::consts::TAU) as f32;
            out.copy_from_slice(&[shown(forward), shown(left), math::wrap_angle(heading)]);
        }
    }
}
