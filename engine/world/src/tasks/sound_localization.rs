//! Say where a sound comes from, and what it is: azimuth, elevation, distance and class, relative to the head.
//!
//! # Source
//! Errors of direction as great-circle angles, and 20 degrees as what counts as right: the location-dependent F-score of the DCASE
//! challenge's task of sound event localization and detection (A. Mesaros et al., "Joint Measurement of Localization and Detection of
//! Sound Events", WASPAA 2019).

use super::audio_nav::{SOUNDS, check_sounds, play_signal};
use super::standing_room::sample_start;
use super::{ExecutedAction, Task, TaskKind, TaskSetup, random_yaw_rad};
use crate::actions::DiscreteAction;
use crate::episode::{
    Answer, AnswerField, Episode, EpisodeGoal, MAX_ANSWER_FIELDS, StepResult, TaskMeasure,
};
use crate::error::WorldError;
use crate::metrics::NavigationMetrics;
use crate::schema;
use crate::sound::SoundPlace;
use crate::world::World;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::interrupt;
use dwell_scene::math;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, Pose};
use dwell_semantics::vocabulary;
use glam::{Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f32::consts::{FRAC_PI_2, PI};

const NAME: &str = "SoundLocalization";
const ASKED: &str = "Find the sound.";
/// Starts, and sources around each, that are tried for an episode.
const STARTS: u64 = 16;
const SOURCES: u64 = 32;
/// The furthest distance that can be answered, m.
const FURTHEST_M: f32 = 50.0;
/// Things nearer to a source than this would hold it, m.
const FREE_AROUND_M: f32 = 0.1;

const MEASURES: &[TaskMeasure] = &[
    TaskMeasure {
        name: "azimuth_error_deg",
        about: "Difference of the azimuths, 0 to 180 degrees.",
    },
    TaskMeasure {
        name: "elevation_error_deg",
        about: "Difference of the elevations, 0 to 180 degrees.",
    },
    TaskMeasure {
        name: "angular_error_deg",
        about: "Angle between both directions along a great circle, 0 to 180 degrees.",
    },
    TaskMeasure {
        name: "distance_error",
        about: "Difference of the distances as a share of the true one.",
    },
    TaskMeasure {
        name: "class_correct",
        about: "1 where the class is right, else 0.",
    },
];

pub(super) const KIND: TaskKind = TaskKind {
    name: NAME,
    version: 0,
    about: "Say where a sound comes from (azimuth, elevation, distance) and what it is.",
    has_goal: true,
    min_agents: 1,
    goal_parts: &[],
    max_steps: 1000,
    actions: DiscreteAction::DEFAULT,
    sensors: &["audio", "spectrogram"],
    measures: MEASURES,
    settings: schema::fields_of::<SoundLocalizationSettings>,
    build,
};

/// The task's settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct SoundLocalizationSettings {
    /// Signals to draw from, as `dwell.sounds.signals` names them; default eight of a household. Their order is that of `class`.
    sounds: Vec<String>,
    /// Level at 1 m, dB SPL; default the typical level of each signal.
    level_db: Option<f32>,
    /// Whether the sound goes on until the end; default true. Else it plays once.
    loops: bool,
    /// The nearest source, m from the head; default 0.5.
    min_distance_m: f32,
    /// The furthest source, m from the head, up to 50; default 6.
    max_distance_m: f32,
    /// The lowest source, m over the floor; default 0.3.
    min_height_m: f32,
    /// The highest source, m over the floor; default 2.
    max_height_m: f32,
    /// Whether nothing stands between source and head at the start; default true.
    in_sight: bool,
    /// Success below this angle between the answer and the direction, degrees, up to 180; default 20.
    success_angle_deg: f64,
    /// Whether success needs the right class, too; default true.
    needs_class: bool,
    /// What a step is paid: `success` (default 2.5), `step` (default -0.01), and with `stop` `angle` for each degree of the angular
    /// error (default 0).
    reward: LocalizationRewards,
}

/// Rewards of a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct LocalizationRewards {
    /// For success; default 2.5.
    success: f64,
    /// For every step; default -0.01.
    step: f64,
    /// For each degree of the angular error, with `stop`; default 0. Below 0 nearer answers are better.
    angle: f64,
}

impl Default for LocalizationRewards {
    fn default() -> Self {
        Self {
            success: 2.5,
            step: -0.01,
            angle: 0.0,
        }
    }
}

