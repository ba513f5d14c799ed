//! Sounds that are started, stopped and made louder while a world runs.

use crate::error::WorldError;
use crate::listener::Listener;
use crate::sound::{PlayRequest, SoundState, check_level};
use crate::world::World;
use dwell_scene::AgentId;

impl World {
    /// Plays a sound from the next step on, until it is over or stopped, or the world is reset. Returns its handle, which no
    /// other sound of the world ever has.
    ///
    /// Sounds are part of snapshots and of the hash; of files their names and check sums.
    ///
    /// # Errors
    /// [`WorldError::Config`] for a level outside -100 to 200 dB, a place that is not finite or a file without
    /// [`sound_root`](crate::WorldConfig::sound_root), [`WorldError::InvalidCall`] for an object or agent that does not exist,
    /// [`WorldError::Houses`] for a file that cannot be read or lies outside the root, [`WorldError::Acoustics`] for a
    /// signal that does not exist or a file that is no sound. Nothing has changed then.
    pub fn play(&mut self, request: PlayRequest) -> Result<u64, WorldError> {
        let root = self.config.sound_root.as_deref();
        self.sound.play((&self.engines, root, &self.state), request)
    }

    /// [`Self::play`], to begin after `offset_s` seconds and to be silenced `duration_s` later; without them at once, and never.
    pub(crate) fn play_between(
        &mut self,
        request: PlayRequest,
        offset_s: Option<f64>,
        duration_s: Option<f64>,
    ) -> Result<u64, WorldError> {
        let handle = self.play(request)?;
        self.sound.delay(handle, offset_s, duration_s);
        Ok(handle)
    }

    /// Silences a sound within 5 ms of the next step. One that was played is dropped; one of an object of the house begins
    /// again with [`World::start_sound`].
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for a handle that no sound has, as of one that is over.
    pub fn stop_sound(&mut self, handle: u64) -> Result<(), WorldError> {
        self.sound.set_silent(self.engines.house(), handle, true)
    }

    /// Lets the sound of an object of the house sound again after [`World::stop_sound`], while the object is switched on; one
    /// that was played and stopped in this step goes on.
    ///
    /// # Errors
    /// As [`World::stop_sound`].
    pub fn start_sound(&mut self, handle: u64) -> Result<(), WorldError> {
        self.sound.set_silent(self.engines.house(), handle, false)
    }

    /// Sets the level at 1 m of a sound, dB SPL, from the next step on.
    ///
    /// # Errors
    /// [`WorldError::Config`] for a level outside -100 to 200 dB; else as [`World::stop_sound`].
    pub fn set_sound_level(&mut self, handle: u64, level_db: f32) -> Result<(), WorldError> {
        check_level(level_db)?;
        self.sound.set_level(self.engines.house(), handle, level_db)
    }

    /// All sources: those of the house's objects, whose handles are their numbers, then those played on request. Sounds of contacts
    /// are not among them.
    pub fn sounds(&self) -> Vec<SoundState> {
        self.sound
            .list_emitters_and_playbacks(self.engines.house(), &self.state)
    }

    /// The newest samples at an agent's ear (0 left, 1 right), Pa; zeros before it listened that long.
    pub fn newest_samples(&self, agent: AgentId, channel: usize, out: &mut [f32]) {
        self.newest_samples_of(&Listener::ears(agent), channel, out);
    }

    /// The newest samples at a channel of an agent's receiver, Pa; zeros before it listened that long.
    pub fn newest_samples_of(&self, listener: &Listener, channel: usize, out: &mut [f32]) {
        self.sound.newest_samples(listener, channel, out);
    }
}
