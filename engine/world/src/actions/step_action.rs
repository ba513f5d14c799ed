//! What an agent does in one step of an environment: an action, velocities of its own, and what its hand is used on.

use super::{AgentAction, DiscreteAction, HandTarget, StepSizes};
use crate::episode::{Answer, MAX_ANSWER_FIELDS, MAX_QUESTION_TOKENS, QuestionTokens};
use crate::error::WorldError;
use crate::sound::Utterance;
use crate::world::World;
use dwell_acoustics::utterance::{MAX_TOKENS, VocalEffort};
use dwell_physics::OutcomeCode;
use dwell_scene::{AgentId, EntityId, ObjectId};
use serde::{Deserialize, Serialize};

/// The form that actions have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ActionMode {
    /// The number of an action; hands are used on what the agent looks at.
    #[default]
    Discrete,
    /// Velocities of the body; no hand.
    Velocity,
    /// An action, and a place in the picture on which hands are used.
    Pointer,
    /// An action, and the id of a thing on which hands are used.
    Object,
    /// Velocities and an action of the hand with a place in the picture, together.
    Dict,
}

impl ActionMode {
    /// Returns whether an action says what a hand is used on.
    pub(crate) fn has_targets(self) -> bool {
        matches!(self, Self::Pointer | Self::Object | Self::Dict)
    }

    /// The actions to choose from by default, out of those of the task.
    pub(crate) fn default_actions(self, of_task: Vec<DiscreteAction>) -> Vec<DiscreteAction> {
        match self {
            Self::Discrete => of_task,
            Self::Velocity => vec![DiscreteAction::Stop],
            Self::Pointer | Self::Object | Self::Dict => {
                let alone = DiscreteAction::ALONE.iter().copied();
                let others = of_task
                    .into_iter()
                    .filter(|own| !DiscreteAction::ALONE.contains(own));
                alone.chain(others).collect()
            }
        }
    }
}

/// What a hand is used on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ActionTarget {
    /// What the agent looks at.
    #[default]
    Gaze,
    /// What the picture of the agent's first camera shows at a place: shares of its width from the left and of its height from
    /// the top, 0 to 1. Without a camera that of a square picture with the agent's own field of view.
    Picture([f32; 2]),
    /// The thing with an id that sensors report.
    Entity(EntityId),
}

/// What an agent begins to say in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StepUtterance {
    /// Numbers of words of the vocabulary, up to the first 0.
    pub tokens: [u32; MAX_TOKENS],
    /// How loudly.
    pub effort: VocalEffort,
}

impl StepUtterance {
    /// Returns the utterance; `None` without words.
    pub(crate) fn utterance(&self) -> Option<Utterance> {
        let words = self.tokens.iter().copied();
        let tokens: Vec<u32> = words.take_while(|token| *token != 0).collect();
        (!tokens.is_empty()).then_some(Utterance {
            tokens,
            effort: self.effort,
        })
    }
}

/// An agent's part of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepAction {
    /// The action.
    pub action: DiscreteAction,
    /// Velocities in place of those of the action: forward, right, turn to the left, look up, each as a share of what a movement
    /// action makes, -1 to 1.
    pub velocity: Option<[f32; 4]>,
    /// What its hand is used on.
    pub target: ActionTarget,
    /// With `stop`, the answer that its task expects; NaN for none.
    pub answer: Answer,
    /// What it begins to say; `None`: nothing. While an agent speaks, nothing that it says else is taken.
    pub utterance: Option<StepUtterance>,
    /// What it asks the oracle of its task, where that has one; no sound.
    pub question: QuestionTokens,
}

impl From<DiscreteAction> for StepAction {
    fn from(action: DiscreteAction) -> Self {
        Self {
            action,
            velocity: None,
            target: ActionTarget::Gaze,
            answer: [f32::NAN; MAX_ANSWER_FIELDS],
            utterance: None,
            question: [0; MAX_QUESTION_TOKENS],
        }
    }
}

impl StepAction {
    /// Refuses numbers out of range.
    ///
    /// # Errors
    /// [`WorldError::Config`] names the number.
    pub(crate) fn check(&self) -> Result<(), WorldError> {
        let fault = |field: &'static str, found: String, allowed: &str| {
            Err(WorldError::Config {
                field,
                found,
                allowed: allowed.to_owned(),
            })
        };
        let outside =
            |numbers: &[f32], low: f32| numbers.iter().any(|number| !(low..=1.0).contains(number));
        if let Some(velocity) = self.velocity.filter(|velocity| outside(velocity, -1.0)) {
            return fault("velocity", format!("{velocity:?}"), "numbers from -1 to 1");
        }
        let words = dwell_semantics::vocabulary::size();
        let said = self.utterance.iter().flat_map(|said| &said.tokens);
        let mut written = said.chain(&self.question);
        if let Some(token) = written.find(|token| **token as usize >= words) {
            let allowed = format!("numbers of words, 1 to {}, or 0 for none", words - 1);
            return fault("tokens", token.to_string(), &allowed);
        }
        match self.target {
            ActionTarget::Picture(place) if outside(&place, 0.0) => {
                fault("pixel", format!("{place:?}"), "numbers from 0 to 1")
            }
            _ => Ok(()),
        }
    }
}

