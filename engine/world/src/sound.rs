//! What sounds in a world, and what its agents hear: the one file that turns states and contacts into sound.

use crate::config::WorldConfig;
use crate::engines::Engines;
use crate::error::WorldError;
use dwell_acoustics::{ActiveSource, Stream, StreamConfig};
use dwell_acoustics::{ImpactSound, Receiver, signals};
use dwell_physics::{ContactEvent, ContactKind, Toucher};
use dwell_scene::parallel::Threads;
use dwell_scene::random::Key;
use dwell_scene::rays::RayScene;
use dwell_scene::units::{db_spl_from_pa, pa_from_db_spl};
use dwell_scene::{AgentId, House, PartId, State};
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Blows weaker than this are not heard, N·s.
const FAINTEST_N_S: f32 = 0.02;
/// The most blows that begin to sound in one step; the hardest win.
const MOST_BLOWS: usize = 16;
/// Source ids of blows begin here; those of emitters are their numbers.
const FIRST_BLOW_ID: u64 = 1 << 32;

/// What a wall or a closed door takes off when the loudness of a source in another room is estimated, dB.
const OTHER_ROOM_DB: f32 = 20.0;
/// Sources estimated below this at the ear are not followed, dB SPL: quieter than a quiet room's own noise.
const INAUDIBLE_DB: f32 = 15.0;

/// The sounds of a world and the ears that listen.
#[derive(Debug)]
pub(crate) struct Sound {
    rate_hz: u32,
    block: usize,
    preset: String,
    /// Blocks that are over. The first is the one before the world's start, so that there is something to hear at once.
    blocks: u64,
    blows: Vec<Blow>,
    next_blow: u64,
    ears: Vec<Ears>,
}

/// A blow that still rings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Blow {
    id: u64,
    sound: ImpactSound,
    /// The sample, since the world's start, at which it begins.
    start: u64,
}

/// One agent's ears.
#[derive(Debug)]
struct Ears {
    agent: AgentId,
    stream: Stream,
    /// The newest samples. Shape (2, length), oldest first.
    window: Vec<f32>,
    length: usize,
}

/// What sounds in a block.
struct Sounding {
    id: u64,
    /// m.
    position: Vec3,
    /// Pressure at 1 m, Pa. Shape (sample,).
    signal: Vec<f32>,
}

impl Ears {
    /// Hears the next block.
    fn hear(
        &mut self,
        house: &House,
        rays: &RayScene,
        state: &State,
        sources: &[Sounding],
    ) -> Result<(), WorldError> {
        let Some(agent) = state.agents.get(self.agent) else {
            return Ok(());
        };
        let receiver = Receiver::binaural(agent.world_from_head());
        let active = loudest_first(house, sources, agent.eye_position());
        let size = self.stream.config().block_samples;
        let mut heard = vec![0.0; 2 * size];
        self.stream
            .block(rays, state, &active, &receiver, &mut heard)?;
        for (window, block) in self
            .window
            .chunks_exact_mut(self.length)
            .zip(heard.chunks_exact(size))
        {
            window.copy_within(size.., 0);
            window[self.length - size..].copy_from_slice(block);
        }
        Ok(())
    }

    /// Makes the window at least `length` long; what was heard stays at its end.
    fn lengthen(&mut self, length: usize) {
        if length <= self.length {
            return;
        }
        let mut longer = vec![0.0; 2 * length];
        for (new, old) in longer
            .chunks_exact_mut(length)
            .zip(self.window.chunks_exact(self.length))
        {
            new[length - self.length..].copy_from_slice(old);
        }
        (self.window, self.length) = (longer, length);
    }
}

#[derive(Serialize, Deserialize)]
struct Memory {
    rate_hz: u32,
    /// Samples a control step.
    block: usize,
    blocks: u64,
    blows: Vec<Blow>,
    next_blow: u64,
    ears: Vec<(AgentId, Vec<f32>, Vec<u8>)>,
}

impl Sound {
    pub(crate) fn new(config: &WorldConfig) -> Self {
        Self {
            rate_hz: config.sound_rate_hz,
            block: config.samples_per_step(),
            preset: config.sound_preset.clone(),
            blocks: 1,
            blows: Vec::new(),
            next_blow: 0,
            ears: Vec::new(),
        }
    }

    /// Silence, and no one who listens.
    pub(crate) fn reset(&mut self) {
        self.blocks = 1;
        self.blows.clear();
        self.next_blow = 0;
        self.ears.clear();
    }

