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
#[derive(Default)]
pub(super) enum PartialTraceOutcome {
    Unchanged,
    #[default]
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

/// What is computed for a source in a block.
enum ResponseWork<'a> {
    /// The response of the source at this place in the order.
    Shared {
        inputs: ResponseInputs,
        place: usize,
    },
    /// One of an earlier block.
    Known(&'a (ResponseInputs, ImpulseResponse)),
    Rotation {
        inputs: ResponseInputs,
        response: &'a ImpulseResponse,
    },
    /// Few rays, and the rest of the tail reused; all rays where another tail shows and these may be traced.
    FewRays {
        inputs: ResponseInputs,
        before: &'a (ResponseInputs, ImpulseResponse),
        may_trace_all: bool,
    },
    /// So many rays, and nothing else.
    Rough { inputs: ResponseInputs, rays: usize },
    /// All rays, of which at `most` so many now.
    AllRays {
        job: Box<TraceJob>,
        most: usize,
        ends: bool,
    },
}

impl ResponseWork<'_> {
    /// Returns the situation of the response that there will be.
    fn inputs(&self) -> Option<&ResponseInputs> {
        match self {
            Self::Shared { inputs, .. }
            | Self::Known((inputs, _))
            | Self::Rotation { inputs, .. }
            | Self::FewRays { inputs, .. }
            | Self::Rough { inputs, .. } => Some(inputs),
            Self::AllRays { job, ends, .. } => ends.then_some(&job.situation),
        }
    }
}

/// A computed response; none where rays are left to trace.
#[derive(Default)]
struct ComputedResponse {
    response: Option<(ResponseInputs, ImpulseResponse)>,
    partial_trace: PartialTraceOutcome,
    traced_responses: usize,
    rotated: usize,
    rays: usize,
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
    pub(super) fn update_responses<'a>(
        &'a self,
        around: &BlockContext<'_>,
        wants: &mut [UpdateRequest<'a>],
        report: &mut BlockReport,
    ) -> Result<(), AcousticsError> {
        // Before the first block nothing can wait.
        let bounded = self.config.update_rays > 0 && self.block > 0;
        let mut budget = RayBudget {
            left: bounded.then_some(self.config.update_rays),
            served: false,
            settled: false,
        };
        let mut order: Vec<&mut UpdateRequest<'a>> = Vec::new();
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
        let mut work: Vec<Option<ResponseWork<'_>>> = Vec::new();
        for want in &mut order {
            let chosen = self.choose_work(around, &work, want, &mut budget);
            work.push(chosen);
        }
        let computed = self.threads.map(order.len(), |k| {
            let work = work[k].as_ref()?;
            Some(self.compute(around, order[k].id, work))
        });
        for (k, (work, computed)) in work.into_iter().zip(computed).enumerate() {
            let (earlier, rest) = order.split_at_mut(k);
            let want = &mut *rest[0];
            if let Some(computed) = computed {
                let computed = computed?;
                report.traced_responses += computed.traced_responses;
                report.rays += computed.rays;
                report.rotated += computed.rotated;
                want.new_response = match work {
                    Some(ResponseWork::Shared { place, .. }) => earlier[place].new_response.clone(),
                    _ => computed.response,
                };
                want.partial_trace = computed.partial_trace;
                want.is_waiting = want.new_response.is_none();
            }
            report.waiting_sources += usize::from(want.is_waiting);
        }
        Ok(())
    }

