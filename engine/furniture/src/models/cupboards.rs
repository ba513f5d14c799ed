//! A shoe cabinet, a larder and a safe.

use super::cabinet_parts::{BOARD_M, Carcass, GAP_M, SHELVES, door, horizontal_handle};
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{black_plastic, chrome, grey_board, painted_steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cylinder, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("shoe_cabinet", "shoes_cabinet", 28, shoe_cabinet),
    CatalogueEntry::new("safe", "safe", 30, safe),
    CatalogueEntry::new("larder", "kitchen_cabinet", 47, larder),
];

const FLAPS: [&str; 4] = ["flap_1", "flap_2", "flap_3", "flap_4"];

/// A flat cabinet for shoes; its flaps tilt forward about their lower edges.
fn shoe_cabinet(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("shoe_cabinet", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let rows = if h > 1.25 { 3 } else { 2 };
    let (x, top) = (0.5 * w, h - 0.02);
    let carcass = Carcass::floor_standing(w - 0.01, 0.05, top, depth - BOARD_M - 0.01);
    let z = carcass.max[2];
    let body = PartBuilder::new("body")
        .with(
            &style.wood,
            rounded_block([-x, top, carcass.min[2]], [x, h, z + BOARD_M], 0.004, 1),
        )
        .with(
            &black_plastic(),
            block(
                [-x + 0.03, 0.0, carcass.min[2] + 0.01],
                [x - 0.03, 0.05, z - 0.02],
            ),
        )
        .with_all(&style.front, carcass.boards(&[], &[]));
    let mut model = Model::articulated("shoe_cabinet", "shoes_cabinet")
        .part(body)
        .with_support_surface("top", [-x, h, carcass.min[2]], [x, h + 0.5, z + BOARD_M]);
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
                horizontal_handle(0.0, high - 0.05, z + BOARD_M, 0.06),
            );
        model = model
            .part(flap)
            .hinged(name, [0.0, low, z + BOARD_M], Vec3::X, 0.75);
        let shelf = carcass.max[1].min(high) - 0.03;
        model = model.with_container_space(
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
fn larder(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("larder", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let carcass = Carcass::floor_standing(w, 0.1, h, depth - BOARD_M);
    let (x, z) = (0.5 * w, carcass.max[2]);
    let split = 0.6;
    let body = PartBuilder::new("body")
        .with(
            &black_plastic(),
            block([-x, 0.0, carcass.min[2] + 0.02], [x, 0.1, z - 0.04]),
        )
        .with_all(&grey_board(), carcass.boards(&[0.2, 0.4, split, 0.8], &[]));
    let mut model = Model::articulated("larder", "kitchen_cabinet")
        .part(body)
        .with_support_surface("top", [-x, h, carcass.min[2]], [x, h + 0.3, z]);
    for (k, name) in SHELVES.into_iter().take(5).enumerate() {
        let (low, high) = carcass.space_between_shelves(0.2 * k as f32, 0.2 * (k + 1) as f32);
        model = model.with_container_space(name, low, high);
    }
    let y = carcass.min[1] + split * (h - carcass.min[1]);
    let left = d.chance("hinge", 0.5);
    let (hinge, axis) = if left {
        (-x, Vec3::NEG_Y)
    } else {
        (x, Vec3::Y)
    };
    let front = style.kitchen_front_style();
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

/// A steel safe with a keypad and a door.
fn safe(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("safe", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z, t) = (0.5 * w, 0.5 * depth, 0.03);
    let paint = d.choose(
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
            part.with_fill_fraction(&steel, wall, 0.3)
        });
    let knob = cylinder(0.12 * w, 0.02, 20).rotated_x(FRAC_PI_2);
    let leaf = block(
        [-x + 0.004, 0.004, face + 0.001],
        [x - 0.004, h - 0.004, z - 0.008],
    );
    let door = PartBuilder::new("door")
        .with_fill_fraction(&steel, leaf, 0.4)
        .with_fill_fraction(&chrome(), knob.translated(0.2 * w, 0.5 * h, z - 0.012), 0.5)
        .with(
            &black_plastic(),
            block([-0.25 * w, 0.42 * h, z - 0.008], [-0.02 * w, 0.62 * h, z]),
        );
    Model::articulated("safe", "safe")
        .part(body)
        .with_container_space(
            "inside",
            [-x + t, t, back + t],
            [x - t, h - t, face - 0.002],
        )
        .with_support_surface("top", [-x, h, back], [x, h + 0.3, face])
        .part(door)
        .hinged("door", [-x + 0.004, 0.0, z - 0.008], Vec3::NEG_Y, 1.57)
}
