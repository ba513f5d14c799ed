//! What agents say: utterances as sound at their mouths.

use super::playback::mouth_of;
use super::{BlockSource, WorldSound};
use crate::error::WorldError;
use dwell_acoustics::utterance::{self, SpeakerVoice, VocalEffort};
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{AgentId, Id, State};
use serde::{Deserialize, Serialize};

/// First source id of utterances. Each has one of its own by when it begins and who says it.
const FIRST_SPOKEN_ID: u64 = 2 << 48;
/// More agents than a world has.
const MOST_AGENTS: u64 = 64;

/// What an agent says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Utterance {
    /// Numbers of words of the vocabulary, in order; 1 to [`utterance::MAX_TOKENS`].
    pub tokens: Vec<u32>,
    /// How loudly.
    pub effort: VocalEffort,
}

/// An utterance under way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SpokenUtterance {
    /// The block with which it begins.
    block: u64,
    pub(super) agent: AgentId,
    pub(super) utterance: Utterance,
}

impl SpokenUtterance {
    /// Its id as a source of sound.
    pub(super) fn id(&self) -> u64 {
        FIRST_SPOKEN_ID + self.block * MOST_AGENTS + u64::from(self.agent.0)
    }
}

/// An utterance with its sound.
#[derive(Clone, Debug)]
pub(super) struct ActiveUtterance {
    pub(super) spoken: SpokenUtterance,
    /// The sample since the world's start at which it begins.
    pub(super) start: u64,
    /// Pressure at 1 m, Pa. Shape (sample,).
    signal: Vec<f32>,
    /// Samples after its beginning at which each token ends. Shape (token,).
    pub(super) token_ends: Vec<u64>,
}

impl ActiveUtterance {
    /// Makes the sound of an utterance. `key`: of the world's sounds.
    ///
    /// # Errors
    /// [`WorldError::Acoustics`] for what is no utterance.
    pub(super) fn new(
        spoken: SpokenUtterance,
        (rate_hz, block_samples): (u32, usize),
        key: RandomKey,
    ) -> Result<Self, WorldError> {
        let Utterance { tokens, effort } = &spoken.utterance;
        let voice = SpeakerVoice::draw(key.child("voice").child(u64::from(spoken.agent.0)));
        let own = key.child("utterance").child(spoken.id());
        let signal = utterance::utterance(tokens, &voice, *effort, rate_hz, own)?;
        let ends = (1..=tokens.len()).map(|count| utterance::duration_s(&tokens[..count]));
        let rate = f64::from(rate_hz);
        let token_ends = ends
            .map(|end| Ok((end? * rate).ceil() as u64))
            .collect::<Result<Vec<_>, WorldError>>()?;
        Ok(Self {
            start: spoken.block.saturating_mul(block_samples as u64),
            spoken,
            signal,
            token_ends,
        })
    }

    /// Writes the block that begins at `start`.
    fn read(&self, start: u64, out: &mut [f32]) {
        out.fill(0.0);
        let skip = self.start.saturating_sub(start).min(out.len() as u64) as usize;
        let elapsed = start.saturating_sub(self.start) as usize;
        let rest = self.signal.get(elapsed..).unwrap_or_default();
        for (sample, own) in out[skip..].iter_mut().zip(rest) {
            *sample = *own;
        }
    }

    /// Returns the first sample after its sound.
    pub(super) fn end(&self) -> u64 {
        self.start + self.signal.len() as u64
    }
}

impl WorldSound {
    /// Lets an agent say something from the next block on. Returns whether it does: not while it speaks already.
    ///
    /// # Errors
    /// [`WorldError::Acoustics`] for what is no utterance.
    pub(crate) fn say(
        &mut self,
        agent: AgentId,
        utterance: Utterance,
        key: RandomKey,
    ) -> Result<bool, WorldError> {
        let spoken = SpokenUtterance {
            block: self.blocks,
            agent,
            utterance,
        };
        let active = ActiveUtterance::new(spoken, (self.rate_hz, self.block), key)?;
        if self.is_speaking(agent) {
            return Ok(false);
        }
        // In the order of agents, whoever begins first.
        let place = self.spoken.partition_point(|own| own.spoken.agent < agent);
        self.spoken.insert(place, active);
        Ok(true)
    }

    /// Returns whether an agent's voice sounds in the next block.
    pub(crate) fn is_speaking(&self, agent: AgentId) -> bool {
        let next = self.blocks * self.block as u64;
        let mut spoken = self.spoken.iter();
        spoken.any(|own| own.spoken.agent == agent && own.end() > next)
    }

    /// Returns the voices of a block that begins at sample `start`.
    pub(super) fn voice_sources(
        &self,
        state: &State,
        rays: &RayScene,
        start: u64,
    ) -> Vec<BlockSource> {
        let sounding = self.spoken.iter().filter(|own| own.end() > start);
        let voices = sounding.filter_map(|own| {
            let speaker = state.agents.get(own.spoken.agent)?;
            let mut signal = vec![0.0; self.block];
            own.read(start, &mut signal);
            Some(BlockSource {
                id: own.spoken.id(),
                position: mouth_of(speaker, rays),
                signal,
            })
        });
        voices.collect()
    }

    /// The utterances that a snapshot holds.
    ///
    /// # Errors
    /// [`WorldError::Snapshot`] for such as no world of these agents has.
    pub(super) fn restore_spoken(
        &mut self,
        spoken: Vec<SpokenUtterance>,
        state: &State,
        key: RandomKey,
    ) -> Result<(), WorldError> {
        for own in spoken {
            if own.agent.index() >= state.agents.len() || own.block > self.blocks {
                let (agent, block) = (own.agent.0, own.block);
                let why = format!("an utterance of agent {agent} from block {block} on");
                return Err(WorldError::Snapshot(why));
            }
            let active = ActiveUtterance::new(own, (self.rate_hz, self.block), key)?;
            self.spoken.push(active);
        }
        Ok(())
    }
}
