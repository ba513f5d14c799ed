//! Settling of objects before a world begins.

use super::PhysicsWorld;
use crate::contact::ExcessEventTotals;
use crate::error::PhysicsError;
use dwell_scene::{State, interrupt};

/// Longest settling time, s.
const LONGEST_S: f64 = 60.0;

impl PhysicsWorld {
    /// Lets objects fall, lean and come to rest for at most `longest_s`, 0 to 60 s, less where all rest sooner; agents
    /// stand still. Then time begins: no events of the settling are reported.
    ///
    /// Copies of a settled world begin with most of their bodies cached, and so with a tenth of the work.
    ///
    /// # Errors
    /// [`PhysicsError::Range`] for another duration, [`PhysicsError::ForeignState`] for another world's state. Nothing has happened
    /// then.
    pub fn settle(&mut self, state: &mut State, longest_s: f64) -> Result<(), PhysicsError> {
        if !(0.0..=LONGEST_S).contains(&longest_s) {
            return Err(PhysicsError::Range {
                at: "world".to_owned(),
                field: "settle_s",
                found: longest_s.to_string(),
                allowed: "0 to 60 s",
            });
        }
        self.check_state(state)?;
        let steps = longest_s * f64::from(self.dynamics.settings.config.control_rate_hz);
        let mut events = Vec::new();
        for _ in 0..steps.round() as u64 {
            interrupt::unwind_if_cancelled();
            self.step(state, &[], &mut events)?;
            events.clear();
            if self.awake_count() == 0 {
                break;
            }
        }
        self.dynamics.tick = 0;
        self.contacts.tracker.forget_events();
        self.contacts.merged_events = ExcessEventTotals::default();
        self.notices.clear();
        Ok(())
    }
}
