//! One storey: rooms in strips along a corridor.

use super::{GeneratedRoom, GridRect, GridSteps, metres, steps};
use crate::generate::room_program::RequiredRoom;
use crate::generate::rooms::GeneratedRoomKind;
use dwell_scene::random::RandomStream;

/// Width of the stairs' place: two flights and a gap between them.
pub(super) const STAIRS_WIDTH: GridSteps = 44;
/// Smallest depth of the strip that holds the stairs.
pub(super) const STAIRS_DEPTH: GridSteps = 66;
/// A doorway with what it needs on both sides.
const DOORWAY: GridSteps = 25;

/// The frame of all storeys of a house: the strips' depths and the corridor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct StoreyFrame {
    /// Depth of the strips north and south of the corridor; 0: none.
    pub(super) strips: [GridSteps; 2],
    pub(super) corridor: GridSteps,
    /// Width from west to east.
    pub(super) width: GridSteps,
    /// True if stairs stand at the west end of the northern strip.
    pub(super) stairs: bool,
}

impl StoreyFrame {
    pub(super) fn depth(&self) -> GridSteps {
        self.strips[0] + self.corridor + self.strips[1]
    }

    /// Returns the ends of the corridor from north to south.
    fn corridor_span(&self) -> [GridSteps; 2] {
        [self.strips[0], self.strips[0] + self.corridor]
    }
}

/// The layout of a storey: the rooms of its strips and ends.
#[derive(Clone, Debug, Default)]
pub(super) struct StripLayout {
    /// Rooms of the northern and the southern strip from west to east.
    pub(super) strips: [Vec<RequiredRoom>; 2],
    /// A room over the full depth at the east end, and rooms carved from it.
    pub(super) east: Option<RequiredRoom>,
    pub(super) corridor_rooms: Vec<RequiredRoom>,
    /// A room over the full depth at the west end; the way in then crosses the southern strip.
    pub(super) west: Option<RequiredRoom>,
}

impl StripLayout {
    /// Floor of the rooms at the east end, m².
    pub(super) fn east_area_m2(&self) -> f32 {
        let rooms = self.east.iter().chain(&self.corridor_rooms);
        rooms.map(|room| room.area_m2).sum()
    }

    /// Returns the preferred width of a strip.
    pub(super) fn preferred_width(&self, strip: usize, depth: GridSteps) -> GridSteps {
        let rooms = self.strips[strip].iter();
        rooms.map(|room| width_of(room, depth)).sum()
    }
}

/// The width of a room in a strip.
pub(super) fn width_of(room: &RequiredRoom, depth: GridSteps) -> GridSteps {
    let least = steps(room.kind.requirements().min_width_m);
    let depth_m = metres(depth).max(0.5);
    steps(room.area_m2 / depth_m).max(least)
}

/// Widths of rooms that fill `length` exactly, in proportion to their preferred ones; `None` when they do not fit.
fn fit_widths(
    rooms: &[RequiredRoom],
    depth: GridSteps,
    length: GridSteps,
) -> Option<Vec<GridSteps>> {
    let wishes: Vec<GridSteps> = rooms.iter().map(|room| width_of(room, depth)).collect();
    let total: GridSteps = wishes.iter().sum();
    if total == 0 {
        return (length == 0).then(Vec::new);
    }
    let mut widths: Vec<GridSteps> = wishes
        .iter()
        .map(|wish| (wish * length / total).max(1))
        .collect();
    let rest = length - widths.iter().sum::<GridSteps>();
    *widths.last_mut()? += rest;
    let fits = rooms
        .iter()
        .zip(&widths)
        .all(|(room, width)| *width >= steps(room.kind.requirements().min_width_m));
    fits.then_some(widths)
}

