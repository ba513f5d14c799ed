//! Where things belong that are to be put back.

use super::{
    AgentSensorSettings, Dtype, ObservationBuffer, ObservedAgent, Sensor, SensorContext,
    SensorKind, SensorSetup, SensorSpec,
};
use crate::episode::GoalField;
use crate::error::WorldError;
use crate::schema;
use dwell_scene::Pose;

/// Rows of the observation.
const ROWS: usize = 20;
/// Numbers of a row.
const COLUMNS: usize = 12;
const ABOUT: &str = "Where things belong that were changed, in the agent's frame (its feet; x to the right, -z ahead), by id: id, middle in m, \
                     edges in m, rotation x, y, z, w, and how far open it is to be (-1 for what is put there); unused rows are 0; \
                     shape (20, 12).";

pub(super) const KIND: SensorKind = SensorKind {
    name: "rearrangegoal",
    about: ABOUT,
    build,
    settings: schema::fields_of::<AgentSensorSettings>,
    image: None,
    goal_part: Some(GoalField::Placements),
};

#[derive(Debug)]
struct RearrangeGoalSensor(ObservedAgent);

fn build(value: &serde_json::Value, setup: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    Ok(Box::new(RearrangeGoalSensor(ObservedAgent::build(
        KIND.name, value, setup,
    )?)))
}

impl Sensor for RearrangeGoalSensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: self.0.name.clone(),
            shape: vec![ROWS, COLUMNS],
            dtype: Dtype::Float32,
            unit: "id, m, m, 1, 1",
            low: -1e9,
            high: 1e9,
            about: ABOUT,
        }
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        let ObservationBuffer::Float32(out) = out else {
            return;
        };
        out.fill(0.0);
        let Some(agent) = self.0.state(seen) else {
            return;
        };
        let agent_from_world = Pose::from_position_yaw(agent.position, agent.yaw_rad).inverse();
        let house = seen.world.house();
        let placements = &seen.episode.goal.placements;
        for (row, placement) in out.chunks_exact_mut(COLUMNS).zip(placements) {
            let pose = agent_from_world * placement.world_from_box;
            row[0] = house.entity_of_object(placement.object).0 as f32;
            row[1..4].copy_from_slice(&pose.position.to_array());
            row[4..7].copy_from_slice(&placement.size.to_array());
            row[7..11].copy_from_slice(&pose.rotation.to_array());
            row[11] = placement.openness.unwrap_or(-1.0);
        }
    }
}
