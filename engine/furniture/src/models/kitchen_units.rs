//! Base units of fitted kitchens, with worktop and sink.

use super::cabinet_parts::{BOARD_M, Carcass, GAP_M, TOP_BOARD, door, drawer, drawer_space};
use super::taps::with_mixer_tap;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, lacquer, steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{SolidMesh, block};
use crate::style::{FrontStyle, Style};
use dwell_scene::random::RandomKey;
use glam::Vec3;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("sink_unit", "kitchen_set", 39, sink_unit),
    CatalogueEntry::new("sink_unit_2", "kitchen_set", 40, sink_unit_2),
    CatalogueEntry::new("sink_unit_3", "kitchen_set", 41, sink_unit_3),
    CatalogueEntry::new("base_unit_1", "kitchen_set", 42, base_unit_1),
    CatalogueEntry::new("base_unit_2", "kitchen_set", 43, two_bay_base_unit),
];

/// Height of worktops, m.
pub(super) const WORKTOP_M: f32 = 0.91;
/// Depth of worktops, m.
pub(super) const UNIT_DEPTH_M: f32 = 0.62;

/// The kind of base unit under one stretch of worktop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum UnitKind {
    /// A door with its hinge on the left.
    Door,
    /// Three drawers.
    Drawers,
    /// A door below a sink.
    Sink,
}

/// A run of base units.
#[derive(Clone, Debug)]
struct KitchenUnit {
    /// Width of one bay, m.
    bay_m: f32,
    /// From left to right as one stands before it, at most four.
    bays: Vec<UnitKind>,
    /// Style of doors and drawers.
    front: FrontStyle,
    /// Finish of the worktop.
    worktop: Finish,
}

impl KitchenUnit {
    /// The model of these sizes and finishes.
    fn build(&self) -> Model {
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
        boards.remove(TOP_BOARD);
        let mut body = PartBuilder::new("body")
            .with(
                &black_plastic(),
                block([-x, 0.0, -z + 0.02], [x, 0.1, face - 0.04]),
            )
            .with_all(&carcass_board(), boards);
        let left_of = |k: usize| -x + self.bay_m * k as f32;
        // The worktop has a hole for each sink.
        let mut start = -x;
        for k in (0..count).filter(|k| self.bays[*k] == UnitKind::Sink) {
            let middle = left_of(k) + 0.5 * self.bay_m;
            let (a, b) = (middle - 0.25, middle + 0.25);
            body = body
                .with_hollow(&self.worktop, block([start, under, -z], [a, WORKTOP_M, z]))
                .with_hollow(&self.worktop, block([a, under, -z], [b, WORKTOP_M, -0.19]))
                .with_hollow(&self.worktop, block([a, under, 0.21], [b, WORKTOP_M, z]))
                .with_all(&steel(), basin(middle));
            start = b;
        }
        body = body.with_hollow(&self.worktop, block([start, under, -z], [x, WORKTOP_M, z]));
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
            model = model.with_support_surface(
                "worktop",
                [-x, WORKTOP_M, -z],
                [left_end, WORKTOP_M + 0.45, z],
            );
        }
        if right_start < x - 0.1 {
            model = model.with_support_surface(
                "worktop_right",
                [right_start, WORKTOP_M, -z],
                [x, WORKTOP_M + 0.45, z],
            );
        }
        if let Some(k) = sink {
            let middle = left_of(k) + 0.5 * self.bay_m;
            model = model.with_container_space(
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
                        .with_container_space(name, min, max);
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
                model = model.with_container_space(DOORS[k], inside.0, inside.1);
                // What lies behind the door stays with the body.
                if let Some(space) = model.spaces.last_mut().filter(|space| space.part == last) {
                    space.part = 0;
                }
            }
        }
        model
    }
}

pub(super) const DOORS: [&str; 4] = ["door_1", "door_2", "door_3", "door_4"];

const DRAWERS: [[&str; 3]; 4] = [
    ["drawer_1_1", "drawer_1_2", "drawer_1_3"],
    ["drawer_2_1", "drawer_2_2", "drawer_2_3"],
    ["drawer_3_1", "drawer_3_2", "drawer_3_3"],
    ["drawer_4_1", "drawer_4_2", "drawer_4_3"],
];

/// Boards of the carcass: dark, so that the gaps between fronts show.
pub(super) const fn carcass_board() -> Finish {
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

fn run(style: &Style, bay_m: f32, bays: Vec<UnitKind>) -> Model {
    KitchenUnit {
        bay_m,
        bays,
        front: style.kitchen_front_style(),
        worktop: style.worktop.clone(),
    }
    .build()
}

fn base_unit_1(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("base_unit_1", key);
    run(
        style,
        d.sample_m("width"),
        vec![d.choose("bay", [UnitKind::Door, UnitKind::Drawers])],
    )
}

fn two_bay_base_unit(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("base_unit_2", key);
    let bays = d.choose(
        "order",
        [
            [UnitKind::Door, UnitKind::Drawers],
            [UnitKind::Drawers, UnitKind::Door],
        ],
    );
    run(style, 0.5 * d.sample_m("width"), bays.to_vec())
}

/// A run with a sink and its tap.
fn sink(style: &Style, d: &SizeSampler, bay_m: f32, bays: Vec<UnitKind>) -> Model {
    let place = bays
        .iter()
        .position(|bay| *bay == UnitKind::Sink)
        .unwrap_or(0);
    let middle = bay_m * (place as f32 + 0.5 - 0.5 * bays.len() as f32);
    let sizes = [d.range("tap", 0.2, 0.3), d.range("reach", 0.16, 0.19)];
    with_mixer_tap(
        run(style, bay_m, bays),
        style,
        d,
        sizes,
        [middle, WORKTOP_M, -0.24],
        0.0,
    )
}

fn sink_unit(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("sink_unit", key);
    sink(style, &d, d.sample_m("width"), vec![UnitKind::Sink])
}

fn sink_unit_2(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("sink_unit_2", key);
    let other = d.choose("other", [UnitKind::Door, UnitKind::Drawers]);
    let bays = d.choose("order", [[UnitKind::Sink, other], [other, UnitKind::Sink]]);
    sink(style, &d, 0.5 * d.sample_m("width"), bays.to_vec())
}

fn sink_unit_3(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("sink_unit_3", key);
    let other = d.choose("other", [UnitKind::Door, UnitKind::Drawers]);
    let orders = [
        [UnitKind::Drawers, UnitKind::Sink, other],
        [other, UnitKind::Sink, UnitKind::Drawers],
        [UnitKind::Sink, UnitKind::Door, UnitKind::Drawers],
    ];
    sink(
        style,
        &d,
        d.sample_m("width") / 3.0,
        d.choose("order", orders).to_vec(),
    )
}
