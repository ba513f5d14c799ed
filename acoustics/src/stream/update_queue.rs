//! Scheduling of the impulse responses that are computed in a block.
//!
//! A door that opens changes all responses at once. [`StreamConfig::update_rays`](super::StreamConfig::update_rays) bounds
//! the work of a block. It counts rays, never time, so that streams stay equal to the bit on all machines. First come
//! sources without a response, then those with moved positions or parts, then tails of few rays; among equals the longest
//! waiting, and then the loudest. A waiting source keeps its response, with direct path and reflections as they are now.
//! Where all rays are needed, they are traced piece by piece, and used together when the last is traced.

use super::block_plan::BlockContext;
use super::response_update::ResponseUpdater;
use super::source_state::{ResponseInputChange, ResponseInputs, SourceState, TraceJob};
use super::tail_update::{TailHistory, partial_ray_count};
use super::{BlockReport, Stream};
use crate::error::AcousticsError;
use crate::receiver::SoundSourcePose;
use crate::response::ImpulseResponse;
use crate::tail::TraceProgress;
use dwell_scene::Pose;
use glam::Vec3;

/// Cost of a response's early paths and synthesis, in rays.
const RESPONSE_COST_RAYS: usize = 150;
/// Cost of rotating a response, in rays.
const ROTATION_COST_RAYS: usize = 50;
/// Fewest rays that give information on a tail.
const MIN_RAYS: usize = 64;

/// A source in a block, and its needs.
pub(super) struct UpdateRequest<'a> {
    pub(super) id: u64,
    /// True for a source that still sounds; else it only rings out.
    pub(super) is_playing: bool,
    /// Its rank by loudness.
    pub(super) loudness_rank: usize,
    /// Positions of source and receiver.
    pub(super) positions: (Vec3, Pose),
    pub(super) source_state: Option<&'a SourceState>,
    pub(super) now: ResponseInputs,
    pub(super) change: ResponseInputChange,
    /// True if a tail of few rays is to be replaced by one of all rays.
    pub(super) has_stale_tail: bool,
    /// The block in which a new response became due.
    pub(super) due_block: u64,
    pub(super) new_response: Option<(ResponseInputs, ImpulseResponse)>,
    pub(super) partial_trace: PartialTraceOutcome,
    /// True while a new response still waits for its turn or for rays.
    pub(super) is_waiting: bool,
}

/// The outcome of a partial trace.
pub(super) enum PartialTraceOutcome {
    Unchanged,
    None,
    Advanced(Box<TraceJob>),
}

/// The urgency of a new response.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum UpdateUrgency {
    /// No response, or none that may still be used.
    Immediate,
    Moved,
    Stale,
    None,
}

impl<'a> UpdateRequest<'a> {
    pub(super) fn current_response(&self) -> Option<&'a (ResponseInputs, ImpulseResponse)> {
        self.source_state
            .and_then(|voice| voice.current_response.as_ref())
    }

    fn started(&self) -> Option<&'a TraceJob> {
        self.source_state
            .and_then(|voice| voice.pending_update.job.as_deref())
    }

    fn need(&self) -> UpdateUrgency {
        match (self.change, self.current_response()) {
            (_, None) => UpdateUrgency::Immediate,
            (_, Some((then, _))) if then.invalidates_response(&self.now) => {
                UpdateUrgency::Immediate
            }
            (ResponseInputChange::Moved | ResponseInputChange::Rotated, _) => UpdateUrgency::Moved,
            (ResponseInputChange::None, _) if self.has_stale_tail => UpdateUrgency::Stale,
            (ResponseInputChange::None, _) => UpdateUrgency::None,
        }
    }
}

/// The computation left for a block.
struct RayBudget {
    /// Rays; `None`: as many as are needed.
    left: Option<usize>,
    /// True once any response was computed: one always is.
    served: bool,
    /// True once one tail was refined to all rays: one per block is.
    settled: bool,
}

impl RayBudget {
    /// Returns whether the budget has `rays` left.
    fn holds(&self, rays: usize) -> bool {
        self.left.is_none_or(|left| rays <= left)
    }

    /// Returns whether work of `rays` may start.
    fn may_start(&self, rays: usize) -> bool {
        !self.served || self.holds(rays)
    }

