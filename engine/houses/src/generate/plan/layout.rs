//! Layout of rooms: the best of many drawn plans.

use super::links::{connect_rooms, missing_links};
use super::storey::{
    STAIRS_DEPTH, STAIRS_WIDTH, StoreyFrame, StripLayout, draw_storey, full_depth_width,
};
use super::{
    GeneratedPlan, GeneratedRoom, GeneratedStorey, GridRect, GridSteps, StairwellPlan, metres,
    steps,
};
use crate::generate::room_program::{RequiredRoom, RoomProgram};
use crate::generate::rooms::GeneratedRoomKind;
use crate::generate::spec::HomeKind;
use dwell_scene::random::{RandomKey, RandomStream};

/// Number of plans that are drawn before the best is taken.
const DRAWN: u64 = 96;
/// Largest number of plans that are drawn while none fits.
const AT_MOST: u64 = 1600;

/// The best plan of a bounded number of drawn ones; `None` when none fits.
pub(crate) fn best_plan(
    programme: &RoomProgram,
    adjacency: &[[GeneratedRoomKind; 2]],
    key: RandomKey,
) -> Option<GeneratedPlan> {
    let mut best: Option<(f32, GeneratedPlan)> = None;
    for round in 0..AT_MOST {
        if round >= DRAWN && best.is_some() {
            break;
        }
        let mut stream = key.child(round).stream();
        let Some((score, plan)) = draw_scored_plan(programme, adjacency, &mut stream) else {
            continue;
        };
        if best.as_ref().is_none_or(|(least, _)| score < *least) {
            best = Some((score, plan));
        }
    }
    let (_, mut plan) = best?;
    add_outside(
        &mut plan,
        programme.outside,
        &mut key.child("outside").stream(),
    );
    randomly_orient(&mut plan, &mut key.child("turn").stream());
    Some(plan)
}

/// One plan with its faults: the less the better.
fn draw_scored_plan(
    programme: &RoomProgram,
    adjacency: &[[GeneratedRoomKind; 2]],
    stream: &mut RandomStream,
) -> Option<(f32, GeneratedPlan)> {
    let stairs = programme.storeys.len() > 1;
    let arrangements: Vec<StripLayout> = programme
        .storeys
        .iter()
        .enumerate()
        .map(|(k, rooms)| arrange(rooms, programme.home, stairs, k == 0, stream))
        .collect();
    let frame = draw_frame(&arrangements, programme.home, stairs, stream)?;
    let mut storeys = Vec::new();
    let mut score = 0.0;
    for (k, (arrangement, wanted)) in arrangements.iter().zip(&programme.storeys).enumerate() {
        let rooms = draw_storey(&frame, arrangement, k == 0, stream)?;
        score += deviation_cost(&rooms, wanted)?;
        let links = connect_rooms(&rooms, k == 0, adjacency)?;
        storeys.push(GeneratedStorey {
            rooms,
            connections: links,
        });
    }
    let missing_connections = missing_links(&storeys, adjacency);
    score += 3.0 * missing_connections.len() as f32;
    let stairs = stairs.then(|| {
        let west = arrangements.iter().any(|a| a.west.is_some());
        debug_assert!(!west, "stairs stand at the west end");
        StairwellPlan {
            area: [0, 0, STAIRS_WIDTH, frame.strips[0]],
            climb: [0, -1],
            across: [1, 0],
        }
    });
    let plan = GeneratedPlan {
        storeys,
        stairs,
        missing_connections,
    };
    Some((score, plan))
}

