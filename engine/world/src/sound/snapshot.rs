//! Sounds as bytes: the part that goes on bit for bit after a restore.

use super::ears::AgentListener;
use super::emitters::EmitterStates;
use super::events::ActiveContactSound;
use super::gait::GaitPhase;
use super::hearing::Hearing;
use super::playback::{Playback, PlaybackState};
use super::speech::SpokenUtterance;
use super::{FIRST_PLAYED_ID, WorldSound};
use crate::config::WorldConfig;
use crate::engines::Engines;
use crate::error::WorldError;
use crate::listener::Listener;
use dwell_acoustics::HeadId;
use dwell_scene::State;
use dwell_scene::random::RandomKey;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
struct SoundSnapshot {
    preset: String,
    head: Option<HeadId>,
    rate_hz: u32,
    /// Samples a control step.
    block: usize,
    blocks: u64,
    touches: Vec<ActiveContactSound>,
    next_blow: u64,
    gaits: Vec<GaitPhase>,
    emitters: EmitterStates,
    playing: Vec<PlaybackState>,
    next_played: u64,
    ears: Vec<(Listener, Vec<f32>, Vec<u8>)>,
}

/// Voices, where agents have spoken.
#[derive(Serialize, Deserialize)]
struct SpeechSnapshot {
    spoken: Vec<SpokenUtterance>,
    hearing: Hearing,
}

impl WorldSound {
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let ears = self.ears.iter().map(|ears| {
            (
                ears.listener.clone(),
                ears.recent_samples.clone(),
                ears.stream.snapshot(),
            )
        });
        let memory = SoundSnapshot {
            preset: self.preset.clone(),
            head: self.head,
            rate_hz: self.rate_hz,
            block: self.block,
            blocks: self.blocks,
            touches: self.touches.clone(),
            gaits: self.gaits.clone(),
            next_blow: self.next_blow,
            emitters: self.emitters.clone(),
            playing: self.playing.iter().map(|p| p.state.clone()).collect(),
            next_played: self.next_played,
            ears: ears.collect(),
        };
        let mut bytes =
            postcard::to_stdvec(&memory).expect("plain data can always be written to memory");
        // Behind the rest, so that worlds without such sounds have the bytes that they always had.
        let spoke = !self.spoken.is_empty() || !self.hearing.is_idle();
        if spoke || !self.ends.is_empty() {
            let ends = postcard::to_stdvec(&self.ends);
            bytes.extend(ends.expect("plain data can always be written to memory"));
        }
        if spoke {
            let speech = SpeechSnapshot {
                spoken: self.spoken.iter().map(|own| own.spoken.clone()).collect(),
                hearing: self.hearing.clone(),
            };
            let speech = postcard::to_stdvec(&speech);
            bytes.extend(speech.expect("plain data can always be written to memory"));
        }
        bytes
    }

    /// The sounds that [`WorldSound::to_bytes`] wrote, for a world of these settings.
    pub(crate) fn from_bytes(
        config: &WorldConfig,
        (engines, state): (&Engines, &State),
        key: RandomKey,
        bytes: &[u8],
    ) -> Result<Self, WorldError> {
        let refuse = |error: postcard::Error| WorldError::Snapshot(error.to_string());
        let (memory, rest): (SoundSnapshot, _) =
            postcard::take_from_bytes(bytes).map_err(refuse)?;
        let mut sound = Self::new(config);
        if (memory.rate_hz, memory.block) != (sound.rate_hz, sound.block) {
            return Err(WorldError::Snapshot(format!(
                "its sound has {} Hz in blocks of {} samples, that of the world {} Hz in blocks of {}",
                memory.rate_hz, memory.block, sound.rate_hz, sound.block
            )));
        }
        if memory.preset != config.sound_preset {
            return Err(WorldError::Snapshot(format!(
                "its sound_preset is {:?}, and that of the world {:?}",
                memory.preset, config.sound_preset
            )));
        }
        if memory.head != config.sound_head {
            let why = "its sound_head is another than the world's";
            return Err(WorldError::Snapshot(why.to_owned()));
        }
        if memory.blocks == 0 {
            return Err(WorldError::Snapshot("no block of sound is over".to_owned()));
        }
        (sound.blocks, sound.touches, sound.next_blow) =
            (memory.blocks, memory.touches, memory.next_blow);
        sound.gaits = memory.gaits;
        let house = engines.house();
        let most = house.emitters.len() as u64;
        let fades = memory.emitters.fades.len() as u64;
        if memory.emitters.overrides.keys().any(|k| *k >= most) || (fades != 0 && fades != most) {
            let why = "it has sounds that the house does not have";
            return Err(WorldError::Snapshot(why.to_owned()));
        }
        sound.emitters = memory.emitters;
        let root = config.sound_root.as_deref();
        for saved in memory.playing {
            if !(FIRST_PLAYED_ID..FIRST_PLAYED_ID + memory.next_played).contains(&saved.id) {
                let why = format!("a sound with the handle {}", saved.id);
                return Err(WorldError::Snapshot(why));
            }
            let playing = Playback::restore((engines, root, state), sound.rate_hz, saved)?;
            sound.playing.push(playing);
        }
        sound.next_played = memory.next_played;
        let mut rest = rest;
        if !rest.is_empty() {
            (sound.ends, rest) = postcard::take_from_bytes(rest).map_err(refuse)?;
        }
        if !rest.is_empty() {
            let speech: SpeechSnapshot = postcard::from_bytes(rest).map_err(refuse)?;
            sound.restore_spoken(speech.spoken, state, key)?;
            sound.hearing = speech.hearing;
        }
        for (listener, window, stream) in memory.ears {
            listener.check(sound.head)?;
            let channels = listener.channels();
            let length = window.len() / channels;
            if length == 0 || length % sound.block != 0 || window.len() != channels * length {
                return Err(WorldError::Snapshot(format!(
                    "a window of {} samples",
                    window.len()
                )));
            }
            let mut own = sound.new_stream(engines, &listener, key)?;
            own.restore(&stream)?;
            let mut ears = AgentListener::new(listener, own, sound.head, length);
            ears.recent_samples = window;
            sound.ears.push(ears);
        }
        Ok(sound)
    }
}
