//! What is heard in a block: which sources, and which of them need new impulse responses.

use super::voice::{self, Change, Situation, Threshold};
use super::{ActiveSource, BlockReport, Memory, Stream, early};
use crate::echogram::Path;
use crate::error::AcousticsError;
use crate::receiver::{Receiver, Source};
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
}

impl Stream {
    /// The sources that are heard in this block, by id, with new impulse responses where they need them.
    pub(super) fn plan(
        &self,
        rays: &RayScene,
        state: &State,
        sources: &[ActiveSource<'_>],
        receiver: &Receiver,
        report: &mut BlockReport,
    ) -> Result<Vec<Planned>, AcousticsError> {
        let ids = self.sounding(sources, report);
        // The microphones of an array hear early paths of their own.
        let glides = self.config.moving_paths > 0 && receiver.microphone_positions().is_none();
        let distance_m = self.config.update_distance_m;
        let threshold = Threshold {
            distance_m: if glides {
                distance_m
            } else {
                distance_m / STIFF
            },
            angle_rad: self.config.update_angle_rad,
            part_m: self.config.update_part_m,
        };
        let parts = self.poses(state);
        // Nothing is remembered where all rays are traced anyway.
        let remembers = self.config.update_share < 1.0;
        let passing = remembers && voice::furthest(&self.parts, &parts) > STILL_M;
        let mut settled = false;
        let mut planned = Vec::with_capacity(ids.len());
        for (id, position) in ids {
            let at = self.voices.binary_search_by_key(&id, |voice| voice.id);
            let at = at.ok().map(|at| &self.voices[at]);
            let heard = at.and_then(|voice| voice.heard.as_ref());
            let named = position.is_some();
            // What is no longer named rings out where it was last.
            let last = at.and_then(|voice| voice.moved.last);
            let Some(position) = position.or(last.map(|(source, _)| source)) else {
                continue;
            };
            let key = self.key_of(id);
            let mut now = Situation {
                source: position,
                receiver: receiver.clone(),
                parts: parts.clone(),
                overrides: state.overrides.clone(),
                effects: *self.scene.effects(),
                passing: false,
                noise: heard.map_or_else(
                    || between(key, position, receiver.position()),
                    |(then, _)| then.noise,
                ),
            };
            let changed = |then: &Situation| then.change(&now, &threshold);
            let change = heard.map_or(Change::Moved, |(then, _)| {
                if named {
                    changed(then)
                } else {
                    then.change_while_ringing(&now, &threshold)
                }
            });
            // A blow on the table is heard as the one before it was: other sources' impulse responses serve as well.
            let known = || {
                let others = self.voices.iter().filter_map(|voice| voice.heard.as_ref());
                let usable = |then: &Situation| passing || !then.passing;
                let mut close =
                    others.filter(|(then, _)| usable(then) && changed(then) == Change::None);
                close.next().cloned()
            };
            let (scene, threads) = (&self.scene, self.threads);
            // When a door has come to rest, all rays tell what is heard now: one source in a block.
            let stale = heard.is_some_and(|(then, _)| then.passing && named && !passing);
            let settles = stale && !settled;
            settled |= settles;
            let news = match (change, heard) {
                (Change::None, _) if !settles => None,
                (Change::Turned, Some((then, response))) => {
                    report.turned += 1;
                    // The echogram stays that of the place where it was traced.
                    let mut turned = then.clone();
                    turned.receiver.pose.rotation = receiver.pose.rotation;
                    let response = scene.turn(response, &turned.receiver, turned.noise);
                    Some((turned, response))
                }
                _ => Some(if let Some(known) = known() {
                    known
                } else {
                    report.traced += 1;
                    let source = Source::at(position);
                    let alike = |then: &Situation| {
                        !settles && then.differs_by_places_only(&now, &threshold, passing)
                    };
                    let again = heard
                        .filter(|(then, _)| alike(then))
                        .or_else(|| self.heard_near(rays, &now, alike));
                    let response = if let Some((then, response)) = again {
                        now.passing = passing || then.passing;
                        let memory = Memory {
                            before: &response.echogram,
                            moved_m: then.moved_m(&now),
                            share: self.config.update_share,
                            update: self.block,
                            noise: now.noise,
                        };
                        scene.arrive_again(rays, &source, receiver, &memory, key, threads)?
                    } else {
                        let receivers = std::slice::from_ref(receiver);
                        let noise = |_: &Receiver| now.noise;
                        let arrived =
                            scene.arrivals(rays, &source, receivers, key, noise, threads)?;
                        arrived.into_iter().next().unwrap_or_default()
                    };
                    (now.clone(), response)
                }),
            };
            let place = (position, receiver.pose);
            let moved = at.is_some_and(|voice| {
                voice.moved.followed.is_some() || voice.moved.last.is_some_and(|last| last != place)
            });
            let known = news.as_ref().or(heard);
            let elsewhere =
                known.is_some_and(|(then, _)| (then.source, then.receiver.pose) != place);
            let followed = known
                .filter(|_| glides && (moved || elsewhere))
                .map(|(_, response)| {
                    let chosen = early::choose(&response.echogram.paths, self.config.moving_paths);
                    scene.follow(rays, position, receiver.position(), &chosen)
                });
            planned.push(Planned {
                id,
                named,
                place,
                news,
                followed,
            });
        }
        Ok(planned)
    }

    /// The sources that sound or ring, by id, and where they are; `None` for what is no longer named.
    fn sounding(
        &self,
        sources: &[ActiveSource<'_>],
        report: &mut BlockReport,
    ) -> Vec<(u64, Option<Vec3>)> {
        let mut ids: Vec<(u64, Option<Vec3>)> = Vec::new();
        let mut seen = 0;
        for source in sources {
            if ids.iter().any(|(id, _)| *id == source.id) {
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
                    ids.push((source.id, Some(source.position)));
                } else {
                    report.left_out += 1;
                }
            }
        }
        for voice in &self.voices {
            if !voice.input.is_silent() && !ids.iter().any(|(id, _)| *id == voice.id) {
                ids.push((voice.id, None));
            }
        }
        ids.sort_by_key(|(id, _)| *id);
        report.heard = ids.len();
        ids
    }

    /// What another source is heard as, close to where one begins and with nothing in between: a step sounds much like the last one.
    fn heard_near(
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
