//! Routes that are told of a way.

use super::milestone::{MilestoneThresholds, RouteMilestone};
use super::walk::RouteTracker;
use crate::check::{Addressee, Checker};
use crate::form::{
    Description, Form, Modifier, Noun, Phrase, Quantifier, RequestStep, TurnDirection,
};
use crate::instruct::{StepCondition, say};
use crate::refer::{refer, refer_to_room};
use crate::route::{RouteEvent, RouteFinder, SampledRoute, to_xz};
use crate::scene::{SemanticScene, Term};
use dwell_scene::random::RandomStream;
use dwell_scene::rays::RayScene;
use dwell_scene::space::forward_from_yaw;
use dwell_scene::{ObjectId, RoomId};
use glam::Vec3;

/// The fewest steps of a route, its end included.
const LEAST_STEPS: usize = 3;

/// Distance from the start within which no turn but that at the start is told, m: one has no direction before it.
const BY_START_M: f32 = 1.6;

/// Distance from the way at which one still follows it, m, and the places of the way (of 0.1 m) between two of which one cuts corners.
const BESIDE_M: f32 = 0.2;
const CUT: usize = 8;

/// A way that a route is told of.
#[derive(Clone, Copy, Debug)]
pub struct DescribedPath<'a> {
    /// Its corners on the ground, m; straight lines between them can be walked.
    pub corners: &'a [Vec3],
    /// Where one looks at its start, rad.
    pub yaw_rad: f32,
    /// Height of the eyes above the feet, m.
    pub eye_m: f32,
    /// What is so at its end: the agent stands in a room ([`StepCondition::AgentIn`]) or has found a thing ([`StepCondition::Found`]).
    pub end: StepCondition,
}

/// A step of a route.
#[derive(Clone, Debug, PartialEq)]
pub struct RouteStep {
    /// The request.
    pub request: RequestStep,
    /// What one has passed when it is done.
    pub milestone: RouteMilestone,
    /// Where on the way it is done, m.
    pub place: Vec3,
    /// The length of the way up to there, m.
    pub way_m: f64,
}

/// A route in words: steps along a way, each of which can be checked.
#[derive(Clone, Debug, PartialEq)]
pub struct RouteInstruction {
    /// The steps in order; the last is the end.
    pub steps: Vec<RouteStep>,
    /// The way, as places at most 0.1 m apart, m.
    pub way: Vec<Vec3>,
}

/// A step before it is known where on the way it is done.
#[derive(Clone)]
struct Candidate {
    request: RequestStep,
    milestone: RouteMilestone,
}

impl Candidate {
    /// Returns whether the route can be told without it: rooms are told.
    fn is_optional(&self) -> bool {
        self.is_turn() || self.is_past()
    }

    fn is_turn(&self) -> bool {
        matches!(self.milestone, RouteMilestone::Turned { .. })
    }

    fn is_past(&self) -> bool {
        matches!(self.milestone, RouteMilestone::Passed(_))
    }
}

