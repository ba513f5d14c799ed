//! Find a thing of a class, such as a chair: stand near it and look at it; then stop.
//!
//! # Source
//! The success rule of `RoboTHOR` (M. Deitke et al., CVPR 2020): `stop` within 1 m of a thing of the class that is in view.

use super::goal_cells::LargestIslandIndex;
use super::navigation::{
    GoalContext, GoalKind, NavigationGoal, NavigationTask, navigation_settings,
};
use super::point_nav::check_success_distance;
use super::stated_things::resolve_stated_objects;
use super::{Task, TaskKind, TaskSetup};
use crate::actions::DiscreteAction;
use crate::episode::{EpisodeGoal, GoalField, category_of_class};
use crate::episode_spec::StatedGoal;
use crate::error::WorldError;
use crate::schema;
use crate::world::World;
use dwell_render::{ClassSet, EntityClasses};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, ObjectId};
use dwell_semantics::category::categories;
use dwell_semantics::english;
use dwell_semantics::instruct::{InstructionGoal, is_search_target};
use std::collections::BTreeMap;
use std::sync::Arc;

pub(super) const KIND: TaskKind = TaskKind {
    name: ObjectNav::NAME,
    version: 0,
    about: "Find a thing of a class, such as a chair, and stop within 1 m of it with the thing in view.",
    has_goal: true,
    min_agents: 1,
    goal_parts: &[GoalField::Class],
    max_steps: 1000,
    actions: DiscreteAction::DEFAULT,
    sensors: &["rgb", "depth", "semantic", "gps", "compass", "objectgoal"],
    measures: &[],
    settings: schema::fields_of::<ObjectNavSettings>,
    build,
};

navigation_settings! {
    /// The task's settings.
    ObjectNavSettings {
        /// Classes to draw from, by the names of `assets/categories.csv`; default all that can be looked for.
        classes: Vec<String> = Vec::new(),
        /// Success within this distance of the thing's outline, seen from above, m; default 1.
        success_distance_m: f64 = 1.0,
    }
}

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let (settings, rules) = ObjectNavSettings::parse(value)?;
    check_success_distance(settings.success_distance_m)?;
    let rows = categories().rows();
    let known = |name: &String| rows.iter().any(|row| row.name == name);
    if let Some(name) = settings.classes.iter().find(|name| !known(name)) {
        return Err(WorldError::Unknown {
            kind: "class",
            name: name.clone(),
            known: rows.iter().map(|row| row.name.to_owned()).collect(),
        });
    }
    Ok(Box::new(NavigationTask::new(
        ObjectNav { settings },
        rules,
        setup,
    )))
}

#[derive(Debug)]
struct ObjectNav {
    settings: ObjectNavSettings,
}

impl GoalKind for ObjectNav {
    const NAME: &'static str = "ObjectNav";
    const LACKS: &'static str = "it has no thing of the classes that are asked for, or none that one can stand near and see";

    fn settings(&self) -> serde_json::Value {
        serde_json::json!(self.settings)
    }

    fn survey(
        &self,
        world: &World,
        agent: AgentId,
        ground: &LargestIslandIndex<'_>,
    ) -> Vec<NavigationGoal> {
        let radius_m = self.settings.success_distance_m as f32;
        class_goals((world, agent), ground, &self.settings.classes, radius_m)
    }

    fn stated(
        &self,
        site: &GoalContext<'_>,
        asked: &StatedGoal,
    ) -> Result<Arc<NavigationGoal>, WorldError> {
        asked.reject_other_fields(Self::NAME, &["class", "also", "objects", "positions"])?;
        let (objects, class) = resolve_stated_objects(site.world, asked)?;
        let mut offers = site.offers.iter();
        if let Some(offer) =
            offers.find(|offer| offer.told.class == class && offer.told.objects == objects)
        {
            return Ok(offer.clone());
        }
        let told = EpisodeGoal {
            kind: "object",
            objects: objects.clone(),
            class,
            ..EpisodeGoal::default()
        };
        let ground = LargestIslandIndex::of(site.grid);
        let radius_m = self.settings.success_distance_m as f32;
        let goal = InstructionGoal::objects(objects, radius_m);
        let found =
            NavigationGoal::from_instruction_goal((site.world, site.agent), &ground, goal, told);
        found.map(Arc::new).ok_or_else(|| WorldError::Config {
            field: "episode.goal",
            found: "one of things that nobody can stand near and see".to_owned(),
            allowed: "a goal that can be reached from the house's main floor".to_owned(),
        })
    }

    fn begin(
        &self,
        _world: &mut World,
        goal: &NavigationGoal,
        _asked: Option<&StatedGoal>,
        _key: RandomKey,
    ) -> Result<String, WorldError> {
        let noun = category_of_class(goal.told.class).map_or("thing", |row| row.singular);
        Ok(format!("Find {}.", english::with_article(noun)))
    }
}

/// The goals to find a thing of a class, for each class of which one stands near and in view of walkable places; of `asked`, or of all
/// that can be looked for without names.
pub(super) fn class_goals(
    (world, agent): (&World, AgentId),
    ground: &LargestIslandIndex<'_>,
    asked: &[String],
    radius_m: f32,
) -> Vec<NavigationGoal> {
    let house = world.house();
    let classes = EntityClasses::new(house, ClassSet::Coarse);
    let mut by_class: BTreeMap<i32, Vec<ObjectId>> = BTreeMap::new();
    for object in house.objects.ids() {
        let class = classes.of(house.entity_of_object(object).0);
        let sought = category_of_class(class).is_some_and(|row| {
            is_search_target(row) && (asked.is_empty() || asked.iter().any(|name| name == row.name))
        });
        if sought {
            by_class.entry(class).or_default().push(object);
        }
    }
    let goals = by_class.into_iter().filter_map(|(class, objects)| {
        let goal = InstructionGoal::objects(objects.clone(), radius_m);
        let told = EpisodeGoal {
            kind: "object",
            objects,
            class,
            ..EpisodeGoal::default()
        };
        NavigationGoal::from_instruction_goal((world, agent), ground, goal, told)
    });
    goals.collect()
}
