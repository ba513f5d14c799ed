//! Whose impulse response is computed anew in a block, and whose later.
//!
//! A door that opens changes all that is heard at once. [`StreamConfig::update_rays`](super::StreamConfig::update_rays) bounds what a
//! block computes. It counts rays, never time, so that streams stay equal to the bit on all machines. First come sources of which
//! nothing is known yet, then what something has moved for, then tails that a few rays have told of; among equals what waits longest,
//! and then the loudest. What waits is heard as before, on straight ways and reflections as they are now. Where all rays are needed,
//! they are traced piece by piece, and heard together when the last is traced.

use super::memory::{Memory, rays_of};
use super::plan::Surroundings;
use super::voice::{Change, Job, Situation, Voice};
use super::way::Way;
use super::{BlockReport, Stream};
use crate::error::AcousticsError;
use crate::receiver::Source;
use crate::response::ImpulseResponse;
use crate::tail::Progress;
use dwell_scene::Pose;
use glam::Vec3;

/// What finding a response's early paths and making the response count as, rays.
const OF_A_RESPONSE: usize = 150;
/// What turning a response counts as, rays.
const OF_A_TURN: usize = 50;
/// The fewest rays that tell anything of a tail.
const FEWEST: usize = 64;

/// A source in a block, and what it needs.
pub(super) struct Want<'a> {
    pub(super) id: u64,
    /// Whether its source is heard; else it only rings out.
    pub(super) named: bool,
    /// Its place among the sources, of which the loudest come first.
    pub(super) rank: usize,
    /// Where source and receiver are.
    pub(super) place: (Vec3, Pose),
    pub(super) voice: Option<&'a Voice>,
    pub(super) now: Situation,
    pub(super) change: Change,
    /// Whether all rays are to tell what a few have told of.
    pub(super) stale: bool,
    /// The block in which a new response became due.
    pub(super) since: u64,
    pub(super) news: Option<(Situation, ImpulseResponse)>,
    pub(super) job: Pieces,
    /// Whether a new response still waits for its turn or for rays.
    pub(super) waits: bool,
}

/// What becomes of rays that are traced piece by piece.
pub(super) enum Pieces {
    AsBefore,
    None,
    Now(Box<Job>),
}

/// How soon a response is needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Need {
    /// There is none, or none that may still be heard.
    AtOnce,
    Moved,
    Stale,
    Nothing,
}

impl<'a> Want<'a> {
    pub(super) fn heard(&self) -> Option<&'a (Situation, ImpulseResponse)> {
        self.voice.and_then(|voice| voice.heard.as_ref())
    }

    fn begun(&self) -> Option<&'a Job> {
        self.voice.and_then(|voice| voice.waiting.job.as_deref())
    }

    fn need(&self) -> Need {
        match (self.change, self.heard()) {
            (_, None) => Need::AtOnce,
            (_, Some((then, _))) if then.is_of_another_kind(&self.now) => Need::AtOnce,
            (Change::Moved | Change::Turned, _) => Need::Moved,
            (Change::None, _) if self.stale => Need::Stale,
            (Change::None, _) => Need::Nothing,
        }
    }
}

/// What a block may still compute.
struct Budget {
    /// Rays; `None`: as many as are needed.
    left: Option<usize>,
    /// Whether any response was computed: one always is.
    served: bool,
    /// Whether one tail has settled: one does in a block.
    settled: bool,
}

impl Budget {
    /// Whether there is room for `rays`.
    fn holds(&self, rays: usize) -> bool {
        self.left.is_none_or(|left| rays <= left)
    }

    /// Whether it is the turn of what takes `rays`.
    fn allows(&self, rays: usize) -> bool {
        !self.served || self.holds(rays)
    }

    fn spend(&mut self, rays: usize) {
        self.served = true;
        self.left = self.left.map(|left| left.saturating_sub(rays));
    }
}

