//! Sound of a world: its sources, and the ears of its agents.
//!
//! - `emitters`: the sounds of the house's own objects; `playback`: sounds played on request; `sound_state`: both for people.
//! - `events`: the one file that turns contacts, swinging joints and footsteps into sounds; `gait`: when feet come down.
//! - `speech`: what agents say; `hearing`: what is understood of it.
//! - `ears`: a stream for each receiver of an agent that listens; `fade`: levels without clicks; `snapshot`: all of it as bytes.

mod ears;
mod emitters;
mod events;
mod fade;
mod gait;
mod hearing;
mod playback;
mod snapshot;
mod sound_state;
mod speech;

pub(crate) use events::StepContext;
pub use hearing::HeardToken;
pub(crate) use playback::check_level;
pub use playback::{PlayRequest, SoundName, SoundPlace, default_level_db};
pub use sound_state::SoundState;
pub use speech::Utterance;

use crate::air_position::nearest_open_air_point;
use crate::config::WorldConfig;
use crate::engines::Engines;
use crate::error::WorldError;
use crate::listener::Listener;
use dwell_acoustics::{AcousticConfig, HeadId, Stream, StreamConfig};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{AgentId, House, State};
use ears::AgentListener;
use emitters::EmitterStates;
use events::ActiveContactSound;
use gait::GaitPhase;
use glam::Vec3;
use hearing::Hearing;
use playback::Playback;
use speech::ActiveUtterance;
use std::collections::{BTreeMap, BTreeSet};

/// First handle and source id of sounds that are played; those of emitters are their numbers.
const FIRST_PLAYED_ID: u64 = 1 << 48;

/// The sounds of a world and the ears that listen.
#[derive(Debug)]
pub(crate) struct WorldSound {
    rate_hz: u32,
    block: usize,
    /// On how many threads receivers hear.
    threads: Threads,
    preset: String,
    /// The head of all ears; `None`: the built-in sphere.
    head: Option<HeadId>,
    /// Number of ended blocks. The first is the one before the world's start, so that there is something to hear at once.
    blocks: u64,
    touches: Vec<ActiveContactSound>,
    next_blow: u64,
    /// Shape (agent,).
    gaits: Vec<GaitPhase>,
    emitters: EmitterStates,
    playing: Vec<Playback>,
    /// The samples, since the world's start, at which sounds that are played are silenced, by their handles.
    ends: BTreeMap<u64, u64>,
    next_played: u64,
    spoken: Vec<ActiveUtterance>,
    hearing: Hearing,
    ears: Vec<AgentListener>,
}

/// A source that sounds in a block.
struct BlockSource {
    id: u64,
    /// m.
    position: Vec3,
    /// Pressure at 1 m, Pa. Shape (sample,).
    signal: Vec<f32>,
}

impl BlockSource {
    /// Adds a source of the house's things or of a contact to one of these at the same place, or to the list.
    fn join_or_push(self, sources: &mut Vec<Self>) {
        let mut joinable = sources.iter_mut().filter(|one| one.id < FIRST_PLAYED_ID);
        match joinable.find(|one| one.position == self.position) {
            Some(one) => {
                for (sum, x) in one.signal.iter_mut().zip(&self.signal) {
                    *sum += x;
                }
            }
            None => sources.push(self),
        }
    }
}

impl WorldSound {
    pub(crate) fn new(config: &WorldConfig) -> Self {
        Self {
            rate_hz: config.sound_rate_hz,
            block: config.samples_per_step(),
            threads: Threads::ONE,
            preset: config.sound_preset.clone(),
            head: config.sound_head,
            blocks: 1,
            touches: Vec::new(),
            next_blow: 0,
            gaits: Vec::new(),
            emitters: EmitterStates::default(),
            playing: Vec::new(),
            ends: BTreeMap::new(),
            next_played: 0,
            spoken: Vec::new(),
            hearing: Hearing::default(),
            ears: Vec::new(),
        }
    }

