//! Go to a point, given by distance and direction; then stop.
//!
//! # Source
//! `PointNav` of P. Anderson et al., "On Evaluation of Embodied Navigation Agents", arXiv:1807.06757 (2018); the success distance of
//! habitat-lab: 0.2 m, twice the radius of its agent.

use super::navigation::{
    GoalContext, GoalKind, NavigationGoal, NavigationTask, StatedPoint, navigation_settings,
};
use super::{Task, TaskKind, TaskSetup};
use crate::actions::DiscreteAction;
use crate::episode::GoalField;
use crate::episode_spec::StatedGoal;
use crate::error::WorldError;
use crate::schema;
use crate::world::World;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::random::RandomKey;
use std::sync::Arc;

pub(super) const KIND: TaskKind = TaskKind {
    name: PointNav::NAME,
    version: 0,
    about: "Go to a point that is given by distance and direction, then stop within 0.2 m of it.",
    has_goal: true,
    min_agents: 1,
    goal_parts: &[GoalField::Position],
    max_steps: 1000,
    actions: DiscreteAction::DEFAULT,
    sensors: &["rgb", "depth", "pointgoal_with_gps_compass"],
    measures: &[],
    settings: schema::fields_of::<PointNavSettings>,
    build,
};

navigation_settings! {
    /// The task's settings.
    PointNavSettings {
        /// Success below this geodesic distance to the point, m; default 0.2.
        success_distance_m: f64 = 0.2,
    }
}

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let (settings, rules) = PointNavSettings::parse(value)?;
    check_success_distance(settings.success_distance_m)?;
    Ok(Box::new(NavigationTask::new(
        PointNav { settings },
        rules,
        setup,
    )))
}

/// Refuses distances within which nobody can stop.
pub(super) fn check_success_distance(success_distance_m: f64) -> Result<(), WorldError> {
    if (0.05..=10.0).contains(&success_distance_m) {
        return Ok(());
    }
    Err(WorldError::Config {
        field: "success_distance_m",
        found: success_distance_m.to_string(),
        allowed: "0.05 to 10".to_owned(),
    })
}

#[derive(Debug)]
struct PointNav {
    settings: PointNavSettings,
}

impl GoalKind for PointNav {
    const NAME: &'static str = "PointNav";
    const LACKS: &'static str = "nobody of the agent's size can stand anywhere";

    fn settings(&self) -> serde_json::Value {
        serde_json::json!(self.settings)
    }

    fn draw(
        &self,
        grid: &NavGrid,
        key: RandomKey,
        allowed: &dyn Fn(NavCell) -> bool,
    ) -> Option<NavigationGoal> {
        let cell = grid.sample(key, allowed)?;
        Some(NavigationGoal::at_cell(
            "point",
            grid,
            cell,
            self.settings.success_distance_m,
        ))
    }

    fn stated(
        &self,
        site: &GoalContext<'_>,
        asked: &StatedGoal,
    ) -> Result<Arc<NavigationGoal>, WorldError> {
        asked.reject_other_fields(Self::NAME, &["position"])?;
        let place = asked.position(Self::NAME)?;
        let point = StatedPoint::on_grid(site.grid, "episode.goal.position", place)?;
        let radius_m = self.settings.success_distance_m;
        Ok(Arc::new(NavigationGoal::at_point("point", point, radius_m)))
    }

    fn begin(
        &self,
        _world: &mut World,
        _goal: &NavigationGoal,
        _asked: Option<&StatedGoal>,
        _key: RandomKey,
    ) -> Result<String, WorldError> {
        Ok("Go to the goal.".to_owned())
    }
}