impl Default for SoundLocalizationSettings {
    fn default() -> Self {
        Self {
            sounds: SOUNDS.map(str::to_owned).to_vec(),
            level_db: None,
            loops: true,
            min_distance_m: 0.5,
            max_distance_m: 6.0,
            min_height_m: 0.3,
            max_height_m: 2.0,
            in_sight: true,
            success_angle_deg: 20.0,
            needs_class: true,
            reward: LocalizationRewards::default(),
        }
    }
}

impl SoundLocalizationSettings {
    fn check(&self) -> Result<(), WorldError> {
        check_sounds(&self.sounds, self.level_db)?;
        let sounds = &self.sounds;
        if let Some(k) = (1..sounds.len()).find(|k| sounds[..*k].contains(&sounds[*k])) {
            // Each is a class of its own.
            return Err(WorldError::Config {
                field: "sounds",
                found: format!("{:?} twice", sounds[k]),
                allowed: "each sound once".to_owned(),
            });
        }
        let fault = |field: &'static str, found: f64, allowed: String| {
            Err(WorldError::Config {
                field,
                found: found.to_string(),
                allowed,
            })
        };
        let range = |names: [&'static str; 2], [low, high]: [f32; 2], most: f32| {
            if !(0.0..=most).contains(&high) {
                return fault(names[1], f64::from(high), format!("0 to {most}"));
            }
            if !(0.0..=high).contains(&low) {
                let allowed = format!("0 to {}, which is {high}", names[1]);
                return fault(names[0], f64::from(low), allowed);
            }
            Ok(())
        };
        let distances = [self.min_distance_m, self.max_distance_m];
        range(["min_distance_m", "max_distance_m"], distances, FURTHEST_M)?;
        let heights = [self.min_height_m, self.max_height_m];
        range(["min_height_m", "max_height_m"], heights, 10.0)?;
        if !(0.0..=180.0).contains(&self.success_angle_deg) {
            let allowed = "0 to 180".to_owned();
            return fault("success_angle_deg", self.success_angle_deg, allowed);
        }
        let LocalizationRewards {
            success,
            step,
            angle,
        } = self.reward;
        for (field, value) in [
            ("reward.success", success),
            ("reward.step", step),
            ("reward.angle", angle),
        ] {
            if value.is_nan() || value.abs() > 1e6 {
                return fault(field, value, "-1,000,000 to 1,000,000".to_owned());
            }
        }
        Ok(())
    }
}

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let settings: SoundLocalizationSettings = crate::parse_settings::parse_task_settings(value)?;
    settings.check()?;
    Ok(Box::new(SoundLocalization {
        settings,
        setup,
        source: None,
        errors: None,
    }))
}

/// A direction and a distance relative to a head.
#[derive(Clone, Copy, Debug)]
struct RelativePlace {
    /// rad, positive to the left, -pi to pi.
    azimuth: f32,
    /// rad, positive up.
    elevation: f32,
    distance_m: f32,
}

impl RelativePlace {
    /// Of a point as a head hears it that is upright at `world_from_head`.
    fn of(world_from_head: Pose, point: Vec3) -> Self {
        let at = world_from_head.inverse().transform_point(point);
        let level_m = Vec2::new(at.x, at.z).length();
        Self {
            azimuth: math::atan2(-at.x, -at.z),
            elevation: math::atan2(at.y, level_m),
            distance_m: at.length(),
        }
    }

    /// The unit vector that points there: X to the right, Y up, -Z ahead.
    fn direction(&self) -> Vec3 {
        let (left, ahead) = math::sin_cos(self.azimuth);
        let (up, level) = math::sin_cos(self.elevation);
        Vec3::new(-left * level, up, -ahead * level)
    }

    /// The angle between two directions along a great circle, degrees: exact for small and for large ones (W. Kahan, "How Futile are
    /// Mindless Assessments of Roundoff in Floating-Point Computation?", 2006, section 12).
    fn angle_to_deg(&self, other: &Self) -> f64 {
        let (a, b) = (self.direction(), other.direction());
        let half = math::atan2((a - b).length(), (a + b).length());
        f64::from(2.0 * half).to_degrees()
    }
}

/// What is to be found.
#[derive(Clone, Copy, Debug)]
struct Source {
    position: Vec3,
    /// Of the settings' `sounds`.
    class: usize,
}

