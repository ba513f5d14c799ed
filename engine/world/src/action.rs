//! The discrete actions of an agent, in the order of their numbers.

use crate::error::WorldError;
use crate::world::World;
use dwell_physics::{Action, ActionOutcome, AgentControl, OutcomeCode};
use dwell_scene::AgentId;
use serde::{Deserialize, Serialize};

/// What an agent does in one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DiscreteAction {
    /// Declares the task done.
    Stop,
    /// Walks forward.
    MoveForward,
    /// Turns to the left.
    TurnLeft,
    /// Turns to the right.
    TurnRight,
    /// Looks up.
    LookUp,
    /// Looks down.
    LookDown,
    /// Does nothing.
    Wait,
    /// Takes what it looks at.
    Pick,
    /// Lets go of what it holds.
    Drop,
    /// Opens what it looks at.
    Open,
    /// Closes what it looks at.
    Close,
    /// Switches what it looks at on or off.
    Toggle,
}

impl DiscreteAction {
    /// All actions, in the order of their numbers.
    pub const ALL: [Self; 12] = [
        Self::Stop,
        Self::MoveForward,
        Self::TurnLeft,
        Self::TurnRight,
        Self::LookUp,
        Self::LookDown,
        Self::Wait,
        Self::Pick,
        Self::Drop,
        Self::Open,
        Self::Close,
        Self::Toggle,
    ];

    /// The action's name, as in action lists and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stop => "stop",
            Self::MoveForward => "move_forward",
            Self::TurnLeft => "turn_left",
            Self::TurnRight => "turn_right",
            Self::LookUp => "look_up",
            Self::LookDown => "look_down",
            Self::Wait => "wait",
            Self::Pick => "pick",
            Self::Drop => "drop",
            Self::Open => "open",
            Self::Close => "close",
            Self::Toggle => "toggle",
        }
    }
}

/// How far the movement actions go in one control step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StepSizes {
    /// m a step; 0.001 to 1, default 0.1 (2 m/s at 20 Hz).
    pub forward_m: f32,
    /// Degrees a step; 0.1 to 180, default 9 (180 degrees/s at 20 Hz).
    pub turn_deg: f32,
    /// Degrees a step; 0.1 to 90, default 9.
    pub look_deg: f32,
}

impl Default for StepSizes {
    fn default() -> Self {
        Self {
            forward_m: 0.1,
            turn_deg: 9.0,
            look_deg: 9.0,
        }
    }
}

impl StepSizes {
    /// Checks every range.
    ///
    /// # Errors
    /// [`crate::WorldError::Config`] names the field.
    pub fn check(&self) -> Result<(), crate::WorldError> {
        let range = |field: &'static str, value: f32, low: f32, high: f32| {
            if (low..=high).contains(&value) {
                return Ok(());
            }
            Err(crate::WorldError::Config {
                field,
                found: value.to_string(),
                allowed: format!("{low} to {high}"),
            })
        };
        range("forward_m", self.forward_m, 0.001, 1.0)?;
        range("turn_deg", self.turn_deg, 0.1, 180.0)?;
        range("look_deg", self.look_deg, 0.1, 90.0)
    }

    /// The velocities that make `action` happen within `step_s`.
    pub fn control(&self, action: DiscreteAction, step_s: f64) -> AgentControl {
        let rate = |degrees: f32| (f64::from(degrees).to_radians() / step_s) as f32;
        let mut control = AgentControl::default();
        match action {
            DiscreteAction::MoveForward => {
                control.forward_m_s = (f64::from(self.forward_m) / step_s) as f32;
            }
            DiscreteAction::TurnLeft => control.yaw_rate_rad_s = rate(self.turn_deg),
            DiscreteAction::TurnRight => control.yaw_rate_rad_s = -rate(self.turn_deg),
            DiscreteAction::LookUp => control.pitch_rate_rad_s = rate(self.look_deg),
            DiscreteAction::LookDown => control.pitch_rate_rad_s = -rate(self.look_deg),
            _ => {}
        }
        control
    }
}

impl World {
    /// Makes one control step of one agent's discrete action; all others stand still.
    ///
    /// # Errors
    /// [`WorldError::Usage`] for an agent that does not exist.
    pub fn act_discrete(
        &mut self,
        agent: AgentId,
        action: DiscreteAction,
        stride: &StepSizes,
    ) -> Result<ActionOutcome, WorldError> {
        let outcome = self.use_hand(agent, action);
        let mut controls = vec![AgentControl::default(); self.state().agents.len()];
        let Some(control) = controls.get_mut(agent.0 as usize) else {
            return Err(WorldError::Usage(format!(
                "no agent {}; there are {}",
                agent.0,
                controls.len()
            )));
        };
        *control = stride.control(action, self.config().step_s());
        self.step(&controls)?;
        Ok(outcome.unwrap_or_else(|| {
            if self.state().agents[agent].collided {
                let sentence = "Something is in the way. Turn or step aside.";
                ActionOutcome::failed(OutcomeCode::Blocked, sentence, None)
            } else {
                ActionOutcome::done(OutcomeCode::Done, "", None)
            }
        }))
    }

    /// Returns what the hand does to the thing the agent looks at; `None` for an action of the feet or neck.
    fn use_hand(&mut self, agent: AgentId, action: DiscreteAction) -> Option<ActionOutcome> {
        let on_target: fn(dwell_scene::ObjectId) -> Action = match action {
            DiscreteAction::Drop => return Some(self.act(agent, &Action::Drop)),
            DiscreteAction::Pick => Action::pick,
            DiscreteAction::Open => |object| Action::open(object),
            DiscreteAction::Close => |object| Action::close(object),
            DiscreteAction::Toggle => |object| Action::toggle(object),
            _ => return None,
        };
        Some(if let Some(object) = self.gaze_target(agent) {
            self.act(agent, &on_target(object))
        } else {
            let sentence =
                "You look at nothing that you could take, open or switch. Turn towards it.";
            ActionOutcome::failed(OutcomeCode::NoTarget, sentence, None)
        })
    }
}
