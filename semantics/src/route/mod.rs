//! What happens on a way through a house: turns, doors, and landmarks that it passes.

use crate::check::Checker;
use crate::form::{Description, Modifier, Noun, Phrase, Quantifier, TurnDirection};
use crate::refer::{refer, room_phrase};
use crate::scene::{SemanticScene, Term};
use dwell_scene::{ObjectId, RoomId};
use glam::{Vec2, Vec3};

/// Distance between the places on the way that are looked at, m.
pub(crate) const STEP_M: f32 = 0.1;
/// Distance over which a direction is taken: shorter swerves around furniture are no turns, m.
const HEADING_M: f32 = 0.8;
/// Change of direction from which it is a turn, and from which it is a turn around, rad: 45 and 140 degrees.
const TURN_RAD: f32 = std::f32::consts::FRAC_PI_4;
const AROUND_RAD: f32 = 2.44;
/// Distance on the way between two turns that are told, m.
const APART_M: f32 = 1.2;
/// Largest distance of a door from where the way changes rooms, m.
const DOOR_M: f32 = 1.0;
/// Largest distance of a landmark from the way, m.
const PAST_M: f32 = 1.0;
/// Smallest volume of a landmark, m3: a chair is one, a vase is none.
const LANDMARK_M3: f32 = 0.1;
/// Height at which the room of a place on the ground is looked up, m.
pub(crate) const ABOVE_FLOOR_M: f32 = 0.3;

/// What happens at a distance along a way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum RouteEvent {
    Turn(TurnDirection),
    /// Into a room, through a door where there is one.
    Enter {
        from: RoomId,
        room: RoomId,
        door: Option<ObjectId>,
    },
    Past(ObjectId),
}

/// A way as places at equal distances.
pub(crate) struct SampledRoute {
    /// The places, [`STEP_M`] apart or less.
    pub(crate) points: Vec<Vec3>,
}

pub(crate) fn to_xz(point: Vec3) -> Vec2 {
    Vec2::new(point.x, point.z)
}

impl SampledRoute {
    /// Of straight pieces between corners.
    pub(crate) fn of(corners: &[Vec3]) -> Self {
        let mut points = Vec::new();
        for piece in corners.windows(2) {
            let length_m = piece[0].distance(piece[1]);
            let number = (length_m / STEP_M).ceil().max(1.0) as usize;
            points.extend((0..number).map(|k| piece[0].lerp(piece[1], k as f32 / number as f32)));
        }
        points.extend(corners.last());
        Self { points }
    }

    /// The direction of the way over [`HEADING_M`] before or after a place; `None` at its ends.
    fn heading(&self, at: usize, ahead: bool) -> Option<Vec2> {
        let reach = (HEADING_M / STEP_M) as usize;
        let other = if ahead {
            (at + reach).min(self.points.len() - 1)
        } else {
            at.saturating_sub(reach)
        };
        let along = to_xz(self.points[other]) - to_xz(self.points[at]);
        let along = if ahead { along } else { -along };
        (along.length() > 0.5 * HEADING_M).then(|| along.normalize())
    }
}

/// The turn from one direction to another, seen from above; `None` where it is straight on.
fn turn(from: Vec2, to: Vec2) -> Option<TurnDirection> {
    // X to the right, Z towards the viewer: a positive angle is to the right.
    let angle = dwell_scene::math::atan2(from.perp_dot(to), from.dot(to));
    match angle.abs() {
        size if size < TURN_RAD => None,
        size if size > AROUND_RAD => Some(TurnDirection::Around),
        _ if angle > 0.0 => Some(TurnDirection::Right),
        _ => Some(TurnDirection::Left),
    }
}

/// What happens on a way through a scene.
pub(crate) struct RouteFinder<'a, 'b> {
    pub(crate) scene: &'b SemanticScene<'a>,
    pub(crate) route: SampledRoute,
    /// The thing where it ends, which is no landmark.
    pub(crate) goal: Option<ObjectId>,
}

impl RouteFinder<'_, '_> {
    /// The room of a place on the way.
    pub(crate) fn room_at(&self, at: usize) -> Option<RoomId> {
        self.scene
            .house()
            .room_at(self.route.points[at] + Vec3::Y * ABOVE_FLOOR_M)
    }

    /// The door between two rooms that is nearest to a place.
    fn door(&self, between: [RoomId; 2], place: Vec3) -> Option<ObjectId> {
        let near = self.scene.semantics.doorways().filter_map(|(door, way)| {
            let joins = between.iter().all(|room| way.rooms.contains(room));
            let bounds = self.scene.extent(door).bounds;
            let distance = to_xz(bounds.center()).distance(to_xz(place));
            (joins && distance <= DOOR_M).then_some((distance, door))
        });
        near.min_by(|p, q| p.0.total_cmp(&q.0))
            .map(|(_, door)| door)
    }

