//! Computation of a stream's response: from all rays, from few and the previous tail, or in pieces.

use super::tail_update::TailHistory;
use crate::echogram::Echogram;
use crate::error::AcousticsError;
use crate::image_sources;
use crate::receiver::{Receiver, SoundSourcePose};
use crate::response::ImpulseResponse;
use crate::scene::AcousticScene;
use crate::tail::{TailTrace, TraceProgress};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;

/// The situation of a response to be computed.
pub(super) struct ResponseUpdater<'a> {
    pub(super) scene: &'a AcousticScene,
    pub(super) rays: &'a RayScene,
    pub(super) source: SoundSourcePose,
    pub(super) receiver: &'a Receiver,
    /// Random key of the rays.
    pub(super) key: RandomKey,
    /// Random key of the tail's arrivals.
    pub(super) noise: RandomKey,
    pub(super) threads: Threads,
}

impl ResponseUpdater<'_> {
    /// Returns a new response for a listener near the situation of `memory`: fewer rays, and the rest of the tail reused.
    /// Where these indicate another tail, all rays if `all`, else these alone.
    ///
    /// Also returns whether the tail is as accurate as it can be.
    ///
    /// # Errors
    /// As [`AcousticScene::echogram`].
    pub(super) fn update_from_history(
        &self,
        memory: &TailHistory<'_>,
        all: bool,
    ) -> Result<(ImpulseResponse, bool), AcousticsError> {
        let config = self.scene.config();
        let again = self.key.child("again").child(memory.update);
        let mut echogram = self.echogram(memory.rays_to_trace(config), again)?;
        let mut known = memory.blend_into(&mut echogram);
        if !known && all {
            echogram = self.echogram(config.rays, again.child("all"))?;
            known = true;
        }
        Ok((self.render_echogram(echogram), known))
    }

    /// Returns a response traced with `count` rays.
    ///
    /// # Errors
    /// As [`AcousticScene::echogram`].
    pub(super) fn trace_with_rays(&self, count: usize) -> Result<ImpulseResponse, AcousticsError> {
        let echogram = self.echogram(count, self.key.child("roughly"))?;
        Ok(self.render_echogram(echogram))
    }

    /// Traces up to `most` more rays of a response; returns it when all are traced, the same to the bit in whatever pieces.
    ///
    /// # Errors
    /// As [`AcousticScene::echogram`].
    pub(super) fn trace_incrementally(
        &self,
        progress: &mut TraceProgress,
        most: usize,
    ) -> Result<Option<ImpulseResponse>, AcousticsError> {
        self.check()?;
        let (scene, rays, source) = (self.scene, self.rays, &self.source);
        let centre = self.receiver.position();
        let (count, key) = (scene.config().rays, self.key.child("tail"));
        let trace = TailTrace::new(
            scene.data(),
            rays,
            source,
            &[centre],
            count,
            key,
            self.threads,
        );
        if !trace.advance(progress, most) {
            return Ok(None);
        }
        let paths = image_sources::find_specular_paths(scene.data(), rays, source, centre);
        let late = trace.finish(progress.clone()).into_iter();
        let echograms = late
            .map(|late| scene.join_paths_and_tail(paths.clone(), late, source.position(), centre));
        Ok(echograms
            .map(|echogram| self.render_echogram(echogram))
            .next())
    }

    fn check(&self) -> Result<(), AcousticsError> {
        let centre = [self.receiver.position()];
        self.scene
            .check_trace_inputs(self.rays, &self.source, &centre)?;
        self.scene.check_receiver(self.receiver)
    }

    fn echogram(&self, count: usize, key: RandomKey) -> Result<Echogram, AcousticsError> {
        self.check()?;
        let centre = [self.receiver.position()];
        let (rays, source) = (self.rays, &self.source);
        let scene = self.scene;
        let echograms =
            scene.echograms_with_ray_count(rays, source, &centre, count, key, self.threads);
        Ok(echograms.into_iter().next().unwrap_or_default())
    }

    fn render_echogram(&self, echogram: Echogram) -> ImpulseResponse {
        let (scene, receiver) = (self.scene, self.receiver);
        let early = scene.early_paths_per_microphone(self.rays, &self.source, receiver);
        scene.response_before_microphones(echogram, receiver, early.as_deref(), self.noise)
    }
}
