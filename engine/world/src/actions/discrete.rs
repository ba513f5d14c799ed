//! A control step of discrete actions.

use super::hand_action_order::HandActionOrder;
use super::step_sizes::turn_rate_rad_s;
use super::{DiscreteAction, StepSizes};
use crate::error::WorldError;
use crate::world::World;
use dwell_physics::actions::PlaceInPose;
use dwell_physics::{ActionOutcome, AgentControl, HandAction, OutcomeCode, Target};
use dwell_scene::{AgentId, Id, Locomotion, Pose};
use serde_json::Map;

/// A discrete action of one agent in a control step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AgentAction {
    /// The agent.
    pub agent: AgentId,
    /// The action.
    pub action: DiscreteAction,
    /// Velocities in place of the action's own: forward, right, turn to the left, look up, as shares of what movement actions
    /// make, -1 to 1. Wheels that do not go sideways leave the second out.
    pub velocity: Option<[f32; 4]>,
    /// What a hand is used on.
    pub target: HandTarget,
    /// Lengths and angles of its movement actions.
    pub step_sizes: StepSizes,
}

/// What a hand is used on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HandTarget {
    /// The thing in the middle of the view.
    Gaze,
    /// What is stated.
    At(Target),
    /// The pose in which the first part of what is held is left; for `place` alone.
    Pose(Pose),
    /// A place of a picture that shows nothing.
    Nothing,
}

impl AgentAction {
    /// An action on what the agent looks at, with the velocities of its own.
    pub fn new(agent: AgentId, action: DiscreteAction, step_sizes: StepSizes) -> Self {
        Self {
            agent,
            action,
            velocity: None,
            target: HandTarget::Gaze,
            step_sizes,
        }
    }

    /// The velocities of the body in a step of `step_s`.
    fn control(&self, world: &World, step_s: f64) -> AgentControl {
        let Some([forward, right, turn, look]) = self.velocity else {
            return self.action.kind().control(&self.step_sizes, step_s);
        };
        let sizes = &self.step_sizes;
        let step_m_s = (f64::from(sizes.forward_m) / step_s) as f32;
        let body = world.state().agents.get(self.agent);
        let rolls = body
            .is_some_and(|agent| matches!(agent.body.locomotion, Locomotion::DifferentialDrive(_)));
        AgentControl {
            forward_m_s: forward * step_m_s,
            right_m_s: if rolls { 0.0 } else { right * step_m_s },
            yaw_rate_rad_s: turn * turn_rate_rad_s(sizes.turn_deg, step_s),
            pitch_rate_rad_s: look * turn_rate_rad_s(sizes.look_deg, step_s),
            ..AgentControl::default()
        }
    }
}

impl World {
    /// Makes one control step of one agent's discrete action; all others stand still.
    ///
    /// # Errors
    /// Those of [`World::step_discrete_actions`].
    pub fn act_discrete(
        &mut self,
        agent: AgentId,
        action: DiscreteAction,
        stride: &StepSizes,
    ) -> Result<ActionOutcome, WorldError> {
        let step = AgentAction::new(agent, action, *stride);
        let mut outcomes = self.step_discrete_actions(&[step])?;
        let none = || WorldError::InvalidCall("no action was made".to_owned());
        outcomes.pop().ok_or_else(none)
    }

    /// Makes one control step of several agents' discrete actions, at most one for each; all others stand still. Hands act
    /// before the step, the nearest to its thing first, whatever the agents' numbers. Returns what became of each.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an agent that does not exist; nothing has changed then.
    pub fn step_discrete_actions(
        &mut self,
        steps: &[AgentAction],
    ) -> Result<Vec<ActionOutcome>, WorldError> {
        let step_s = self.config().step_s();
        let mut controls = vec![AgentControl::default(); self.state().agents.len()];
        for step in steps {
            let count = controls.len();
            let own = step.control(self, step_s);
            let Some(control) = controls.get_mut(step.agent.index()) else {
                return Err(WorldError::InvalidCall(format!(
                    "no agent {}; there are {count}",
                    step.agent.0
                )));
            };
            *control = own;
        }
        let mut hands = vec![None; steps.len()];
        let HandActionOrder { order, contested } = self.hand_order(steps);
        for place in order {
            hands[place] = match contested[place] {
                Some(object) => Some(self.contested_outcome(object)),
                None => self.use_hand(&steps[place])?,
            };
        }
        self.step(&controls)?;
        let outcomes = steps.iter().zip(hands);
        Ok(outcomes
            .map(|(step, hand)| hand.unwrap_or_else(|| self.movement_outcome(step.agent)))
            .collect())
    }

    /// Returns what became of an action of the feet or neck in the step that has just been made.
    fn movement_outcome(&self, agent: AgentId) -> ActionOutcome {
        if self.state().agents[agent].collided {
            let sentence = "Something is in the way. Turn or step aside.";
            ActionOutcome::failed(OutcomeCode::Blocked, sentence, None)
        } else {
            ActionOutcome::done(OutcomeCode::Done, "", None)
        }
    }

    /// Performs the hand's part of an action; `None` for an action of the feet or neck.
    fn use_hand(&mut self, step: &AgentAction) -> Result<Option<ActionOutcome>, WorldError> {
        Ok(self.hand_action(step)?.map(|action| match action {
            Ok(action) => self.act(step.agent, &*action),
            Err(refusal) => refusal,
        }))
    }

    /// Returns the hand's part of an action, or the refusal where it has no target; `None` for an action of the feet or neck.
    pub(super) fn hand_action(
        &self,
        step: &AgentAction,
    ) -> Result<Option<HandActionResult>, WorldError> {
        let kind = step.action.kind();
        if !kind.is_hand_action() {
            return Ok(None);
        }
        let refuse = |sentence: &str| {
            let outcome = ActionOutcome::failed(OutcomeCode::NoTarget, sentence, None);
            Ok(Some(Err(outcome)))
        };
        // These two find themselves what is in view: a surface, or whatever is pointed at.
        let finds = matches!(step.action, DiscreteAction::Place | DiscreteAction::Point);
        let target = match step.target {
            _ if !kind.takes_target() => None,
            HandTarget::At(target) => Some(target),
            HandTarget::Pose(world_from_part) if step.action == DiscreteAction::Place => {
                let action: Box<dyn HandAction> = Box::new(PlaceInPose { world_from_part });
                return Ok(Some(Ok(action)));
            }
            HandTarget::Nothing => {
                return refuse("That place of the picture shows nothing. Choose another.");
            }
            HandTarget::Gaze | HandTarget::Pose(_) if finds => None,
            HandTarget::Gaze | HandTarget::Pose(_) => {
                match self.object_in_view_centre(step.agent) {
                    Some(object) => Some(object.into()),
                    None => {
                        return refuse(
                            "You look at nothing that you could take, open or switch. Turn towards it.",
                        );
                    }
                }
            }
        };
        Ok(Some(Ok(kind.parse_hand_action(target, Map::new())?)))
    }
}

/// The hand's part of an action, or why it is refused.
pub(super) type HandActionResult = Result<Box<dyn HandAction>, ActionOutcome>;
