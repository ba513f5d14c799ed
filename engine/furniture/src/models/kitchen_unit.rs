//! Fitted kitchens: base units with worktop and sink, and cabinets on the wall.

use super::cabinet_parts::{BOARD_M, Carcass, GAP_M, TOP, door, drawer, drawer_space};
use crate::finishes::{Finish, black, granite, lacquer, steel};
use crate::model::{Model, PartBuilder};
use crate::shapes::{SolidMesh, block};
use crate::style::FrontStyle;
use glam::Vec3;

/// Height of worktops, m.
pub const WORKTOP_M: f32 = 0.91;
/// Depth of worktops, m.
pub const UNIT_DEPTH_M: f32 = 0.62;

/// What stands under one stretch of worktop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnitKind {
    /// A door with its hinge on the left.
    Door,
    /// Three drawers.
    Drawers,
    /// A door below a sink.
    Sink,
}

/// A run of base units.
#[derive(Clone, Debug)]
pub struct KitchenUnit {
    /// Width of one bay, m.
    pub bay_m: f32,
    /// From left to right as one stands before it, at most four.
    pub bays: Vec<UnitKind>,
    /// What doors and drawers look like.
    pub front: FrontStyle,
    /// What the worktop is made of.
    pub worktop: Finish,
}

impl Default for KitchenUnit {
    fn default() -> Self {
        let front = lacquer("sage_lacquer", [150, 166, 146]);
        Self {
            bay_m: 0.6,
            bays: vec![UnitKind::Drawers, UnitKind::Sink, UnitKind::Door],
            front: FrontStyle::plain(front, steel()),
            worktop: granite(),
        }
    }
}

const DOORS: [&str; 4] = ["door_1", "door_2", "door_3", "door_4"];
const DRAWERS: [[&str; 3]; 4] = [
    ["drawer_1_1", "drawer_1_2", "drawer_1_3"],
    ["drawer_2_1", "drawer_2_2", "drawer_2_3"],
    ["drawer_3_1", "drawer_3_2", "drawer_3_3"],
    ["drawer_4_1", "drawer_4_2", "drawer_4_3"],
];

impl KitchenUnit {
    /// The model of these sizes and finishes.
    pub fn build(&self) -> Model {
        let count = self.bays.len().min(DOORS.len());
        let (x, z) = (0.5 * self.bay_m * count as f32, 0.5 * UNIT_DEPTH_M);
        let under = WORKTOP_M - 0.038;
        let carcass = Carcass {
            min: [-x, 0.1, -z],
            max: [x, under, z - 0.02 - BOARD_M],
        };
        let face = carcass.max[2];
        let walls: Vec<f32> = (1..count).map(|k| k as f32 / count as f32).collect();
        // The worktop is the lid: a board below it would go through the sink.
        let mut boards = carcass.boards(&[], &walls);
        boards.remove(TOP);
        let mut body = PartBuilder::new("body")
            .with(&black(), block([-x, 0.0, -z + 0.02], [x, 0.1, face - 0.04]))
            .with_all(&carcass_board(), boards);
        let left_of = |k: usize| -x + self.bay_m * k as f32;
        // The worktop has a hole for each sink.
        let mut start = -x;
        for k in (0..count).filter(|k| self.bays[*k] == UnitKind::Sink) {
            let middle = left_of(k) + 0.5 * self.bay_m;
            let (a, b) = (middle - 0.25, middle + 0.25);
            body = body
                .with_bar(&self.worktop, block([start, under, -z], [a, WORKTOP_M, z]))
                .with_bar(&self.worktop, block([a, under, -z], [b, WORKTOP_M, -0.19]))
                .with_bar(&self.worktop, block([a, under, 0.21], [b, WORKTOP_M, z]))
                .with_all(&steel(), basin(middle));
            start = b;
        }
        body = body.with_bar(&self.worktop, block([start, under, -z], [x, WORKTOP_M, z]));
        let mut model = Model::articulated("kitchen_unit", "kitchen_set").part(body);
        // Worktop left and right of the sink, and the basin.
        let sink = self
            .bays
            .iter()
            .take(count)
            .position(|bay| *bay == UnitKind::Sink);
        let (left_end, right_start) =
            sink.map_or((x, x), |k| (left_of(k) + 0.03, left_of(k + 1) - 0.03));
        if left_end > -x + 0.1 {
            model = model.top(
                "worktop",
                [-x, WORKTOP_M, -z],
                [left_end, WORKTOP_M + 0.45, z],
            );
        }
        if right_start < x - 0.1 {
            model = model.top(
                "worktop_right",
                [right_start, WORKTOP_M, -z],
                [x, WORKTOP_M + 0.45, z],
            );
        }
        if let Some(k) = sink {
            let middle = left_of(k) + 0.5 * self.bay_m;
            model = model.inside(
                "sink",
                [middle - 0.23, WORKTOP_M - 0.168, -0.17],
                [middle + 0.23, WORKTOP_M, 0.19],
            );
        }
        let front = self.front.clone();
        for (k, bay) in self.bays.iter().take(count).enumerate() {
            let (a, b) = (left_of(k) + 0.5 * GAP_M, left_of(k + 1) - 0.5 * GAP_M);
            let inside = (
                [a + 0.03, 0.1 + BOARD_M, -z + 0.01],
                [b - 0.03, under - 0.17, face - 0.01],
            );
            if *bay == UnitKind::Drawers {
                let step = (under - 0.105) / 3.0;
                for (row, name) in DRAWERS[k].into_iter().enumerate() {
                    let low = 0.105 + step * row as f32;
                    let (low, high) = ([a, low], [b, low + step - GAP_M]);
                    let (min, max) = drawer_space(low, high, face, 0.48);
                    model = model
                        .part(drawer(name, low, high, face, 0.48, &front))
                        .sliding(name, Vec3::Z, 0.4)
                        .inside(name, min, max);
                }
            } else {
                model = model
                    .part(door(
                        DOORS[k],
                        [a, 0.105],
                        [b, under - GAP_M],
                        face,
                        true,
                        &front,
                    ))
                    .hinged(DOORS[k], [a, 0.0, face + BOARD_M], Vec3::NEG_Y, 1.7);
                let last = model.parts.len() - 1;
                model = model.inside(DOORS[k], inside.0, inside.1);
                // What lies behind the door stays with the body.
                if let Some(space) = model.spaces.last_mut().filter(|space| space.part == last) {
                    space.part = 0;
                }
            }
        }
        model
    }
}

