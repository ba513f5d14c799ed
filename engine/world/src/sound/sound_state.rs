//! The sources of a world, for people.

use super::playback::SoundName;
use serde::Serialize;

/// A source of sound in its current state.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SoundState {
    /// The handle that [`World::stop_sound`](crate::World::stop_sound) and kin take.
    pub handle: u64,
    /// The sound.
    pub sound: SoundName,
    /// m.
    pub position: [f32; 3],
    /// Level at 1 m in the free field, dB SPL (RMS).
    pub level_db: f32,
    /// True if it begins again when it is over.
    pub loops: bool,
    /// True if it sounds.
    pub on: bool,
    /// The object whose own sound it is.
    pub object: Option<String>,
}
