//! Wheel odometry: a base's pose estimated from its wheels alone.

use super::{
    AgentSensorSettings, Dtype, ObservationBuffer, ObservedAgent, Sensor, SensorContext,
    SensorKind, SensorSetup, SensorSpec,
};
use crate::error::WorldError;
use crate::schema;
use dwell_scene::{Id, Locomotion, math};

const ABOUT: &str = "Where the base believes to be from its wheels and nominal geometry, since it was placed: metres \
                     forward, metres to the left, radians to the left in (-pi, pi]; refused of an agent on legs; shape (3,).";

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
    let observed = ObservedAgent::build(KIND.name, value, setup)?;
    let body = &setup.config.agents[observed.agent.index()];
    if matches!(body.locomotion, Locomotion::Walking(_)) {
        // Zeros would say that it stands still.
        return Err(WorldError::Config {
            field: "sensor",
            found: format!(
                "\"{}\" of agent {}, which walks",
                KIND.name, observed.agent.0
            ),
            allowed: "agents on wheels, of the locomotion \"differential_drive\" or \"holonomic\""
                .to_owned(),
        });
    }
    Ok(Box::new(WheelOdometrySensor(observed)))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::WorldConfig;
    use dwell_scene::{AgentBody, AgentId, DifferentialDrive, HolonomicBase};
    use serde_json::json;

    #[test]
    fn legs_have_no_wheels_to_count() {
        let body = |locomotion| AgentBody {
            locomotion,
            ..AgentBody::default()
        };
        let config = WorldConfig {
            agents: vec![
                AgentBody::default(),
                body(Locomotion::DifferentialDrive(DifferentialDrive::default())),
                body(Locomotion::Holonomic(HolonomicBase::default())),
            ],
            ..WorldConfig::default()
        };
        let setup = SensorSetup {
            config: &config,
            agent: AgentId(0),
        };
        assert_eq!(
            build(&json!({}), setup).unwrap_err().to_string(),
            "sensor is \"wheel_odometry\" of agent 0, which walks; allowed is agents on wheels, of the locomotion \
             \"differential_drive\" or \"holonomic\""
        );
        for agent in [1, 2] {
            build(&json!({"agent": agent}), setup).unwrap();
        }
    }
}