/// The rooms of a storey; the hallway is the last one if there is any. `None` when they do not fit the frame.
pub(super) fn draw_storey(
    frame: &StoreyFrame,
    arrangement: &StripLayout,
    way_in: bool,
    stream: &mut RandomStream,
) -> Option<Vec<GeneratedRoom>> {
    let depth = frame.depth();
    let east_width = full_depth_width(arrangement.east_area_m2(), depth);
    let west_width = full_depth_width(arrangement.west.map_or(0.0, |room| room.area_m2), depth);
    let (from, to) = (west_width, frame.width - east_width);
    let [north, south] = frame.corridor_span();
    let mut rooms = Vec::new();
    let mut hallway = Vec::new();
    let has_strips = arrangement.strips.iter().any(|strip| !strip.is_empty());
    if to - from
        < if has_strips || frame.stairs {
            DOORWAY
        } else {
            0
        }
    {
        return None;
    }
    let mut lasts = [0; 2];
    let mut left = Vec::new();
    for (k, strip) in arrangement.strips.iter().enumerate() {
        let (z0, z1) = if k == 0 { (0, north) } else { (south, depth) };
        let mut x = from;
        if k == 0 && frame.stairs {
            hallway.push([x, z0, x + STAIRS_WIDTH, z1]);
            x += STAIRS_WIDTH;
        }
        if k == 1 && way_in && arrangement.west.is_some() {
            let leg = steps(stream.range(1.35, 1.7));
            hallway.push([x, z0, x + leg, z1]);
            x += leg;
        }
        if z1 == z0 {
            continue;
        }
        if strip.is_empty() && to > x {
            // Nobody wants it: the room at the end takes it.
            arrangement.east?;
            left.push([x, z0, to, z1]);
            continue;
        }
        for (room, width) in strip.iter().zip(fit_widths(strip, z1 - z0, to - x)?) {
            rooms.push(GeneratedRoom {
                kind: room.kind,
                areas: vec![[x, z0, x + width, z1]],
            });
            x += width;
            lasts[k] = width;
        }
    }
    let mut end = to;
    if has_strips || frame.stairs {
        // The corridor may stop at the last doors and leave the rest to the room behind.
        let spare = lasts
            .iter()
            .filter(|width| **width > 0)
            .min()
            .map_or(0, |w| w - DOORWAY);
        let tongue = spare >= 16 && to - from - spare >= 2 * DOORWAY && left.is_empty();
        if tongue && arrangement.east.is_some() && stream.below(2) == 0 {
            end = to - spare;
        }
        hallway.insert(0, [from, north, end, south]);
    }
    if let Some(room) = arrangement.west {
        rooms.push(GeneratedRoom {
            kind: room.kind,
            areas: vec![[0, 0, west_width, depth]],
        });
    }
    if let Some(room) = arrangement.east {
        let block = [to, 0, frame.width, depth];
        let mut areas = vec![block];
        areas.append(&mut left);
        if end < to {
            areas.push([end, north, to, south]);
        }
        let mut living = GeneratedRoom {
            kind: room.kind,
            areas,
        };
        for (k, carved) in arrangement.corridor_rooms.iter().enumerate() {
            rooms.push(carve(&mut living, block, carved, k == 0, [north, south])?);
        }
        rooms.push(living);
    }
    if !hallway.is_empty() {
        rooms.push(GeneratedRoom {
            kind: GeneratedRoomKind::Hallway,
            areas: hallway,
        });
    }
    Some(rooms)
}

/// The width of a room over the full depth.
pub(super) fn full_depth_width(area_m2: f32, depth: GridSteps) -> GridSteps {
    if area_m2 > 0.0 {
        steps(area_m2 / metres(depth).max(0.5)).max(steps(2.8))
    } else {
        0
    }
}

/// Carves another room from a corner of the room at the east end: at the north or the south. The rest must keep its width
/// and stay at the corridor's end.
fn carve(
    living: &mut GeneratedRoom,
    block: GridRect,
    carved: &RequiredRoom,
    at_north: bool,
    aisle: [GridSteps; 2],
) -> Option<GeneratedRoom> {
    let [x0, z0, x1, z1] = block;
    let least = steps(carved.kind.requirements().min_width_m);
    let width = x1 - x0;
    // All of the block's width, unless that makes a corridor of it.
    let mut wide = width;
    let mut deep = steps(carved.area_m2 / metres(wide));
    if deep < least {
        deep = least;
        wide = steps(carved.area_m2 / metres(deep));
        // A niche beside it would be of no use.
        if width - wide < 30 {
            wide = width;
        }
    }
    let limit = if at_north { aisle[0] } else { z1 - aisle[1] };
    if deep > limit || wide < least || wide > width {
        return None;
    }
    let (corner, beside) = if at_north {
        (
            [x1 - wide, z0, x1, z0 + deep],
            [x0, z0, x1 - wide, z0 + deep],
        )
    } else {
        (
            [x1 - wide, z1 - deep, x1, z1],
            [x0, z1 - deep, x1 - wide, z1],
        )
    };
    let main = living.areas.first_mut()?;
    if at_north {
        main[1] = z0 + deep;
    } else {
        main[3] = z1 - deep;
    }
    if main[3] - main[1] < steps(2.6) {
        return None;
    }
    if beside[2] > beside[0] {
        living.areas.push(beside);
    }
    Some(GeneratedRoom {
        kind: carved.kind,
        areas: vec![corner],
    })
}