    /// Lets the impacts of the last step sound in the block that ends now; the acoustics have no sound of scraping yet.
    pub(crate) fn take_events(
        &mut self,
        house: &House,
        events: &[ContactEvent],
        step_start_s: f64,
        key: Key,
    ) {
        let mut hard: Vec<&ContactEvent> = events
            .iter()
            .filter(|event| event.kind == ContactKind::Impact && event.impulse_n_s >= FAINTEST_N_S)
            .collect();
        hard.sort_by(|a, b| b.impulse_n_s.total_cmp(&a.impulse_n_s));
        let size = |toucher: Toucher| match toucher {
            Toucher::Part(part) => Some(part_size_m(house, part)),
            _ => None,
        };
        for event in hard.into_iter().take(MOST_BLOWS) {
            let late_s = (event.time_s - step_start_s).max(0.0);
            let late = ((late_s * f64::from(self.rate_hz)) as u64).min(self.block as u64 - 1);
            self.blows.push(Blow {
                id: FIRST_BLOW_ID + self.next_blow,
                sound: ImpactSound {
                    position: event.position,
                    impulse_n_s: event.impulse_n_s,
                    substances: [event.substance_a.to_owned(), event.substance_b.to_owned()],
                    size_m: [size(event.a), size(event.b)],
                    key: key.child("blow").child(self.next_blow),
                },
                start: self.blocks * self.block as u64 + late,
            });
            self.next_blow += 1;
        }
    }

    /// Ends a block: every ear hears what sounded in it.
    pub(crate) fn advance(
        &mut self,
        engines: &Engines,
        rays: &RayScene,
        state: &State,
    ) -> Result<(), WorldError> {
        if !self.ears.is_empty() {
            let sources = self.sources(engines.house(), state, self.blocks)?;
            for ears in &mut self.ears {
                ears.hear(engines.house(), rays, state, &sources)?;
            }
        }
        self.blocks += 1;
        // What rang in the block that has just ended is kept for ears that begin to listen after it.
        let ended = (self.blocks - 1) * self.block as u64;
        let rate = f64::from(self.rate_hz);
        self.blows
            .retain(|blow| blow.start as f64 + blow.sound.duration_s() * rate > ended as f64);
        Ok(())
    }

    /// From now on these agents listen, each with a window of at least so many samples. Ears that are new hear the block that
    /// has just ended; ears that listen already keep what they heard.
    pub(crate) fn listen(
        &mut self,
        engines: &Engines,
        rays: &RayScene,
        state: &State,
        agents: &[(AgentId, usize)],
        key: Key,
    ) -> Result<(), WorldError> {
        for (agent, samples) in agents {
            let length = samples.next_multiple_of(self.block).max(self.block);
            if let Some(ears) = self.ears.iter_mut().find(|ears| ears.agent == *agent) {
                ears.lengthen(length);
                continue;
            }
            let mut ears = Ears {
                agent: *agent,
                stream: self.stream(engines, *agent, key)?,
                window: vec![0.0; 2 * length],
                length,
            };
            let sources = self.sources(engines.house(), state, self.blocks - 1)?;
            ears.hear(engines.house(), rays, state, &sources)?;
            // In the order of agents, whoever began first.
            let place = self.ears.partition_point(|other| other.agent < *agent);
            self.ears.insert(place, ears);
        }
        Ok(())
    }

