//! Go to where a sound comes from; then stop.
//!
//! # Source
//! `AudioGoal` of C. Chen et al., "SoundSpaces: Audio-Visual Navigation in 3D Environments", ECCV 2020: the source stands 1.5 m over
//! the floor and sounds all the time; success within 1 m.

use super::navigation::{
    GoalContext, GoalKind, NavigationGoal, NavigationTask, StatedPoint, navigation_settings,
};
use super::point_nav::check_success_distance;
use super::{Task, TaskKind, TaskSetup};
use crate::actions::DiscreteAction;
use crate::episode_spec::StatedGoal;
use crate::error::WorldError;
use crate::schema;
use crate::sound::{PlayRequest, SoundName, SoundPlace, check_level, default_level_db};
use crate::world::World;
use dwell_acoustics::signals;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::sync::Arc;

/// The words of the instruction.
pub(super) const ASKED: &str = "Go to the sound.";
/// Height of the source over the floor, m.
const SOURCE_HEIGHT_M: f32 = 1.5;
/// Sounds that are drawn by default: of the kinds that people at home walk to.
pub(super) const SOUNDS: [&str; 8] = [
    "alarm",
    "doorbell",
    "kettle",
    "phone",
    "radio",
    "speech",
    "television",
    "vacuum_cleaner",
];

pub(super) const KIND: TaskKind = TaskKind {
    name: AudioNav::NAME,
    version: 0,
    about: "Go to where a sound comes from, then stop within 1 m of there.",
    has_goal: true,
    min_agents: 1,
    goal_parts: &[],
    max_steps: 1000,
    actions: DiscreteAction::DEFAULT,
    sensors: &["rgb", "depth", "audio", "spectrogram"],
    measures: &[],
    settings: schema::fields_of::<AudioNavSettings>,
    build,
};

navigation_settings! {
    /// The task's settings.
    AudioNavSettings {
        /// Signals to draw from, as `dwell.sounds.signals` names them; default eight of a household.
        sounds: Vec<String> = SOUNDS.map(str::to_owned).to_vec(),
        /// Level at 1 m, dB SPL; default the typical level of each signal.
        level_db: Option<f32> = None,
        /// Success below this geodesic distance to the place under the source, m; default 1.
        success_distance_m: f64 = 1.0,
    }
}

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let (settings, rules) = AudioNavSettings::parse(value)?;
    check_success_distance(settings.success_distance_m)?;
    check_sounds(&settings.sounds, settings.level_db)?;
    Ok(Box::new(NavigationTask::new(
        AudioNav { settings },
        rules,
        setup,
    )))
}

/// Refuses signals that do not exist, none at all, and levels out of range.
pub(super) fn check_sounds(sounds: &[String], level_db: Option<f32>) -> Result<(), WorldError> {
    if sounds.is_empty() {
        return Err(WorldError::Config {
            field: "sounds",
            found: "none".to_owned(),
            allowed: "at least one signal".to_owned(),
        });
    }
    for name in sounds {
        signals::info(name)?;
    }
    level_db.map_or(Ok(()), check_level)
}

/// The level of a sound for which nobody states one, dB SPL at 1 m.
fn usual_level_db(sound: &SoundName) -> Result<f32, WorldError> {
    default_level_db(sound)?.ok_or_else(|| WorldError::Config {
        field: "episode.goal",
        found: format!("one of {sound} without level_db"),
        allowed: "one with level_db, dB SPL at 1 m: a recording has no usual level".to_owned(),
    })
}

/// Plays a signal at a place, by default at its typical level, once or for ever.
pub(super) fn play_signal(
    world: &mut World,
    name: &str,
    (place, level_db, loops): (SoundPlace, Option<f32>, bool),
) -> Result<(), WorldError> {
    let request = PlayRequest {
        sound: SoundName::Signal(name.to_owned()),
        place,
        level_db: match level_db {
            Some(level_db) => level_db,
            None => signals::info(name)?.typical_level_db,
        },
        loops,
    };
    world.play(request).map(|_| ())
}

#[derive(Debug)]
struct AudioNav {
    settings: AudioNavSettings,
}

impl GoalKind for AudioNav {
    const NAME: &'static str = "AudioNav";
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
            "sound",
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
        let own = [
            "position",
            "sound",
            "sound_file",
            "level_db",
            "height_m",
            "offset_s",
            "duration_s",
        ];
        asked.reject_other_fields(Self::NAME, &own)?;
        if asked.sound.is_some() && asked.sound_file.is_some() {
            return Err(WorldError::Config {
                field: "episode.goal",
                found: "one with sound and sound_file".to_owned(),
                allowed: "one of the two".to_owned(),
            });
        }
        let place = asked.position(Self::NAME)?;
        let point = StatedPoint::on_grid(site.grid, "episode.goal.position", place)?;
        let radius_m = self.settings.success_distance_m;
        Ok(Arc::new(NavigationGoal::at_point("sound", point, radius_m)))
    }

    fn begin(
        &self,
        world: &mut World,
        goal: &NavigationGoal,
        asked: Option<&StatedGoal>,
        key: RandomKey,
    ) -> Result<String, WorldError> {
        let sounds = &self.settings.sounds;
        let (Some(floor), Some(drawn)) = (
            goal.told.position,
            key.child("sound").stream().choose(sounds),
        ) else {
            return Ok(ASKED.to_owned());
        };
        let asked = asked.cloned().unwrap_or_default();
        let height_m = asked.height_m.unwrap_or(SOURCE_HEIGHT_M);
        let sound = match asked.sound_file {
            Some(path) => SoundName::File(path),
            None => SoundName::Signal(asked.sound.unwrap_or_else(|| drawn.clone())),
        };
        let level_db = asked.level_db.or(self.settings.level_db);
        let request = PlayRequest {
            level_db: match level_db {
                Some(level_db) => level_db,
                None => usual_level_db(&sound)?,
            },
            sound,
            place: SoundPlace::Point(floor + Vec3::Y * height_m),
            loops: true,
        };
        world.play_scheduled(request, asked.offset_s, asked.duration_s)?;
        Ok(ASKED.to_owned())
    }
}
