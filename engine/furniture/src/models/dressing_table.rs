//! A dressing table with drawers and a mirror.

use super::cabinet_parts::{BOARD_M, Carcass, GAP_M, drawer, drawer_space};
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::mirror;
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cylinder, frame, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "dressing_table",
    "dressing_table",
    15,
    dressing_table,
)];

/// A table with a mirror and two drawers, to make oneself up at.
fn dressing_table(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("dressing_table", key);
    let (w, h, depth, table) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
        d.sample_m("table"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let wood = style.random_wood(&mut d.stream("wood"));
    let carcass = Carcass {
        min: [-x + 0.005, table - 0.15, -z + 0.005],
        max: [x - 0.005, table - 0.02, z - BOARD_M],
    };
    let face = carcass.max[2];
    let mut body = PartBuilder::new("body")
        .with(
            wood,
            rounded_block([-x, table - 0.02, -z], [x, table, z], 0.006, 1),
        )
        .with_all(wood, carcass.boards(&[], &[0.5]))
        .with_all_hollow(
            style.leg_finish(),
            style.legs([x - 0.04, z - 0.05], table - 0.15, 0.045),
        );
    let round = d.chance("round", 0.4);
    let tall = h - table;
    if round {
        let r = 0.5 * tall - 0.03;
        let disc = |radius: f32, from: f32, deep: f32| {
            cylinder(radius, deep, 32).rotated_x(FRAC_PI_2).translated(
                0.0,
                table + 0.03 + 0.5 * tall - 0.015,
                from,
            )
        };
        body = body
            .with(wood, disc(r + 0.015, -z + 0.02, 0.02))
            .with(&mirror(), disc(r, -z + 0.04, 0.004))
            .with(
                wood,
                block([-0.06, table, -z + 0.01], [0.06, table + 0.05, -z + 0.02]),
            )
            .with(
                wood,
                block([-0.06, table, -z + 0.04], [0.06, table + 0.03, -z + 0.06]),
            );
    } else {
        let wide = (0.7 * w).min(0.8);
        body = body
            .with(
                wood,
                frame(wide, tall, 0.03, 0.02).translated(0.0, table + 0.5 * tall, -z + 0.01),
            )
            .with(
                &mirror(),
                block(
                    [-0.5 * wide + 0.03, table + 0.03, -z + 0.014],
                    [0.5 * wide - 0.03, h - 0.03, -z + 0.026],
                ),
            );
    }
    let mut model = Model::articulated("dressing_table", "dressing_table")
        .part(body)
        .with_support_surface("top", [-x, table, -z + 0.07], [x, table + 0.5, z]);
    let front = style.front_style();
    for (name, a, b) in [
        ("left_drawer", -x + 0.007, -0.5 * GAP_M),
        ("right_drawer", 0.5 * GAP_M, x - 0.007),
    ] {
        let (low, high) = ([a, table - 0.148], [b, table - 0.024]);
        let (min, max) = drawer_space(low, high, face, depth - 0.1);
        model = model
            .part(drawer(name, low, high, face, depth - 0.1, &front))
            .sliding(name, Vec3::Z, 0.6 * (depth - 0.1))
            .with_container_space(name, min, max);
    }
    model
}
