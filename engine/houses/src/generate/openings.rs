//! Doors where builders put them, and windows by the use of a room.
//!
//! A door stands beside a corner of the room into which it swings, its hinges at that corner, so that the open leaf lies
//! against the wall. No two leaves meet, and no open leaf stands before another door.

use super::plan::{
    BoundarySegment, ConnectionKind, GeneratedPlan, GeneratedStorey, GridRect, GridSteps,
    StairwellPlan, StoreyCells, metres, steps,
};
use super::reachability::count_unreachable_when_empty;
use super::rooms::{GeneratedRoomKind, WindowStyle};
use dwell_scene::random::{RandomKey, RandomStream};

/// Thickness of walls between rooms, m.
pub(crate) const INNER_WALL_M: f32 = 0.1;
/// Thickness of walls to the outside, m.
pub(crate) const OUTER_WALL_M: f32 = 0.2;
/// Width of the opening of a door, in steps.
const DOOR: GridSteps = 19;
/// From the middle of the wall at a corner to the opening.
const CORNER: GridSteps = 3;
/// Width beside its opening that a leaf takes that opens beyond a right angle, with its handle, m.
const BESIDE_M: f32 = 0.099;
/// Depth before a door that no open leaf may reach into, from the middle of its wall, m: one passes between the two.
const PASS_M: f32 = 0.85;
/// Upper edge of doors, m.
pub(crate) const DOOR_WIDTH_M: f32 = 2.06;
/// Upper edge of openings without a leaf, m.
const ARCH_M: f32 = 2.2;

/// A rectangle in metres: x from, z from, x to, z to.
pub(crate) type ZoneXz = [f32; 4];

/// The contents of a hole in a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum HoleContents {
    /// A leaf into the room.
    Door {
        /// True if it hangs on the right, seen from inside the room.
        hinge_right: bool,
        /// True if it has a pane.
        glazed: bool,
        /// True for an entrance of the house.
        entrance: bool,
    },
    /// Nothing.
    Open,
    /// A window.
    Window {
        /// Of frosted glass.
        frosted: bool,
    },
}

/// A hole in a wall with what fills it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WallHole {
    /// The room to which it belongs: that into which a leaf swings.
    pub(crate) room: usize,
    /// The room behind; `None`: outside.
    pub(crate) other_room: Option<usize>,
    /// True if the wall runs along x.
    pub(crate) along_x: bool,
    /// The middle of the wall, across it, m.
    pub(crate) at_m: f32,
    /// Along the wall, m.
    pub(crate) from_m: f32,
    pub(crate) to_m: f32,
    /// Above the floor, m.
    pub(crate) low_m: f32,
    pub(crate) high_m: f32,
    /// +1 when the room lies at larger coordinates across the wall, else -1.
    pub(crate) inward_sign: f32,
    pub(crate) contents: HoleContents,
}

impl WallHole {
    /// The thickness of its wall, m.
    pub(crate) fn wall_m(&self, storey: &GeneratedStorey) -> f32 {
        let outside = self
            .other_room
            .is_none_or(|room| storey.rooms[room].kind.is_outside());
        if outside { OUTER_WALL_M } else { INNER_WALL_M }
    }

    /// A rectangle before it in its room (`side` 1) or in the one behind (-1), from the wall's middle to `depth_m`.
    pub(crate) fn zone_in_front(&self, side: f32, depth_m: f32, margin_m: f32) -> ZoneXz {
        let far = self.at_m + self.inward_sign * side * depth_m;
        let (low, high) = (self.at_m.min(far), self.at_m.max(far));
        let (from, to) = (self.from_m - margin_m, self.to_m + margin_m);
        if self.along_x {
            [from, low, to, high]
        } else {
            [low, from, high, to]
        }
    }

    /// The floor that its leaf passes, if it has one.
    pub(crate) fn swept_zone(&self) -> Option<ZoneXz> {
        matches!(self.contents, HoleContents::Door { .. })
            .then(|| self.zone_in_front(1.0, self.to_m - self.from_m + 0.1, 0.06))
    }

    /// The floor beside its hinges into which a leaf reaches that opens beyond a right angle, if it has one.
    pub(crate) fn zone_beside_hinges(&self, wall_m: f32) -> Option<ZoneXz> {
        let HoleContents::Door { hinge_right, .. } = self.contents else {
            return None;
        };
        let (from, to) = if self.hinge_at_low_end(hinge_right) {
            (self.from_m - BESIDE_M, self.from_m)
        } else {
            (self.to_m, self.to_m + BESIDE_M)
        };
        let ends =
            [0.5 * wall_m, self.to_m - self.from_m].map(|off| self.at_m + self.inward_sign * off);
        let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        Some(if self.along_x {
            [from, low, to, high]
        } else {
            [low, from, high, to]
        })
    }