/// How far an answer is from the truth, in the order of [`MEASURES`].
#[derive(Clone, Copy, Debug)]
struct AnswerErrors {
    azimuth_deg: f64,
    elevation_deg: f64,
    angular_deg: f64,
    distance: f64,
    class_correct: bool,
}

impl AnswerErrors {
    /// `None` for an answer with what is no number.
    fn of(answer: &Answer, truth: &RelativePlace, class: usize) -> Option<Self> {
        let [azimuth, elevation, distance_m, given_class] = *answer;
        if !answer.iter().all(|number| number.is_finite()) {
            return None;
        }
        let given = RelativePlace {
            azimuth,
            elevation,
            distance_m,
        };
        let turn_deg = f64::from(azimuth - truth.azimuth)
            .to_degrees()
            .rem_euclid(360.0);
        let distance = f64::from(distance_m - truth.distance_m).abs();
        Some(Self {
            azimuth_deg: turn_deg.min(360.0 - turn_deg),
            elevation_deg: f64::from(elevation - truth.elevation).abs().to_degrees(),
            angular_deg: given.angle_to_deg(truth),
            distance: distance / f64::from(truth.distance_m.max(0.01)),
            class_correct: given_class.round() == class as f32,
        })
    }
}

#[derive(Debug)]
struct SoundLocalization {
    settings: SoundLocalizationSettings,
    setup: TaskSetup,
    source: Option<Source>,
    /// Of the answer, once it was given.
    errors: Option<AnswerErrors>,
}

impl SoundLocalization {
    /// Returns where the source is as the agent's head hears it.
    fn truth(&self, world: &World, source: &Source) -> Option<RelativePlace> {
        let agent = world.state().agents.get(self.setup.agent)?;
        Some(RelativePlace::of(agent.world_from_head(), source.position))
    }

    /// A place for a source that the agent can hear from where it stands.
    fn draw_source(&self, world: &World, grid: &NavGrid, key: RandomKey) -> Option<Vec3> {
        let agent = world.state().agents.get(self.setup.agent)?;
        let head = agent.eye_position();
        let SoundLocalizationSettings {
            min_distance_m,
            max_distance_m,
            min_height_m,
            max_height_m,
            ..
        } = self.settings;
        let near = |cell: NavCell| {
            let floor = grid.position(cell);
            let level = Vec3::new(floor.x - head.x, 0.0, floor.z - head.z);
            (floor.y - agent.position.y).abs() < 0.5 && level.length() <= max_distance_m
        };
        let cells: Vec<NavCell> = grid.walkable().filter(|cell| near(*cell)).collect();
        (0..SOURCES).find_map(|k| {
            let mut stream = key.child(k).stream();
            let floor = grid.position(*stream.choose(&cells)?);
            let point = floor + Vec3::Y * stream.range(min_height_m, max_height_m);
            let way = point - head;
            if !(min_distance_m..=max_distance_m).contains(&way.length()) {
                return None;
            }
            let hit = world.rays().closest(&Ray::new(head, way), RayMask::EYE);
            let is_clear = hit.is_none_or(|hit| hit.distance_m > way.length() + FREE_AROUND_M);
            // The walls of things around it, for a place that is not in sight.
            let is_free = self.settings.in_sight || is_in_the_open(world, point);
            ((is_clear || !self.settings.in_sight) && is_free).then_some(point)
        })
    }
}

/// Returns whether no surface is close to a point on any side.
fn is_in_the_open(world: &World, point: Vec3) -> bool {
    let sides = [
        Vec3::X,
        Vec3::NEG_X,
        Vec3::Y,
        Vec3::NEG_Y,
        Vec3::Z,
        Vec3::NEG_Z,
    ];
    sides.into_iter().all(|side| {
        let hit = world.rays().closest(&Ray::new(point, side), RayMask::EYE);
        hit.is_none_or(|hit| hit.distance_m > FREE_AROUND_M)
    })
}

impl Task for SoundLocalization {
    fn settings(&self) -> serde_json::Value {
        serde_json::json!(self.settings)
    }

