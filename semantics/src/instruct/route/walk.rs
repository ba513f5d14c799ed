//! The path of somebody who follows a route, and the milestones that it has passed.

use super::milestone::{MilestoneThresholds, RouteMilestone, TURN_M};
use crate::line_of_sight::{FieldOfView, is_in_line_of_sight};
use crate::route::{ABOVE_FLOOR_M, to_xz};
use crate::scene::{SemanticScene, Viewer};
use dwell_scene::rays::RayScene;
use dwell_scene::{ObjectId, Pose, RoomId};
use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// Largest distance between the places of a path that are looked at, m: steps that are longer are looked at in between.
const STEP_M: f32 = 0.1;
/// Most places that are looked at on one step: nobody walks further in one.
const MOST_BETWEEN: f32 = 100.0;
/// Distance beyond the border of a zone at which one has left it, m.
const BEYOND_M: f32 = 0.1;
/// Least distances over which the directions before and after a turn are taken, m.
const LEAST_LEG_M: f32 = 0.4;
/// Largest difference of height from the place of a turn, and from a door's middle, m.
const SAME_STOREY_M: f32 = 1.8;

/// A stay in the zone around a turn or a landmark that has not ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct ZoneStay {
    /// When it began.
    begin: u32,
    /// Where, seen from above, m.
    entry: Vec2,
    /// The place of the stay that is nearest to the middle of the zone, seen from above, and its distance from the zone's border, m.
    nearest: (Vec2, f32),
    /// True once the thing was in sight.
    seen: bool,
}

/// What is known of a walk so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RouteProgress {
    /// The number of places that were looked at.
    time: u32,
    /// Feet and eyes at the last one, m.
    last: Option<[Vec3; 2]>,
    /// The last room.
    room: Option<RoomId>,
    /// The stays that have not ended. Shape (milestone,).
    stays: Vec<Option<ZoneStay>>,
    /// When each milestone was passed, from when to when. Shape (milestone, time).
    passed: Vec<Vec<[u32; 2]>>,
}

/// A judge of a walk: knows how many milestones of a route it has passed in their order.
///
/// Each milestone is passed at a place (a door), or over a stretch of the path (a landmark, a turn). A walk has passed the first k
/// milestones if there are places p1, ..., pk on it, none before the one before it, with each milestone passed at its place.
#[derive(Clone, Debug)]
pub struct RouteTracker {
    milestones: Vec<RouteMilestone>,
    limits: MilestoneThresholds,
    progress: RouteProgress,
}

impl RouteTracker {
    /// A walk that has not begun.
    pub fn new(milestones: Vec<RouteMilestone>) -> Self {
        Self::with_limits(milestones, MilestoneThresholds::FOLLOWED)
    }

    pub(super) fn with_limits(
        milestones: Vec<RouteMilestone>,
        limits: MilestoneThresholds,
    ) -> Self {
        let progress = RouteProgress {
            stays: vec![None; milestones.len()],
            passed: vec![Vec::new(); milestones.len()],
            ..RouteProgress::default()
        };
        Self {
            milestones,
            limits,
            progress,
        }
    }