/// Boards of the carcass: dark, so that the gaps between fronts show.
const fn carcass_board() -> Finish {
    lacquer("graphite_board", [84, 86, 88])
}

/// A basin of sheet steel, open at the worktop, about x = `middle`.
fn basin(middle: f32) -> Vec<SolidMesh> {
    let (low, top, t) = (WORKTOP_M - 0.18, WORKTOP_M + 0.003, 0.012);
    let (x0, x1, z0, z1) = (middle - 0.25, middle + 0.25, -0.19, 0.21);
    vec![
        block([x0, low, z0], [x1, low + t, z1]),
        block([x0, low + t, z0], [x0 + t, top, z1]),
        block([x1 - t, low + t, z0], [x1, top, z1]),
        block([x0 + t, low + t, z0], [x1 - t, top, z0 + t]),
        block([x0 + t, low + t, z1 - t], [x1 - t, top, z1]),
    ]
}

const SHELVES: [[&str; 2]; 4] = [
    ["lower_shelf", "upper_shelf"],
    ["lower_shelf_2", "upper_shelf_2"],
    ["lower_shelf_3", "upper_shelf_3"],
    ["lower_shelf_4", "upper_shelf_4"],
];

/// Cabinets on the wall: `doors` doors of `door_m` width; y = 0 is their lower edge.
pub fn wall_cabinet(doors: usize, door_m: f32, height_m: f32, front: &FrontStyle) -> Model {
    const DEPTH_M: f32 = 0.34;
    let count = doors.clamp(1, DOORS.len());
    let x = 0.5 * door_m * count as f32;
    let carcass = Carcass {
        min: [-x, 0.0, 0.0],
        max: [x, height_m, DEPTH_M - BOARD_M],
    };
    let walls: Vec<f32> = (1..count).map(|k| k as f32 / count as f32).collect();
    let white = carcass_board();
    let (low, middle) = carcass.space(0.0, 0.5);
    let (upper, high) = carcass.space(0.5, 1.0);
    let mut model = Model::articulated("wall_cabinet", "hanging_kitchen_cabinet")
        .part(PartBuilder::new("body").with_all(&white, carcass.boards(&[0.5], &walls)));
    let look = front;
    for (k, [lower, above]) in SHELVES.into_iter().take(count).enumerate() {
        let (a, b) = (
            -x + door_m * k as f32 + BOARD_M,
            -x + door_m * (k + 1) as f32 - BOARD_M,
        );
        model = model
            .inside(lower, [a, low[1], low[2]], [b, middle[1], middle[2]])
            .inside(above, [a, upper[1], upper[2]], [b, high[1], high[2]]);
    }
    let z = carcass.max[2];
    for (k, name) in DOORS.into_iter().take(count).enumerate() {
        let (a, b) = (-x + door_m * k as f32, -x + door_m * (k + 1) as f32);
        let hinge_left = k % 2 == 0;
        let face = [a + 0.5 * GAP_M, 0.002];
        let leaf = PartBuilder::new(name)
            .with(
                &look.board,
                block(
                    [face[0], face[1], z],
                    [b - 0.5 * GAP_M, height_m - 0.002, z + BOARD_M],
                ),
            )
            .with(
                &look.handle,
                super::cabinet_parts::upright_handle(
                    if hinge_left { b - 0.04 } else { a + 0.04 },
                    0.05,
                    0.15,
                    z + BOARD_M,
                ),
            );
        let (hinge, axis) = if hinge_left {
            (a, Vec3::NEG_Y)
        } else {
            (b, Vec3::Y)
        };
        model = model
            .part(leaf)
            .hinged(name, [hinge, 0.0, z + BOARD_M], axis, 1.7);
    }
    model
}