/// Reads names of actions.
///
/// # Errors
/// [`WorldError::Unknown`] lists those there are; [`WorldError::Config`] for none, or one twice.
pub(crate) fn actions_named(names: &[String]) -> Result<Vec<DiscreteAction>, WorldError> {
    let find = |name: &String| {
        let known = DiscreteAction::ALL.into_iter();
        known
            .clone()
            .find(|action| action.name() == name)
            .ok_or_else(|| WorldError::Unknown {
                kind: "discrete action",
                name: name.clone(),
                known: known.map(|action| action.name().to_owned()).collect(),
            })
    };
    let found: Vec<DiscreteAction> = names.iter().map(find).collect::<Result<_, _>>()?;
    let fault = |found: String, allowed: &str| {
        Err(WorldError::Config {
            field: "actions",
            found,
            allowed: allowed.to_owned(),
        })
    };
    if found.is_empty() {
        return fault("[]".to_owned(), "at least one action");
    }
    match (1..found.len()).find(|k| found[..*k].contains(&found[*k])) {
        Some(k) => fault(format!("{} twice", found[k].name()), "each action once"),
        None => Ok(found),
    }
}

impl World {
    /// Returns, for each discrete action, whether nothing known beforehand rules it out: on what the agent looks at, or in a `mode` with
    /// targets on everything within its reach; true for all that use no hand. What is not ruled out may still fail.
    pub(crate) fn possible_actions(
        &mut self,
        agent: AgentId,
        step_sizes: StepSizes,
        mode: ActionMode,
    ) -> Result<[bool; DiscreteAction::ALL.len()], WorldError> {
        let mut mask = [true; DiscreteAction::ALL.len()];
        let mut near = None;
        for (possible, action) in mask.iter_mut().zip(DiscreteAction::ALL) {
            let step = AgentAction::new(agent, action, step_sizes);
            *possible = match self.hand_action(&step)? {
                None => true,
                Some(Err(_)) => false,
                Some(Ok(hand)) => self.check_action(agent, &*hand).is_ok(),
            };
            if !*possible && mode.has_targets() && action.kind().takes_target() {
                let near = near.get_or_insert_with(|| self.objects_within_reach(agent));
                *possible = self.is_possible_on_one_of(near, &step)?;
            }
        }
        Ok(mask)
    }

    /// Returns whether nothing rules an action out on one of `near`, of which those that turn out to be out of reach are removed.
    fn is_possible_on_one_of(
        &mut self,
        near: &mut Vec<ObjectId>,
        step: &AgentAction,
    ) -> Result<bool, WorldError> {
        let mut k = 0;
        while let Some(object) = near.get(k) {
            let target = HandTarget::At((*object).into());
            let Some(Ok(hand)) = self.hand_action(&AgentAction { target, ..*step })? else {
                return Ok(false);
            };
            match self
                .check_action(step.agent, &*hand)
                .map_err(|own| own.code)
            {
                // What hides the nearest point of a thing need not hide all of it.
                Ok(()) | Err(OutcomeCode::NotVisible) => return Ok(true),
                Err(OutcomeCode::TooFar | OutcomeCode::BehindAgent) => {
                    near.swap_remove(k);
                }
                Err(OutcomeCode::HandFull | OutcomeCode::HandEmpty) => return Ok(false),
                Err(_) => k += 1,
            }
        }
        Ok(false)
    }

    /// The objects whose boxes a hand of an agent may reach.
    fn objects_within_reach(&self, agent: AgentId) -> Vec<ObjectId> {
        let Some(own) = self.state().agents.get(agent) else {
            return Vec::new();
        };
        let (eye, reach_m) = (own.eye_position(), own.body.reach_m);
        let (house, state) = (self.house(), self.state());
        let in_reach = |object: &ObjectId| {
            let bounds = house.object_bounds(state, *object);
            eye.distance(eye.clamp(bounds.min, bounds.max)) <= reach_m
        };
        house.objects.ids().filter(in_reach).collect()
    }
}