    /// Goes on, straight, to where the feet are at `feet` and the eyes at `eye`, m; the first time begins there. `is_at_end`: whether
    /// the condition of the end holds there. `rays` must be up to date with the scene's state.
    pub fn advance(
        &mut self,
        (scene, rays): (&SemanticScene<'_>, &RayScene),
        [feet, eye]: [Vec3; 2],
        is_at_end: bool,
    ) {
        let [from, eye_from] = self.progress.last.unwrap_or([feet, eye]);
        let pieces = (feet.distance(from) / STEP_M)
            .ceil()
            .clamp(1.0, MOST_BETWEEN);
        let count = if pieces.is_nan() { 1 } else { pieces as u32 };
        for piece in 1..=count {
            let share = piece as f32 / count as f32;
            let place = [from.lerp(feet, share), eye_from.lerp(eye, share)];
            self.look((scene, rays), place, is_at_end && piece == count);
        }
        self.progress.last = Some([feet, eye]);
    }

    fn look(
        &mut self,
        (scene, rays): (&SemanticScene<'_>, &RayScene),
        [feet, eye]: [Vec3; 2],
        is_at_end: bool,
    ) {
        let time = self.progress.time;
        self.progress.time = time.saturating_add(1);
        let room = scene.house().room_at(feet + Vec3::Y * ABOVE_FLOOR_M);
        let before = self.progress.room;
        self.progress.room = room.or(before);
        let change = before.zip(room).filter(|(from, to)| from != to);
        for number in 0..self.milestones.len() {
            let is_here = match (&self.milestones[number], change) {
                (RouteMilestone::Left(room), Some((from, _))) => *room == from,
                (RouteMilestone::Entered(room), Some((_, to))) => *room == to,
                (RouteMilestone::Through { door, to: room }, Some((_, to))) => {
                    let middle = scene.extent(*door).bounds.center();
                    let near = to_xz(middle).distance(to_xz(feet)) <= self.limits.door_m;
                    let level = (middle.y - feet.y - 1.0).abs() <= SAME_STOREY_M;
                    *room == to && near && level
                }
                (RouteMilestone::Reached(_), _) => is_at_end,
                (RouteMilestone::Turned { .. } | RouteMilestone::Passed(_), _) => {
                    self.stay(number, (scene, rays), [feet, eye]);
                    false
                }
                _ => false,
            };
            if is_here {
                self.pass(number, [time, time]);
            }
        }
    }

    /// Looks whether a zone is entered or left at a place.
    fn stay(
        &mut self,
        number: usize,
        (scene, rays): (&SemanticScene<'_>, &RayScene),
        [feet, eye]: [Vec3; 2],
    ) {
        let here = to_xz(feet);
        let time = self.progress.time - 1;
        let outside_m = match &self.milestones[number] {
            RouteMilestone::Turned { place, .. } => {
                let level = (place.y - feet.y).abs() <= SAME_STOREY_M;
                let outside_m = to_xz(*place).distance(here) - TURN_M;
                if level { outside_m } else { f32::INFINITY }
            }
            RouteMilestone::Passed(thing) => {
                let extent = scene.extent(*thing);
                let level = extent.bounds.max.y > feet.y - 0.5 && extent.bounds.min.y < eye.y + 1.0;
                let outside_m = extent.footprint.distance_to(here) - self.limits.past_m;
                if level { outside_m } else { f32::INFINITY }
            }
            _ => return,
        };
        match &mut self.progress.stays[number] {
            None if outside_m <= 0.0 => {
                let stay = ZoneStay {
                    begin: time,
                    entry: here,
                    nearest: (here, outside_m),
                    seen: self.is_seen(number, (scene, rays), eye),
                };
                self.progress.stays[number] = Some(stay);
            }
            Some(stay) if outside_m <= BEYOND_M => {
                if outside_m < stay.nearest.1 {
                    stay.nearest = (here, outside_m);
                }
                if !stay.seen {
                    let seen = self.is_seen(number, (scene, rays), eye);
                    if let Some(stay) = &mut self.progress.stays[number] {
                        stay.seen = seen;
                    }
                }
            }
            Some(stay) => {
                let stay = *stay;
                self.progress.stays[number] = None;
                if self.has_passed(number, &stay, here) {
                    self.pass(number, [stay.begin, time]);
                }
            }
            None => {}
        }
    }

    /// Returns whether the landmark of a zone is in sight; turns need none.
    fn is_seen(
        &self,
        number: usize,
        (scene, rays): (&SemanticScene<'_>, &RayScene),
        eye: Vec3,
    ) -> bool {
        let RouteMilestone::Passed(thing) = self.milestones[number] else {
            return true;
        };
        sees(scene, rays, eye, thing)
    }

    /// Returns whether a stay that ends at `exit` has passed the milestone.
    fn has_passed(&self, number: usize, stay: &ZoneStay, exit: Vec2) -> bool {
        match &self.milestones[number] {
            RouteMilestone::Turned {
                direction,
                place,
                before: Some(before),
            } => self
                .limits
                .is_turn(*direction, *before, exit - to_xz(*place)),
            // From where it was nearest: a straight line beside the place is no turn.
            RouteMilestone::Turned { direction, .. } => {
                let (nearest, _) = stay.nearest;
                let (before, after) = (nearest - stay.entry, exit - nearest);
                before.length().min(after.length()) >= LEAST_LEG_M
                    && self.limits.is_turn(*direction, before, after)
            }
            RouteMilestone::Passed(_) => {
                stay.seen && stay.entry.distance(exit) >= self.limits.past_apart_m
            }
            _ => false,
        }
    }

    fn pass(&mut self, number: usize, [begin, end]: [u32; 2]) {
        let passed = &mut self.progress.passed[number];
        match passed.last_mut() {
            // One who stays at the end is there all the while.
            Some(last) if last[1].saturating_add(1) == begin => last[1] = end,
            _ => passed.push([begin, end]),
        }
    }

    /// How many milestones are passed, in their order.
    pub fn passed_count(&self) -> usize {
        let mut time = 0;
        for (number, passed) in self.progress.passed.iter().enumerate() {
            let late = passed.iter().filter(|[_, end]| *end >= time);
            let Some(first) = late.map(|[begin, _]| *begin).min() else {
                return number;
            };
            time = first.max(time);
        }
        self.milestones.len()
    }

    /// The milestones, in order.
    pub fn milestones(&self) -> &[RouteMilestone] {
        &self.milestones
    }

    /// What is known so far.
    pub fn progress(&self) -> &RouteProgress {
        &self.progress
    }

    /// Goes to a [`Self::progress`] of a walk with the same milestones; `false` for one that is none, which changes nothing.
    #[must_use]
    pub fn restore(&mut self, progress: RouteProgress) -> bool {
        let count = self.milestones.len();
        let times = || progress.passed.iter().flatten();
        let fits = progress.stays.len() == count
            && progress.passed.len() == count
            && times().all(|[begin, end]| begin <= end && *end < progress.time);
        if fits {
            self.progress = progress;
        }
        fits
    }
}

fn sees(scene: &SemanticScene<'_>, rays: &RayScene, eye: Vec3, thing: ObjectId) -> bool {
    let viewer = Viewer {
        world_from_camera: Pose::from_position_yaw(eye, 0.0),
    };
    is_in_line_of_sight(scene, rays, &viewer, thing, FieldOfView::Around)
}
