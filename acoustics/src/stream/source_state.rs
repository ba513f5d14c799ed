//! The state of one source in a stream: its past samples, and its last response.

use super::convolver::{ConvolverInput, PartitionedFilter};
use super::early::TrackedPath;
use crate::fft::RealFft;
use crate::laws::PathEffects;
use crate::receiver::Receiver;
use crate::response::ImpulseResponse;
use crate::synthesis::CachedGains;
use crate::tail::TraceProgress;
use dwell_scene::random::RandomKey;
use dwell_scene::{Address, Pose};
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The situation for which an impulse response was computed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct ResponseInputs {
    pub(super) source: Vec3,
    pub(super) receiver: Receiver,
    /// Poses of the parts that are large enough to be heard. Shape (large part,).
    pub(super) parts: Vec<Pose>,
    pub(super) overrides: BTreeMap<Address, f64>,
    pub(super) effects: PathEffects,
    /// True for a tail that is not traced with all rays: large parts moved, so that it is partly that of their earlier
    /// poses, or only a few rays were traced yet.
    pub(super) has_approximate_tail: bool,
    /// Random key of the tail's arrivals: that between the places where it was first heard.
    pub(super) noise: RandomKey,
}

/// The kind of change between two situations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum ResponseInputChange {
    /// No audible change.
    None,
    /// The head turned.
    Rotated,
    /// Something moved: new rays are needed.
    Moved,
}

/// Least differences that count as a change.
#[derive(Clone, Copy, Debug)]
pub(super) struct UpdateThreshold {
    pub(super) distance_m: f32,
    pub(super) angle_rad: f32,
    pub(super) part_m: f32,
}

/// Factor on a part's displacement: near a door the tail changes that much faster with it than with the listener's own; a
/// quarter turn changes all.
const PART_MOVEMENT_FACTOR: f32 = 25.0;

/// Returns the largest displacement, m, or rotation, rad, of the parts: a part that rotates by an angle moves its far edge
/// by about as many metres. Shape of both: (large part,).
pub(super) fn largest_part_movement(before: &[Pose], now: &[Pose]) -> f32 {
    let ways = before.iter().zip(now).filter(|(a, b)| a != b);
    ways.map(|(a, b)| {
        a.position
            .distance(b.position)
            .max(angle(a.rotation, b.rotation))
    })
    .fold(0.0, f32::max)
}

fn angle(a: glam::Quat, b: glam::Quat) -> f32 {
    2.0 * dwell_scene::math::acos(a.dot(b).abs().min(1.0))
}

impl ResponseInputs {
    /// Returns the displacement of source and receiver to `now`, m; displacements of large parts count [`PART_MOVEMENT_FACTOR`] times.
    pub(super) fn displacement_m(&self, now: &Self) -> f64 {
        let receivers = self.receiver.position().distance(now.receiver.position());
        let parts = PART_MOVEMENT_FACTOR * largest_part_movement(&self.parts, &now.parts);
        f64::from(self.source.distance(now.source) + receivers + parts)
    }

    /// Returns whether only source and receiver moved, and large parts if they are `passing`.
    pub(super) fn differs_by_positions_only(
        &self,
        now: &Self,
        threshold: &UpdateThreshold,
        passing: bool,
    ) -> bool {
        let mut there = Self {
            source: now.source,
            receiver: now.receiver.clone(),
            ..self.clone()
        };
        if passing && self.parts.len() == now.parts.len() {
            there.parts.clone_from(&now.parts);
        }
        self.receiver.kind == now.receiver.kind
            && there.change(now, threshold) == ResponseInputChange::None
    }

    /// Returns whether more than poses changed, so that the old response must not be used any more.
    pub(super) fn invalidates_response(&self, now: &Self) -> bool {
        self.receiver.kind != now.receiver.kind
            || self.overrides != now.overrides
            || self.effects != now.effects
            || self.parts.len() != now.parts.len()
    }

    /// As [`Self::change`], for a source that has ended: it rings out where it was heard last, and what it sent out before a
    /// door or the listener moved is not traced anew.
    pub(super) fn change_of_ended_source(
        &self,
        now: &Self,
        threshold: &UpdateThreshold,
    ) -> ResponseInputChange {
        let mut there = now.clone();
        there.source = self.source;
        there.receiver.pose.position = self.receiver.pose.position;
        if there.parts.len() == self.parts.len() {
            there.parts.clone_from(&self.parts);
        }
        self.change(&there, threshold)
    }

