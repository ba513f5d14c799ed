//! Go to the thing that was heard, which falls silent on the way; then stop in front of it.
//!
//! # Source
//! C. Chen et al., "Semantic Audio-Visual Navigation", CVPR 2021: things sound as their kind does, for a time; success within 1 m of
//! the thing; a second thing may sound, too (distractor).

use super::audio_nav::{ASKED, play_signal};
use super::goal_cells::LargestIslandIndex;
use super::navigation::{GoalKind, NavigationGoal, NavigationTask, navigation_settings};
use super::point_nav::check_success_distance;
use super::{Task, TaskKind, TaskSetup};
use crate::actions::DiscreteAction;
use crate::episode::{EpisodeGoal, GoalField, category_of_class};
use crate::episode_spec::StatedGoal;
use crate::error::WorldError;
use crate::schema;
use crate::sound::{SoundPlace, check_level};
use crate::world::World;
use dwell_render::{ClassSet, EntityClasses};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, ObjectId};
use dwell_semantics::instruct::InstructionGoal;

/// The signal of things of a class.
const SIGNALS: [(&str, &str); 23] = [
    ("cellphone", "phone"),
    ("clock", "clock"),
    ("coffee_machine", "kettle"),
    ("computer", "hum"),
    ("cooker", "kettle"),
    ("dishwasher", "dishwasher"),
    ("dryer", "washing_machine"),
    ("fan", "fan"),
    ("hair_dryer", "hair_dryer"),
    ("kettle", "kettle"),
    ("loudspeaker", "radio"),
    ("microwave", "microwave"),
    ("radio", "radio"),
    ("range_hood", "fan"),
    ("refrigerator", "fridge"),
    ("sink", "tap"),
    ("stereo_set", "radio"),
    ("tap", "tap"),
    ("telephone", "phone"),
    ("television", "television"),
    ("toilet", "toilet_flush"),
    ("vacuum_cleaner", "vacuum_cleaner"),
    ("washer", "washing_machine"),
];

pub(super) const KIND: TaskKind = TaskKind {
    name: SemanticAudioNav::NAME,
    version: 0,
    about: "Go to the thing that was heard, also when it has fallen silent, and stop within 1 m of it with the thing in view.",
    has_goal: true,
    min_agents: 1,
    goal_parts: &[GoalField::Class],
    max_steps: 1000,
    actions: DiscreteAction::DEFAULT,
    sensors: &["rgb", "depth", "gps", "compass", "audio", "spectrogram"],
    measures: &[],
    settings: schema::fields_of::<SemanticAudioNavSettings>,
    build,
};

navigation_settings! {
    /// The task's settings.
    SemanticAudioNavSettings {
        /// Whether the thing sounds all the time; by default once, for 2 to 12 s.
        loops: bool = false,
        /// Other things that sound at the same time, each with another signal than the goal, 0 to 8; default 0.
        distractors: u32 = 0,
        /// Level at 1 m, dB SPL; default the typical level of each signal.
        level_db: Option<f32> = None,
        /// Success within this distance of the thing's outline, seen from above, m; default 1.
        success_distance_m: f64 = 1.0,
    }
}

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let (settings, rules) = SemanticAudioNavSettings::parse(value)?;
    check_success_distance(settings.success_distance_m)?;
    settings.level_db.map_or(Ok(()), check_level)?;
    if settings.distractors > 8 {
        return Err(WorldError::Config {
            field: "distractors",
            found: settings.distractors.to_string(),
            allowed: "0 to 8".to_owned(),
        });
    }
    Ok(Box::new(NavigationTask::new(
        SemanticAudioNav { settings },
        rules,
        setup,
    )))
}

/// A thing of a kind that sounds.
struct SoundingThing {
    object: ObjectId,
    /// As the sensor `semantic` numbers them by default.
    class: i32,
    signal: &'static str,
}

fn sounding_things(world: &World) -> Vec<SoundingThing> {
    let house = world.house();
    let classes = EntityClasses::new(house, ClassSet::Coarse);
    let of = |object: ObjectId| {
        let class = classes.of(house.entity_of_object(object).0);
        let name = category_of_class(class)?.name;
        let (_, signal) = SIGNALS.iter().find(|(class, _)| *class == name)?;
        Some(SoundingThing {
            object,
            class,
            signal,
        })
    };
    house.objects.ids().filter_map(of).collect()
}

#[derive(Debug)]
struct SemanticAudioNav {
    settings: SemanticAudioNavSettings,
}

impl SemanticAudioNav {
    fn play(&self, world: &mut World, thing: &SoundingThing) -> Result<(), WorldError> {
        let SemanticAudioNavSettings {
            level_db, loops, ..
        } = self.settings;
        let place = SoundPlace::Object(thing.object);
        play_signal(world, thing.signal, (place, level_db, loops))
    }
}

impl GoalKind for SemanticAudioNav {
    const NAME: &'static str = "SemanticAudioNav";
    const LACKS: &'static str =
        "it has no thing of a kind that sounds, or none that one can stand near and see";

    fn settings(&self) -> serde_json::Value {
        serde_json::json!(self.settings)
    }

    fn survey(
        &self,
        world: &World,
        agent: AgentId,
        ground: &LargestIslandIndex<'_>,
    ) -> Vec<NavigationGoal> {
        let sounding = sounding_things(world).into_iter().filter_map(|thing| {
            let SoundingThing { object, class, .. } = thing;
            let radius_m = self.settings.success_distance_m as f32;
            let goal = InstructionGoal::objects(vec![object], radius_m);
            let told = EpisodeGoal {
                kind: "sound",
                objects: vec![object],
                class,
                ..EpisodeGoal::default()
            };
            NavigationGoal::from_instruction_goal((world, agent), ground, goal, told)
        });
        sounding.collect()
    }

    fn begin(
        &self,
        world: &mut World,
        goal: &NavigationGoal,
        _asked: Option<&StatedGoal>,
        key: RandomKey,
    ) -> Result<String, WorldError> {
        let all = sounding_things(world);
        let asked = all
            .iter()
            .find(|thing| goal.told.objects.contains(&thing.object));
        if let Some(asked) = asked {
            self.play(world, asked)?;
            // What sounds like the goal could not be told from it.
            let mut others: Vec<&SoundingThing> = all.iter().collect();
            others.retain(|thing| thing.signal != asked.signal);
            key.child("distractors").stream().shuffle(&mut others);
            for thing in others.into_iter().take(self.settings.distractors as usize) {
                self.play(world, thing)?;
            }
        }
        Ok(ASKED.to_owned())
    }
}
