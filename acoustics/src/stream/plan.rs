//! What is heard in a block: which sources, and which of them need new impulse responses.

use super::turns::{Pieces, Want};
use super::voice::{self, Change, Situation, Threshold};
use super::{ActiveSource, BlockReport, Stream, early};
use crate::echogram::Path;
use crate::error::AcousticsError;
use crate::receiver::Receiver;
use crate::response::ImpulseResponse;
use crate::scene::between;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::rays::RayScene;
use dwell_scene::{Pose, State};
use glam::Vec3;

/// What does not glide is computed anew after movements so many times smaller.
const STIFF: f32 = 5.0;
/// A source that begins so close to another, counted with the listener's way since, begins with its tail, m.
const BESIDE_M: f64 = 2.0;
/// Large parts that move less than this in a block stand still, m.
const STILL_M: f32 = 5e-3;

/// What a voice does in one block.
pub(super) struct Planned {
    pub(super) id: u64,
    /// Whether its source is heard; else it only rings out.
    pub(super) named: bool,
    /// Where source and receiver are.
    pub(super) place: (Vec3, Pose),
    /// The impulse response from now on, and the situation it belongs to; `None`: as before.
    pub(super) news: Option<(Situation, ImpulseResponse)>,
    /// Early paths that are heard apart from the impulse response, where they are now; `None`: none are.
    pub(super) followed: Option<Vec<Path>>,
    /// Since which block a new response waits for its turn.
    pub(super) since: Option<u64>,
    /// What was traced of it so far.
    pub(super) job: Pieces,
}

/// A source that sounds or rings.
struct Sounding {
    id: u64,
    /// `None` for what is no longer named.
    position: Option<Vec3>,
    /// Its place among the sources, of which the loudest come first.
    rank: usize,
}

/// What all sources of a block have in common.
pub(super) struct Surroundings<'a> {
    pub(super) rays: &'a RayScene,
    pub(super) receiver: &'a Receiver,
    pub(super) threshold: Threshold,
    /// Whether a large part is on its way.
    pub(super) passing: bool,
}

