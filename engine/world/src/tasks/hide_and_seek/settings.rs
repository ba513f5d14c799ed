//! Settings of the task, and who is who.

use crate::error::WorldError;
use crate::world::World;
use dwell_scene::AgentId;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the scripted seeker looks for hiders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum SeekerExpert {
    /// It knows where they are, and goes to the nearest one that was not found yet.
    #[default]
    Knows,
    /// It knows the house alone: it walks from place to place, and looks around at each.
    Tours,
}

/// The task's settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct HideAndSeekSettings {
    /// The numbers of the agents who seek, at least one and not all; all others hide. By default the second half of the agents, of three the last one.
    pub(super) seekers: Option<Vec<u32>>,
    /// Steps that seekers stay where they are before they may move, 0 or more and fewer than `steps`; default 240.
    pub(super) wait_steps: u64,
    /// Steps of an episode, 2 to 100,000; default 600.
    pub(super) steps: u64,
    /// Angle of the cone around where a seeker looks in which it sees, degrees, above 0 to 360; default 90.
    pub(super) view_deg: f32,
    /// How far a seeker sees, straight m, above 0 to 100; default 10.
    pub(super) view_distance_m: f32,
    /// How the scripted seeker looks for hiders: `knows` (it knows where they are) or `tours` (it knows the house alone); default `knows`.
    pub(super) seeker_expert: SeekerExpert,
}

impl Default for HideAndSeekSettings {
    fn default() -> Self {
        Self {
            seekers: None,
            wait_steps: 240,
            steps: 600,
            view_deg: 90.0,
            view_distance_m: 10.0,
            seeker_expert: SeekerExpert::default(),
        }
    }
}

impl HideAndSeekSettings {
    /// # Errors
    /// [`WorldError::Config`] names the setting.
    pub(super) fn check(&self) -> Result<(), WorldError> {
        let fault = |field: &'static str, found: String, allowed: String| {
            Err(WorldError::Config {
                field,
                found,
                allowed,
            })
        };
        if !(2..=100_000).contains(&self.steps) {
            let found = self.steps.to_string();
            return fault("steps", found, "2 to 100,000".to_owned());
        }
        if self.wait_steps >= self.steps {
            let allowed = format!("fewer than steps, {}", self.steps);
            return fault("wait_steps", self.wait_steps.to_string(), allowed);
        }
        if !(self.view_deg > 0.0 && self.view_deg <= 360.0) {
            let allowed = "above 0 to 360".to_owned();
            return fault("view_deg", self.view_deg.to_string(), allowed);
        }
        if !(self.view_distance_m > 0.0 && self.view_distance_m <= 100.0) {
            let found = self.view_distance_m.to_string();
            return fault("view_distance_m", found, "above 0 to 100".to_owned());
        }
        Ok(())
    }

    /// Half of the cone in which a seeker sees, rad.
    pub(super) fn half_view_rad(&self) -> f32 {
        0.5 * self.view_deg.to_radians()
    }
}

/// Who hides and who seeks.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Teams {
    /// Rising.
    pub(super) hiders: Vec<AgentId>,
    /// Rising.
    pub(super) seekers: Vec<AgentId>,
}

impl Teams {
    /// # Errors
    /// [`WorldError::Config`] for seekers that do not exist, none and all.
    pub(super) fn of(settings: &HideAndSeekSettings, world: &World) -> Result<Self, WorldError> {
        let count = world.state().agents.len() as u32;
        let usual = || (count.div_ceil(2)..count).collect();
        let named: Vec<u32> = settings.seekers.clone().unwrap_or_else(usual);
        let (seekers, hiders): (Vec<u32>, Vec<u32>) =
            (0..count).partition(|agent| named.contains(agent));
        let known = named.iter().all(|agent| *agent < count) && seekers.len() == named.len();
        if !known || seekers.is_empty() || hiders.is_empty() {
            return Err(WorldError::Config {
                field: "seekers",
                found: format!("{named:?} of {count} agents"),
                allowed: "numbers of agents, each once, at least one and not all of them"
                    .to_owned(),
            });
        }
        let ids = |numbers: Vec<u32>| numbers.into_iter().map(AgentId).collect();
        Ok(Self {
            hiders: ids(hiders),
            seekers: ids(seekers),
        })
    }
}
