//! Laws of wheeled bases and of agents' gyros. Their target is an agent's number, counted from 0; without one they act on
//! every agent with the required base, those that are added later too; agents on legs have none of it.

pub(super) mod gyro_bias_scale;
pub(super) mod unequal_wheels;
pub(super) mod wheel_slip;

use crate::error::PhysicsError;
use dwell_scene::{AgentId, Id, LawValues, Locomotion, State};

/// The locomotion that an agent must have for a law to act on it.
#[derive(Clone, Copy, Debug)]
enum RequiredBase {
    /// A left and a right wheel.
    DrivenWheels,
    /// Wheels of any kind, with a gyro between them.
    Wheels,
}

impl RequiredBase {
    fn are_met_by(self, locomotion: &Locomotion) -> bool {
        match self {
            Self::DrivenWheels => matches!(locomotion, Locomotion::DifferentialDrive(_)),
            Self::Wheels => !matches!(locomotion, Locomotion::Walking(_)),
        }
    }

    fn requirement_message(self) -> &'static str {
        match self {
            Self::DrivenWheels => "the law needs the two wheels of a differential drive",
            Self::Wheels => "the law needs a base on wheels",
        }
    }
}

/// The agents that a spec acts on; `None`: all with the required base, whenever they are added. Agents without it are never
/// queried: only driven wheels roll, and only bases have a gyro.
#[derive(Clone, Debug)]
struct TargetAgents(Option<AgentId>);

impl TargetAgents {
    fn of(values: LawValues<'_>, state: &State, needs: RequiredBase) -> Result<Self, PhysicsError> {
        let unfit = |what: String, agent: AgentId| PhysicsError::LawUnfit {
            law: values.info.id,
            what,
            why: format!(
                "its body is of the kind {:?}; {}",
                state.agents[agent].body.locomotion.name(),
                needs.requirement_message()
            ),
        };
        let fits = |agent: &AgentId| needs.are_met_by(&state.agents[*agent].body.locomotion);
        match values.spec.target_agent(state.agents.len()) {
            Ok(Some(agent)) if fits(&agent) => Ok(Self(Some(agent))),
            Ok(Some(agent)) => Err(unfit(format!("agent {}", agent.index()), agent)),
            Ok(None) => match state.agents.ids().next() {
                Some(first) if !state.agents.ids().any(|agent| fits(&agent)) => {
                    Err(unfit("any agent".to_owned(), first))
                }
                _ => Ok(Self(None)),
            },
            Err(target) => {
                let numbers: Vec<String> = state
                    .agents
                    .ids()
                    .map(|id| id.index().to_string())
                    .collect();
                let names = numbers.iter().map(String::as_str);
                Err(PhysicsError::no_target(
                    values.info.id,
                    "agent",
                    target,
                    names,
                ))
            }
        }
    }

    fn contains(&self, agent: AgentId) -> bool {
        self.0.is_none_or(|named| named == agent)
    }
}
