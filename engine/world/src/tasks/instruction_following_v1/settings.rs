//! Settings of the task.

use super::drawn_instruction::InstructionForm;
use super::step_candidates::MOST_THINGS;
use crate::error::WorldError;
use crate::tasks::navigation::{NavigationRules, navigation_settings};
use dwell_semantics::instruct::{InstructionSplit, StepKind};

navigation_settings! {
    /// The task's settings.
    pub(super) InstructionFollowingV1Settings {
        /// Forms of instructions to draw from; default all but `route`.
        forms: Vec<InstructionForm> = InstructionForm::BY_DEFAULT.to_vec(),
        /// Kinds of steps to draw from; default all that the agent's actions can carry out.
        kinds: Vec<StepKind> = StepKind::ALL.to_vec(),
        /// The greatest number of steps of a sequence, 2 or 3; default 2.
        max_sequence_steps: u32 = 2,
        /// The greatest number of things that are left to do of a `quantity`, 1 to 4; default 4.
        max_things: usize = MOST_THINGS,
        /// The longest walkable way on which a thing is carried, m; default as long as the whole way.
        max_transport_m: Option<f64> = None,
        /// Which instructions by their words: `train` holds out pairs of colour and noun, relations and wordings, `colors`, `relations`
        /// and `wordings` ask for what is held out; default all.
        words: InstructionSplit = InstructionSplit::All,
        /// What every step that is done is paid, beside `reward`; default 0.5.
        step_done_reward: f64 = 0.5,
    }
}

impl InstructionFollowingV1Settings {
    /// Reads settings and checks them.
    ///
    /// # Errors
    /// [`WorldError::Config`] names the field.
    pub(super) fn read(value: &serde_json::Value) -> Result<(Self, NavigationRules), WorldError> {
        let (settings, rules) = Self::parse(value)?;
        let fault = |field: &'static str, found: String, allowed: String| {
            Err(WorldError::Config {
                field,
                found,
                allowed,
            })
        };
        if settings.kinds.is_empty() {
            let names = StepKind::ALL.map(StepKind::name).join(", ");
            let allowed = format!("at least one of {names}");
            return fault("kinds", "none".to_owned(), allowed);
        }
        if settings.forms.is_empty() {
            let names = InstructionForm::ALL.map(InstructionForm::name).join(", ");
            let allowed = format!("at least one of {names}");
            return fault("forms", "none".to_owned(), allowed);
        }
        let most = settings.max_sequence_steps;
        if !(2..=3).contains(&most) {
            let allowed = "2 or 3".to_owned();
            return fault("max_sequence_steps", most.to_string(), allowed);
        }
        if !(1..=MOST_THINGS).contains(&settings.max_things) {
            let allowed = format!("1 to {MOST_THINGS}");
            return fault("max_things", settings.max_things.to_string(), allowed);
        }
        if let Some(most) = settings.max_transport_m
            && !(0.0..=1e6).contains(&most)
        {
            let allowed = "0 to 1,000,000".to_owned();
            return fault("max_transport_m", most.to_string(), allowed);
        }
        if settings.step_done_reward.is_nan() || settings.step_done_reward.abs() > 1e6 {
            let found = settings.step_done_reward.to_string();
            let allowed = "-1,000,000 to 1,000,000".to_owned();
            return fault("step_done_reward", found, allowed);
        }
        Ok((settings, rules))
    }
}