/// Deals the rooms of a storey to the strips and ends.
fn arrange(
    rooms: &[RequiredRoom],
    home: HomeKind,
    stairs: bool,
    ground: bool,
    stream: &mut RandomStream,
) -> StripLayout {
    use GeneratedRoomKind::{DiningRoom, Kitchen, LivingRoom, Lobby, Studio};
    let mut rest: Vec<RequiredRoom> = rooms.to_vec();
    let mut arrangement = StripLayout::default();
    let public = |room: &RequiredRoom| matches!(room.kind, LivingRoom | Lobby | Studio);
    let mut main = rest.iter().position(public);
    // Without a room for all, the largest one takes the end, or none on an upper storey.
    if main.is_none() && (rest.len() < 3 || stream.below(2) == 0) {
        main = (0..rest.len()).max_by(|a, b| rest[*a].area_m2.total_cmp(&rest[*b].area_m2));
    }
    if let Some(k) = main {
        let end = rest.remove(k);
        arrangement.east = Some(end);
        if public(&end) {
            for kind in [Kitchen, DiningRoom] {
                let found = rest.iter().position(|room| room.kind == kind);
                if let Some(k) = found.filter(|_| stream.below(5) < 2) {
                    arrangement.corridor_rooms.push(rest.remove(k));
                }
            }
        }
    }
    let may_west = !stairs && ground && rest.len() >= 5;
    if may_west && home != HomeKind::Studio && stream.below(3) == 0 {
        let largest = (0..rest.len()).max_by(|a, b| rest[*a].area_m2.total_cmp(&rest[*b].area_m2));
        arrangement.west = largest.map(|k| rest.remove(k));
    }
    stream.shuffle(&mut rest);
    // A few rooms can all stand on one side; else both sides get about the same floor, small rooms to the north.
    let both = rest.len() >= 2 && (rest.len() > 3 || stream.below(3) > 0);
    if stream.below(2) == 0 {
        rest.sort_by(|a, b| a.area_m2.total_cmp(&b.area_m2));
    }
    let total: f32 = rest.iter().map(|room| room.area_m2).sum();
    let mut north = 0.0;
    let share = stream.range(0.34, 0.56);
    for room in rest {
        let to_north = !both || north + 0.5 * room.area_m2 < share * total;
        if to_north {
            north += room.area_m2;
        }
        arrangement.strips[usize::from(!to_north)].push(room);
    }
    for strip in &mut arrangement.strips {
        stream.shuffle(strip);
    }
    arrangement
}

/// Depths and width for the first storey; the others follow.
fn draw_frame(
    arrangements: &[StripLayout],
    home: HomeKind,
    stairs: bool,
    stream: &mut RandomStream,
) -> Option<StoreyFrame> {
    let used = |strip: usize| arrangements.iter().any(|a| !a.strips[strip].is_empty());
    let draw = |used: bool, low: f32, high: f32, stream: &mut RandomStream| {
        let depth = steps(stream.range(low, high));
        if used { depth } else { 0 }
    };
    let north = draw(used(0) || stairs, 2.2, 4.6, stream);
    let south = draw(used(1), 2.6, 4.9, stream);
    let strips = [
        if stairs {
            north.max(STAIRS_DEPTH)
        } else {
            north
        },
        south,
    ];
    let any = strips.iter().any(|depth| *depth > 0);
    let corridor = match (any, home) {
        (false, _) => steps(stream.range(3.4, 6.5)),
        (_, HomeKind::Office) => steps(stream.range(1.5, 2.0)),
        _ => steps(stream.range(1.25, 1.6)),
    };
    let mut frame = StoreyFrame {
        strips,
        corridor,
        width: 0,
        stairs,
    };
    // The floor of all rooms stays what it shall be.
    let width = |arrangement: &StripLayout| {
        let mut floor = [0.0; 2];
        let mut widest: GridSteps = 0;
        for k in 0..2 {
            let extra = if k == 0 && stairs { STAIRS_WIDTH } else { 0 };
            let leg = if k == 1 && arrangement.west.is_some() {
                31
            } else {
                0
            };
            let wish = arrangement.preferred_width(k, strips[k]) + extra + leg;
            floor[k] = metres(wish) * metres(strips[k]);
            if strips[k] > 0 {
                widest = widest.max(wish);
            }
        }
        let depth = metres(strips[0] + strips[1]);
        let mean = if depth > 0.0 {
            (floor[0] + floor[1]) / depth
        } else {
            0.0
        };
        let ends = full_depth_width(arrangement.east_area_m2(), frame.depth())
            + full_depth_width(arrangement.west.map_or(0.0, |r| r.area_m2), frame.depth());
        steps(mean).max(widest * 9 / 10) + ends
    };
    let widths: Vec<GridSteps> = arrangements.iter().map(width).collect();
    let widest = widths.iter().copied().max()?;
    frame.width = widest;
    (metres(frame.width) <= 30.0).then_some(frame)
}

/// Returns the cost of the rooms' deviations from the programme; `None` when one cannot be used.
fn deviation_cost(rooms: &[GeneratedRoom], wanted: &[RequiredRoom]) -> Option<f32> {
    let mut score = 0.0;
    let mut open: Vec<&RequiredRoom> = wanted.iter().collect();
    for room in rooms {
        let area_m2: f32 = room
            .areas
            .iter()
            .map(|[x0, z0, x1, z1]| metres(x1 - x0) * metres(z1 - z0))
            .sum();
        if room.kind == GeneratedRoomKind::Hallway {
            score += 0.04 * area_m2;
            continue;
        }
        let of_kind = |w: &&RequiredRoom| w.kind == room.kind;
        let nearest = (0..open.len())
            .filter(|k| of_kind(&open[*k]))
            .min_by(|a, b| {
                let far = |k: usize| (open[k].area_m2 - area_m2).abs();
                far(*a).total_cmp(&far(*b))
            })?;
        let target = open.remove(nearest).area_m2;
        let traits = room.kind.requirements();
        if area_m2 < 0.9 * traits.area_m2[0] || area_m2 > 2.0 * traits.area_m2[2] {
            return None;
        }
        let ratio = area_m2 / target;
        score += 2.0 * (ratio.max(1.0 / ratio) - 1.0);
        let [x0, z0, x1, z1] = room.areas[0];
        let (w, d) = (metres(x1 - x0), metres(z1 - z0));
        let (short, long) = (w.min(d), w.max(d));
        let aspect = long / short;
        if short < traits.min_width_m - 0.01 || aspect > 3.2 {
            return None;
        }
        score += (aspect - 1.5).max(0.0);
    }
    Some(score)
}