    /// Chooses what is computed for a source; `None`: nothing in this block. `earlier`: what is computed for the sources whose
    /// turn came before.
    fn choose_work<'a>(
        &'a self,
        around: &BlockContext<'_>,
        earlier: &[Option<ResponseWork<'a>>],
        want: &mut UpdateRequest<'a>,
        budget: &mut RayBudget,
    ) -> Option<ResponseWork<'a>> {
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
                return None;
            }
            (ResponseInputChange::Rotated, Some((then, response))) => {
                want.is_waiting = !budget.may_start(ROTATION_COST_RAYS);
                if want.is_waiting {
                    return None;
                }
                budget.spend(ROTATION_COST_RAYS);
                // The echogram stays that of the place where it was traced.
                let mut inputs = then.clone();
                inputs.receiver.pose.rotation = want.now.receiver.pose.rotation;
                return Some(ResponseWork::Rotation { inputs, response });
            }
            _ => {}
        }
        // An impact on the table uses the response of the one before it, and the five of a plate that rattles use one: other
        // sources' impulse responses serve as well.
        let fits =
            |then: &ResponseInputs| then.change(&want.now, threshold) == ResponseInputChange::None;
        let now = earlier
            .iter()
            .map(|work| work.as_ref().and_then(ResponseWork::inputs));
        let mut now = now.enumerate();
        let shared = now.find_map(|(place, then)| then.filter(|then| fits(then)).map(|_| place));
        if let Some(place) = shared {
            let inputs = want.now.clone();
            return Some(ResponseWork::Shared { inputs, place });
        }
        let voices = self.voices.iter();
        let mut before = voices.filter_map(|voice| voice.current_response.as_ref());
        let usable = |(then, _): &&(ResponseInputs, ImpulseResponse)| {
            (passing || !then.has_approximate_tail) && fits(then)
        };
        if let Some(known) = before.find(usable) {
            return Some(ResponseWork::Known(known));
        }
        let alike = |then: &ResponseInputs| {
            !settles && then.differs_by_positions_only(&want.now, threshold, passing)
        };
        let again = heard
            .filter(|(then, _)| alike(then))
            .or_else(|| self.response_of_nearby_source(around.rays, &want.now, alike));
        match again {
            Some(before) => self.choose_few_rays(around, want, before, budget),
            None => self.choose_all_rays(around, want, budget),
        }
    }

    /// Few rays, and the rest reused.
    fn choose_few_rays<'a>(
        &self,
        around: &BlockContext<'_>,
        want: &mut UpdateRequest<'_>,
        before: &'a (ResponseInputs, ImpulseResponse),
        budget: &mut RayBudget,
    ) -> Option<ResponseWork<'a>> {
        let rays = partial_ray_count(self.scene.config(), self.config.update_share);
        want.is_waiting =
            want.need() != UpdateUrgency::Immediate && !budget.may_start(rays + RESPONSE_COST_RAYS);
        if want.is_waiting {
            return None;
        }
        budget.spend(rays + RESPONSE_COST_RAYS);
        let mut inputs = want.now.clone();
        inputs.has_approximate_tail = around.large_part_moving || before.0.has_approximate_tail;
        Some(ResponseWork::FewRays {
            inputs,
            before,
            may_trace_all: budget.holds(self.scene.config().rays),
        })
    }

    /// All rays, or as many as the budget allows.
    fn choose_all_rays<'a>(
        &self,
        around: &BlockContext<'_>,
        want: &mut UpdateRequest<'a>,
        budget: &mut RayBudget,
    ) -> Option<ResponseWork<'a>> {
        let config = self.scene.config();
        let all = config.rays;
        let begins = self.block == 0 && self.config.start_share < 1.0;
        if want.current_response().is_none() && (begins || !budget.holds(all)) {
            let rays = if begins {
                partial_ray_count(config, self.config.start_share)
            } else {
                let share = partial_ray_count(config, self.config.update_share);
                share.min(budget.left.unwrap_or(all))
            };
            let rays = rays.clamp(MIN_RAYS.min(all), all);
            budget.spend(rays + RESPONSE_COST_RAYS);
            let mut inputs = want.now.clone();
            inputs.has_approximate_tail = true;
            return Some(ResponseWork::Rough { inputs, rays });
        }
        let is_waiting = want.need() != UpdateUrgency::Immediate;
        let most = match budget.left {
            Some(left) if is_waiting => left,
            _ => usize::MAX,
        };
        if is_waiting && !budget.may_start(MIN_RAYS) {
            want.is_waiting = true;
            return None;
        }
        let mut job = match want.started() {
            Some(job) if job.is_still_valid(&want.now, &around.threshold) => Box::new(job.clone()),
            // A listener who walks on must not keep all other sources from their turns.
            Some(_) if is_waiting => {
                (want.is_waiting, want.due_block, want.partial_trace) =
                    (true, self.block, PartialTraceOutcome::None);
                return None;
            }
            _ => Box::new(TraceJob {
                situation: want.now.clone(),
                progress: TraceProgress::new(config, 1),
            }),
        };
        // It is rendered with the head's present rotation.
        job.situation.receiver.pose.rotation = want.now.receiver.pose.rotation;
        let left = all.saturating_sub(job.progress.rays());
        let ends = job.progress.ends_within(all, most);
        budget.spend(most.min(left) + if ends { RESPONSE_COST_RAYS } else { 0 });
        Some(ResponseWork::AllRays { job, most, ends })
    }

    /// Computes a response.
    fn compute(
        &self,
        around: &BlockContext<'_>,
        id: u64,
        work: &ResponseWork<'_>,
    ) -> Result<ComputedResponse, AcousticsError> {
        let mut computed = ComputedResponse::default();
        match work {
            // Taken from the other when all are computed.
            ResponseWork::Shared { .. } => {}
            ResponseWork::Known(known) => computed.response = Some((*known).clone()),
            ResponseWork::Rotation { inputs, response } => {
                computed.rotated = 1;
                computed.partial_trace = PartialTraceOutcome::Unchanged;
                let response =
                    self.scene
                        .rotated_response(response, &inputs.receiver, inputs.noise);
                computed.response = Some((inputs.clone(), response));
            }
            ResponseWork::FewRays {
                inputs,
                before: (then, response),
                may_trace_all,
            } => {
                let memory = TailHistory {
                    previous: &response.echogram,
                    moved_m: then.displacement_m(inputs),
                    share: self.config.update_share,
                    update: self.block,
                };
                let way = self.response_updater(around, id, inputs);
                let (response, known) = way.update_from_history(&memory, *may_trace_all)?;
                computed.traced_responses = 1;
                computed.rays = response.echogram.ray_statistics.rays as usize;
                let mut inputs = inputs.clone();
                inputs.has_approximate_tail |= !known;
                computed.response = Some((inputs, response));
            }
            ResponseWork::Rough { inputs, rays } => {
                let response = self
                    .response_updater(around, id, inputs)
                    .trace_with_rays(*rays)?;
                computed.traced_responses = 1;
                computed.rays = *rays;
                computed.response = Some((inputs.clone(), response));
            }
            ResponseWork::AllRays { job, most, .. } => {
                let mut job = job.clone();
                let before = job.progress.rays();
                let way = self.response_updater(around, id, &job.situation);
                let response = way.trace_incrementally(&mut job.progress, *most)?;
                computed.rays = job.progress.rays() - before;
                match response {
                    Some(response) => {
                        computed.traced_responses = 1;
                        computed.response = Some((job.situation, response));
                    }
                    None => computed.partial_trace = PartialTraceOutcome::Advanced(job),
                }
            }
        }
        Ok(computed)
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