impl RouteInstruction {
    /// Tells a way: which room one leaves or enters, and by which door, where one turns, what one goes past, and where one stops.
    /// `stream` draws how a change of rooms is told, where there are several ways to.
    ///
    /// `None` where that can't be said so that each phrase means exactly one thing or room, in a text of an instruction's length; where
    /// fewer than three steps are to be told; and for ways that enter a room twice. Turns and landmarks that are not clear are left
    /// out: those who walk beside the way shall have passed them, too.
    ///
    /// `rays` must be up to date with the scene's state.
    pub fn generate(
        (scene, rays): (&SemanticScene<'_>, &RayScene),
        way: DescribedPath<'_>,
        stream: &mut RandomStream,
    ) -> Option<Self> {
        let finder = RouteFinder {
            scene,
            route: SampledRoute::of(way.corners),
            goal: way.end.object(),
        };
        let teller = RouteTeller {
            checker: Checker::new(scene, Addressee::default()),
            finder,
            rays,
            way,
        };
        let mut steps = teller.candidates(stream)?;
        steps.retain(|own| !own.is_optional() || teller.is_clear(own));
        teller.keep_passed(&mut steps)?;
        teller.keep_to_length(&mut steps)?;
        let places = teller.places(&steps, MilestoneThresholds::FOLLOWED)?;
        let way = teller.finder.route.points;
        let mut lengths_m = vec![0.0];
        for piece in way.windows(2) {
            let before = lengths_m[lengths_m.len() - 1];
            lengths_m.push(before + f64::from(piece[0].distance(piece[1])));
        }
        let placed = steps.into_iter().zip(places).map(|(own, at)| RouteStep {
            request: own.request,
            milestone: own.milestone,
            place: way[at],
            way_m: lengths_m[at],
        });
        Some(Self {
            steps: placed.collect(),
            way,
        })
    }

    /// The requests of its steps.
    pub fn requests(&self) -> Vec<RequestStep> {
        self.steps.iter().map(|own| own.request.clone()).collect()
    }

    /// The judge of somebody who begins to follow it.
    pub fn walk(&self) -> RouteTracker {
        let milestones = self.steps.iter().map(|own| own.milestone.clone());
        RouteTracker::new(milestones.collect())
    }

    /// The length of its way, m.
    pub fn length_m(&self) -> f64 {
        self.steps.last().map_or(0.0, |end| end.way_m)
    }
}

struct RouteTeller<'a, 'b> {
    checker: Checker<'b>,
    finder: RouteFinder<'a, 'b>,
    rays: &'b RayScene,
    way: DescribedPath<'b>,
}

impl RouteTeller<'_, '_> {
    /// All that can be told of the way, in order.
    fn candidates(&self, stream: &mut RandomStream) -> Option<Vec<Candidate>> {
        let finder = &self.finder;
        let entries = finder.entries();
        let mut rooms = vec![finder.room_at(0)?];
        for (_, event) in &entries {
            if let RouteEvent::Enter { room, .. } = event {
                if rooms.contains(room) {
                    return None;
                }
                rooms.push(*room);
            }
        }
        let looks = to_xz(forward_from_yaw(self.way.yaw_rad));
        let mut events = finder.turns(looks);
        events.extend(finder.landmarks(&entries));
        // A way to a room ends at its border.
        if let Some(room) = self.way.end.room() {
            let (end, _) = entries.last()?;
            events.retain(|(at, _)| at < end);
            (rooms.last() == Some(&room)).then_some(())?;
        }
        events.extend(entries);
        events.sort_by_key(|(at, _)| *at);
        let mut found = Vec::new();
        for (at, event) in events {
            let candidate = match event {
                // One turns around at the start alone: no way goes on backwards.
                RouteEvent::Turn(TurnDirection::Around) if at > 0 => continue,
                // What lies so near to the start is no turn on the way yet.
                RouteEvent::Turn(_) if at > 0 && self.is_by_start(at) => continue,
                RouteEvent::Turn(direction) => Candidate {
                    request: RequestStep::Turn(direction),
                    milestone: RouteMilestone::Turned {
                        direction,
                        place: finder.route.points[at],
                        before: (at == 0).then_some(looks),
                    },
                },
                RouteEvent::Past(thing) => Candidate {
                    request: act("go_past", refer(finder.scene, thing)?),
                    milestone: RouteMilestone::Passed(thing),
                },
                RouteEvent::Enter { room, .. } if self.way.end == StepCondition::AgentIn(room) => {
                    continue;
                }
                RouteEvent::Enter { from, room, door } => {
                    let is_first = from == rooms[0];
                    let ways = self.entries_in_words((from, room), door, is_first);
                    stream.choose(&ways)?.clone()
                }
            };
            found.push(candidate);
        }
        found.push(self.end()?);
        Some(found)
    }

    fn is_by_start(&self, at: usize) -> bool {
        let points = &self.finder.route.points;
        to_xz(points[at]).distance(to_xz(points[0])) < BY_START_M
    }

    /// The ways to say that one goes from a room to another.
    fn entries_in_words(
        &self,
        (from, room): (RoomId, RoomId),
        door: Option<ObjectId>,
        is_first: bool,
    ) -> Vec<Candidate> {
        let scene = self.finder.scene;
        let words = refer_to_room(scene, room);
        let leaves = (is_first && self.has_one_way_out(from)).then(|| refer_to_room(scene, from));
        let leave = leaves.flatten().map(|own| Candidate {
            request: RequestStep::Leave(own.into()),
            milestone: RouteMilestone::Left(from),
        });
        let through = door.and_then(|door| {
            Some(Candidate {
                request: act("go_through", self.door_words(door, words.as_ref())?),
                milestone: RouteMilestone::Through { door, to: room },
            })
        });
        let enter = words.clone().map(|own| Candidate {
            request: RequestStep::GoTo(own.into()),
            milestone: RouteMilestone::Entered(room),
        });
        [leave, through, enter].into_iter().flatten().collect()
    }

    /// "The door", or where there are several "the door that leads to the hall"; `None` where that may mean another.
    fn door_words(&self, door: ObjectId, to: Option<&Description>) -> Option<Description> {
        let noun = Noun::Object(self.finder.scene.facts(door).noun.clone());
        let plain = Description::new(Quantifier::The, noun);
        let leading = to.map(|to| {
            let to = Modifier::new("leads_to", [Phrase::from(to.clone())]);
            plain.clone().with_modifier(to)
        });
        let tried = [Some(plain.clone()), leading];
        let means_it =
            |own: &Description| self.checker.certain_referent(own) == Some(Term::Object(door));
        tried.into_iter().flatten().find(means_it)
    }