    /// On how many threads receivers hear.
    pub(crate) fn threads(&self) -> Threads {
        self.threads
    }

    /// Sets on how many threads receivers hear. What they hear does not depend on it.
    pub(crate) fn set_threads(&mut self, threads: Threads) {
        self.threads = threads;
    }

    /// Resets to silence without listeners.
    pub(crate) fn reset(&mut self) {
        self.blocks = 1;
        self.touches.clear();
        self.next_blow = 0;
        self.gaits.clear();
        self.emitters = EmitterStates::default();
        self.playing.clear();
        self.ends.clear();
        self.next_played = 0;
        self.spoken.clear();
        self.hearing = Hearing::default();
        self.ears.clear();
    }

    /// The signals of emitters that are on, each once, and the rate at which they are heard.
    pub(crate) fn active_signals_and_rate(
        &self,
        house: &House,
        state: &State,
    ) -> (Vec<String>, u32) {
        let emitters = house.emitters.iter().enumerate();
        let on = emitters.filter(|(k, emitter)| {
            emitter.sound_file.is_none() && self.emitters.is_on(house, state, *k)
        });
        let names: BTreeSet<&String> = on.map(|(_, emitter)| &emitter.signal).collect();
        (names.into_iter().cloned().collect(), self.rate_hz)
    }

    /// Ends a block: every ear hears its sources. `key`: of the world's sounds.
    pub(crate) fn advance(
        &mut self,
        engines: &Engines,
        rays: &RayScene,
        state: &State,
        key: RandomKey,
    ) -> Result<(), WorldError> {
        self.emitters.update(engines.house(), state);
        let begun = self.blocks * self.block as u64;
        for playing in &mut self.playing {
            let end = self.ends.get(&playing.state.id);
            if end.is_some_and(|end| *end <= begun) {
                playing.state.stopped = true;
            }
            let target = playing.target_pressure_pa();
            playing.state.fade.update(target);
        }
        if !self.ears.is_empty() {
            self.locate_contact_sounds(rays);
            let sources = self.sources(engines, rays, state, self.blocks)?;
            for ears in &mut self.ears {
                ears.stream.set_threads(self.threads);
            }
            let mut rendered: Vec<_> = self.ears.iter_mut().map(|ears| (ears, Ok(()))).collect();
            self.threads.for_each(&mut rendered, |_, (ears, outcome)| {
                *outcome = ears.render_block(engines.house(), rays, state, &sources);
            });
            rendered.into_iter().try_for_each(|(_, outcome)| outcome)?;
            self.hear(state, &sources, key);
        }
        self.blocks += 1;
        // The sources of the block that has just ended are kept for ears that begin to listen after it.
        let ended = (self.blocks - 1) * self.block as u64;
        self.touches
            .retain(|touch| touch.start + touch.length > ended);
        self.playing.retain(|playing| !playing.is_finished(ended));
        self.spoken.retain(|own| own.end() > ended);
        let playing = &self.playing;
        self.ends
            .retain(|id, _| playing.iter().any(|own| own.state.id == *id));
        Ok(())
    }

    /// Opens these receivers, each with a window of at least so many samples. New ones hear the block that
    /// has just ended; those that listen already keep what they heard.
    pub(crate) fn enable_listeners(
        &mut self,
        engines: &Engines,
        rays: &RayScene,
        state: &State,
        listeners: &[(Listener, usize)],
        key: RandomKey,
    ) -> Result<(), WorldError> {
        if !listeners.is_empty() {
            self.locate_contact_sounds(rays);
        }
        for (listener, samples) in listeners {
            let length = samples.next_multiple_of(self.block).max(self.block);
            let mut known = self.ears.iter_mut();
            if let Some(ears) = known.find(|ears| ears.listener == *listener) {
                ears.extend_window(length);
                continue;
            }
            listener.check(self.head)?;
            let stream = self.new_stream(engines, listener, key)?;
            let mut ears = AgentListener::new(listener.clone(), stream, self.head, length);
            let sources = self.sources(engines, rays, state, self.blocks - 1)?;
            ears.render_block(engines.house(), rays, state, &sources)?;
            // In the order of agents and receivers, whichever began first.
            let order = |listener: &Listener| (listener.agent, listener.receiver_key());
            let own = order(listener);
            let before = |other: &AgentListener| order(&other.listener) < own;
            let place = self.ears.partition_point(before);
            self.ears.insert(place, ears);
        }
        Ok(())
    }

