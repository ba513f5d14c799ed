//! Wall cabinets of fitted kitchens.

use super::cabinet_parts::{BOARD_M, Carcass, GAP_M, vertical_handle};
use super::kitchen_units::{DOORS, carcass_board};
use crate::catalogue_entry::CatalogueEntry;
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::block;
use crate::style::{FrontStyle, Style};
use dwell_scene::random::RandomKey;
use glam::Vec3;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new(
        "wall_cabinet",
        "hanging_kitchen_cabinet",
        44,
        sample_wall_cabinet,
    ),
    CatalogueEntry::new(
        "wall_cabinet_2",
        "hanging_kitchen_cabinet",
        45,
        two_door_wall_cabinet,
    ),
    CatalogueEntry::new(
        "wall_cabinet_3",
        "hanging_kitchen_cabinet",
        46,
        wall_cabinet_3,
    ),
];

const SHELVES: [[&str; 2]; 4] = [
    ["lower_shelf", "upper_shelf"],
    ["lower_shelf_2", "upper_shelf_2"],
    ["lower_shelf_3", "upper_shelf_3"],
    ["lower_shelf_4", "upper_shelf_4"],
];

/// Cabinets on the wall: `doors` doors of `door_m` width; y = 0 is their lower edge.
fn wall_cabinet(doors: usize, door_m: f32, height_m: f32, front: &FrontStyle) -> Model {
    const DEPTH_M: f32 = 0.34;
    let count = doors.clamp(1, DOORS.len());
    let x = 0.5 * door_m * count as f32;
    let carcass = Carcass {
        min: [-x, 0.0, 0.0],
        max: [x, height_m, DEPTH_M - BOARD_M],
    };
    let walls: Vec<f32> = (1..count).map(|k| k as f32 / count as f32).collect();
    let white = carcass_board();
    let (low, middle) = carcass.space_between_shelves(0.0, 0.5);
    let (upper, high) = carcass.space_between_shelves(0.5, 1.0);
    let mut model = Model::articulated("wall_cabinet", "hanging_kitchen_cabinet")
        .part(PartBuilder::new("body").with_all(&white, carcass.boards(&[0.5], &walls)));
    for (k, [lower, above]) in SHELVES.into_iter().take(count).enumerate() {
        let (a, b) = (
            -x + door_m * k as f32 + BOARD_M,
            -x + door_m * (k + 1) as f32 - BOARD_M,
        );
        model = model
            .with_container_space(lower, [a, low[1], low[2]], [b, middle[1], middle[2]])
            .with_container_space(above, [a, upper[1], upper[2]], [b, high[1], high[2]]);
    }
    let z = carcass.max[2];
    for (k, name) in DOORS.into_iter().take(count).enumerate() {
        let (a, b) = (-x + door_m * k as f32, -x + door_m * (k + 1) as f32);
        let hinge_left = k % 2 == 0;
        let face = [a + 0.5 * GAP_M, 0.002];
        let leaf = PartBuilder::new(name)
            .with(
                &front.board,
                block(
                    [face[0], face[1], z],
                    [b - 0.5 * GAP_M, height_m - 0.002, z + BOARD_M],
                ),
            )
            .with(
                &front.handle,
                vertical_handle(
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

fn cabinet(style: &Style, name: &'static str, key: RandomKey, doors: usize) -> Model {
    let d = SizeSampler::new(name, key);
    wall_cabinet(
        doors,
        d.sample_m("width") / doors as f32,
        d.sample_m("height"),
        &style.kitchen_front_style(),
    )
}

fn sample_wall_cabinet(style: &Style, key: RandomKey) -> Model {
    cabinet(style, "wall_cabinet", key, 1)
}

fn two_door_wall_cabinet(style: &Style, key: RandomKey) -> Model {
    cabinet(style, "wall_cabinet_2", key, 2)
}

fn wall_cabinet_3(style: &Style, key: RandomKey) -> Model {
    cabinet(style, "wall_cabinet_3", key, 3)
}