    fn stream(&self, engines: &Engines, agent: AgentId, key: Key) -> Result<Stream, WorldError> {
        let scene = engines.acoustics(&self.preset, self.rate_hz)?;
        let Some(config) = StreamConfig::preset(&self.preset) else {
            let allowed = "\"rl\" or \"full\"".to_owned();
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
        Ok(Stream::new(
            scene,
            config,
            key.child("ears").child(u64::from(agent.0)),
            Threads::ONE,
        )?)
    }

    /// What sounds in a block: emitters that are on, and blows that ring.
    fn sources(
        &self,
        house: &House,
        state: &State,
        block: u64,
    ) -> Result<Vec<Sounding>, WorldError> {
        let start = block * self.block as u64;
        let mut sources = Vec::new();
        for (k, emitter) in house.emitters.iter().enumerate() {
            if !state.is_on(house, emitter.object) {
                continue;
            }
            let mut signal = vec![0.0; self.block];
            signals::synthesize(&emitter.signal, self.rate_hz, start, &mut signal)?;
            let pressure = pa_from_db_spl(emitter.level_db);
            for sample in &mut signal {
                *sample *= pressure;
            }
            sources.push(Sounding {
                id: k as u64,
                position: state.part_pose[emitter.part].transform_point(emitter.position),
                signal,
            });
        }
        for blow in &self.blows {
            let mut signal = vec![0.0; self.block];
            let (skip, elapsed) = (
                blow.start.saturating_sub(start) as usize,
                start.saturating_sub(blow.start),
            );
            blow.sound
                .synthesize(self.rate_hz, elapsed, &mut signal[skip.min(self.block)..]);
            sources.push(Sounding {
                id: blow.id,
                position: blow.sound.position,
                signal,
            });
        }
        Ok(sources)
    }

    /// The newest samples at an ear, Pa; zeros before it listened that long, and for who never listened.
    pub(crate) fn heard(&self, agent: AgentId, channel: usize, out: &mut [f32]) {
        out.fill(0.0);
        if let Some(ears) = self
            .ears
            .iter()
            .find(|ears| ears.agent == agent && channel < 2)
        {
            let window = &ears.window[channel * ears.length..(channel + 1) * ears.length];
            let count = out.len().min(window.len());
            let first = out.len() - count;
            out[first..].copy_from_slice(&window[window.len() - count..]);
        }
    }

    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let ears = self
            .ears
            .iter()
            .map(|ears| (ears.agent, ears.window.clone(), ears.stream.snapshot()));
        let memory = Memory {
            rate_hz: self.rate_hz,
            block: self.block,
            blocks: self.blocks,
            blows: self.blows.clone(),
            next_blow: self.next_blow,
            ears: ears.collect(),
        };
        postcard::to_stdvec(&memory).expect("plain data can always be written to memory")
    }

    /// The sounds that [`Sound::to_bytes`] wrote, for a world of these settings.
    pub(crate) fn from_bytes(
        config: &WorldConfig,
        engines: &Engines,
        key: Key,
        bytes: &[u8],
    ) -> Result<Self, WorldError> {
        let memory: Memory =
            postcard::from_bytes(bytes).map_err(|error| WorldError::Snapshot(error.to_string()))?;
        let mut sound = Self::new(config);
        if (memory.rate_hz, memory.block) != (sound.rate_hz, sound.block) {
            return Err(WorldError::Snapshot(format!(
                "its sound has {} Hz in blocks of {} samples, that of the world {} Hz in blocks of {}",
                memory.rate_hz, memory.block, sound.rate_hz, sound.block
            )));
        }
        if memory.blocks == 0 {
            return Err(WorldError::Snapshot("no block of sound is over".to_owned()));
        }
        (sound.blocks, sound.blows, sound.next_blow) =
            (memory.blocks, memory.blows, memory.next_blow);
        for (agent, window, stream) in memory.ears {
            let length = window.len() / 2;
            if length == 0 || length % sound.block != 0 || window.len() != 2 * length {
                return Err(WorldError::Snapshot(format!(
                    "a window of {} samples",
                    window.len()
                )));
            }
            let mut ears = Ears {
                agent,
                stream: sound.stream(engines, agent, key)?,
                window,
                length,
            };
            ears.stream.restore(&stream)?;
            sound.ears.push(ears);
        }
        Ok(sound)
    }
}

/// The sources that can be heard at `ear`, the loudest first: a stream follows only so many.
fn loudest_first<'a>(house: &House, sources: &'a [Sounding], ear: Vec3) -> Vec<ActiveSource<'a>> {
    let room = house.room_at(ear);
    let mut heard: Vec<(f32, ActiveSource<'a>)> = sources
        .iter()
        .map(|source| {
            let signal = &source.signal;
            let power = signal.iter().map(|x| x * x).sum::<f32>() / signal.len().max(1) as f32;
            let spread = (source.position - ear).length().max(0.1);
            let walls = if house.room_at(source.position) == room {
                0.0
            } else {
                OTHER_ROOM_DB
            };
            let level_db = db_spl_from_pa(power.sqrt() / spread) - walls;
            (
                level_db,
                ActiveSource {
                    id: source.id,
                    position: source.position,
                    signal,
                },
            )
        })
        .filter(|(level_db, _)| *level_db > INAUDIBLE_DB)
        .collect();
    heard.sort_by(|(a, x), (b, y)| b.total_cmp(a).then(x.id.cmp(&y.id)));
    heard.into_iter().map(|(_, source)| source).collect()
}

/// The largest edge of a part's mesh, m.
fn part_size_m(house: &House, part: PartId) -> f32 {
    let part = &house.parts[part];
    house.meshes[part.mesh]
        .bounds()
        .transformed(&part.part_from_mesh)
        .size()
        .max_element()
}
