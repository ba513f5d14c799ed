//! Positions of the doors and windows of a plan.

use super::super::edit_errors::{check_range, invalid_field, prefix_field, unknown_name};
use super::data::{CardinalDirection, DoorPlan, OUTSIDE, StoreyPlan, WindowPlan};
use super::grid::{Millimetres, PlanCell, metres};
use super::walls::WallSegment;
use crate::building::wall::WallOpening;
use crate::error::HousesError;

/// Wall that stays above an opening, and beside it, m.
const REST_M: f32 = 0.05;
/// Distance from the end of a wall within which a leaf cannot open beyond a right angle, m.
const BESIDE_M: f32 = 0.12;

/// The contents of a hole.
#[derive(Clone, Copy, Debug)]
pub(super) enum OpeningFill<'a> {
    Door(&'a DoorPlan),
    Window(&'a WindowPlan),
}

/// A hole in a stretch of wall.
#[derive(Debug)]
pub(super) struct PlanOpening<'a> {
    /// Index of the stretch.
    pub(super) wall_segment: usize,
    pub(super) opening: WallOpening,
    pub(super) filling: OpeningFill<'a>,
    /// The room into which it looks.
    pub(super) room: usize,
    /// True if that room lies at larger coordinates across the wall.
    pub(super) room_on_positive_side: bool,
    /// True if a leaf opens to a right angle only.
    pub(super) max_right_angle: bool,
}

/// All holes of a storey.
///
/// # Errors
/// [`HousesError::Spec`] for rooms that are not there or share no wall, and for what does not fit into its wall.
pub(super) fn plan_openings<'a>(
    storey: &'a StoreyPlan,
    stretches: &[WallSegment],
) -> Result<Vec<PlanOpening<'a>>, HousesError> {
    let mut holes: Vec<PlanOpening<'a>> = Vec::new();
    for (k, door) in storey.doors.iter().enumerate() {
        let hole = door_opening(storey, door, stretches)
            .map_err(prefix_field(format_args!("doors[{k}]")))?;
        check_no_overlap(&holes, &hole).map_err(prefix_field(format_args!("doors[{k}]")))?;
        holes.push(hole);
    }
    for (k, window) in storey.windows.iter().enumerate() {
        let hole = of_window(storey, window, stretches)
            .map_err(prefix_field(format_args!("windows[{k}]")))?;
        check_no_overlap(&holes, &hole).map_err(prefix_field(format_args!("windows[{k}]")))?;
        holes.push(hole);
    }
    Ok(holes)
}

fn room(storey: &StoreyPlan, field: &str, name: &str) -> Result<usize, HousesError> {
    let found = storey.rooms.iter().position(|room| room.name == name);
    found.ok_or_else(|| {
        let names = storey.rooms.iter().map(|room| room.name.as_str());
        unknown_name(field, name, "rooms of the storey", names)
    })
}

fn door_opening<'a>(
    storey: &StoreyPlan,
    door: &'a DoorPlan,
    stretches: &[WallSegment],
) -> Result<PlanOpening<'a>, HousesError> {
    let [front, behind] = &door.rooms;
    let own = room(storey, "rooms[0]", front)?;
    let other = if behind == OUTSIDE {
        PlanCell::Outside
    } else {
        PlanCell::Room(room(storey, "rooms[1]", behind)?)
    };
    if other == PlanCell::Room(own) {
        return Err(invalid_field(
            "rooms",
            format_args!("{front:?} twice"),
            format!("two rooms, or one and {OUTSIDE:?}"),
        ));
    }
    let width = check_range("width_m", door.width_m, [0.5, 10.0], "m")?;
    let height = check_range(
        "height_m",
        door.height_m,
        [1.0, storey.height_m - REST_M],
        "m in this storey",
    )?;
    check_range("open", door.open, [0.0, 1.0], "")?;
    let between = match door.side {
        None => format!("{front:?} and {behind:?}"),
        Some(_) => format!(
            "{front:?} and, on its {}side, {behind:?}",
            side_adjective(door.side)
        ),
    };
    let fits = |stretch: &WallSegment| is_wall_on_side(stretch, own, other, door.side);
    let (stretch, along) = locate_in_wall(stretches, fits, (&between, door.at_m, width))?;
    let inward = stretches[stretch].sides[1] == PlanCell::Room(own);
    // The model looks along +Z into the room; its left is where hinges are by default.
    let low_is_left = inward == stretches[stretch].along_x;
    let at_low = (door.hinge == super::data::HingeSide::Left) == low_is_left;
    let [from, to] = stretches[stretch].span().map(metres);
    let beside = if at_low {
        along[0] - from
    } else {
        to - along[1]
    };
    Ok(PlanOpening {
        wall_segment: stretch,
        opening: WallOpening {
            along,
            up: [0.0, height],
        },
        filling: OpeningFill::Door(door),
        room: own,
        room_on_positive_side: inward,
        max_right_angle: beside < BESIDE_M,
    })
}

