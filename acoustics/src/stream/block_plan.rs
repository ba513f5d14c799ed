//! The plan of a block: sources that are heard, and those that need new impulse responses.

use super::source_state::{self, ResponseInputChange, ResponseInputs, UpdateThreshold};
use super::update_queue::{PartialTraceOutcome, UpdateRequest};
use super::{ActiveSource, BlockReport, Stream, early};
use crate::echogram::PropagationPath;
use crate::error::AcousticsError;
use crate::receiver::Receiver;
use crate::response::ImpulseResponse;
use crate::scene::arrival_key;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::rays::RayScene;
use dwell_scene::{Pose, State};
use glam::Vec3;

/// Factor by which update distances are smaller for responses without gliding delays.
const UPDATE_DIVISOR: f32 = 5.0;
/// Distance from another source, plus the listener's displacement since, within which a new source begins with its tail, m.
const BESIDE_M: f64 = 2.0;
/// Displacement in a block below which large parts count as still, m.
const STILL_M: f32 = 5e-3;

/// The plan of a source for one block.
pub(super) struct PlannedSource {
    pub(super) id: u64,
    /// True for a source that still sounds; else it only rings out.
    pub(super) is_playing: bool,
    /// Positions of source and receiver.
    pub(super) positions: (Vec3, Pose),
    /// The new impulse response, and its situation; `None`: as before.
    pub(super) new_response: Option<(ResponseInputs, ImpulseResponse)>,
    /// Early paths outside the impulse response, at their present positions; `None`: none are.
    pub(super) tracked_paths: Option<Vec<PropagationPath>>,
    /// The block since which a new response waits for its turn.
    pub(super) waiting_since_block: Option<u64>,
    /// The state of its partial trace.
    pub(super) partial_trace: PartialTraceOutcome,
}

/// A source that sounds or rings out.
struct SoundingSource {
    id: u64,
    /// `None` for a source that is no longer named.
    position: Option<Vec3>,
    /// Its rank by loudness.
    rank: usize,
}

/// The inputs common to all sources of a block.
pub(super) struct BlockContext<'a> {
    pub(super) rays: &'a RayScene,
    pub(super) receiver: &'a Receiver,
    pub(super) threshold: UpdateThreshold,
    /// True while a large part moves.
    pub(super) large_part_moving: bool,
}

impl Stream {
    /// Returns the sources of this block, by id, with new impulse responses where they need them and it is their turn.
    pub(super) fn plan(
        &self,
        rays: &RayScene,
        state: &State,
        sources: &[ActiveSource<'_>],
        receiver: &Receiver,
        report: &mut BlockReport,
    ) -> Result<Vec<PlannedSource>, AcousticsError> {
        let all = self.sounding(sources, report);
        // The microphones of an array have their own early paths.
        let glides =
            self.config.tracked_reflections > 0 && receiver.microphone_positions().is_none();
        let distance_m = self.config.update_distance_m;
        let parts = self.large_part_poses(state);
        // Nothing is reused where all rays are traced anyway.
        let remembers = self.config.update_share < 1.0;
        let around = BlockContext {
            rays,
            receiver,
            threshold: UpdateThreshold {
                distance_m: if glides {
                    distance_m
                } else {
                    distance_m / UPDATE_DIVISOR
                },
                angle_rad: self.config.update_angle_rad,
                part_m: self.config.update_part_m,
            },
            large_part_moving: remembers
                && source_state::largest_part_movement(&self.parts, &parts) > STILL_M,
        };
        let wants = all
            .iter()
            .filter_map(|one| self.update_request(&around, one, state, &parts));
        let mut wants: Vec<UpdateRequest<'_>> = wants.collect();
        self.update_responses(&around, &mut wants, report)?;
        // Early paths are those of each source alone.
        let followed = self.threads.map(wants.len(), |k| {
            let want = &wants[k];
            let heard = want.current_response();
            let last = want
                .source_state
                .and_then(|voice| voice.tracked.last_positions);
            let follows = want
                .source_state
                .is_some_and(|voice| voice.tracked.paths.is_some());
            let moved = follows || last.is_some_and(|last| last != want.positions);
            let known = want.new_response.as_ref().or(heard);
            let elsewhere =
                known.is_some_and(|(then, _)| (then.source, then.receiver.pose) != want.positions);
            // A source that waits is rendered with its direct path and known reflections as they are now.
            let moved = moved
                || elsewhere
                || (want.is_waiting && want.change == ResponseInputChange::Moved);
            known.filter(|_| glides && moved).map(|(_, response)| {
                let chosen = early::select_tracked_paths(
                    &response.echogram.paths,
                    self.config.tracked_reflections,
                );
                let (source, receiver) = (want.positions.0, receiver.position());
                self.scene
                    .updated_early_paths(rays, source, receiver, &chosen)
            })
        });
        let planned = wants.into_iter().zip(followed);
        let planned = planned.map(|(want, followed)| PlannedSource {
            id: want.id,
            is_playing: want.is_playing,
            positions: want.positions,
            tracked_paths: followed,
            waiting_since_block: want.is_waiting.then_some(want.due_block),
            partial_trace: want.partial_trace,
            new_response: want.new_response,
        });
        Ok(planned.collect())
    }

    /// Returns the change of a source's situation; `None` for a source that was never heard.
    fn update_request(
        &self,
        around: &BlockContext<'_>,
        one: &SoundingSource,
        state: &State,
        parts: &[Pose],
    ) -> Option<UpdateRequest<'_>> {
        let id = one.id;
        let at = self.voices.binary_search_by_key(&id, |voice| voice.id);
        let voice = at.ok().map(|at| &self.voices[at]);
        let heard = voice.and_then(|voice| voice.current_response.as_ref());
        let named = one.position.is_some();
        // A source that is no longer named rings out at its last position.
        let last = voice.and_then(|voice| voice.tracked.last_positions);
        let position = one.position.or(last.map(|(source, _)| source))?;
        let receiver = around.receiver;
        let now = ResponseInputs {
            source: position,
            receiver: receiver.clone(),
            parts: parts.to_vec(),
            overrides: state.overrides.clone(),
            effects: *self.scene.effects(),
            has_approximate_tail: false,
            noise: heard.map_or_else(
                || arrival_key(self.key_of(id), position, receiver.position()),
                |(then, _)| then.noise,
            ),
        };
        let change = heard.map_or(ResponseInputChange::Moved, |(then, _)| {
            if named {
                then.change(&now, &around.threshold)
            } else {
                then.change_of_ended_source(&now, &around.threshold)
            }
        });
        Some(UpdateRequest {
            id,
            is_playing: named,
            loudness_rank: one.rank,
            positions: (position, receiver.pose),
            source_state: voice,
            change,
            // When a door has come to rest, all rays are traced again.
            has_stale_tail: heard.is_some_and(|(then, _)| {
                then.has_approximate_tail && named && !around.large_part_moving
            }),
            due_block: voice
                .and_then(|voice| voice.pending_update.due_block)
                .unwrap_or(self.block),
            now,
            new_response: None,
            partial_trace: PartialTraceOutcome::Unchanged,
            is_waiting: false,
        })
    }

