//! Shower cabins, heads and screens.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{chrome, glass, sanitary_ware};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cylinder, rod, rounded_block, tube};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("shower_cabin", "shower", 71, shower_cabin),
    CatalogueEntry::new("shower_head", "shower", 72, sample_shower_head),
    CatalogueEntry::new("shower_screen", "shower", 73, sample_shower_screen),
];

/// A shower in a corner: a tray, two panes of glass and a door of glass; walls behind it (-Z) and to its left (-X).
fn shower_cabin(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("shower_cabin", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let metal = if d.chance("metal", 0.4) {
        style.metal.clone()
    } else {
        chrome()
    };
    let (t, step) = (0.008, 0.05);
    let half = 0.012;
    let face = z - 0.02;
    let head = h - 0.08;
    let split = -x + 0.42 * w;
    let post = |a: f32, b: f32| block([a - half, step, b - half], [a + half, h, b + half]);
    let pipe = tube(
        &[
            [-0.2 * w, 1.0, -z + 0.04],
            [-0.2 * w, head - 0.05, -z + 0.04],
            [-0.2 * w, head, -z + 0.09],
            [-0.2 * w, head, -z + 0.3],
        ],
        0.011,
        8,
    );
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &sanitary_ware(),
            rounded_block([-x, 0.0, -z], [x, step, z], 0.012, 1),
            0.3,
        )
        .with(
            &chrome(),
            cylinder(0.045, 0.002, 16)
                .translated(0.0, step, 0.0)
                .visual_only(),
        )
        .with(
            &glass(),
            block(
                [x - 0.02 - 0.5 * t, step, -z + 0.01],
                [x - 0.02 + 0.5 * t, h - 0.01, face - half],
            ),
        )
        .with(
            &glass(),
            block(
                [-x + 0.01, step, face - 0.5 * t],
                [split, h - 0.01, face + 0.5 * t],
            ),
        )
        .with_fill_fraction(&metal, post(x - 0.02, face), 0.3)
        .with_fill_fraction(
            &metal,
            block(
                [-x, h - 0.01, face - half],
                [x - 0.02 - half, h, face + half],
            ),
            0.3,
        )
        .with_fill_fraction(
            &metal,
            block(
                [x - 0.02 - half, h - 0.01, -z],
                [x - 0.02 + half, h, face - half],
            ),
            0.3,
        )
        .with(&chrome(), pipe)
        .with(
            &chrome(),
            rod([-0.2 * w, 1.05, -z], [-0.2 * w, 1.05, -z + 0.05], 0.03),
        )
        .with(
            &chrome(),
            cylinder(0.11, 0.012, 24).translated(-0.2 * w, head - 0.024, -z + 0.3),
        );
    let (a, b) = (split + 0.006, x - 0.02 - half - 0.004);
    let door = PartBuilder::new("door")
        .with(
            &glass(),
            block(
                [a, step + 0.01, face - 0.5 * t],
                [b, h - 0.015, face + 0.5 * t],
            ),
        )
        .with(
            &chrome(),
            rod(
                [a + 0.04, 0.95, face + 0.03],
                [a + 0.04, 1.2, face + 0.03],
                0.008,
            ),
        )
        .with(
            &chrome(),
            rod([a + 0.04, 1.0, face], [a + 0.04, 1.0, face + 0.03], 0.006).visual_only(),
        )
        .with(
            &chrome(),
            rod([a + 0.04, 1.15, face], [a + 0.04, 1.15, face + 0.03], 0.006).visual_only(),
        );
    Model::articulated("shower_cabin", "shower")
        .with_switch_state(false)
        .part(body)
        .with_sound([-0.2 * w, head - 0.03, -z + 0.3], "tap", 66.0)
        .with_container_space(
            "floor",
            [-x + 0.05, step + 0.004, -z + 0.12],
            [x - 0.05, 0.9, face - 0.03],
        )
        .part(door)
        .hinged("door", [b, 0.0, face + 0.5 * t], Vec3::Y, 1.5)
}

/// A pane of glass on the rim of a tub, from the wall at z = 0 outwards; y = 0 is the rim.
fn shower_screen(width_m: f32, height_m: f32) -> Model {
    let body = PartBuilder::new("body")
        .with(
            &glass(),
            block([-0.004, 0.0, 0.02], [0.004, height_m, width_m]),
        )
        .with(
            &chrome(),
            block([-0.008, 0.0, 0.0], [0.008, height_m, 0.02]),
        )
        .with(
            &chrome(),
            block([-0.006, height_m, 0.0], [0.006, height_m + 0.012, width_m]),
        );
    Model::fixed("shower_screen", "shower").part(body)
}

fn sample_shower_screen(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("shower_screen", key);
    shower_screen(d.sample_m("depth"), d.sample_m("height"))
}

/// A shower head on a rail on the wall; y = 0 is the rail's foot.
fn shower_head() -> Model {
    let rail = tube(
        &[
            [0.0, 0.0, 0.04],
            [0.0, 1.2, 0.04],
            [0.0, 1.33, 0.09],
            [0.0, 1.33, 0.2],
        ],
        0.011,
        8,
    );
    let hold = |y: f32| rod([0.0, y, 0.0], [0.0, y, 0.03], 0.012);
    let head = cylinder(0.1, 0.012, 24).translated(0.0, 1.31, 0.2);
    let mixer = rod([-0.09, 0.08, 0.05], [0.09, 0.08, 0.05], 0.022);
    let body =
        PartBuilder::new("body").with_all(&chrome(), [rail, hold(0.08), hold(1.0), head, mixer]);
    Model::fixed("shower_head", "shower").part(body)
}

fn sample_shower_head(_style: &Style, key: RandomKey) -> Model {
    shower_head().resized(SizeSampler::new("shower_head", key).sample_m("height") / 1.33)
}