fn of_window<'a>(
    storey: &StoreyPlan,
    window: &'a WindowPlan,
    stretches: &[WallSegment],
) -> Result<PlanOpening<'a>, HousesError> {
    let own = room(storey, "room", &window.room)?;
    let width = check_range("width_m", window.width_m, [0.2, 20.0], "m")?;
    let sill = check_range(
        "sill_m",
        window.sill_m,
        [0.05, storey.height_m - 0.3],
        "m in this storey",
    )?;
    let most = storey.height_m - REST_M - sill;
    let height = check_range(
        "height_m",
        window.height_m,
        [0.2, most],
        "m above this sill",
    )?;
    let fits =
        |stretch: &WallSegment| is_wall_on_side(stretch, own, PlanCell::Outside, window.side);
    let between = format!(
        "{:?} and its {}outside",
        window.room,
        side_adjective(window.side)
    );
    let (stretch, along) = locate_in_wall(stretches, fits, (&between, window.at_m, width))?;
    Ok(PlanOpening {
        wall_segment: stretch,
        opening: WallOpening {
            along,
            up: [sill, sill + height],
        },
        filling: OpeningFill::Window(window),
        room: own,
        room_on_positive_side: stretches[stretch].sides[1] == PlanCell::Room(own),
        max_right_angle: false,
    })
}

/// Returns whether a stretch separates a room from something else, on a side of the room.
fn is_wall_on_side(
    stretch: &WallSegment,
    own: usize,
    other: PlanCell,
    side: Option<CardinalDirection>,
) -> bool {
    let own = PlanCell::Room(own);
    let Some(side) = side else {
        return stretch.separates(own, other);
    };
    let sides = match side {
        CardinalDirection::North | CardinalDirection::West => [other, own],
        CardinalDirection::South | CardinalDirection::East => [own, other],
    };
    let along_x = matches!(side, CardinalDirection::North | CardinalDirection::South);
    stretch.along_x == along_x && stretch.sides == sides
}

/// A side before a noun.
fn side_adjective(side: Option<CardinalDirection>) -> String {
    side.map_or_else(String::new, |side| format!("{side:?} ").to_lowercase())
}

/// A stretch for which `fits` holds, and the position of the hole along it.
fn locate_in_wall(
    stretches: &[WallSegment],
    fits: impl Fn(&WallSegment) -> bool,
    (between, at_m, width_m): (&str, Option<f32>, f32),
) -> Result<(usize, [f32; 2]), HousesError> {
    let fitting = stretches
        .iter()
        .enumerate()
        .filter(|(_, stretch)| fits(stretch));
    let mut fitting: Vec<(usize, [Millimetres; 2])> =
        fitting.map(|(k, stretch)| (k, stretch.span())).collect();
    // The longest first; of equals the first.
    fitting.sort_by_key(|(k, [from, to])| (from - to, *k));
    let Some((longest, [from, to])) = fitting.first().copied() else {
        return Err(invalid_field(
            "rooms",
            format_args!("no wall between {between}"),
            "rooms with a wall between them",
        ));
    };
    let spans = || {
        let spans = fitting
            .iter()
            .map(|(_, [from, to])| format!("{:.3} to {:.3} m", metres(*from), metres(*to)));
        spans.collect::<Vec<_>>().join("; ")
    };
    let widest = metres(to - from) - 2.0 * REST_M;
    if width_m > widest + 1e-5 {
        let possible = format!("at most {widest:.3} m in the wall between {between}");
        return Err(invalid_field("width_m", width_m, possible));
    }
    let Some(at_m) = at_m else {
        let middle = 0.5 * (metres(from) + metres(to));
        return Ok((longest, [middle - 0.5 * width_m, middle + 0.5 * width_m]));
    };
    let hole = [at_m - 0.5 * width_m, at_m + 0.5 * width_m];
    let holds = |[from, to]: [Millimetres; 2]| {
        hole[0] >= metres(from) + REST_M - 1e-4 && hole[1] <= metres(to) - REST_M + 1e-4
    };
    let found = fitting.iter().find(|(_, span)| holds(*span));
    found.map(|(k, _)| (*k, hole)).ok_or_else(|| {
        let possible = format!(
            "a place for {width_m} m in the wall between {between}: {}",
            spans()
        );
        invalid_field("at_m", at_m, possible)
    })
}

/// Refuses a hole in another one.
fn check_no_overlap(holes: &[PlanOpening<'_>], new: &PlanOpening<'_>) -> Result<(), HousesError> {
    let meets = |a: [f32; 2], b: [f32; 2]| a[0] < b[1] + REST_M && b[0] < a[1] + REST_M;
    let other = holes.iter().find(|other| {
        other.wall_segment == new.wall_segment
            && meets(other.opening.along, new.opening.along)
            && meets(other.opening.up, new.opening.up)
    });
    match other {
        None => Ok(()),
        Some(other) => {
            let [from, to] = other.opening.along;
            let found = format!("an opening that meets another one, from {from:.3} to {to:.3} m");
            Err(invalid_field(
                "at_m",
                found,
                format!("at least {REST_M} m of wall between them"),
            ))
        }
    }
}