    /// Returns where its leaf stands when open.
    pub(crate) fn open_leaf_zone(&self) -> Option<ZoneXz> {
        let HoleContents::Door { hinge_right, .. } = self.contents else {
            return None;
        };
        let zone = self.zone_in_front(1.0, self.to_m - self.from_m + 0.1, 0.0);
        let low_end = self.hinge_at_low_end(hinge_right);
        let mut leaf = zone;
        let axis = usize::from(!self.along_x);
        if low_end {
            leaf[axis] = self.from_m - 0.12;
            leaf[axis + 2] = self.from_m + 0.12;
        } else {
            leaf[axis] = self.to_m - 0.12;
            leaf[axis + 2] = self.to_m + 0.12;
        }
        Some(leaf)
    }

    /// Returns whether hinges on the right mean hinges at the smaller coordinate along the wall. The model's +Z looks into the
    /// room and its right is +X: with the room at larger z, right is the larger x; at larger x, the smaller z.
    fn hinge_at_low_end(&self, hinge_right: bool) -> bool {
        let right_is_high = if self.along_x {
            self.inward_sign > 0.0
        } else {
            self.inward_sign < 0.0
        };
        hinge_right != right_is_high
    }

    /// The yaw that turns the model's +Z into the room, degrees.
    pub(crate) fn yaw_deg(&self) -> f32 {
        match (self.along_x, self.inward_sign > 0.0) {
            (true, true) => 0.0,
            (true, false) => 180.0,
            (false, true) => 90.0,
            (false, false) => -90.0,
        }
    }
}

/// Returns whether two zones share some floor.
pub(crate) fn overlap(a: &ZoneXz, b: &ZoneXz) -> bool {
    a[0] < b[2] - 1e-4 && b[0] < a[2] - 1e-4 && a[1] < b[3] - 1e-4 && b[1] < a[3] - 1e-4
}

/// The holes of every storey; the second is the number of doors that block each other all the same.
pub(crate) fn openings(plan: &GeneratedPlan, key: RandomKey) -> (Vec<Vec<WallHole>>, usize) {
    let mut tight = 0;
    let all = plan.storeys.iter().enumerate().map(|(k, storey)| {
        let key = key.child(k as u64);
        let runs = StoreyCells::new(&storey.rooms).boundaries();
        let stairs = plan.stairs.map(|stairs| stairs.area);
        let (mut holes, faults) =
            doors(storey, &runs, plan.stairs, &mut key.child("doors").stream());
        tight += faults;
        windows(
            storey,
            &runs,
            stairs,
            &mut holes,
            &mut key.child("windows").stream(),
        );
        holes
    });
    (all.collect(), tight)
}

/// Number of draws for doors that do not block each other.
const DEALS: usize = 24;

/// The doors of a storey; the second is the number of those that block others all the same.
fn doors(
    storey: &GeneratedStorey,
    runs: &[BoundarySegment],
    stairs: Option<StairwellPlan>,
    stream: &mut RandomStream,
) -> (Vec<WallHole>, usize) {
    let mut best: Option<(Vec<WallHole>, usize)> = None;
    for _ in 0..DEALS {
        let mut dealt = sample_doors(storey, runs, stairs.map(|stairs| stairs.area), stream);
        // Where no two doors meet, an open leaf may still block the way to a room.
        if dealt.1 == 0 {
            dealt.1 = count_unreachable_when_empty(storey, &dealt.0, stairs);
        }
        if best.as_ref().is_none_or(|(_, least)| dealt.1 < *least) {
            best = Some(dealt);
        }
        if best.as_ref().is_some_and(|(_, tight)| *tight == 0) {
            break;
        }
    }
    best.unwrap_or_default()
}

fn sample_doors(
    storey: &GeneratedStorey,
    runs: &[BoundarySegment],
    stairs: Option<GridRect>,
    stream: &mut RandomStream,
) -> (Vec<WallHole>, usize) {
    let mut holes: Vec<WallHole> = Vec::new();
    let mut tight = 0;
    for link in &storey.connections {
        let mut found = candidates(storey, runs, link.into, link.from, link.kind, stream);
        stream.shuffle(&mut found);
        let clear = |hole: &WallHole| {
            let on_stairs = stairs.is_some_and(|area| {
                let zone = area.map(metres);
                [1.0, -1.0]
                    .iter()
                    .any(|side| overlap(&hole.zone_in_front(*side, 0.5, 0.0), &zone))
            });
            !on_stairs
                && leaves_passage(storey, runs, hole)
                && holes.iter().all(|other| apart(hole, other))
        };
        let good = found.iter().position(clear);
        tight += usize::from(good.is_none());
        holes.extend(found.get(good.unwrap_or(0)).copied());
    }
    (holes, tight)
}