    fn new_stream(
        &self,
        engines: &Engines,
        listener: &Listener,
        key: RandomKey,
    ) -> Result<Stream, WorldError> {
        let mut scene = engines.acoustic_scene(&self.preset, self.rate_hz)?;
        if let Some(head) = self.head {
            scene.add_head(&engines.head(head)?);
        }
        let Some(config) = StreamConfig::preset(&self.preset) else {
            let allowed = AcousticConfig::PRESETS.join(", ");
            return Err(WorldError::Config {
                field: "sound_preset",
                found: self.preset.clone(),
                allowed,
            });
        };
        let config = StreamConfig {
            block_samples: self.block,
            ..config
        };
        let own = key.child("ears").child(u64::from(listener.agent.0));
        // One background noise for all ears of a world.
        let stream =
            Stream::new(scene, config, own, self.threads)?.with_room_key(key.child("room"));
        if listener.receiver.is_none() {
            return Ok(stream);
        }
        // The receivers of an agent are in one sound field, each with a noise of its own.
        let receiver = own.child("receiver");
        Ok(stream.with_microphone_key(receiver.child(listener.receiver_key().as_str())))
    }

    /// Returns the sources of the block that has just ended or ends now: emitters, playbacks, and contacts. What the house's own
    /// things and contacts emit at one place is one source.
    fn sources(
        &self,
        engines: &Engines,
        rays: &RayScene,
        state: &State,
        block: u64,
    ) -> Result<Vec<BlockSource>, WorldError> {
        let house = engines.house();
        let start = block * self.block as u64;
        let mut sources = Vec::new();
        let fades = self.emitters.gain_ramps(house, state);
        let places = engines.emission_points();
        for (k, (emitter, fade)) in house.emitters.iter().zip(fades).enumerate() {
            if fade.is_silent() {
                continue;
            }
            let mut signal = vec![0.0; self.block];
            let time = (self.rate_hz, self.block as u64, start);
            emitters::read_emitter_block(engines, emitter, time, &mut signal)?;
            fade.apply(self.rate_hz, &mut signal);
            let source = BlockSource {
                id: k as u64,
                position: state.part_pose[emitter.part].transform_point(places[k]),
                signal,
            };
            source.join_or_push(&mut sources);
        }
        for playing in &self.playing {
            let mut signal = vec![0.0; self.block];
            playing.read(start, &mut signal);
            playing.state.fade.apply(self.rate_hz, &mut signal);
            sources.push(BlockSource {
                id: playing.state.id,
                position: nearest_open_air_point(rays, playing.emission_point(house, rays, state)),
                signal,
            });
        }
        sources.extend(self.voice_sources(state, rays, start));
        for touch in &self.touches {
            let mut signal = vec![0.0; self.block];
            touch.read(self.rate_hz, start, &mut signal);
            let source = BlockSource {
                id: touch.id,
                position: touch.air_position.unwrap_or(touch.sound.position()),
                signal,
            };
            source.join_or_push(&mut sources);
        }
        Ok(sources)
    }

    /// The newest samples of a channel, Pa; zeros before it listened that long, and for receivers that never listened.
    pub(crate) fn newest_samples(&self, listener: &Listener, channel: usize, out: &mut [f32]) {
        out.fill(0.0);
        let mut ears = self.ears.iter();
        let heard = ears.find(|ears| ears.listener == *listener && channel < ears.channels);
        if let Some(ears) = heard {
            ears.copy_newest(channel, out);
        }
    }

