//! Cupboards for shoes, provisions and valuables, racks, chests with lids.

use super::cabinet_parts::{BOARD_M, Carcass, GAP_M, door, level_handle};
use crate::finishes::{black, brass, chrome, grey_board, painted_steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cylinder, rod, rounded_block, trough};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::FRAC_PI_2;

const FLAPS: [&str; 4] = ["flap_1", "flap_2", "flap_3", "flap_4"];
const SHELVES: [&str; 6] = [
    "shelf_1", "shelf_2", "shelf_3", "shelf_4", "shelf_5", "shelf_6",
];

/// A flat cabinet for shoes; its flaps tilt forward about their lower edges.
pub fn shoe_cabinet(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("shoe_cabinet", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let rows = if h > 1.25 { 3 } else { 2 };
    let (x, top) = (0.5 * w, h - 0.02);
    let carcass = Carcass::standing(w - 0.01, 0.05, top, depth - BOARD_M - 0.01);
    let z = carcass.max[2];
    let body = PartBuilder::new("body")
        .with(
            &style.wood,
            rounded_block([-x, top, carcass.min[2]], [x, h, z + BOARD_M], 0.004, 1),
        )
        .with(
            &black(),
            block(
                [-x + 0.03, 0.0, carcass.min[2] + 0.01],
                [x - 0.03, 0.05, z - 0.02],
            ),
        )
        .with_all(&style.front, carcass.boards(&[], &[]));
    let mut model = Model::articulated("shoe_cabinet", "shoes_cabinet")
        .part(body)
        .top("top", [-x, h, carcass.min[2]], [x, h + 0.5, z + BOARD_M]);
    let step = (top - 0.05 - GAP_M) / rows as f32;
    for (k, name) in FLAPS.into_iter().take(rows).enumerate() {
        let (low, high) = (0.055 + step * k as f32, 0.05 + step * (k + 1) as f32);
        let half = carcass.max[0] - 0.5 * GAP_M;
        let flap = PartBuilder::new(name)
            .with(
                &style.front,
                block([-half, low, z], [half, high, z + BOARD_M]),
            )
            .with(
                &style.metal,
                level_handle(0.0, high - 0.05, z + BOARD_M, 0.06),
            );
        model = model
            .part(flap)
            .hinged(name, [0.0, low, z + BOARD_M], Vec3::X, 0.75);
        let shelf = carcass.max[1].min(high) - 0.03;
        model = model.inside(
            name,
            [-half + 0.03, low + 0.02, carcass.min[2] + 0.01],
            [half - 0.03, shelf, z - 0.01],
        );
        // What lies behind the flap stays with the body.
        if let Some(space) = model.spaces.last_mut() {
            space.part = 0;
        }
    }
    model
}

/// A tall larder cupboard of a fitted kitchen: two doors, one above the other.
pub fn larder(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("larder", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let carcass = Carcass::standing(w, 0.1, h, depth - BOARD_M);
    let (x, z) = (0.5 * w, carcass.max[2]);
    let split = 0.6;
    let body = PartBuilder::new("body")
        .with(
            &black(),
            block([-x, 0.0, carcass.min[2] + 0.02], [x, 0.1, z - 0.04]),
        )
        .with_all(&grey_board(), carcass.boards(&[0.2, 0.4, split, 0.8], &[]));
    let mut model = Model::articulated("larder", "kitchen_cabinet")
        .part(body)
        .top("top", [-x, h, carcass.min[2]], [x, h + 0.3, z]);
    for (k, name) in SHELVES.into_iter().take(5).enumerate() {
        let (low, high) = carcass.space(0.2 * k as f32, 0.2 * (k + 1) as f32);
        model = model.inside(name, low, high);
    }
    let y = carcass.min[1] + split * (h - carcass.min[1]);
    let left = d.chance("hinge", 0.5);
    let (hinge, axis) = if left {
        (-x, Vec3::NEG_Y)
    } else {
        (x, Vec3::Y)
    };
    let front = style.kitchen_doors();
    let leaf = |name, low: f32, high: f32| {
        let (a, b) = ([-x + 0.002, low], [x - 0.002, high]);
        door(name, a, b, z, left, &front)
    };
    model
        .part(leaf("lower_door", 0.105, y - 0.002))
        .hinged("lower_door", [hinge, 0.0, z + BOARD_M], axis, 1.57)
        .part(leaf("upper_door", y + 0.002, h - 0.002))
        .hinged("upper_door", [hinge, 0.0, z + BOARD_M], axis, 1.57)
}

/// A rack of open cubes.
pub fn cube_shelf(style: &Style, key: RandomKey) -> Model {
    const NAMES: [[&str; 4]; 4] = [
        ["cube_1_1", "cube_1_2", "cube_1_3", "cube_1_4"],
        ["cube_2_1", "cube_2_2", "cube_2_3", "cube_2_4"],
        ["cube_3_1", "cube_3_2", "cube_3_3", "cube_3_4"],
        ["cube_4_1", "cube_4_2", "cube_4_3", "cube_4_4"],
    ];
    let d = SizeSampler::new("cube_shelf", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let count = |length: f32| ((length / 0.37).round() as usize).clamp(1, 4);
    let (columns, rows) = (count(w), count(h));
    let carcass = Carcass::standing(w, 0.0, h, depth);
    let share = |k: usize, n: usize| k as f32 / n as f32;
    let levels: Vec<f32> = (1..rows).map(|k| share(k, rows)).collect();
    let walls: Vec<f32> = (1..columns).map(|k| share(k, columns)).collect();
    let wood = style.any_wood(&mut d.stream("wood"));
    let body = PartBuilder::new("body").with_all(wood, carcass.boards(&levels, &walls));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let mut model =
        Model::fixed("cube_shelf", "shelving")
            .part(body)
            .top("top", [-x, h, -z], [x, h + 0.5, z]);
    for (row, names) in NAMES.iter().take(rows).enumerate() {
        let (low, high) = carcass.space(share(row, rows), share(row + 1, rows));
        for (column, name) in names.iter().take(columns).enumerate() {
            let left = -x + share(column, columns) * w + BOARD_M;
            let right = -x + share(column + 1, columns) * w - BOARD_M;
            model = model.top(name, [left, low[1], low[2]], [right, high[1], high[2]]);
        }
    }
    model
}

/// A rack of steel posts with boards: for a pantry, a cellar, a workshop loft.
pub fn metal_rack(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("metal_rack", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let steel = painted_steel("black_steel", [46, 46, 48]);
    let boards = if d.chance("wooden", 0.5) {
        style.wood.clone()
    } else {
        grey_board()
    };
    let mut body = PartBuilder::new("body");
    for (sx, sz) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let (a, b) = (sx * (x - 0.015), sz * (z - 0.015));
        let post = block([a - 0.015, 0.0, b - 0.015], [a + 0.015, h, b + 0.015]);
        body = body.with_filled(&steel, post, 0.2);
    }
    let levels = ((h / 0.4).round() as usize).clamp(3, SHELVES.len());
    let level = |k: usize| 0.08 + (h - 0.12) * k as f32 / (levels - 1) as f32;
    for k in 0..levels {
        let y = level(k);
        let board = block([-x + 0.03, y, -z + 0.002], [x - 0.03, y + 0.018, z - 0.002]);
        body = body.with(&boards, board);
    }
    let mut model = Model::fixed("metal_rack", "shelving").part(body);
    for (k, name) in SHELVES.into_iter().take(levels).enumerate() {
        let ceiling = if k + 1 < levels {
            level(k + 1)
        } else {
            h + 0.35
        };
        let low = [-x + 0.035, level(k) + 0.018, -z + 0.01];
        model = model.top(name, low, [x - 0.035, ceiling, z - 0.01]);
    }
    model
}

/// A chest to sit on; its lid turns up about the back edge.
pub fn storage_bench(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("storage_bench", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let (cushion, lid) = (0.05, 0.02);
    let under = h - cushion - lid;
    let wood = style.any_wood(&mut d.stream("wood"));
    let feet = style.legs([x - 0.06, z - 0.06], 0.06, 0.045);
    let low = 0.06;
    let body = PartBuilder::new("body")
        .with(wood, trough([-x, low, -z], [x, under, z], 0.02))
        .with_bars(style.leg_finish(), feet);
    let cover = style.cover(&mut d.stream("cover"));
    let top = PartBuilder::new("lid")
        .with(wood, block([-x, under + 0.001, -z], [x, under + lid, z]))
        .with_filled(
            cover,
            rounded_block(
                [-x + 0.005, under + lid, -z + 0.01],
                [x - 0.005, h, z - 0.005],
                0.02,
                2,
            ),
            0.4 * cover.padded(),
        );
    Model::articulated("storage_bench", "storage_bench")
        .part(body)
        .inside(
            "chest",
            [-x + 0.02, low + 0.02, -z + 0.02],
            [x - 0.02, under - 0.005, z - 0.02],
        )
        .part(top)
        .hinged("lid", [0.0, under + 0.001, -z], Vec3::NEG_X, 1.3)
        .top(
            "seat",
            [-x + 0.02, h, -z + 0.02],
            [x - 0.02, h + 0.5, z - 0.02],
        )
}

/// A steel safe with a keypad and a door.
pub fn safe(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("safe", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z, t) = (0.5 * w, 0.5 * depth, 0.03);
    let paint = d.of(
        "paint",
        [[70, 74, 78], [44, 52, 48], [96, 98, 100], [40, 42, 52]],
    );
    let steel = painted_steel("safe_paint", paint);
    let (back, face) = (-z, z - 0.03);
    let walls = [
        block([-x, 0.0, back], [x, t, face]),
        block([-x, h - t, back], [x, h, face]),
        block([-x, t, back], [-x + t, h - t, face]),
        block([x - t, t, back], [x, h - t, face]),
        block([-x + t, t, back], [x - t, h - t, back + t]),
    ];
    let body = walls
        .into_iter()
        .fold(PartBuilder::new("body"), |part, wall| {
            part.with_filled(&steel, wall, 0.3)
        });
    let knob = cylinder(0.12 * w, 0.02, 20).about_x(FRAC_PI_2);
    let leaf = block(
        [-x + 0.004, 0.004, face + 0.001],
        [x - 0.004, h - 0.004, z - 0.008],
    );
    let door = PartBuilder::new("door")
        .with_filled(&steel, leaf, 0.4)
        .with_filled(&chrome(), knob.at(0.2 * w, 0.5 * h, z - 0.012), 0.5)
        .with(
            &black(),
            block([-0.25 * w, 0.42 * h, z - 0.008], [-0.02 * w, 0.62 * h, z]),
        );
    Model::articulated("safe", "safe")
        .part(body)
        .inside(
            "inside",
            [-x + t, t, back + t],
            [x - t, h - t, face - 0.002],
        )
        .top("top", [-x, h, back], [x, h + 0.3, face])
        .part(door)
        .hinged("door", [-x + 0.004, 0.0, z - 0.008], Vec3::NEG_Y, 1.57)
}

/// A trolley on castors with two or three trays and a bar to push.
pub fn cart(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("serving_cart", key);
    let (w, h, depth) = (d.m("width"), d.m("height"), d.m("depth"));
    let (x, z) = (0.5 * w, 0.5 * depth);
    let levels = d.of("levels", [2, 3]);
    let brass_like = d.chance("brass", 0.3);
    let metal = if brass_like {
        brass()
    } else {
        style.metal.clone()
    };
    let mut body = PartBuilder::new("body");
    for (sx, sz) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let (a, b) = (sx * (x - 0.02), sz * (z - 0.02));
        let wheel = cylinder(0.03, 0.02, 16).about_z(FRAC_PI_2);
        body = body
            .with_filled(&metal, rod([a, 0.055, b], [a, h - 0.01, b], 0.01), 0.4)
            .with(&black(), wheel.at(a + 0.01, 0.03, b));
    }
    for side in [-1.0, 1.0] {
        let a = side * (x - 0.02);
        body = body.with_filled(
            &metal,
            rod([a, h - 0.01, -z + 0.02], [a, h - 0.01, z - 0.02], 0.01),
            0.4,
        );
    }
    let level = |k: usize| 0.12 + (h - 0.22) * k as f32 / (levels - 1) as f32;
    let wood = style.any_wood(&mut d.stream("wood"));
    for k in 0..levels {
        let y = level(k);
        body = body.with(
            wood,
            block([-x + 0.03, y, -z + 0.012], [x - 0.03, y + 0.018, z - 0.012]),
        );
    }
    let mut model = Model::movable("serving_cart", "cart").part(body);
    for (k, name) in SHELVES.into_iter().take(levels).enumerate() {
        let ceiling = if k + 1 < levels {
            level(k + 1)
        } else {
            h + 0.3
        };
        let low = [-x + 0.035, level(k) + 0.018, -z + 0.03];
        model = model.top(name, low, [x - 0.035, ceiling, z - 0.03]);
    }
    model
}
