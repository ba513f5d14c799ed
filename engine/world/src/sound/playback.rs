//! Sounds played on request.

use super::fade::GainRamp;
use crate::air_position::nearest_open_air_point;
use crate::engines::Engines;
use crate::error::WorldError;
use dwell_acoustics::signals::{self, Signal};
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::rays::RayScene;
use dwell_scene::units::pa_from_db_spl;
use dwell_scene::{AgentId, AgentState, House, ObjectId, State};
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The sound to play.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SoundName {
    /// A signal, as [`signals::list`] names it.
    Signal(String),
    /// A file: its path below [`WorldConfig::sound_root`](crate::WorldConfig::sound_root).
    File(String),
}

impl fmt::Display for SoundName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Signal(name) => write!(f, "the signal {name:?}"),
            Self::File(path) => write!(f, "the file {path:?}"),
        }
    }
}

/// The place of a sound.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SoundPlace {
    /// At a point, m.
    Point(Vec3),
    /// At the middle of an object's first part, wherever that goes. It is heard from above the part, since meshes are closed around
    /// their middles.
    Object(ObjectId),
    /// At an agent's mouth.
    Agent(AgentId),
}

/// A sound that is to be played.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlayRequest {
    /// The sound.
    pub sound: SoundName,
    /// Its place.
    pub place: SoundPlace,
    /// Level at 1 m in the free field, dB SPL (RMS over the whole sound); -100 to 200.
    pub level_db: f32,
    /// True if it begins again when it is over.
    pub loops: bool,
}

/// Least and largest height over an object's top at which what it plays is heard, m.
const RISE_M: [f32; 2] = [0.03, 0.15];
/// Distance over the top from which on something counts as above it, m.
const SURFACE_M: f32 = 1e-3;

/// The middle of a mouth in the space of a head whose origin lies between the eyes, m.
const MOUTH_IN_HEAD: Vec3 = Vec3::new(0.0, -0.08, -0.1);

/// The state of a sound that plays.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct PlaybackState {
    pub(super) id: u64,
    pub(super) request: PlayRequest,
    /// The sample, since the world's start, at which it begins.
    pub(super) start: u64,
    pub(super) stopped: bool,
    pub(super) fade: GainRamp,
    /// Hash of the samples: a file may have changed when a snapshot is restored.
    pub(super) content_hash: u64,
}

/// A sound that plays.
#[derive(Clone, Debug)]
pub(super) struct Playback {
    pub(super) state: PlaybackState,
    signal: Signal,
}

/// Returns the point from which an agent's voice is heard, m.
pub(super) fn mouth_of(agent: &AgentState, rays: &RayScene) -> Vec3 {
    let mouth = agent.world_from_head().transform_point(MOUTH_IN_HEAD);
    nearest_open_air_point(rays, mouth)
}

/// Refuses levels out of range.
pub(crate) fn check_level(level_db: f32) -> Result<(), WorldError> {
    if (-100.0..=200.0).contains(&level_db) {
        return Ok(());
    }
    Err(WorldError::Config {
        field: "level_db",
        found: level_db.to_string(),
        allowed: "-100 to 200".to_owned(),
    })
}

fn open(
    engines: &Engines,
    root: Option<&str>,
    rate_hz: u32,
    sound: &SoundName,
) -> Result<(Signal, u64), WorldError> {
    match sound {
        SoundName::Signal(name) => Ok((Signal::open(name, rate_hz)?, 0)),
        SoundName::File(name) => engines.recording(root, name, rate_hz),
    }
}

/// Refuses places that do not exist.
fn check_place(house: &House, state: &State, place: &SoundPlace) -> Result<(), WorldError> {
    use dwell_scene::Id;
    let (what, found, count) = match place {
        SoundPlace::Point(point) if point.is_finite() && point.abs().max_element() <= 1e6 => {
            return Ok(());
        }
        SoundPlace::Point(point) => {
            return Err(WorldError::Config {
                field: "the place of a sound",
                found: format!("{:?}", point.to_array()),
                allowed: "coordinates up to 1,000,000 m".to_owned(),
            });
        }
        SoundPlace::Object(object) => ("object", object.index(), house.objects.len()),
        SoundPlace::Agent(agent) => ("agent", agent.index(), state.agents.len()),
    };
    if found < count {
        return Ok(());
    }
    Err(WorldError::InvalidCall(format!(
        "no {what} {found}; there are {count}"
    )))
}