/// Depth of a room in which a leaf may stand free, m: one passes behind it.
const FREE_LEAF_M: f32 = 1.75;

/// Returns whether one can pass the open leaf: it lies against a wall of a corner, or the room is deep.
fn leaves_passage(storey: &GeneratedStorey, runs: &[BoundarySegment], hole: &WallHole) -> bool {
    let HoleContents::Door { hinge_right, .. } = hole.contents else {
        return true;
    };
    let zone = hole.zone_in_front(1.0, FREE_LEAF_M, 0.1);
    let area = |z: &ZoneXz| (z[2] - z[0]).max(0.0) * (z[3] - z[1]).max(0.0);
    let common = |a: ZoneXz| {
        area(&[
            a[0].max(zone[0]),
            a[1].max(zone[1]),
            a[2].min(zone[2]),
            a[3].min(zone[3]),
        ])
    };
    let areas = storey.rooms[hole.room].areas.iter();
    let covered: f32 = areas.map(|area| common(area.map(metres))).sum();
    if covered > area(&zone) - 1e-3 {
        return true;
    }
    let hinge = if hole.hinge_at_low_end(hinge_right) {
        hole.from_m
    } else {
        hole.to_m
    };
    runs.iter().any(|run| {
        let beside = run.along_x != hole.along_x
            && run.sides.contains(&Some(hole.room))
            && (metres(run.at) - hinge).abs() < 0.25;
        let (from, to) = (metres(run.from), metres(run.to));
        let inward = if hole.inward_sign > 0.0 {
            (from - hole.at_m).abs() < 0.01 && to - from > 0.85
        } else {
            (to - hole.at_m).abs() < 0.01 && to - from > 0.85
        };
        beside && inward
    })
}

/// Returns whether two doors of a storey leave each other alone.
fn apart(a: &WallHole, b: &WallHole) -> bool {
    let meet = |p: Option<ZoneXz>, q: Option<ZoneXz>| match (p, q) {
        (Some(p), Some(q)) => overlap(&p, &q),
        _ => false,
    };
    let blocked = |leaf: &WallHole, door: &WallHole| {
        leaf.open_leaf_zone().is_some_and(|leaf| {
            [1.0, -1.0]
                .iter()
                .any(|side| overlap(&leaf, &door.zone_in_front(*side, PASS_M, 0.0)))
        })
    };
    let beside =
        |p: f32, q: f32| overlap(&a.zone_in_front(p, 0.1, 0.1), &b.zone_in_front(q, 0.1, 0.1));
    let same = beside(1.0, 1.0) || beside(1.0, -1.0);
    !same && !meet(a.swept_zone(), b.swept_zone()) && !blocked(a, b) && !blocked(b, a)
}

/// Returns where a door between two rooms can be: at both ends and in the middle of every stretch that is long enough.
fn candidates(
    storey: &GeneratedStorey,
    runs: &[BoundarySegment],
    room: usize,
    behind: Option<usize>,
    kind: ConnectionKind,
    stream: &mut RandomStream,
) -> Vec<WallHole> {
    use GeneratedRoomKind::{Balcony, DiningRoom, LivingRoom, Lobby, Studio, Terrace};
    let kinds = [Some(room), behind].map(|room| room.map(|room| storey.rooms[room].kind));
    let between = runs.iter().filter(|run| run.separates(Some(room), behind));
    let mut holes = Vec::new();
    for run in between {
        let length = run.to - run.from;
        let wide = match kind {
            ConnectionKind::Open => (length - 12).min(steps(stream.range(1.5, 2.2))),
            ConnectionKind::Door => DOOR,
        };
        if length < wide + 5 {
            continue;
        }
        let inward = if run.sides[1] == Some(room) {
            1.0
        } else {
            -1.0
        };
        let gap = CORNER.min((length - wide) / 2);
        let (start, end) = (run.from + gap, run.to - gap - wide);
        let middle = run.from + (length - wide) / 2;
        for (from, hinge_low) in [(start, true), (end, false), (middle, stream.below(2) == 0)] {
            let mut hole = WallHole {
                room,
                other_room: behind,
                along_x: run.along_x,
                at_m: metres(run.at),
                from_m: metres(from),
                to_m: metres(from + wide),
                low_m: 0.0,
                high_m: if kind == ConnectionKind::Open {
                    ARCH_M
                } else {
                    DOOR_WIDTH_M
                },
                inward_sign: inward,
                contents: HoleContents::Open,
            };
            if kind == ConnectionKind::Door {
                let outside = matches!(kinds[1], Some(Balcony | Terrace));
                let glazed = outside
                    || matches!(kinds[0], Some(LivingRoom | DiningRoom | Studio | Lobby))
                        && behind.is_some();
                let right = hole.hinge_at_low_end(true) == hinge_low;
                hole.contents = HoleContents::Door {
                    hinge_right: right,
                    glazed,
                    entrance: behind.is_none(),
                };
            }
            holes.push(hole);
        }
    }
    holes
}

