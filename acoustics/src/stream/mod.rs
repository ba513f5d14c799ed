//! Streams: sound in step with a world, as blocks of pressure at one receiver while sources, listener and doors move.

mod block_plan;
mod block_rendering;
mod config;
mod convolver;
mod delay_line;
mod early;
mod response_update;
mod snapshot_check;
mod source_state;
mod tail_update;
mod update_queue;

pub use config::StreamConfig;

use crate::echogram::Echogram;
use crate::error::{AcousticsError, check_finite};
use crate::fft::RealFft;
use crate::microphone_chain::{self, MicrophoneChain};
use crate::receiver::Receiver;
use crate::response::ImpulseResponse;
use crate::scene::AcousticScene;
use block_rendering::{BlockRendering, SourceBlock};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{PartId, Pose, State};
use glam::Vec3;
use serde::{Deserialize, Serialize};
use source_state::{ResponseInputs, SourceState};
use xxhash_rust::xxh3::xxh3_64;

const VERSION: u32 = 10;

/// A source that sounds during a block.
#[derive(Clone, Copy, Debug)]
pub struct ActiveSource<'a> {
    /// Identifies the source from block to block.
    pub id: u64,
    /// Its position at the end of the block, m.
    pub position: Vec3,
    /// Pressure at 1 m in the free field, Pa. Shape (block,).
    pub signal: &'a [f32],
}

/// The cost of a block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BlockReport {
    /// Number of impulse responses for which rays were traced.
    pub traced_responses: usize,
    /// Number of these rays.
    pub rays: usize,
    /// Number of sources whose new impulse responses wait for their turn ([`StreamConfig::update_rays`]).
    pub waiting_sources: usize,
    /// Number of impulse responses that were only rotated.
    pub rotated: usize,
    /// Number of tracked early paths.
    pub tracked_paths: usize,
    /// Number of sources that sounded or rang out.
    pub audible_sources: usize,
    /// Number of sources beyond [`StreamConfig::max_sources`].
    pub dropped_sources: usize,
}

/// The sound at one receiver, block after block.
///
/// Each source is convolved with its impulse response; when that changes, the old and the new one are crossfaded over one
/// block, so that nothing clicks. While source or listener move, the direct path and the strongest reflections are traced
/// again in every block and rendered by gliding delays, which gives the Doppler shift; the response holds the rest. A
/// source that is no longer named rings out.
#[derive(Debug)]
pub struct Stream {
    scene: AcousticScene,
    config: StreamConfig,
    key: RandomKey,
    /// Random key of the place.
    room: RandomKey,
    /// Random key of the microphones' own noise.
    microphone: RandomKey,
    threads: Threads,
    partitions: usize,
    large_parts: Vec<PartId>,
    fft: RealFft,
    fade: Vec<f32>,
    block: u64,
    /// By id.
    voices: Vec<SourceState>,
    /// Poses of the large parts at the end of the last block. Shape (large part,); empty before the first.
    parts: Vec<Pose>,
    microphones: MicrophoneChain,
}

#[derive(Serialize, Deserialize)]
struct StreamSnapshot {
    version: u32,
    block_samples: u64,
    partitions: u64,
    block: u64,
    voices: Vec<source_state::SourceSnapshot>,
    parts: Vec<Pose>,
    microphones: microphone_chain::MicrophoneChainState,
}

impl Stream {
    /// A silent stream. `key`: the random key of the tails' details and microphones' noise.
    ///
    /// # Errors
    /// [`AcousticsError::Range`] for a setting out of range.
    pub fn new(
        scene: AcousticScene,
        config: StreamConfig,
        key: RandomKey,
        threads: Threads,
    ) -> Result<Self, AcousticsError> {
        config.check()?;
        let settings = scene.config();
        let longest_s = settings.max_duration_s + 0.02;
        let longest = (longest_s * f64::from(settings.rate_hz)).ceil() as usize;
        let large_parts = scene.data().plane_table().large_parts().collect();
        Ok(Self {
            partitions: longest.div_ceil(config.block_samples).max(1),
            fft: RealFft::new(2 * config.block_samples),
            fade: fade(config.block_samples),
            large_parts,
            microphones: MicrophoneChain::new(f64::from(settings.rate_hz)),
            scene,
            config,
            room: key.child("room"),
            microphone: key.child("microphone"),
            key,
            threads,
            block: 0,
            voices: Vec::new(),
            parts: Vec::new(),
        })
    }

    /// Returns the same stream in a place with the random key `room`: streams that begin together share one background noise.
    #[must_use]
    pub fn with_room_key(self, room: RandomKey) -> Self {
        Self { room, ..self }
    }

    /// Returns the same stream with microphones of the random key `microphone`: streams of one key whose receivers have one centre are
    /// in one sound field, and differ in the noise of their microphones.
    #[must_use]
    pub fn with_microphone_key(self, microphone: RandomKey) -> Self {
        Self { microphone, ..self }
    }

    /// Sets on how many threads a block is rendered. The samples do not depend on it.
    pub fn set_threads(&mut self, threads: Threads) {
        self.threads = threads;
    }