/// A balcony or terrace at the longest outer wall of the room for all (or the largest), if there is one long enough.
fn add_outside(
    plan: &mut GeneratedPlan,
    kind: Option<GeneratedRoomKind>,
    stream: &mut RandomStream,
) {
    let (Some(kind), Some(storey)) = (kind, plan.storeys.first_mut()) else {
        return;
    };
    let depth = if kind == GeneratedRoomKind::Balcony {
        steps(stream.range(1.5, 2.0))
    } else {
        steps(stream.range(2.4, 3.4))
    };
    let cells = super::StoreyCells::new(&storey.rooms);
    let social = |room: &GeneratedRoom| {
        use GeneratedRoomKind::{Bedroom, LivingRoom, Lobby, Office, Studio};
        match room.kind {
            LivingRoom | Studio | Lobby => 3,
            Bedroom => 2,
            Office => 1,
            _ => 0,
        }
    };
    let runs = cells.boundaries();
    let outer = runs.iter().filter_map(|run| {
        let (room, outward) = match run.sides {
            [Some(room), None] => (room, 1),
            [None, Some(room)] => (room, -1),
            _ => return None,
        };
        let rank = social(&storey.rooms[room]);
        (rank > 0 && run.to - run.from >= 50).then_some((
            rank,
            run.to - run.from,
            room,
            outward,
            run,
        ))
    });
    let Some((_, length, room, outward, run)) =
        outer.max_by_key(|(rank, length, room, ..)| (*rank, *length, usize::MAX - *room))
    else {
        return;
    };
    let long = length.min(steps(stream.range(2.6, 4.6)));
    let from = run.from + (length - long) / 2;
    let (near, far) = if outward > 0 {
        (run.at, run.at + depth)
    } else {
        (run.at - depth, run.at)
    };
    let area: GridRect = if run.along_x {
        [from, near, from + long, far]
    } else {
        [near, from, far, from + long]
    };
    storey.rooms.push(GeneratedRoom {
        kind,
        areas: vec![area],
    });
    storey.connections.push(super::RoomConnection {
        into: room,
        from: Some(storey.rooms.len() - 1),
        kind: super::ConnectionKind::Door,
    });
}

/// Mirrors and turns the plan in one of eight ways and moves its corner to the origin.
fn randomly_orient(plan: &mut GeneratedPlan, stream: &mut RandomStream) {
    let [swap, flip_x, flip_z] = [0; 3].map(|_| stream.below(2) == 1);
    let point = |x: GridSteps, z: GridSteps| {
        let (x, z) = if swap { (z, x) } else { (x, z) };
        (if flip_x { -x } else { x }, if flip_z { -z } else { z })
    };
    let area = |[x0, z0, x1, z1]: GridRect| -> GridRect {
        let ((a, b), (c, d)) = (point(x0, z0), point(x1, z1));
        [a.min(c), b.min(d), a.max(c), b.max(d)]
    };
    let mut corner = [GridSteps::MAX; 2];
    for room in plan.storeys.iter_mut().flat_map(|storey| &mut storey.rooms) {
        for place in &mut room.areas {
            *place = area(*place);
            corner = [corner[0].min(place[0]), corner[1].min(place[1])];
        }
    }
    let shift = |place: &mut GridRect| {
        for (k, value) in place.iter_mut().enumerate() {
            *value -= corner[k % 2];
        }
    };
    for room in plan.storeys.iter_mut().flat_map(|storey| &mut storey.rooms) {
        room.areas.iter_mut().for_each(shift);
    }
    if let Some(stairs) = &mut plan.stairs {
        stairs.area = area(stairs.area);
        shift(&mut stairs.area);
        for way in [&mut stairs.climb, &mut stairs.across] {
            let (x, z) = point(way[0], way[1]);
            *way = [x, z];
        }
    }
}