impl Playback {
    pub(super) fn new(
        (engines, root, state): (&Engines, Option<&str>, &State),
        rate_hz: u32,
        request: PlayRequest,
        (id, start): (u64, u64),
    ) -> Result<Self, WorldError> {
        check_level(request.level_db)?;
        check_place(engines.house(), state, &request.place)?;
        let (signal, print) = open(engines, root, rate_hz, &request.sound)?;
        let playback = PlaybackState {
            id,
            start,
            stopped: false,
            fade: GainRamp::steady(pa_from_db_spl(request.level_db)),
            content_hash: print,
            request,
        };
        Ok(Self {
            state: playback,
            signal,
        })
    }

    /// Restores the sound from its state.
    pub(super) fn restore(
        (engines, root, state): (&Engines, Option<&str>, &State),
        rate_hz: u32,
        saved: PlaybackState,
    ) -> Result<Self, WorldError> {
        check_place(engines.house(), state, &saved.request.place)?;
        let sound = &saved.request.sound;
        let (signal, print) = open(engines, root, rate_hz, sound)?;
        if print != saved.content_hash {
            return Err(WorldError::Snapshot(format!(
                "{sound} is another sound now than the one that played"
            )));
        }
        Ok(Self {
            state: saved,
            signal,
        })
    }

    /// The target pressure at 1 m, Pa.
    pub(super) fn target_pressure_pa(&self) -> f32 {
        if self.state.stopped {
            0.0
        } else {
            pa_from_db_spl(self.state.request.level_db)
        }
    }

    /// Writes the block that begins at `start`, root mean square 1 over the whole sound.
    pub(super) fn read(&self, start: u64, out: &mut [f32]) {
        let skip = self.state.start.saturating_sub(start).min(out.len() as u64) as usize;
        let elapsed = start.saturating_sub(self.state.start);
        out[..skip].fill(0.0);
        if self.state.request.loops {
            self.signal.read(elapsed, &mut out[skip..]);
        } else {
            self.signal.read_once(elapsed, &mut out[skip..]);
        }
    }

    /// Returns whether nothing of it can be heard any more in blocks from `start` on.
    pub(super) fn is_finished(&self, start: u64) -> bool {
        let end = self.state.start + self.signal.samples().len() as u64;
        (!self.state.request.loops && end <= start)
            || (self.state.stopped && self.state.fade.is_silent())
    }

    /// The point from which it is heard, m: of an object, not from within it, but from above, as high over its top as half its width: at
    /// the rim of a vessel its wall would stand in the way. Where something is right above, it is half as far.
    pub(super) fn emission_point(&self, house: &House, rays: &RayScene, state: &State) -> Vec3 {
        let SoundPlace::Object(object) = self.state.request.place else {
            return self.position(house, state);
        };
        let part = house.objects[object].first_part;
        let shape = &house.parts[part];
        let world_from_mesh = state.part_pose[part].to_affine() * shape.part_from_mesh;
        let bounds = house.meshes[shape.mesh].bounds();
        let bounds = bounds.transformed(&world_from_mesh);
        let top = bounds.center().with_y(bounds.max.y + SURFACE_M);
        let size = bounds.size();
        let [least_m, most_m] = RISE_M;
        let rise_m = (0.5 * size.x.max(size.z)).clamp(least_m, most_m);
        let up = Ray::new(top, Vec3::Y).with_range(0.0, 2.0 * rise_m);
        let free_m = rays
            .closest(&up, RayMask::EAR)
            .map_or(2.0 * rise_m, |hit| hit.distance_m);
        top + Vec3::Y * (0.5 * free_m)
    }

    /// Returns its position now, m.
    pub(super) fn position(&self, house: &House, state: &State) -> Vec3 {
        match self.state.request.place {
            SoundPlace::Point(point) => point,
            SoundPlace::Object(object) => {
                let part = house.objects[object].first_part;
                let shape = &house.parts[part];
                let bounds = house.meshes[shape.mesh].bounds();
                let middle = bounds.transformed(&shape.part_from_mesh).center();
                state.part_pose[part].transform_point(middle)
            }
            SoundPlace::Agent(agent) => state.agents[agent]
                .world_from_head()
                .transform_point(MOUTH_IN_HEAD),
        }
    }
}

/// The level of a sound without a stated one: that of a signal; files have none.
///
/// # Errors
/// [`WorldError::Acoustics`] for a signal that does not exist.
pub fn default_level_db(sound: &SoundName) -> Result<Option<f32>, WorldError> {
    match sound {
        SoundName::Signal(name) => Ok(Some(signals::info(name)?.typical_level_db)),
        SoundName::File(_) => Ok(None),
    }
}
