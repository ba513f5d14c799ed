//! Where a base believes to be, from its wheels alone.

use super::{
    Dtype, NoSettings, ObservationBuffer, Sensor, SensorContext, SensorKind, SensorSetup,
    SensorSpec, settings,
};
use crate::error::WorldError;
use crate::schema;
use dwell_scene::{AgentId, Id, math};

const ABOUT: &str = "Where the base believes to be from its wheels and nominal geometry, since it was placed: metres \
                     forward, metres to the left, radians to the left in (-pi, pi]; zeros without wheels; shape (3,).";

/// Furthest way that is shown, m.
const FURTHEST_M: f64 = 1000.0;

pub(super) const KIND: SensorKind = SensorKind {
    name: "wheel_odometry",
    about: ABOUT,
    build,
    settings: schema::fields::<NoSettings>,
    image: None,
};

#[derive(Debug)]
struct WheelOdometrySensor;

fn build(value: &serde_json::Value, _: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let NoSettings {} = settings(value)?;
    Ok(Box::new(WheelOdometrySensor))
}

impl Sensor for WheelOdometrySensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: "wheel_odometry".to_owned(),
            shape: vec![3],
            dtype: Dtype::Float32,
            unit: "m, m, rad",
            low: -FURTHEST_M,
            high: FURTHEST_M,
            about: ABOUT,
        }
    }

    fn finish(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        if let (Some(agent), ObservationBuffer::Float32(out)) =
            (seen.world.state().agents.get(AgentId::from_index(0)), out)
        {
            let [forward, left, heading] = agent.base.odometry;
            let shown = |way: f64| way.clamp(-FURTHEST_M, FURTHEST_M) as f32;
            let turns = (heading / std::f64::consts::TAU).round();
            let heading = (heading - turns * std::f64::consts::TAU) as f32;
            out.copy_from_slice(&[shown(forward), shown(left), math::wrap_angle(heading)]);
        }
    }
}