impl Stream {
    /// Computes the responses whose turn it is.
    pub(super) fn serve(
        &self,
        around: &Surroundings<'_>,
        wants: &mut [Want<'_>],
        report: &mut BlockReport,
    ) -> Result<(), AcousticsError> {
        // Before the first block nothing is heard that could wait.
        let bounded = self.config.update_rays > 0 && self.block > 0;
        let mut budget = Budget {
            left: bounded.then_some(self.config.update_rays),
            served: false,
            settled: false,
        };
        let mut order: Vec<&mut Want<'_>> = Vec::new();
        for want in wants {
            match want.need() {
                // Things are again as they were heard.
                Need::Nothing if want.begun().is_some() => want.job = Pieces::None,
                Need::Nothing => {}
                _ => order.push(want),
            }
        }
        if bounded {
            order.sort_by_key(|want| {
                (
                    want.need(),
                    want.begun().is_none(),
                    want.since,
                    want.rank,
                    want.id,
                )
            });
        }
        for want in order {
            self.serve_one(around, want, &mut budget, report)?;
            report.waiting += usize::from(want.waits);
        }
        Ok(())
    }

    fn serve_one(
        &self,
        around: &Surroundings<'_>,
        want: &mut Want<'_>,
        budget: &mut Budget,
        report: &mut BlockReport,
    ) -> Result<(), AcousticsError> {
        let (heard, threshold, passing) = (want.heard(), &around.threshold, around.passing);
        // Where work is bounded, a place that is left again is not worth all rays.
        let stays = budget.left.is_none() || want.change == Change::None;
        let settles = want.stale && stays && !budget.settled;
        budget.settled |= settles;
        match (want.change, heard) {
            (Change::None, Some(_)) if !settles => {
                want.waits = true;
                return Ok(());
            }
            (Change::Turned, Some((then, response))) => {
                want.waits = !budget.allows(OF_A_TURN);
                if !want.waits {
                    budget.spend(OF_A_TURN);
                    report.turned += 1;
                    // The echogram stays that of the place where it was traced.
                    let mut turned = then.clone();
                    turned.receiver.pose.rotation = want.now.receiver.pose.rotation;
                    let response = self.scene.turn(response, &turned.receiver, turned.noise);
                    want.news = Some((turned, response));
                }
                return Ok(());
            }
            _ => {}
        }
        // A blow on the table is heard as the one before it was: other sources' impulse responses serve as well.
        let usable = |then: &Situation| {
            (passing || !then.rough) && then.change(&want.now, threshold) == Change::None
        };
        let mut others = self.voices.iter().filter_map(|voice| voice.heard.as_ref());
        if let Some(known) = others.find(|(then, _)| usable(then)) {
            want.job = Pieces::None;
            want.news = Some(known.clone());
            return Ok(());
        }
        let alike = |then: &Situation| {
            !settles && then.differs_by_places_only(&want.now, threshold, passing)
        };
        let again = heard
            .filter(|(then, _)| alike(then))
            .or_else(|| self.heard_near(around.rays, &want.now, alike));
        match again {
            Some(before) => self.hear_again(around, want, before, budget, report),
            None => self.hear_anew(around, want, budget, report),
        }
    }

    /// Few rays, and the rest from memory.
    fn hear_again(
        &self,
        around: &Surroundings<'_>,
        want: &mut Want<'_>,
        (then, response): &(Situation, ImpulseResponse),
        budget: &mut Budget,
        report: &mut BlockReport,
    ) -> Result<(), AcousticsError> {
        let rays = rays_of(self.scene.config(), self.config.update_share);
        want.waits = want.need() != Need::AtOnce && !budget.allows(rays + OF_A_RESPONSE);
        if want.waits {
            return Ok(());
        }
        budget.spend(rays + OF_A_RESPONSE);
        let memory = Memory {
            before: &response.echogram,
            moved_m: then.moved_m(&want.now),
            share: self.config.update_share,
            update: self.block,
        };
        let all = budget.holds(self.scene.config().rays);
        let way = self.way(around, want.id, &want.now);
        let (response, known) = way.again(&memory, all)?;
        report.traced += 1;
        report.rays += response.echogram.trace.rays as usize;
        want.now.rough = around.passing || then.rough || !known;
        want.job = Pieces::None;
        want.news = Some((want.now.clone(), response));
        Ok(())
    }

    /// All rays, or as many as it is the turn of.
    fn hear_anew(
        &self,
        around: &Surroundings<'_>,
        want: &mut Want<'_>,
        budget: &mut Budget,
        report: &mut BlockReport,
    ) -> Result<(), AcousticsError> {
        let all = self.scene.config().rays;
        if want.heard().is_none() && !budget.holds(all) {
            let share = rays_of(self.scene.config(), self.config.update_share);
            let rays = share
                .min(budget.left.unwrap_or(all))
                .clamp(FEWEST.min(all), all);
            budget.spend(rays + OF_A_RESPONSE);
            let way = self.way(around, want.id, &want.now);
            let response = way.roughly(rays)?;
            report.traced += 1;
            report.rays += rays;
            want.now.rough = true;
            want.news = Some((want.now.clone(), response));
            return Ok(());
        }
        let waits = want.need() != Need::AtOnce;
        let most = match budget.left {
            Some(left) if waits => left,
            _ => usize::MAX,
        };
        if waits && !budget.allows(FEWEST) {
            want.waits = true;
            return Ok(());
        }
        let mut job = match want.begun() {
            Some(job) if job.serves(&want.now, &around.threshold) => Box::new(job.clone()),
            // Somebody who walks on must not keep all others from their turns.
            Some(_) if waits => {
                (want.waits, want.since, want.job) = (true, self.block, Pieces::None);
                return Ok(());
            }
            _ => Box::new(Job {
                situation: want.now.clone(),
                progress: Progress::new(self.scene.config(), 1),
            }),
        };
        // It is heard with the head as it is turned now.
        job.situation.receiver.pose.rotation = want.now.receiver.pose.rotation;
        let before = job.progress.rays();
        let way = self.way(around, want.id, &job.situation);
        let response = way.by_pieces(&mut job.progress, most)?;
        let rays = job.progress.rays() - before;
        report.rays += rays;
        budget.spend(rays);
        if let Some(response) = response {
            budget.spend(OF_A_RESPONSE);
            report.traced += 1;
            want.job = Pieces::None;
            want.news = Some((job.situation, response));
        } else {
            want.waits = true;
            want.job = Pieces::Now(job);
        }
        Ok(())
    }

    fn way<'a>(&'a self, around: &Surroundings<'a>, id: u64, situation: &'a Situation) -> Way<'a> {
        Way {
            scene: &self.scene,
            rays: around.rays,
            source: Source::at(situation.source),
            receiver: &situation.receiver,
            key: self.key_of(id),
            noise: situation.noise,
            threads: self.threads,
        }
    }
}