    /// Returns the scene.
    pub fn scene(&self) -> &AcousticScene {
        &self.scene
    }

    /// Returns the settings.
    pub fn config(&self) -> &StreamConfig {
        &self.config
    }

    /// Returns the number of blocks so far.
    pub fn block_count(&self) -> u64 {
        self.block
    }

    /// Returns the present energies of each source, by its id, for agents that observe no waveform. Tracked early paths are
    /// at their present positions, the others and the tail at those of the last trace.
    pub fn echograms(&self) -> impl Iterator<Item = (u64, Echogram)> {
        let voices = self.voices.iter();
        voices.filter_map(|voice| {
            let mut echogram = voice.current_response.as_ref()?.1.echogram.clone();
            if let Some(followed) = &voice.tracked.paths {
                let chosen =
                    early::select_tracked_paths(&echogram.paths, self.config.tracked_reflections);
                let mut paths = echogram.paths;
                paths.retain(|path| !chosen.contains(path));
                paths.extend(followed.iter().map(|one| one.path.clone()));
                paths.sort_by(|a, b| a.length_m.total_cmp(&b.length_m));
                echogram.paths = paths;
            }
            Some((voice.id, echogram))
        })
    }

    /// Resets the stream to silence and block 0.
    pub fn reset(&mut self) {
        self.voices.clear();
        self.parts.clear();
        self.microphones.reset();
        self.block = 0;
    }

    /// Writes the next block of pressure at `receiver`, Pa, and applies the state's microphone laws.
    ///
    /// `rays` and `state`: the world at the end of the block. `out`: shape (channel, sample), one channel after the other;
    /// overwritten. Signals of equal id are summed.
    ///
    /// # Errors
    /// [`AcousticsError::Buffer`] for signals that are not one block long or an `out` that is not one block for each channel;
    /// those of [`AcousticScene::echogram`]. The stream is unchanged then.
    ///
    /// # Determinism
    /// The samples depend on the calls so far alone, not on the number of threads.
    pub fn render_block(
        &mut self,
        rays: &RayScene,
        state: &State,
        sources: &[ActiveSource<'_>],
        receiver: &Receiver,
        out: &mut [f32],
    ) -> Result<BlockReport, AcousticsError> {
        let size = self.config.block_samples;
        check_length("out", size * receiver.channels(), out.len())?;
        self.scene.check_receiver(receiver)?;
        for source in sources {
            check_length("a source's signal", size, source.signal.len())?;
            check_finite("a source", source.position)?;
        }
        self.scene.update(state);
        let receiver = &self.scene.effects().true_receiver(receiver);
        let mut report = BlockReport::default();
        // Fallible work comes first, so that an error leaves the stream as it was.
        let planned = self.plan(rays, state, sources, receiver, &mut report)?;
        for planned in &planned {
            let at = self
                .voices
                .binary_search_by_key(&planned.id, |voice| voice.id);
            if let Err(at) = at {
                let voice = SourceState::new(planned.id, size, self.partitions);
                self.voices.insert(at, voice);
            }
            report.tracked_paths += planned.tracked_paths.as_ref().map_or(0, Vec::len);
        }
        // Both lists are by id.
        let mut voices = self.voices.iter_mut();
        let blocks = planned.into_iter().filter_map(|planned| {
            Some(SourceBlock {
                voice: voices.find(|voice| voice.id == planned.id)?,
                planned: Some(planned),
                out: vec![0.0; out.len()],
            })
        });
        let mut blocks: Vec<SourceBlock<'_>> = blocks.collect();
        let rendering = BlockRendering {
            scene: &self.scene,
            config: &self.config,
            fft: &self.fft,
            fade: &self.fade,
            partitions: self.partitions,
            sources,
            receiver,
        };
        self.threads
            .for_each(&mut blocks, |_, block| rendering.render(block));
        out.fill(0.0);
        for block in blocks {
            add(out, &block.out);
        }
        self.voices.retain(|voice| {
            !voice.input.is_silent() || sources.iter().any(|source| source.id == voice.id)
        });
        let own = self.microphone.child(self.block);
        let listener = self.scene.stage_context(receiver, self.room, own);
        self.microphones.process_block(&state.laws, &listener, out);
        self.parts = self.large_part_poses(state);
        self.block += 1;
        Ok(report)
    }

    /// Returns the poses of the large parts. Shape (large part,).
    fn large_part_poses(&self, state: &State) -> Vec<Pose> {
        let parts = self.large_parts.iter();
        parts.map(|part| state.part_pose[*part]).collect()
    }

    fn encode_state(&self) -> Vec<u8> {
        let snapshot = StreamSnapshot {
            version: VERSION,
            block_samples: self.config.block_samples as u64,
            partitions: self.partitions as u64,
            block: self.block,
            voices: self.voices.iter().map(SourceState::snapshot).collect(),
            parts: self.parts.clone(),
            microphones: self.microphones.state(),
        };
        postcard::to_stdvec(&snapshot)
            .expect("a snapshot is plain data that postcard can always write to memory")
    }

    /// Returns the stream's state as bytes: with them an equal stream continues bit for bit.
    pub fn snapshot(&self) -> Vec<u8> {
        let body = self.encode_state();
        let mut bytes = xxh3_64(&body).to_le_bytes().to_vec();
        bytes.extend_from_slice(&body);
        bytes
    }

    /// Restores the state from [`Stream::snapshot`]. The stream must have been made with the same scene, settings and key.
    ///
    /// # Errors
    /// [`AcousticsError::Snapshot`] for damaged bytes, those of a stream with other blocks, and states that no stream can
    /// have; the stream is unchanged then.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), AcousticsError> {
        let refuse = |why: String| Err(AcousticsError::Snapshot(why));
        let Some((sum, body)) = bytes.split_first_chunk::<8>() else {
            return refuse(format!("{} bytes are too few", bytes.len()));
        };
        if u64::from_le_bytes(*sum) != xxh3_64(body) {
            return refuse("its check sum does not fit: it is damaged".to_owned());
        }
        let snapshot: StreamSnapshot = match postcard::from_bytes(body) {
            Ok(snapshot) => snapshot,
            Err(error) => return refuse(error.to_string()),
        };
        if snapshot.version != VERSION {
            return refuse(format!(
                "version {}; this build reads {VERSION}",
                snapshot.version
            ));
        }
        let (size, partitions) = (self.config.block_samples as u64, self.partitions as u64);
        if (snapshot.block_samples, snapshot.partitions) != (size, partitions) {
            return refuse(format!(
                "{} blocks of {} samples; this stream has {partitions} of {size}",
                snapshot.partitions, snapshot.block_samples
            ));
        }
        if let Err(what) = snapshot_check::check(&self.scene, &snapshot.voices) {
            return refuse(what);
        }
        let rate_hz = f64::from(self.scene.config().rate_hz);
        self.microphones = MicrophoneChain::restore(rate_hz, snapshot.microphones)?;
        let voices = snapshot.voices.into_iter();
        self.voices = voices.map(|memory| self.restore_source(memory)).collect();
        self.parts = snapshot.parts;
        self.block = snapshot.block;
        Ok(())
    }

