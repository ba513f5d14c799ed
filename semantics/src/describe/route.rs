//! The way from a place to a thing or a room, by doors, turns and landmarks.

use super::options::{TextLength, TextOptions};
use super::room::object_in_room;
use super::text::{GroundedText, TextWriter, claim};
use crate::check::{Addressee, Checker};
use crate::form::{Description, Form, Noun, Phrase, Quantifier, RequestStep};
use crate::refer::{refer, room_phrase};
use crate::route::{ABOVE_FLOOR_M, RouteEvent, RouteFinder, SampledRoute, to_xz};
use crate::scene::{SemanticScene, Term, Viewer};
use dwell_scene::AgentBody;
use dwell_scene::navigation::{NavCell, NavGrid};
use glam::Vec3;

/// Distance from the box around a goal at which the way ends, m.
const ARRIVAL_M: f32 = 0.5;
/// Distance from the feet at which the way begins, m.
const NEAR_M: f32 = 0.5;
/// Places around a thing and in a room that are tried as its goal.
const AROUND: usize = 16;
const WITHIN: usize = 64;
/// Height of the eyes above the feet of a viewer without a body, m.
const EYES_M: f32 = 1.5;

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

/// The request to go on at an event.
fn request(
    finder: &RouteFinder<'_, '_>,
    checker: &Checker<'_>,
    event: RouteEvent,
) -> Option<RequestStep> {
    let act = |verb: &str, object: Phrase| RequestStep::Do {
        verb: verb.to_owned(),
        object,
    };
    Some(match event {
        RouteEvent::Turn(direction) => RequestStep::Turn(direction),
        RouteEvent::Enter { from, room, door } => match door {
            Some(door) => act(
                "go_through",
                finder.door_phrase(checker, door, [from, room]),
            ),
            None => RequestStep::GoTo(room_phrase(finder.scene, room)),
        },
        RouteEvent::Past(object) => act("go_past", refer(finder.scene, object)?.into()),
    })
}

/// Where somebody stands who looks from `viewer`.
fn feet(scene: &SemanticScene<'_>, listener: &Addressee, viewer: &Viewer) -> Vec3 {
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
    listener: Addressee,
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
    let finder = RouteFinder {
        scene,
        route: SampledRoute::of(&route),
        goal: to.object(),
    };
    // On the way the listener sees other things than now.
    let checker = Checker::new(scene, Addressee::default());
    let mut writer = TextWriter::new(&checker, options.wording);
    if let Term::Room(room) = to
        && finder.room_at(0) == Some(room)
    {
        let here = vec![Phrase::Listener, room_phrase(scene, room)];
        writer.say(claim("in_room", here));
        return Some(writer.finish());
    }
    let entries = finder.entries();
    let mut events = finder.turns(to_xz(looks).normalize_or_zero());
    if options.length != TextLength::Short {
        events.extend(finder.landmarks(&entries));
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
        let Some(step) = request(&finder, &checker, event) else {
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
            Some(room) => object_in_room(scene, object, room),
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