    /// The changes of rooms, with their places on the way.
    pub(crate) fn entries(&self) -> Vec<(usize, RouteEvent)> {
        let mut found: Vec<(usize, RouteEvent)> = Vec::new();
        let mut before = self.room_at(0);
        for at in 1..self.route.points.len() {
            let Some(room) = self.room_at(at) else {
                continue;
            };
            if let Some(from) = before.filter(|from| *from != room) {
                let door = self.door([from, room], self.route.points[at]);
                found.push((at, RouteEvent::Enter { from, room, door }));
            }
            before = Some(room);
        }
        found
    }

    /// The turns: at the start from where the viewer looks, then where the way turns most, those that lie apart.
    pub(crate) fn turns(&self, looks: Vec2) -> Vec<(usize, RouteEvent)> {
        let mut found = Vec::new();
        let start = self.route.heading(0, true);
        if let Some(direction) = start.and_then(|ahead| turn(looks, ahead)) {
            found.push((0, RouteEvent::Turn(direction)));
        }
        let apart = (APART_M / STEP_M) as usize;
        let mut corners: Vec<(f32, usize, TurnDirection)> = Vec::new();
        for at in 1..self.route.points.len() {
            let headings = (self.route.heading(at, false), self.route.heading(at, true));
            let (Some(before), Some(after)) = headings else {
                continue;
            };
            if let Some(direction) = turn(before, after) {
                corners.push((before.dot(after), at, direction));
            }
        }
        // The sharpest first.
        corners.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
        let mut told: Vec<usize> = vec![0];
        for (_, at, direction) in corners {
            if told.iter().all(|other| at.abs_diff(*other) >= apart) {
                told.push(at);
                found.push((at, RouteEvent::Turn(direction)));
            }
        }
        found
    }

    /// The largest thing that the way passes in each room, away from its ends.
    pub(crate) fn landmarks(&self, entries: &[(usize, RouteEvent)]) -> Vec<(usize, RouteEvent)> {
        let last = self.route.points.len() - 1;
        let mut edges: Vec<usize> = vec![0];
        edges.extend(entries.iter().map(|(at, _)| *at));
        edges.push(last);
        let margin = (APART_M / STEP_M) as usize;
        let mut found = Vec::new();
        for leg in edges.windows(2) {
            let Some(room) = self.room_at(leg[0]) else {
                continue;
            };
            let mut best: Option<(f32, usize, ObjectId)> = None;
            for object in self.scene.objects_in(room).iter().copied() {
                let bounds = self.scene.extent(object).bounds;
                let volume = bounds.volume();
                let facts = self.scene.facts(object);
                let is_small = volume < LANDMARK_M3 || bounds.size().y < 0.4;
                let is_worse = best.is_some_and(|(most, ..)| most >= volume);
                let hangs = bounds.min.y > self.scene.house().rooms[room].floor_y + 0.5;
                if is_small
                    || is_worse
                    || hangs
                    || facts.belongs_to_opening()
                    || self.goal == Some(object)
                {
                    continue;
                }
                let distance = |at: usize| {
                    let point = to_xz(self.route.points[at]);
                    let (low, high) = (to_xz(bounds.min), to_xz(bounds.max));
                    point.distance(point.clamp(low, high))
                };
                let nearest = (leg[0]..=leg[1])
                    .map(|at| (distance(at), at))
                    .min_by(|p, q| p.0.total_cmp(&q.0));
                let Some((gap, at)) = nearest else {
                    continue;
                };
                let inside = at >= leg[0] + margin && at + margin <= leg[1];
                if gap <= PAST_M && inside && refer(self.scene, object).is_some() {
                    best = Some((volume, at, object));
                }
            }
            found.extend(best.map(|(_, at, object)| (at, RouteEvent::Past(object))));
        }
        found
    }

    /// "The door", or where there are several "the door that leads to the hall".
    pub(crate) fn door_phrase(
        &self,
        checker: &Checker<'_>,
        door: ObjectId,
        rooms: [RoomId; 2],
    ) -> Phrase {
        let scene = self.scene;
        let noun = Noun::Object(scene.facts(door).noun.clone());
        let plain = Description::new(Quantifier::The, noun);
        let to = Modifier::new("leads_to", [room_phrase(scene, rooms[1])]);
        let from = Modifier::new("leads_from", [room_phrase(scene, rooms[0])]);
        let both = plain.clone().with_modifier(from).with_modifier(to.clone());
        let tried = [plain.clone(), plain.with_modifier(to), both.clone()];
        let is_certain =
            |own: &&Description| checker.certain_referent(own) == Some(Term::Object(door));
        tried
            .iter()
            .find(is_certain)
            .unwrap_or(&both)
            .clone()
            .into()
    }
}
