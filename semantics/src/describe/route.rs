//! The way from a place to a thing or a room, by doors, turns and landmarks.

use super::options::{TextLength, TextOptions};
use super::room::in_room;
use super::text::{GroundedText, TextWriter, claim};
use crate::check::{Checker, Listener};
use crate::form::{
    Description, Form, Modifier, Noun, Phrase, Quantifier, RequestStep, TurnDirection,
};
use crate::refer::{refer, room_phrase};
use crate::scene::{SemanticScene, Term, Viewer};
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::{AgentBody, ObjectId, RoomId};
use glam::{Vec2, Vec3};

/// Distance between the places on the way that are looked at, m.
const STEP_M: f32 = 0.1;
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
/// Distance from the box around a goal at which the way ends, m.
const ARRIVAL_M: f32 = 0.5;
/// Distance from the feet at which the way begins, m.
const NEAR_M: f32 = 0.5;
/// Places around a thing and in a room that are tried as its goal.
const AROUND: usize = 16;
const WITHIN: usize = 64;
/// Height at which the room of a place on the ground is looked up, m.
const ABOVE_FLOOR_M: f32 = 0.3;
/// Height of the eyes above the feet of a viewer without a body, m.
const EYES_M: f32 = 1.5;

/// What happens at a distance along a way.
#[derive(Clone, Copy, Debug, PartialEq)]
enum RouteEvent {
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
struct SampledRoute {
    points: Vec<Vec3>,
}

fn flat(point: Vec3) -> Vec2 {
    Vec2::new(point.x, point.z)
}

impl SampledRoute {
    fn of(corners: &[Vec3]) -> Self {
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
        let along = flat(self.points[other]) - flat(self.points[at]);
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

/// The corners of the shortest way from the first place of `starts` from which there is one to the nearest of `goals`. Ends of which
/// `is_start` or `is_end` does not hold do not count: the walkable place nearest to a goal may lie behind a wall.
fn shortest(
    grid: &NavGrid,
    starts: impl Iterator<Item = Vec3>,
    is_start: impl Fn(Vec3) -> bool,
    goals: &[Vec3],
    is_end: impl Fn(Vec3) -> bool,
) -> Option<Vec<Vec3>> {
    let cells = goals.iter().filter_map(|goal| grid.nearest(*goal, NEAR_M));
    let cells: Vec<NavCell> = cells.filter(|cell| is_end(grid.position(*cell))).collect();
    let field = grid.distance_field(&cells);
    let mut begun = starts.filter_map(|start| {
        let cell = grid.nearest(start, NEAR_M)?;
        (is_start(grid.position(cell)) && field.at(cell).is_some()).then_some(cell)
    });
    let way = grid.corners(&grid.follow_gradient(&field, begun.next()?)?);
    Some(way.into_iter().map(|cell| grid.position(cell)).collect())
}

/// Places at which somebody has arrived at a goal.
fn goals(scene: &SemanticScene<'_>, to: Term) -> Vec<Vec3> {
    match to {
        Term::Room(room) => {
            let mut places = scene.house().points_in_room(room, WITHIN);
            for place in &mut places {
                place.y = scene.house().rooms[room].floor_y;
            }
            places
        }
        Term::Object(object) => {
            let bounds = scene.extent(object).bounds;
            let (middle, half) = (bounds.center(), bounds.size() * 0.5);
            let floor_y = scene
                .room_of(object)
                .map(|room| scene.house().rooms[room].floor_y);
            let y = floor_y.unwrap_or(bounds.min.y);
            let around = (0..AROUND).map(|k| {
                let turn = std::f32::consts::TAU * k as f32 / AROUND as f32;
                let (sine, cosine) = dwell_scene::math::sin_cos(turn);
                Vec3::new(
                    middle.x + (half.x + ARRIVAL_M) * cosine,
                    y,
                    middle.z + (half.z + ARRIVAL_M) * sine,
                )
            });
            let own = scene.room_of(object);
            around
                .filter(|place| {
                    own.is_none() || scene.house().room_at(*place + Vec3::Y * ABOVE_FLOOR_M) == own
                })
                .collect()
        }
        _ => Vec::new(),
    }
}

/// Places around the feet, the nearest first: the walkable place nearest to feet beside a wall may lie behind it.
fn starts(feet: Vec3) -> impl Iterator<Item = Vec3> {
    let around = [0.4, 0.8, 1.2].into_iter().flat_map(move |reach: f32| {
        (0..8_u8).map(move |k| {
            let turn = std::f32::consts::FRAC_PI_4 * f32::from(k);
            let (sine, cosine) = dwell_scene::math::sin_cos(turn);
            feet + Vec3::new(cosine, 0.0, sine) * reach
        })
    });
    std::iter::once(feet).chain(around)
}

/// A way that is told.
struct RouteTeller<'a, 'b> {
    scene: &'b SemanticScene<'a>,
    route: SampledRoute,
    goal: Option<ObjectId>,
}

impl RouteTeller<'_, '_> {
    fn room_at(&self, at: usize) -> Option<RoomId> {
        self.scene
            .house()
            .room_at(self.route.points[at] + Vec3::Y * ABOVE_FLOOR_M)
    }

    /// The door between two rooms that is nearest to a place.
    fn door(&self, between: [RoomId; 2], place: Vec3) -> Option<ObjectId> {
        let near = self.scene.semantics.doorways().filter_map(|(door, way)| {
            let joins = between.iter().all(|room| way.rooms.contains(room));
            let bounds = self.scene.extent(door).bounds;
            let distance = flat(bounds.center()).distance(flat(place));
            (joins && distance <= DOOR_M).then_some((distance, door))
        });
        near.min_by(|p, q| p.0.total_cmp(&q.0))
            .map(|(_, door)| door)
    }

    /// The changes of rooms, with their places on the way.
    fn entries(&self) -> Vec<(usize, RouteEvent)> {
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
    fn turns(&self, looks: Vec2) -> Vec<(usize, RouteEvent)> {
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
    fn landmarks(&self, entries: &[(usize, RouteEvent)]) -> Vec<(usize, RouteEvent)> {
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
                if is_small || is_worse || hangs || facts.is_opening() || self.goal == Some(object)
                {
                    continue;
                }
                let distance = |at: usize| {
                    let point = flat(self.route.points[at]);
                    let (low, high) = (flat(bounds.min), flat(bounds.max));
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
    fn door_phrase(&self, checker: &Checker<'_>, door: ObjectId, rooms: [RoomId; 2]) -> Phrase {
        let scene = self.scene;
        let noun = Noun::Object(scene.facts(door).noun.clone());
        let plain = Description::new(Quantifier::The, noun);
        let to = Modifier::new("leads_to", [room_phrase(scene, rooms[1])]);
        let from = Modifier::new("leads_from", [room_phrase(scene, rooms[0])]);
        let both = plain.clone().with_modifier(from).with_modifier(to.clone());
        let tried = [plain.clone(), plain.with_modifier(to), both.clone()];
        let is_certain = |own: &&Description| checker.denotes(own) == Some(Term::Object(door));
        tried
            .iter()
            .find(is_certain)
            .unwrap_or(&both)
            .clone()
            .into()
    }

    fn step(&self, checker: &Checker<'_>, event: RouteEvent) -> Option<RequestStep> {
        let act = |verb: &str, object: Phrase| RequestStep::Do {
            verb: verb.to_owned(),
            object,
        };
        Some(match event {
            RouteEvent::Turn(direction) => RequestStep::Turn(direction),
            RouteEvent::Enter { from, room, door } => match door {
                Some(door) => act("go_through", self.door_phrase(checker, door, [from, room])),
                None => RequestStep::GoTo(room_phrase(self.scene, room)),
            },
            RouteEvent::Past(object) => act("go_past", refer(self.scene, object)?.into()),
        })
    }
}

/// Where somebody stands who looks from `viewer`.
fn feet(scene: &SemanticScene<'_>, listener: &Listener, viewer: &Viewer) -> Vec3 {
    let agent = listener
        .agent
        .and_then(|agent| scene.state.agents.get(agent));
    if let Some(agent) = agent {
        return agent.position;
    }
    let eye = viewer.world_from_camera.position;
    let floor_y = scene
        .house()
        .room_at(eye)
        .map_or(eye.y - EYES_M, |room| scene.house().rooms[room].floor_y);
    Vec3::new(eye.x, floor_y, eye.z)
}

/// The way from where a listener stands and looks to a thing or a room, as requests: turns, doors, what one goes past, and the goal. A
/// body that opens doors walks it; stairs count. The shortest text has doors and turns alone. `None` without a viewer, for other terms,
/// and where no way leads there.
///
/// Turns are changes of direction of 45 degrees and more over 0.8 m of the way, "around" from 140; the first is from where the
/// viewer looks.
pub fn describe_route(
    scene: &SemanticScene<'_>,
    listener: Listener,
    to: Term,
    options: TextOptions,
) -> Option<GroundedText> {
    let viewer = listener.viewer?;
    let agent = listener
        .agent
        .and_then(|agent| scene.state.agents.get(agent));
    let body = agent.map_or_else(AgentBody::default, |agent| agent.body);
    let start = feet(scene, &listener, &viewer);
    let places = goals(scene, to);
    let goal_room = match to {
        Term::Room(room) => Some(room),
        to => to.object().and_then(|object| scene.room_of(object)),
    };
    let room_at = |place: Vec3| scene.house().room_at(place + Vec3::Y * ABOVE_FLOOR_M);
    let is_there = |end: Vec3| goal_room.is_none() || room_at(end) == goal_room;
    let own_room = room_at(start);
    let route = scene
        .semantics
        .with_open_doors(scene.state, &body, |grid| {
            let is_own = |place: Vec3| own_room.is_none() || room_at(place) == own_room;
            shortest(grid, starts(start), is_own, &places, is_there)
        })??;
    let looks = viewer.world_from_camera.transform_vector(Vec3::NEG_Z);
    let teller = RouteTeller {
        scene,
        route: SampledRoute::of(&route),
        goal: to.object(),
    };
    // On the way the listener sees other things than now.
    let checker = Checker::new(scene, Listener::default());
    let mut writer = TextWriter::new(&checker, options.wording);
    if let Term::Room(room) = to
        && teller.room_at(0) == Some(room)
    {
        let here = vec![Phrase::Listener, room_phrase(scene, room)];
        writer.say(claim("in_room", here));
        return Some(writer.finish());
    }
    let entries = teller.entries();
    let mut events = teller.turns(flat(looks).normalize_or_zero());
    if options.length != TextLength::Short {
        events.extend(teller.landmarks(&entries));
    }
    // A way to a room ends at its door.
    if let (Term::Room(_), Some((end, _))) = (to, entries.last()) {
        events.retain(|(at, _)| at < end);
    }
    events.extend(entries);
    events.sort_by_key(|(at, _)| *at);
    let mut turned: Option<RequestStep> = None;
    let mut say = |steps: Vec<RequestStep>| writer.say(Form::Request(steps));
    for (_, event) in events {
        let Some(step) = teller.step(&checker, event) else {
            continue;
        };
        match (turned.take(), &step) {
            (None, RequestStep::Turn(_)) => turned = Some(step),
            (Some(before), RequestStep::Turn(_)) => {
                say(vec![before]);
                turned = Some(step);
            }
            (Some(before), _) => say(vec![before, step]),
            (None, _) => say(vec![step]),
        }
    }
    let last = to.object().map(|object| {
        let noun = Noun::Object(scene.facts(object).noun.clone());
        let any = || match scene.room_of(object) {
            Some(room) => in_room(scene, object, room),
            None => Description::new(Quantifier::Some, noun),
        };
        refer(scene, object).unwrap_or_else(any)
    });
    let last = last.map(|goal| RequestStep::Do {
        verb: "approach".to_owned(),
        object: goal.into(),
    });
    let end: Vec<RequestStep> = turned.into_iter().chain(last).collect();
    if !end.is_empty() {
        say(end);
    }
    Some(writer.finish())
}