impl Stream {
    /// The sources that are heard in this block, by id, with new impulse responses where they need them and it is their turn.
    pub(super) fn plan(
        &self,
        rays: &RayScene,
        state: &State,
        sources: &[ActiveSource<'_>],
        receiver: &Receiver,
        report: &mut BlockReport,
    ) -> Result<Vec<Planned>, AcousticsError> {
        let all = self.sounding(sources, report);
        // The microphones of an array hear early paths of their own.
        let glides = self.config.moving_paths > 0 && receiver.microphone_positions().is_none();
        let distance_m = self.config.update_distance_m;
        let parts = self.poses(state);
        // Nothing is remembered where all rays are traced anyway.
        let remembers = self.config.update_share < 1.0;
        let around = Surroundings {
            rays,
            receiver,
            threshold: Threshold {
                distance_m: if glides {
                    distance_m
                } else {
                    distance_m / STIFF
                },
                angle_rad: self.config.update_angle_rad,
                part_m: self.config.update_part_m,
            },
            passing: remembers && voice::furthest(&self.parts, &parts) > STILL_M,
        };
        let wants = all
            .iter()
            .filter_map(|one| self.want(&around, one, state, &parts));
        let mut wants: Vec<Want<'_>> = wants.collect();
        self.serve(&around, &mut wants, report)?;
        let planned = wants.into_iter().map(|want| {
            let heard = want.heard();
            let last = want.voice.and_then(|voice| voice.moved.last);
            let follows = want
                .voice
                .is_some_and(|voice| voice.moved.followed.is_some());
            let moved = follows || last.is_some_and(|last| last != want.place);
            let known = want.news.as_ref().or(heard);
            let elsewhere =
                known.is_some_and(|(then, _)| (then.source, then.receiver.pose) != want.place);
            // What has to wait is heard on its straight ways and known reflections as they are now.
            let moved = moved || elsewhere || (want.waits && want.change == Change::Moved);
            let followed = known.filter(|_| glides && moved).map(|(_, response)| {
                let chosen = early::choose(&response.echogram.paths, self.config.moving_paths);
                let (source, receiver) = (want.place.0, receiver.position());
                self.scene.follow(rays, source, receiver, &chosen)
            });
            Planned {
                id: want.id,
                named: want.named,
                place: want.place,
                followed,
                since: want.waits.then_some(want.since),
                job: want.job,
                news: want.news,
            }
        });
        Ok(planned.collect())
    }

    /// What has changed for a source; `None` for what was never heard.
    fn want(
        &self,
        around: &Surroundings<'_>,
        one: &Sounding,
        state: &State,
        parts: &[Pose],
    ) -> Option<Want<'_>> {
        let id = one.id;
        let at = self.voices.binary_search_by_key(&id, |voice| voice.id);
        let voice = at.ok().map(|at| &self.voices[at]);
        let heard = voice.and_then(|voice| voice.heard.as_ref());
        let named = one.position.is_some();
        // What is no longer named rings out where it was last.
        let last = voice.and_then(|voice| voice.moved.last);
        let position = one.position.or(last.map(|(source, _)| source))?;
        let receiver = around.receiver;
        let now = Situation {
            source: position,
            receiver: receiver.clone(),
            parts: parts.to_vec(),
            overrides: state.overrides.clone(),
            effects: *self.scene.effects(),
            rough: false,
            noise: heard.map_or_else(
                || between(self.key_of(id), position, receiver.position()),
                |(then, _)| then.noise,
            ),
        };
        let change = heard.map_or(Change::Moved, |(then, _)| {
            if named {
                then.change(&now, &around.threshold)
            } else {
                then.change_while_ringing(&now, &around.threshold)
            }
        });
        Some(Want {
            id,
            named,
            rank: one.rank,
            place: (position, receiver.pose),
            voice,
            change,
            // When a door has come to rest, all rays tell what is heard now.
            stale: heard.is_some_and(|(then, _)| then.rough && named && !around.passing),
            since: voice
                .and_then(|voice| voice.waiting.since)
                .unwrap_or(self.block),
            now,
            news: None,
            job: Pieces::AsBefore,
            waits: false,
        })
    }

    /// The sources that sound or ring, by id.
    fn sounding(&self, sources: &[ActiveSource<'_>], report: &mut BlockReport) -> Vec<Sounding> {
        let mut all: Vec<Sounding> = Vec::new();
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
                    all.push(Sounding {
                        id: source.id,
                        position: Some(source.position),
                        rank: all.len(),
                    });
                } else {
                    report.left_out += 1;
                }
            }
        }
        for voice in &self.voices {
            if !voice.input.is_silent() && !all.iter().any(|one| one.id == voice.id) {
                all.push(Sounding {
                    id: voice.id,
                    position: None,
                    rank: all.len(),
                });
            }
        }
        all.sort_by_key(|one| one.id);
        report.heard = all.len();
        all
    }

    /// What another source is heard as, close to where one begins and with nothing in between: a step sounds much like the last one.
    pub(super) fn heard_near(
        &self,
        rays: &RayScene,
        now: &Situation,
        alike: impl Fn(&Situation) -> bool,
    ) -> Option<&(Situation, ImpulseResponse)> {
        let heard = self.voices.iter().filter_map(|voice| voice.heard.as_ref());
        let close = heard.filter(|(then, _)| then.moved_m(now) <= BESIDE_M && alike(then));
        let nearest = close.min_by(|(a, _), (b, _)| a.moved_m(now).total_cmp(&b.moved_m(now)));
        nearest.filter(|(then, _)| {
            let way = |from, to| Ray::segment(from, to, 0.0);
            let sources = way(then.source, now.source);
            let receivers = way(then.receiver.position(), now.receiver.position());
            !rays.occluded(&sources, RayMask::EAR) && !rays.occluded(&receivers, RayMask::EAR)
        })
    }
}