    /// Returns the sources that sound or ring out, by id.
    fn sounding(
        &self,
        sources: &[ActiveSource<'_>],
        report: &mut BlockReport,
    ) -> Vec<SoundingSource> {
        let mut all: Vec<SoundingSource> = Vec::new();
        let mut seen = 0;
        for source in sources {
            if all.iter().any(|one| one.id == source.id) {
                continue;
            }
            let sounds = sources
                .iter()
                .filter(|other| other.id == source.id)
                .any(|other| other.signal.iter().any(|x| *x != 0.0));
            let rings = self
                .voices
                .iter()
                .any(|voice| voice.id == source.id && !voice.input.is_silent());
            if sounds || rings {
                seen += 1;
                if seen <= self.config.max_sources {
                    all.push(SoundingSource {
                        id: source.id,
                        position: Some(source.position),
                        rank: all.len(),
                    });
                } else {
                    report.dropped_sources += 1;
                }
            }
        }
        for voice in &self.voices {
            if !voice.input.is_silent() && !all.iter().any(|one| one.id == voice.id) {
                all.push(SoundingSource {
                    id: voice.id,
                    position: None,
                    rank: all.len(),
                });
            }
        }
        all.sort_by_key(|one| one.id);
        report.audible_sources = all.len();
        all
    }

    /// Returns the response of another source close to the start of a new one, with nothing in between: a footstep sounds
    /// much like the last one.
    pub(super) fn response_of_nearby_source(
        &self,
        rays: &RayScene,
        now: &ResponseInputs,
        alike: impl Fn(&ResponseInputs) -> bool,
    ) -> Option<&(ResponseInputs, ImpulseResponse)> {
        let heard = self
            .voices
            .iter()
            .filter_map(|voice| voice.current_response.as_ref());
        let close = heard.filter(|(then, _)| then.displacement_m(now) <= BESIDE_M && alike(then));
        let nearest =
            close.min_by(|(a, _), (b, _)| a.displacement_m(now).total_cmp(&b.displacement_m(now)));
        nearest.filter(|(then, _)| {
            let way = |from, to| Ray::segment(from, to, 0.0);
            let sources = way(then.source, now.source);
            let receivers = way(then.receiver.position(), now.receiver.position());
            !rays.occluded(&sources, RayMask::EAR) && !rays.occluded(&receivers, RayMask::EAR)
        })
    }
}