    fn has_one_way_out(&self, room: RoomId) -> bool {
        let semantics = self.finder.scene.semantics;
        let doors = semantics.doorways();
        let doors = doors.filter(|(_, way)| way.rooms.contains(&room) && way.rooms.len() > 1);
        doors.count() + semantics.room(room).passages.len() == 1
    }

    fn end(&self) -> Option<Candidate> {
        let scene = self.finder.scene;
        let request = match self.way.end {
            StepCondition::AgentIn(room) => RequestStep::GoTo(refer_to_room(scene, room)?.into()),
            end => act("stop_at", refer(scene, end.object()?)?),
        };
        Some(Candidate {
            request,
            milestone: RouteMilestone::Reached(self.way.end),
        })
    }

    /// Where on the way each of some steps is done; `None` where not all are, in their order.
    fn places(&self, steps: &[Candidate], limits: MilestoneThresholds) -> Option<Vec<usize>> {
        let places = self.places_of_done(steps, limits);
        (places.len() == steps.len()).then_some(places)
    }

    /// Where on the way each of those steps is done that are done in order.
    fn places_of_done(&self, steps: &[Candidate], limits: MilestoneThresholds) -> Vec<usize> {
        self.places_along(&self.finder.route.points, steps, limits)
    }

    /// As [`Self::places_of_done`] on a way of other places.
    fn places_along(
        &self,
        points: &[Vec3],
        steps: &[Candidate],
        limits: MilestoneThresholds,
    ) -> Vec<usize> {
        let milestones = steps.iter().map(|own| own.milestone.clone());
        let mut walk = RouteTracker::with_limits(milestones.collect(), limits);
        let mut places = Vec::new();
        for (at, point) in points.iter().enumerate() {
            let is_last = at + 1 == points.len();
            let eye = *point + Vec3::Y * self.way.eye_m;
            walk.advance((self.finder.scene, self.rays), [*point, eye], is_last);
            places.resize(walk.passed_count(), at);
        }
        places
    }

    /// Returns whether the way passes a milestone clearly, and so do ways beside it and one that cuts its corners.
    fn is_clear(&self, step: &Candidate) -> bool {
        let step = std::slice::from_ref(step);
        let points = &self.finder.route.points;
        let follows = |points: &[Vec3]| {
            let done = self.places_along(points, step, MilestoneThresholds::FOLLOWED);
            done.len() == step.len()
        };
        let beside = [Vec3::X, Vec3::NEG_X, Vec3::Z, Vec3::NEG_Z];
        let ends = points.last().copied();
        let cut: Vec<Vec3> = points.iter().copied().step_by(CUT).chain(ends).collect();
        self.places(step, MilestoneThresholds::TOLD).is_some()
            && follows(&cut)
            && beside.iter().all(|side| {
                let moved = points.iter().map(|own| *own + *side * BESIDE_M);
                follows(&moved.collect::<Vec<Vec3>>())
            })
    }

    /// Leaves steps out that the way does not pass clearly after those before them; `None` where it does not so pass those that are left.
    fn keep_passed(&self, steps: &mut Vec<Candidate>) -> Option<()> {
        for limits in [MilestoneThresholds::TOLD, MilestoneThresholds::FOLLOWED] {
            loop {
                let done = self.places_of_done(steps, limits).len();
                if done == steps.len() {
                    break;
                }
                let optional = (0..=done).rev().find(|k| steps[*k].is_optional())?;
                steps.remove(optional);
            }
        }
        Some(())
    }

    /// Leaves steps out until the text is short enough: landmarks first, then turns, the last first.
    fn keep_to_length(&self, steps: &mut Vec<Candidate>) -> Option<()> {
        let language = self.finder.scene.semantics.language();
        loop {
            if steps.len() < LEAST_STEPS {
                return None;
            }
            let requests = steps.iter().map(|own| own.request.clone()).collect();
            if say(language, &Form::Request(requests), None).is_some() {
                return Some(());
            }
            let past = steps.iter().rposition(Candidate::is_past);
            let left_out = past.or_else(|| steps.iter().rposition(Candidate::is_turn))?;
            steps.remove(left_out);
        }
    }
}

/// The places where a way with some corners changes rooms, the first of each new room, m.
pub fn room_changes(scene: &SemanticScene<'_>, corners: &[Vec3]) -> Vec<Vec3> {
    let finder = RouteFinder {
        scene,
        route: SampledRoute::of(corners),
        goal: None,
    };
    let entries = finder.entries().into_iter();
    entries.map(|(at, _)| finder.route.points[at]).collect()
}

fn act(verb: &str, object: Description) -> RequestStep {
    RequestStep::Do {
        verb: verb.to_owned(),
        object: object.into(),
    }
}
