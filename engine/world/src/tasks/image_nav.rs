//! Go to where a picture was taken; then stop.
//!
//! # Source
//! The success distance of L. Mezghani et al., "Memory-Augmented Reinforcement Learning for Image-Goal Navigation", IROS 2022: 1 m.

use super::navigation::{GoalKind, NavigationGoal, NavigationTask, navigation_settings};
use super::point_nav::check_success_distance;
use super::{Task, TaskKind, TaskSetup, random_yaw_rad};
use crate::actions::DiscreteAction;
use crate::episode::GoalField;
use crate::episode_spec::StatedGoal;
use crate::error::WorldError;
use crate::schema;
use crate::world::World;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::random::RandomKey;

pub(super) const KIND: TaskKind = TaskKind {
    name: ImageNav::NAME,
    version: 0,
    about: "Go to where a picture was taken, then stop within 1 m of there.",
    has_goal: true,
    min_agents: 1,
    goal_parts: &[GoalField::Image],
    max_steps: 1000,
    actions: DiscreteAction::DEFAULT,
    sensors: &["rgb", "depth", "imagegoal"],
    measures: &[],
    settings: schema::fields_of::<ImageNavSettings>,
    build,
};

navigation_settings! {
    /// The task's settings.
    ImageNavSettings {
        /// Success below this geodesic distance to where the picture was taken, m; default 1.
        success_distance_m: f64 = 1.0,
    }
}

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let (settings, rules) = ImageNavSettings::parse(value)?;
    check_success_distance(settings.success_distance_m)?;
    Ok(Box::new(NavigationTask::new(
        ImageNav { settings },
        rules,
        setup,
    )))
}

#[derive(Debug)]
struct ImageNav {
    settings: ImageNavSettings,
}

impl GoalKind for ImageNav {
    const NAME: &'static str = "ImageNav";
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
        let mut goal =
            NavigationGoal::at_cell("image", grid, cell, self.settings.success_distance_m);
        goal.told.yaw_rad = random_yaw_rad(key);
        Some(goal)
    }

    fn begin(
        &self,
        _world: &mut World,
        _goal: &NavigationGoal,
        _asked: Option<&StatedGoal>,
        _key: RandomKey,
    ) -> Result<String, WorldError> {
        Ok("Go to the place of the picture.".to_owned())
    }
}
