//! Routes as instructions: what is told of a way is read back as the same form, is true of that way, and of no way that differs where
//! it counts.
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use crate::common;

use common::Builder;
use dwell_houses::open;
use dwell_scene::navigation::{DoorPolicy, NavConfig, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{Id, ObjectId, RoomId, State};
use dwell_semantics::form::{Form, TurnDirection};
use dwell_semantics::instruct::{
    DescribedPath, InstructionSplit, MAX_TEXT_LEN, RouteInstruction, RouteMilestone, RouteTracker,
    StepCondition, is_search_target,
};
use dwell_semantics::{SemanticScene, Semantics, vocabulary};
use glam::{Vec2, Vec3};
use std::sync::Arc;

const EYE_M: f32 = 1.25;
/// Far above every house: whoever is there passes nothing.
const AWAY: Vec3 = Vec3::new(0.0, 60.0, 0.0);

fn flat(place: Vec3) -> Vec2 {
    Vec2::new(place.x, place.z)
}

/// How many milestones somebody passes who goes by these places; at the last one the condition of the end holds, if `arrives`.
fn passed(
    (scene, rays): (&SemanticScene<'_>, &RayScene),
    milestones: &[RouteMilestone],
    places: &[Vec3],
    arrives: bool,
) -> usize {
    let mut walk = RouteTracker::new(milestones.to_vec());
    for (k, place) in places.iter().enumerate() {
        let is_at_end = arrives && k + 1 == places.len();
        walk.advance((scene, rays), [*place, *place + Vec3::Y * EYE_M], is_at_end);
    }
    walk.passed_count()
}

/// The places with those taken away for which `is_away` holds: one rises before the first of them, and comes down behind the last.
fn lifted(places: &[Vec3], is_away: impl Fn(&Vec3) -> bool) -> Vec<Vec3> {
    let mut found: Vec<Vec3> = Vec::new();
    let mut before: Option<(Vec3, bool)> = None;
    for place in places {
        let away = is_away(place);
        match before {
            Some((last, false)) if away => found.push(last + AWAY),
            Some((_, true)) if !away => found.push(*place + AWAY),
            _ => {}
        }
        found.push(*place + if away { AWAY } else { Vec3::ZERO });
        before = Some((*place, away));
    }
    found
}

/// The point on the other side of a line through `on` along `along`, seen from above.
fn mirrored(point: Vec3, on: Vec3, along: Vec2) -> Vec3 {
    let along = along.normalize();
    let from = flat(point - on);
    let other = 2.0 * along * from.dot(along) - from;
    Vec3::new(on.x + other.x, point.y, on.z + other.y)
}

/// The angle by which `after` points to the right of `before`, seen from above with X to the right and Z downwards, degrees.
fn right_degrees(before: Vec2, after: Vec2) -> f32 {
    // Clockwise bearings from -Z.
    let bearing = |along: Vec2| along.x.atan2(-along.y).to_degrees();
    (bearing(after) - bearing(before) + 540.0).rem_euclid(360.0) - 180.0
}

fn milestones(route: &RouteInstruction) -> Vec<RouteMilestone> {
    let steps = route.steps.iter();
    steps.map(|own| own.milestone.clone()).collect()
}

#[derive(Default)]
struct Tally {
    told: usize,
    untold: usize,
    turns: usize,
    mirrored: usize,
    skipped: usize,
    swapped: usize,
    splits: usize,
}

/// Looks at a route from all sides.
fn check(
    seen: (&SemanticScene<'_>, &RayScene),
    route: &RouteInstruction,
    looks: Vec2,
    tally: &mut Tally,
) {
    let (scene, _) = seen;
    let language = scene.semantics.language();
    let form = Form::Request(route.requests());
    // What is said in any wording is read as it was meant.
    for (k, split) in [
        InstructionSplit::All,
        InstructionSplit::Train,
        InstructionSplit::Wordings,
    ]
    .into_iter()
    .enumerate()
    {
        let key = RandomKey::root(tally.told as u64).child(k as u64);
        let Some(said) = split.compose(language, route.requests(), key) else {
            continue;
        };
        tally.splits += 1;
        let read = language.read(&said.text).unwrap();
        assert_eq!(read.forms[0], form, "{}", said.text);
        assert!(said.text.len() <= MAX_TEXT_LEN && vocabulary::tokenize(&said.text).is_ok());
    }
    let all = milestones(route);
    let (way, count) = (&route.way, all.len());
    assert!(count >= 3);
    assert_eq!(passed(seen, &all, way, true), count, "{form:?}");
    // Steps that are told in order are done in order.
    assert!(
        route
            .steps
            .windows(2)
            .all(|pair| pair[0].way_m <= pair[1].way_m)
    );
    // To stop elsewhere, at once, and before the last step but the end is done.
    assert!(passed(seen, &all, way, false) < count);
    assert_eq!(passed(seen, &all, &way[..1], true), 0);
    let last_place = route.steps[count - 2].place;
    let early = way.iter().position(|own| *own == last_place).unwrap();
    assert!(passed(seen, &all, &way[..early], true) < count);
    // To go the other way round.
    let backwards: Vec<Vec3> = way.iter().rev().copied().collect();
    assert!(passed(seen, &all, &backwards, true) < count, "{form:?}");
    // Whoever comes to the end by other ways alone has not followed.
    assert!(passed(seen, &all, &way[way.len() - 1..], true) < count);
    for (number, milestone) in all.iter().enumerate() {
        let away = match milestone {
            RouteMilestone::Turned {
                direction,
                place,
                before,
            } => {
                tally.turns += 1;
                let beyond = |own: &Vec3| flat(*own).distance(flat(*place)) > 1.2;
                let at = way.iter().position(|own| own == place).unwrap();
                let comes = way[..at].iter().rposition(beyond);
                let goes = at + way[at..].iter().position(beyond).unwrap();
                let before = match (before, comes) {
                    (Some(before), _) => {
                        assert!(at == 0 && before.distance(looks) < 1e-5);
                        *before
                    }
                    (None, comes) => flat(*place - way[comes.map_or(0, |k| k + 1)]),
                };
                let degrees = right_degrees(before, flat(way[goes] - *place));
                match direction {
                    TurnDirection::Right => assert!((45.0..=135.0).contains(&degrees), "{degrees}"),
                    TurnDirection::Left => {
                        assert!((-135.0..=-45.0).contains(&degrees), "{degrees}");
                    }
                    TurnDirection::Around => assert!(degrees.abs() >= 135.0, "{degrees}"),
                }
                // To the other side: as far as the circle around the turn.
                if *direction != TurnDirection::Around {
                    let mut other: Vec<Vec3> = way[..at].to_vec();
                    let onward = way[at..=goes + 2].iter();
                    other.extend(onward.map(|own| mirrored(*own, *place, before)));
                    let crosses_again = way[..at].iter().filter(|own| !beyond(own)).count() > 20;
                    let one = std::slice::from_ref(milestone);
                    if !crosses_again {
                        tally.mirrored += 1;
                        assert_eq!(passed(seen, one, &other, false), 0, "{form:?}");
                    }
                }
                let place = *place;
                lifted(way, move |own| flat(*own).distance(flat(place)) < 1.5)
            }
            RouteMilestone::Passed(thing) => {
                let bounds = scene.extent(*thing).bounds;
                let gap = |own: &Vec3| {
                    flat(*own).distance(flat(*own).clamp(flat(bounds.min), flat(bounds.max)))
                };
                assert!(way.iter().any(|own| gap(own) <= 1.0));
                lifted(way, move |own| gap(own) < 1.8)
            }
            RouteMilestone::Through { door, .. } => {
                let middle = flat(scene.extent(*door).bounds.center());
                lifted(way, move |own| flat(*own).distance(middle) < 2.0)
            }
            RouteMilestone::Left(room) | RouteMilestone::Entered(room) => {
                let house = scene.house();
                lifted(way, move |own| {
                    house.room_at(*own + Vec3::Y * 0.3) == Some(*room)
                })
            }
            RouteMilestone::Reached(_) => continue,
        };
        // Where nothing is left of what is passed there, the route is not followed.
        tally.skipped += 1;
        assert!(
            passed(seen, &all, &away, true) <= number,
            "{number} of {form:?}"
        );
    }
    // Two steps in the other order, where the second begins after the first is done.
    for number in 0..count - 2 {
        let done = way
            .iter()
            .position(|own| *own == route.steps[number].place)
            .unwrap();
        let begins_before = match &all[number + 1] {
            RouteMilestone::Turned { place, .. } => {
                let near = |own: &Vec3| flat(*own).distance(flat(*place)) < 1.4;
                way[..=done].iter().any(near)
            }
            RouteMilestone::Passed(thing) => {
                let bounds = scene.extent(*thing).bounds;
                let gap = |own: &Vec3| {
                    flat(*own).distance(flat(*own).clamp(flat(bounds.min), flat(bounds.max)))
                };
                way[..=done].iter().any(|own| gap(own) < 1.7)
            }
            // Rooms change at one place.
            _ => route.steps[number + 1].place == route.steps[number].place,
        };
        if !begins_before {
            let mut other = all.clone();
            other.swap(number, number + 1);
            tally.swapped += 1;
            assert!(
                passed(seen, &other, way, true) < count,
                "{number} of {form:?}"
            );
        }
    }
}

/// Ways between the middles of rooms and things of houses are told, and every route is looked at from all sides.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn routes_are_true_of_their_ways_and_of_no_others() {
    let houses = [
        "builtin:apartment",
        "seed:3?home=house",
        "seed:12",
        "seed:21",
        "seed:40",
        "seed:41",
    ];
    let all = std::env::var_os("DWELL_TEST_ALL").is_some();
    let mut tally = Tally::default();
    for name in &houses[..if all { 6 } else { 2 }] {
        let house = Arc::new(open(name).unwrap().0);
        let semantics = Semantics::new(&house);
        let state = State::new(&house);
        let scene = semantics.scene(&state);
        let rays = scene.rays();
        let config = NavConfig {
            doors: DoorPolicy::Open,
            ..NavConfig::default()
        };
        let grid = NavGrid::build(&house, &state, &config).unwrap();
        let on_floor = |room: RoomId| -> Vec<Vec3> {
            let floor_y = house.rooms[room].floor_y;
            let places = house.points_in_room(room, 6).into_iter();
            places.map(|place| place.with_y(floor_y)).collect()
        };
        let mut key = RandomKey::root(5);
        for from in house.rooms.ids() {
            let sought =
                |object: &ObjectId| scene.facts(*object).category.is_some_and(is_search_target);
            let things: Vec<ObjectId> = house.objects.ids().filter(sought).collect();
            let ends = house.rooms.ids().map(StepCondition::AgentIn);
            let things = things
                .into_iter()
                .skip(from.index())
                .step_by(29)
                .map(StepCondition::Found);
            for end in ends.chain(things) {
                key = key.child("next");
                let goals: Vec<Vec3> = match (end.room(), end.object()) {
                    (Some(room), _) => on_floor(room),
                    (_, Some(thing)) => vec![scene.extent(thing).bounds.center()],
                    _ => unreachable!(),
                };
                let mut starts = on_floor(from).into_iter();
                let start = starts.find_map(|place| grid.nearest(place, 0.5));
                let near = |goal: Vec3| grid.nearest(goal.with_y(goal.y.min(0.3)), 1.2);
                let goal = goals.into_iter().find_map(near);
                let path = start
                    .zip(goal)
                    .and_then(|(start, goal)| grid.path(start, goal));
                let Some(path) = path else {
                    continue;
                };
                let corners: Vec<Vec3> = grid
                    .corners(&path)
                    .into_iter()
                    .map(|cell| grid.position(cell))
                    .collect();
                let yaw_rad = key.child("yaw").stream().range(-3.0, 3.0);
                let looks = Vec2::new(-yaw_rad.sin(), -yaw_rad.cos());
                let way = DescribedPath {
                    corners: &corners,
                    yaw_rad,
                    eye_m: EYE_M,
                    end,
                };
                match RouteInstruction::generate((&scene, rays), way, &mut key.stream()) {
                    Some(route) => {
                        tally.told += 1;
                        check((&scene, rays), &route, looks, &mut tally);
                    }
                    None => tally.untold += 1,
                }
            }
        }
    }
    let Tally {
        told,
        untold,
        turns,
        mirrored,
        skipped,
        swapped,
        splits,
    } = tally;
    println!(
        "{told} told, {untold} not; {turns} turns, {mirrored} mirrored, {skipped} skipped, {swapped} swapped, {splits} texts"
    );
    assert!(
        told > 30 && turns > 20 && mirrored > 10 && skipped > 50 && swapped > 5 && splits > told
    );
}

/// A hall with a sofa beside its middle; walks are made by hand. North is -Z.
#[test]
fn walks_by_hand_are_judged_as_one_would() {
    let mut b = Builder::new("hall");
    let hall = b.room("hall", [0.0, 0.0], [8.0, 8.0]);
    let wood = b.material("wood", [150, 111, 72]);
    let sofa = b.thing("sofa", &[([5.0, 0.0, 3.5], [6.0, 0.8, 4.5])], wood);
    let house = b.build();
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let scene = semantics.scene(&state);
    let seen = (&scene, scene.rays());
    let at = |x: f32, z: f32| Vec3::new(x, 0.0, z);
    let past = [RouteMilestone::Passed(sofa)];
    // From south to north beside it; far from it; to it and back.
    assert_eq!(passed(seen, &past, &[at(4.2, 7.5), at(4.2, 0.5)], false), 1);
    assert_eq!(passed(seen, &past, &[at(1.0, 7.5), at(1.0, 0.5)], false), 0);
    assert_eq!(
        passed(
            seen,
            &past,
            &[at(4.2, 7.5), at(4.2, 4.0), at(4.2, 7.5)],
            false
        ),
        0
    );
    // In it one has not passed it yet.
    assert_eq!(passed(seen, &past, &[at(4.2, 7.5), at(4.2, 4.0)], false), 0);
    let turn = |direction, before| {
        [RouteMilestone::Turned {
            direction,
            place: at(2.0, 4.0),
            before,
        }]
    };
    // From the south: west is left, east is right.
    let from_south = [at(2.0, 7.5), at(2.0, 4.0)];
    let sides = [(0.3, TurnDirection::Left), (3.7, TurnDirection::Right)];
    for (x, side) in sides {
        let walk = [&from_south[..], &[at(x, 4.0)]].concat();
        for asked in [
            TurnDirection::Left,
            TurnDirection::Right,
            TurnDirection::Around,
        ] {
            let expected = usize::from(asked == side);
            assert_eq!(
                passed(seen, &turn(asked, None), &walk, false),
                expected,
                "{asked:?} {x}"
            );
        }
        // From the north it is the other side.
        let walk = [at(2.0, 0.5), at(2.0, 4.0), at(x, 4.0)];
        assert_eq!(passed(seen, &turn(side, None), &walk, false), 0);
    }
    let onward = [&from_south[..], &[at(2.0, 0.5)]].concat();
    let back = [&from_south[..], &[at(2.0, 7.5)]].concat();
    for asked in [TurnDirection::Left, TurnDirection::Right] {
        assert_eq!(passed(seen, &turn(asked, None), &onward, false), 0);
        assert_eq!(passed(seen, &turn(asked, None), &back, false), 0);
    }
    // Straight on beside the place is no turn at it.
    let beside = [at(2.7, 7.5), at(2.7, 0.5)];
    for asked in [TurnDirection::Left, TurnDirection::Right] {
        assert_eq!(passed(seen, &turn(asked, None), &beside, false), 0);
    }
    assert_eq!(
        passed(seen, &turn(TurnDirection::Around, None), &back, false),
        1
    );
    // Who stands there and looks east turns to the left to go north, around to go west.
    let east = Some(Vec2::new(1.0, 0.0));
    let north = [at(2.0, 4.0), at(2.0, 0.5)];
    let west = [at(2.0, 4.0), at(0.3, 4.0)];
    assert_eq!(
        passed(seen, &turn(TurnDirection::Left, east), &north, false),
        1
    );
    assert_eq!(
        passed(seen, &turn(TurnDirection::Right, east), &north, false),
        0
    );
    assert_eq!(
        passed(seen, &turn(TurnDirection::Around, east), &west, false),
        1
    );
    assert_eq!(
        passed(seen, &turn(TurnDirection::Left, east), &west, false),
        0
    );
    // One long step is looked at in between, and its length changes nothing.
    let both = [turn(TurnDirection::Right, None).to_vec(), past.to_vec()].concat();
    let walk = [at(2.0, 7.5), at(2.0, 4.0), at(4.0, 4.0), at(4.0, 0.5)];
    assert_eq!(passed(seen, &both, &walk, false), 2);
    let swapped = [both[1].clone(), both[0].clone()];
    let first_past = [
        at(4.2, 7.5),
        at(4.2, 0.5),
        at(0.5, 0.5),
        at(2.0, 7.0),
        at(2.0, 4.0),
        at(0.3, 4.0),
    ];
    assert_eq!(passed(seen, &swapped, &first_past, false), 1);
    let _ = hall;
    // What is known of one walk is nothing for another.
    let mut walk = RouteTracker::new(past.to_vec());
    assert!(!walk.restore(RouteTracker::new(both.clone()).progress().clone()));
    assert!(walk.restore(RouteTracker::new(past.to_vec()).progress().clone()));
}
