//! One receiver of an agent: a stream, and the newest samples that it gave.

use super::BlockSource;
use crate::error::WorldError;
use crate::listener::Listener;
use dwell_acoustics::{ActiveSource, HeadId, Stream};
use dwell_scene::rays::RayScene;
use dwell_scene::units::db_spl_from_pa;
use dwell_scene::{House, Id, State};
use glam::Vec3;

/// Attenuation by a wall or a closed door when the loudness of a source in another room is estimated, dB.
const OTHER_ROOM_DB: f32 = 20.0;
/// Sources estimated below this at the ear are not followed, dB SPL: quieter than a quiet room's own noise.
const INAUDIBLE_DB: f32 = 15.0;

/// One receiver of an agent, such as its ears.
#[derive(Debug)]
pub(super) struct AgentListener {
    pub(super) listener: Listener,
    pub(super) channels: usize,
    pub(super) stream: Stream,
    /// The head of ears; `None`: the built-in sphere.
    pub(super) head: Option<HeadId>,
    /// The newest samples. Shape (channel, length), oldest first.
    pub(super) recent_samples: Vec<f32>,
    pub(super) length: usize,
    /// Whether the log tells already that some sources are left out.
    has_told_dropped: bool,
}

impl AgentListener {
    /// One that has heard nothing yet.
    pub(super) fn new(
        listener: Listener,
        stream: Stream,
        head: Option<HeadId>,
        length: usize,
    ) -> Self {
        let channels = listener.channels();
        Self {
            listener,
            channels,
            stream,
            head,
            recent_samples: vec![0.0; channels * length],
            length,
            has_told_dropped: false,
        }
    }

    /// Hears the next block.
    pub(super) fn render_block(
        &mut self,
        house: &House,
        rays: &RayScene,
        state: &State,
        sources: &[BlockSource],
    ) -> Result<(), WorldError> {
        let Some(agent) = state.agents.get(self.listener.agent) else {
            return Ok(());
        };
        let pose = agent.world_from_head();
        let receiver = self.listener.receiver_at(pose, self.head);
        let active = sort_by_loudness(house, sources, receiver.position());
        let size = self.stream.config().block_samples;
        let mut heard = vec![0.0; self.channels * size];
        let report = self
            .stream
            .render_block(rays, state, &active, &receiver, &mut heard)?;
        if report.dropped_sources > 0 && !self.has_told_dropped {
            self.has_told_dropped = true;
            tracing::warn!(
                agent = self.listener.agent.index(),
                heard = self.stream.config().max_sources,
                left_out = report.dropped_sources,
                "more sources than the sound preset follows: the loudest are heard"
            );
        }
        for (window, block) in self
            .recent_samples
            .chunks_exact_mut(self.length)
            .zip(heard.chunks_exact(size))
        {
            window.copy_within(size.., 0);
            window[self.length - size..].copy_from_slice(block);
        }
        Ok(())
    }

    /// Makes the window at least `length` long; earlier samples stay at its end.
    pub(super) fn extend_window(&mut self, length: usize) {
        if length <= self.length {
            return;
        }
        let mut longer = vec![0.0; self.channels * length];
        for (new, old) in longer
            .chunks_exact_mut(length)
            .zip(self.recent_samples.chunks_exact(self.length))
        {
            new[length - self.length..].copy_from_slice(old);
        }
        (self.recent_samples, self.length) = (longer, length);
    }

    /// Copies the newest samples of a channel to the end of `out`.
    pub(super) fn copy_newest(&self, channel: usize, out: &mut [f32]) {
        let window = &self.recent_samples[channel * self.length..(channel + 1) * self.length];
        let count = out.len().min(window.len());
        let first = out.len() - count;
        out[first..].copy_from_slice(&window[window.len() - count..]);
    }
}

/// The sources that can be heard at `ear`, the loudest first: a stream follows only so many.
fn sort_by_loudness<'a>(
    house: &House,
    sources: &'a [BlockSource],
    ear: Vec3,
) -> Vec<ActiveSource<'a>> {
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