    fn reset(
        &mut self,
        world: &mut World,
        placed: &[AgentId],
        key: RandomKey,
    ) -> Result<Episode, WorldError> {
        (self.source, self.errors) = (None, None);
        let agent = self.setup.agent;
        let body = self.setup.body(world, NAME)?;
        let grid = world.engines().nav_grid(&body)?;
        for k in 0..STARTS {
            interrupt::unwind_if_cancelled();
            let key = key.child("start").child(k);
            let Some(start) = sample_start(world, placed, (&grid, &body, None), key) else {
                break;
            };
            let (position, yaw_rad) = (grid.position(start), random_yaw_rad(key));
            world.place_agent(agent, position, yaw_rad)?;
            let Some(place) = self.draw_source(world, &grid, key.child("source")) else {
                continue;
            };
            let class = key
                .child("sound")
                .stream()
                .below(self.settings.sounds.len());
            let (level_db, loops) = (self.settings.level_db, self.settings.loops);
            let sound = SoundPlace::Point(place);
            play_signal(
                world,
                &self.settings.sounds[class],
                (sound, level_db, loops),
            )?;
            self.source = Some(Source {
                position: place,
                class,
            });
            return Ok(Episode {
                agent,
                instruction: ASKED.to_owned(),
                tokens: vocabulary::tokenize(ASKED)?,
                start: Pose::from_position_yaw(position, yaw_rad),
                progress: NavigationMetrics::new(position, None),
                goal: EpisodeGoal {
                    kind: "sound",
                    ..EpisodeGoal::default()
                },
            });
        }
        Err(WorldError::TaskNotPlayable {
            task: NAME,
            house: world.house().name.clone(),
            why: "it has no place for an agent of this size with a source at the asked distance and height"
                .to_owned(),
        })
    }

    fn judge(
        &mut self,
        world: &World,
        episode: &mut Episode,
        played: &ExecutedAction<'_>,
    ) -> StepResult {
        let Some(agent) = world.state().agents.get(self.setup.agent) else {
            return StepResult::default();
        };
        episode
            .progress
            .advance(agent.position, None, agent.collided);
        let pay = &self.settings.reward;
        if !played.is_stop() {
            return StepResult {
                reward: pay.step,
                ..StepResult::default()
            };
        }
        self.errors = self.source.and_then(|source| {
            let truth = self.truth(world, &source)?;
            AnswerErrors::of(&played.action.answer, &truth, source.class)
        });
        let success = self.errors.is_some_and(|errors| {
            errors.angular_deg < self.settings.success_angle_deg
                && (errors.class_correct || !self.settings.needs_class)
        });
        // No answer is as bad as the worst one.
        let angle_deg = self.errors.map_or(180.0, |errors| errors.angular_deg);
        let mut reward = pay.step + pay.angle * angle_deg;
        if success {
            reward += pay.success;
        }
        StepResult {
            reward,
            terminated: true,
            success,
        }
    }

    fn answer_fields(&self) -> Vec<AnswerField> {
        let number = |name, about, unit, range| AnswerField {
            name,
            about,
            unit,
            range,
            choices: None,
        };
        let sounds = self.settings.sounds.clone();
        vec![
            number(
                "azimuth",
                "Direction of the source from the head, positive to the left; 0 is straight ahead.",
                "rad",
                [-PI, PI],
            ),
            number(
                "elevation",
                "Direction of the source from the head, positive up.",
                "rad",
                [-FRAC_PI_2, FRAC_PI_2],
            ),
            number(
                "distance",
                "Distance of the source from the middle of the head.",
                "m",
                [0.0, FURTHEST_M],
            ),
            AnswerField {
                name: "class",
                about: "Which of the settings' `sounds` it is, counted from 0.",
                unit: "",
                range: [0.0, sounds.len() as f32 - 1.0],
                choices: Some(sounds),
            },
        ]
    }

    fn expert_answer(&self, world: &World) -> Answer {
        let source = self.source.as_ref();
        source
            .and_then(|source| {
                let truth = self.truth(world, source)?;
                let class = source.class as f32;
                Some([truth.azimuth, truth.elevation, truth.distance_m, class])
            })
            .unwrap_or([0.0; MAX_ANSWER_FIELDS])
    }

    fn measures(&self) -> Vec<f64> {
        match self.errors {
            None => vec![f64::NAN; MEASURES.len()],
            Some(errors) => vec![
                errors.azimuth_deg,
                errors.elevation_deg,
                errors.angular_deg,
                errors.distance,
                f64::from(u8::from(errors.class_correct)),
            ],
        }
    }

    fn expert(&mut self, _: &mut World, _: &Episode) -> DiscreteAction {
        DiscreteAction::Stop
    }
}