    /// What an agent heard of others in the last block, the loudest first.
    pub(crate) fn heard_tokens(&self, agent: AgentId) -> Vec<&HeardToken> {
        self.hearing.heard_by(agent)
    }

    pub(crate) fn play(
        &mut self,
        at: (&Engines, Option<&str>, &State),
        request: PlayRequest,
    ) -> Result<u64, WorldError> {
        let id = FIRST_PLAYED_ID + self.next_played;
        let start = self.blocks * self.block as u64;
        let playing = Playback::new(at, self.rate_hz, request, (id, start))?;
        self.playing.push(playing);
        self.next_played += 1;
        Ok(id)
    }

    /// Lets a sound that has not begun yet begin so many seconds later, and end so long after its beginning, to the block.
    pub(crate) fn schedule(&mut self, handle: u64, offset_s: Option<f64>, duration_s: Option<f64>) {
        let samples = |seconds: f64| (seconds * f64::from(self.rate_hz)).round() as u64;
        let (wait, length) = (offset_s.map_or(0, samples), duration_s.map(samples));
        let mut start = self.blocks * self.block as u64;
        if let Some(playing) = self.playback_mut(handle) {
            playing.state.start += wait;
            start = playing.state.start;
        }
        if let Some(length) = length {
            self.ends.insert(handle, start + length);
        }
    }

    pub(crate) fn set_silent(
        &mut self,
        house: &House,
        handle: u64,
        silent: bool,
    ) -> Result<(), WorldError> {
        match self.playback_mut(handle) {
            Some(playing) => playing.state.stopped = silent,
            None => self.emitter_override_mut(house, handle)?.silent = silent,
        }
        Ok(())
    }

    pub(crate) fn set_level(
        &mut self,
        house: &House,
        handle: u64,
        level_db: f32,
    ) -> Result<(), WorldError> {
        match self.playback_mut(handle) {
            Some(playing) => playing.state.request.level_db = level_db,
            None => self.emitter_override_mut(house, handle)?.level_db = Some(level_db),
        }
        Ok(())
    }

    fn playback_mut(&mut self, handle: u64) -> Option<&mut Playback> {
        let mut playing = self.playing.iter_mut();
        playing.find(|playing| playing.state.id == handle)
    }

    fn emitter_override_mut(
        &mut self,
        house: &House,
        handle: u64,
    ) -> Result<&mut emitters::EmitterOverride, WorldError> {
        let count = house.emitters.len();
        if handle < count as u64 {
            return Ok(self.emitters.overrides.entry(handle).or_default());
        }
        let playing: Vec<u64> = self.playing.iter().map(|p| p.state.id).collect();
        Err(WorldError::InvalidCall(format!(
            "no sound {handle}: it is over, or never was; the house has {count}, counted from 0, and {playing:?} play"
        )))
    }

    pub(crate) fn list_emitters_and_playbacks(
        &self,
        house: &House,
        state: &State,
    ) -> Vec<SoundState> {
        let own = house
            .emitters
            .iter()
            .enumerate()
            .map(|(k, emitter)| SoundState {
                handle: k as u64,
                sound: match emitter.sound_file {
                    Some(_) => SoundName::File(emitter.signal.clone()),
                    None => SoundName::Signal(emitter.signal.clone()),
                },
                position: state.part_pose[emitter.part]
                    .transform_point(emitter.position)
                    .to_array(),
                level_db: self.emitters.level_db(house, k),
                loops: emitter.loops,
                on: self.emitters.is_on(house, state, k),
                object: Some(house.objects[emitter.object].name.clone()),
            });
        let played = self.playing.iter().map(|playing| SoundState {
            handle: playing.state.id,
            sound: playing.state.request.sound.clone(),
            position: playing.position(house, state).to_array(),
            level_db: playing.state.request.level_db,
            loops: playing.state.request.loops,
            on: !playing.state.stopped,
            object: None,
        });
        own.chain(played).collect()
    }
}