    pub(super) fn change(&self, now: &Self, threshold: &UpdateThreshold) -> ResponseInputChange {
        let far = |a: Vec3, b: Vec3, limit: f32| {
            // Not "farther than", so that a limit of 0 means any movement at all.
            a != b && a.distance(b) >= limit
        };
        let (here, there) = (&self.receiver, &now.receiver);
        let parts = self.parts.iter().zip(&now.parts);
        let mut parts = parts.map(|(a, b)| {
            // A part that rotates by an angle moves its far edge by about as many metres.
            far(a.position, b.position, threshold.part_m)
                || (a.rotation != b.rotation && angle(a.rotation, b.rotation) >= threshold.part_m)
        });
        if self.invalidates_response(now)
            || far(self.source, now.source, threshold.distance_m)
            || far(here.position(), there.position(), threshold.distance_m)
            || parts.any(|moved| moved)
        {
            return ResponseInputChange::Moved;
        }
        let (a, b) = (here.rotation(), there.rotation());
        if a != b && angle(a, b) >= threshold.angle_rad {
            return if here.is_coincident() {
                ResponseInputChange::Rotated
            } else {
                ResponseInputChange::Moved
            };
        }
        ResponseInputChange::None
    }
}

/// The state of a source that a snapshot holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SourceSnapshot {
    pub(super) id: u64,
    pub(super) current_response: Option<(ResponseInputs, ImpulseResponse)>,
    pub(super) history: Vec<f32>,
    pub(super) tracked: TrackedPaths,
    pub(super) pending_update: PendingUpdate,
}

/// A response that must be computed anew and has not had its turn, or not fully.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct PendingUpdate {
    /// The block in which it became due.
    pub(super) due_block: Option<u64>,
    pub(super) job: Option<Box<TraceJob>>,
}

/// The partial trace of a response.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct TraceJob {
    pub(super) situation: ResponseInputs,
    pub(super) progress: TraceProgress,
}

impl TraceJob {
    /// Returns whether its result will still be useful. The motion of slow parts meanwhile is covered by the later rays,
    /// and by its next update.
    pub(super) fn is_still_valid(&self, now: &ResponseInputs, threshold: &UpdateThreshold) -> bool {
        let mut there = now.clone();
        if there.parts.len() == self.situation.parts.len() {
            there.parts.clone_from(&self.situation.parts);
        }
        self.situation.change(&there, threshold) != ResponseInputChange::Moved
    }
}

/// The early paths of a source while something moves.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct TrackedPaths {
    /// Positions of source and receiver at the end of the last block.
    pub(super) last_positions: Option<(Vec3, Pose)>,
    /// Early paths outside the filter, once anything has moved.
    pub(super) paths: Option<Vec<TrackedPath>>,
}

/// One source.
#[derive(Clone, Debug)]
pub(super) struct SourceState {
    pub(super) id: u64,
    pub(super) current_response: Option<(ResponseInputs, ImpulseResponse)>,
    pub(super) input: ConvolverInput,
    pub(super) filter: PartitionedFilter,
    pub(super) tracked: TrackedPaths,
    pub(super) pending_update: PendingUpdate,
}

impl SourceState {
    pub(super) fn new(id: u64, block: usize, partitions: usize) -> Self {
        Self {
            id,
            current_response: None,
            input: ConvolverInput::new(block, partitions),
            filter: PartitionedFilter::default(),
            tracked: TrackedPaths::default(),
            pending_update: PendingUpdate::default(),
        }
    }

    pub(super) fn snapshot(&self) -> SourceSnapshot {
        let heard = self.current_response.as_ref().map(|(situation, response)| {
            // Samples follow from the echogram, except for an array: each of its microphones has its own early paths.
            let samples = match situation.receiver.microphone_positions() {
                Some(_) => response.samples.clone(),
                None => Vec::new(),
            };
            let response = ImpulseResponse {
                samples,
                echogram: response.echogram.clone(),
                noise_gains: CachedGains::default(),
                ..*response
            };
            (situation.clone(), response)
        });
        SourceSnapshot {
            id: self.id,
            current_response: heard,
            history: self.input.history().to_vec(),
            tracked: self.tracked.clone(),
            pending_update: self.pending_update.clone(),
        }
    }

    pub(super) fn restore(fft: &mut RealFft, memory: SourceSnapshot, partitions: usize) -> Self {
        Self {
            id: memory.id,
            current_response: memory.current_response,
            input: ConvolverInput::restore(fft, &memory.history, partitions),
            filter: PartitionedFilter::default(),
            tracked: memory.tracked,
            pending_update: memory.pending_update,
        }
    }

    /// Convolves with `samples` from now on, shape (channel, sample), flat.
    pub(super) fn set_filter(
        &mut self,
        fft: &mut RealFft,
        samples: &[f32],
        channels: usize,
        partitions: usize,
    ) {
        self.filter = PartitionedFilter::new(fft, samples, channels, partitions);
    }
}
