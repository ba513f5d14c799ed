//! Sounds that are started, stopped and made louder while a world runs.

use crate::error::WorldError;
use crate::listener::Listener;
use crate::sound::{HeardToken, PlayRequest, SoundState, Utterance, check_level};
use crate::world::World;
use dwell_scene::{AgentId, Id};

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
    pub(crate) fn play_scheduled(
        &mut self,
        request: PlayRequest,
        offset_s: Option<f64>,
        duration_s: Option<f64>,
    ) -> Result<u64, WorldError> {
        let handle = self.play(request)?;
        self.sound.schedule(handle, offset_s, duration_s);
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

    /// Lets an agent say something from the next step on: it sounds at its mouth, with its voice, and who listens hears it. Returns
    /// whether it does: not while it speaks already, and not in a world that is [`muted`](crate::WorldConfig::muted).
    ///
    /// An agent's voice is drawn from the episode, the same for all that it says.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an agent that does not exist, [`WorldError::Config`] for a number that no word has,
    /// [`WorldError::Acoustics`] for no tokens or too many. Nothing has changed then.
    pub fn say(&mut self, agent: AgentId, utterance: Utterance) -> Result<bool, WorldError> {
        let count = self.state.agents.len();
        if agent.index() >= count {
            let what = format!("no agent {}; there are {count}", agent.0);
            return Err(WorldError::InvalidCall(what));
        }
        let words = dwell_semantics::vocabulary::size();
        let is_no_word = |token: &&u32| !(1..words).contains(&(**token as usize));
        if let Some(token) = utterance.tokens.iter().find(is_no_word) {
            return Err(WorldError::Config {
                field: "tokens",
                found: token.to_string(),
                allowed: format!("numbers of words, 1 to {}", words - 1),
            });
        }
        dwell_acoustics::utterance::duration_s(&utterance.tokens)?;
        if self.config.muted {
            return Ok(false);
        }
        let key = self.key.child("sound");
        self.sound.say(agent, utterance, key)
    }

    /// Returns whether an agent's voice sounds in the next step.
    pub fn is_speaking(&self, agent: AgentId) -> bool {
        self.sound.is_speaking(agent)
    }

    /// What an agent has understood in the last step of what others say, the loudest first; nothing for one that does not listen.
    pub fn heard_tokens(&self, agent: AgentId) -> Vec<&HeardToken> {
        self.sound.heard_tokens(agent)
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