    fn spend(&mut self, rays: usize) {
        self.served = true;
        self.left = self.left.map(|left| left.saturating_sub(rays));
    }
}

impl Stream {
    /// Computes the responses whose turn it is.
    pub(super) fn update_responses(
        &self,
        around: &BlockContext<'_>,
        wants: &mut [UpdateRequest<'_>],
        report: &mut BlockReport,
    ) -> Result<(), AcousticsError> {
        // Before the first block nothing can wait.
        let bounded = self.config.update_rays > 0 && self.block > 0;
        let mut budget = RayBudget {
            left: bounded.then_some(self.config.update_rays),
            served: false,
            settled: false,
        };
        let mut order: Vec<&mut UpdateRequest<'_>> = Vec::new();
        for want in wants {
            match want.need() {
                // The situation is again that of the response.
                UpdateUrgency::None if want.started().is_some() => {
                    want.partial_trace = PartialTraceOutcome::None;
                }
                UpdateUrgency::None => {}
                _ => order.push(want),
            }
        }
        if bounded {
            order.sort_by_key(|want| {
                (
                    want.need(),
                    want.started().is_none(),
                    want.due_block,
                    want.loudness_rank,
                    want.id,
                )
            });
        }
        for k in 0..order.len() {
            let (earlier, rest) = order.split_at_mut(k);
            let want = &mut *rest[0];
            self.update_one(around, earlier, want, &mut budget, report)?;
            report.waiting_sources += usize::from(want.is_waiting);
        }
        Ok(())
    }

    /// `earlier`: the sources whose turn came before in this block.
    fn update_one(
        &self,
        around: &BlockContext<'_>,
        earlier: &[&mut UpdateRequest<'_>],
        want: &mut UpdateRequest<'_>,
        budget: &mut RayBudget,
        report: &mut BlockReport,
    ) -> Result<(), AcousticsError> {
        let (heard, threshold, passing) = (
            want.current_response(),
            &around.threshold,
            around.large_part_moving,
        );
        // With bounded work, a place that the listener leaves again is not worth all rays.
        let stays = budget.left.is_none() || want.change == ResponseInputChange::None;
        let settles = want.has_stale_tail && stays && !budget.settled;
        budget.settled |= settles;
        match (want.change, heard) {
            (ResponseInputChange::None, Some(_)) if !settles => {
                want.is_waiting = true;
                return Ok(());
            }
            (ResponseInputChange::Rotated, Some((then, response))) => {
                want.is_waiting = !budget.may_start(ROTATION_COST_RAYS);
                if !want.is_waiting {
                    budget.spend(ROTATION_COST_RAYS);
                    report.rotated += 1;
                    // The echogram stays that of the place where it was traced.
                    let mut turned = then.clone();
                    turned.receiver.pose.rotation = want.now.receiver.pose.rotation;
                    let response =
                        self.scene
                            .rotated_response(response, &turned.receiver, turned.noise);
                    want.new_response = Some((turned, response));
                }
                return Ok(());
            }
            _ => {}
        }
        // An impact on the table uses the response of the one before it, and the five of a plate that rattles use one: other
        // sources' impulse responses serve as well.
        let usable = |then: &ResponseInputs| {
            (passing || !then.has_approximate_tail)
                && then.change(&want.now, threshold) == ResponseInputChange::None
        };
        let voices = self.voices.iter();
        let before = voices.filter_map(|voice| voice.current_response.as_ref());
        let now = earlier
            .iter()
            .filter_map(|other| other.new_response.as_ref());
        if let Some(known) = now.chain(before).find(|(then, _)| usable(then)) {
            want.partial_trace = PartialTraceOutcome::None;
            want.new_response = Some(known.clone());
            return Ok(());
        }
        let alike = |then: &ResponseInputs| {
            !settles && then.differs_by_positions_only(&want.now, threshold, passing)
        };
        let again = heard
            .filter(|(then, _)| alike(then))
            .or_else(|| self.response_of_nearby_source(around.rays, &want.now, alike));
        match again {
            Some(before) => self.update_with_few_rays(around, want, before, budget, report),
            None => self.update_fully(around, want, budget, report),
        }
    }

    /// Updates with few rays, and the rest reused.
    fn update_with_few_rays(
        &self,
        around: &BlockContext<'_>,
        want: &mut UpdateRequest<'_>,
        (then, response): &(ResponseInputs, ImpulseResponse),
        budget: &mut RayBudget,
        report: &mut BlockReport,
    ) -> Result<(), AcousticsError> {
        let rays = partial_ray_count(self.scene.config(), self.config.update_share);
        want.is_waiting =
            want.need() != UpdateUrgency::Immediate && !budget.may_start(rays + RESPONSE_COST_RAYS);
        if want.is_waiting {
            return Ok(());
        }
        budget.spend(rays + RESPONSE_COST_RAYS);
        let memory = TailHistory {
            previous: &response.echogram,
            moved_m: then.displacement_m(&want.now),
            share: self.config.update_share,
            update: self.block,
        };
        let all = budget.holds(self.scene.config().rays);
        let way = self.response_updater(around, want.id, &want.now);
        let (response, known) = way.update_from_history(&memory, all)?;
        report.traced_responses += 1;
        report.rays += response.echogram.ray_statistics.rays as usize;
        want.now.has_approximate_tail =
            around.large_part_moving || then.has_approximate_tail || !known;
        want.partial_trace = PartialTraceOutcome::None;
        want.new_response = Some((want.now.clone(), response));
        Ok(())
    }

    /// Updates with all rays, or as many as the budget allows.
    fn update_fully(
        &self,
        around: &BlockContext<'_>,
        want: &mut UpdateRequest<'_>,
        budget: &mut RayBudget,
        report: &mut BlockReport,
    ) -> Result<(), AcousticsError> {
        let all = self.scene.config().rays;
        if want.current_response().is_none() && !budget.holds(all) {
            let share = partial_ray_count(self.scene.config(), self.config.update_share);
            let rays = share
                .min(budget.left.unwrap_or(all))
                .clamp(MIN_RAYS.min(all), all);
            budget.spend(rays + RESPONSE_COST_RAYS);
            let way = self.response_updater(around, want.id, &want.now);
            let response = way.trace_with_rays(rays)?;
            report.traced_responses += 1;
            report.rays += rays;
            want.now.has_approximate_tail = true;
            want.new_response = Some((want.now.clone(), response));
            return Ok(());
        }
        let is_waiting = want.need() != UpdateUrgency::Immediate;
        let most = match budget.left {
            Some(left) if is_waiting => left,
            _ => usize::MAX,
        };
        if is_waiting && !budget.may_start(MIN_RAYS) {
            want.is_waiting = true;
            return Ok(());
        }
        let mut job = match want.started() {
            Some(job) if job.is_still_valid(&want.now, &around.threshold) => Box::new(job.clone()),
            // A listener who walks on must not keep all other sources from their turns.
            Some(_) if is_waiting => {
                (want.is_waiting, want.due_block, want.partial_trace) =
                    (true, self.block, PartialTraceOutcome::None);
                return Ok(());
            }
            _ => Box::new(TraceJob {
                situation: want.now.clone(),
                progress: TraceProgress::new(self.scene.config(), 1),
            }),
        };
        // It is rendered with the head's present rotation.
        job.situation.receiver.pose.rotation = want.now.receiver.pose.rotation;
        let before = job.progress.rays();
        let way = self.response_updater(around, want.id, &job.situation);
        let response = way.trace_incrementally(&mut job.progress, most)?;
        let rays = job.progress.rays() - before;
        report.rays += rays;
        budget.spend(rays);
        if let Some(response) = response {
            budget.spend(RESPONSE_COST_RAYS);
            report.traced_responses += 1;
            want.partial_trace = PartialTraceOutcome::None;
            want.new_response = Some((job.situation, response));
        } else {
            want.is_waiting = true;
            want.partial_trace = PartialTraceOutcome::Advanced(job);
        }
        Ok(())
    }

    fn response_updater<'a>(
        &'a self,
        around: &BlockContext<'a>,
        id: u64,
        situation: &'a ResponseInputs,
    ) -> ResponseUpdater<'a> {
        ResponseUpdater {
            scene: &self.scene,
            rays: around.rays,
            source: SoundSourcePose::omni(situation.source),
            receiver: &situation.receiver,
            key: self.key_of(id),
            noise: situation.noise,
            threads: self.threads,
        }
    }
}