    /// Returns a source from its stored state.
    fn restore_source(&mut self, memory: source_state::SourceSnapshot) -> SourceState {
        let mut voice = SourceState::restore(&mut self.fft, memory, self.partitions);
        let Some((situation, mut response)) = voice.current_response.take() else {
            return voice;
        };
        let scene = self.scene.with_effects(situation.effects);
        let receiver = &situation.receiver;
        if receiver.microphone_positions().is_none() {
            response = scene.response_before_microphones(
                response.echogram,
                receiver,
                None,
                situation.noise,
            );
        }
        let most = voice.tracked.paths.as_ref();
        let most = most.map(|_| self.config.tracked_reflections);
        let samples = response_without_tracked_paths(&scene, &situation, &response, most);
        voice.set_filter(&mut self.fft, &samples, response.channels, self.partitions);
        voice.current_response = Some((situation, response));
        voice
    }

    /// Returns the random key of a source.
    fn key_of(&self, source: u64) -> RandomKey {
        self.key.child("source").child(source)
    }

    /// Returns a hash of all that affects the future output.
    pub fn hash(&self) -> u64 {
        xxh3_64(&self.encode_state())
    }
}

/// Returns the samples of a response without its tracked paths, at `most` this many.
fn response_without_tracked_paths(
    scene: &AcousticScene,
    situation: &ResponseInputs,
    response: &ImpulseResponse,
    most: Option<usize>,
) -> Vec<f32> {
    let Some(most) = most else {
        return response.samples.clone();
    };
    let chosen = early::select_tracked_paths(&response.echogram.paths, most);
    scene.response_without_paths(response, &chosen, &situation.receiver)
}

fn check_length(at: &'static str, expected: usize, found: usize) -> Result<(), AcousticsError> {
    if expected == found {
        return Ok(());
    }
    Err(AcousticsError::Buffer {
        at,
        expected,
        found,
    })
}

fn add(out: &mut [f32], samples: &[f32]) {
    for (y, x) in out.iter_mut().zip(samples) {
        *y += x;
    }
}

/// Returns the weights of the new over one block: a raised cosine, so that neither level nor slope has a step. Shape (sample,).
fn fade(size: usize) -> Vec<f32> {
    (1..=size)
        .map(|k| 0.5 - 0.5 * libm::cos(std::f64::consts::PI * k as f64 / size as f64))
        .map(|weight| weight as f32)
        .collect()
}

/// Adds a crossfade from `old` to `new` within each channel's block.
fn crossfade(out: &mut [f32], old: &[f32], new: &[f32], fade: &[f32]) {
    let weights = fade.iter().cycle();
    for ((y, weight), (a, b)) in out.iter_mut().zip(weights).zip(old.iter().zip(new)) {
        *y += a + (b - a) * weight;
    }
}