fn windows(
    storey: &GeneratedStorey,
    runs: &[BoundarySegment],
    stairs: Option<GridRect>,
    holes: &mut Vec<WallHole>,
    stream: &mut RandomStream,
) {
    for (room, plan) in storey.rooms.iter().enumerate() {
        let traits = plan.kind.requirements();
        // Width, lower and upper edge in m, how many at most, and how much wall each takes.
        let (wide_m, low_m, high_m, most, each_m) = match traits.windows {
            WindowStyle::Wide => (
                stream.range(1.4, 2.0),
                // In steps, so that windows of many houses are alike.
                0.05 * stream.range(10.0, 17.0).round(),
                2.25,
                4,
                3.2,
            ),
            WindowStyle::Usual => (stream.range(1.1, 1.6), 0.9, 2.2, 2, 3.6),
            WindowStyle::High => (stream.range(0.9, 1.3), 1.2, 2.2, 1, 3.0),
            WindowStyle::Frosted => (stream.range(0.5, 0.7), 1.45, 2.1, 1, 3.0),
            WindowStyle::None => continue,
        };
        let mut outer: Vec<&BoundarySegment> = runs
            .iter()
            .filter(|run| run.separates(Some(room), None) && run.to - run.from >= 18)
            .collect();
        outer.sort_by_key(|run| run.from - run.to);
        let mut left = most;
        for run in outer {
            let length_m = metres(run.to - run.from);
            let count = ((length_m / each_m) as usize).clamp(1, left);
            let pitch = length_m / count as f32;
            for k in 0..count {
                let half = 0.5 * wide_m.min(pitch - 0.5);
                // In the middle of its stretch, or aside of open leaves.
                for aside in [0.0, 0.3, -0.3, 0.6, -0.6] {
                    let middle = metres(run.from) + pitch * (k as f32 + 0.5) + aside;
                    // To the step, so that walls keep to the grid.
                    let [from_m, to_m] =
                        [middle - half, middle + half].map(|edge| metres(steps(edge)));
                    let hole = WallHole {
                        room,
                        other_room: None,
                        along_x: run.along_x,
                        at_m: metres(run.at),
                        from_m,
                        to_m,
                        low_m,
                        high_m,
                        inward_sign: if run.sides[1] == Some(room) {
                            1.0
                        } else {
                            -1.0
                        },
                        contents: HoleContents::Window {
                            frosted: traits.windows == WindowStyle::Frosted,
                        },
                    };
                    let in_wall = from_m > metres(run.from) + 0.2 && to_m < metres(run.to) - 0.2;
                    if to_m - from_m >= 0.4 && in_wall && is_clear(&hole, holes, stairs) {
                        holes.push(hole);
                        left -= 1;
                        break;
                    }
                }
            }
            if left == 0 || matches!(traits.windows, WindowStyle::Frosted | WindowStyle::High) {
                break;
            }
        }
    }
}

/// Returns whether a window keeps clear of other holes, of open leaves and of the stairs.
fn is_clear(hole: &WallHole, holes: &[WallHole], stairs: Option<GridRect>) -> bool {
    let before = hole.zone_in_front(1.0, 0.5 * OUTER_WALL_M + 0.12, 0.02);
    let free = |other: &WallHole| {
        let beside = other.along_x != hole.along_x
            || (other.at_m - hole.at_m).abs() > 0.01
            || other.to_m + 0.2 < hole.from_m
            || hole.to_m + 0.2 < other.from_m;
        let leaf = other
            .open_leaf_zone()
            .is_some_and(|leaf| overlap(&leaf, &before));
        beside && !leaf
    };
    let deep = hole.zone_in_front(1.0, 0.5, 0.0);
    let on_stairs = stairs.is_some_and(|area| overlap(&deep, &area.map(metres)));
    !on_stairs && holes.iter().all(free)
}
