//! What an agent understands of what others say, as numbers of the vocabulary.

use super::{
    Dtype, ObservationBuffer, ObservedAgent, Sensor, SensorContext, SensorKind, SensorSetup,
    SensorSpec, parse_sensor_settings,
};
use crate::error::WorldError;
use crate::listener::Listener;
use crate::schema;
use crate::sensor_requests::SensorRequests;
use crate::world::World;
use dwell_scene::AgentId;
use schemars::JsonSchema;
use serde::Deserialize;

const ABOUT: &str = "The words that were understood in this step of what others say, the loudest first, as tokens of the versioned \
                     vocabulary; 0 = none, and the highest number = a word that was not understood; shape (slots,).";

/// Most words in a step.
const MOST_SLOTS: u32 = 16;

pub(super) const KIND: SensorKind = SensorKind {
    name: "heard_tokens",
    about: ABOUT,
    build,
    settings: schema::fields_of::<HeardTokensConfig>,
    image: None,
    goal_part: None,
};

/// The settings of what is heard of words.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct HeardTokensConfig {
    /// The key in the observation; by default the sensor's kind.
    pub(super) name: Option<String>,
    /// Whose ears; by default those of the agent whom the environment is about.
    pub(super) agent: Option<u32>,
    /// Words in a step, 1 to 16, default 4; quieter ones beyond are left out.
    pub(super) slots: u32,
}

impl Default for HeardTokensConfig {
    fn default() -> Self {
        Self {
            name: None,
            agent: None,
            slots: 4,
        }
    }
}

impl HeardTokensConfig {
    /// Returns the agent, and the number of slots.
    pub(super) fn build(
        self,
        kind: &str,
        setup: SensorSetup<'_>,
    ) -> Result<(ObservedAgent, usize), WorldError> {
        if !(1..=MOST_SLOTS).contains(&self.slots) {
            return Err(WorldError::Config {
                field: "slots",
                found: self.slots.to_string(),
                allowed: format!("1 to {MOST_SLOTS}"),
            });
        }
        let own = ObservedAgent {
            name: super::key(kind, self.name)?,
            agent: setup.agent(self.agent)?,
        };
        Ok((own, self.slots as usize))
    }
}

/// States that an agent listens.
pub(super) fn request_ears(agent: AgentId, world: &World, requests: &mut SensorRequests) {
    requests.request_sound(&Listener::ears(agent), world.config().samples_per_step());
}

#[derive(Debug)]
struct HeardTokensSensor {
    own: ObservedAgent,
    slots: usize,
}

fn build(value: &serde_json::Value, setup: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let (own, slots) =
        parse_sensor_settings::<HeardTokensConfig>(value)?.build(KIND.name, setup)?;
    Ok(Box::new(HeardTokensSensor { own, slots }))
}

/// The number of a word that was not understood.
fn unknown_token() -> i32 {
    dwell_semantics::vocabulary::size() as i32
}

impl Sensor for HeardTokensSensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: self.own.name.clone(),
            shape: vec![self.slots],
            dtype: Dtype::Int32,
            unit: "token",
            low: 0.0,
            high: f64::from(unknown_token()) + 1.0,
            about: ABOUT,
        }
    }

    fn request(&self, world: &World, requests: &mut SensorRequests) {
        request_ears(self.own.agent, world, requests);
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        let ObservationBuffer::Int32(out) = out else {
            return;
        };
        out.fill(0);
        for (slot, heard) in out.iter_mut().zip(seen.world.heard_tokens(self.own.agent)) {
            *slot = heard.token.map_or_else(unknown_token, |token| token as i32);
        }
    }
}
