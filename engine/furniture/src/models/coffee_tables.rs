//! Coffee tables: on four legs, round, or of glass.

use super::four_legged_table::Table;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, glass};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cylinder};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::TAU;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "coffee_table",
    "coffee_table",
    11,
    coffee_table,
)];

/// A low table before a sofa: with a shelf, round, or of glass on a frame of metal.
fn coffee_table(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("coffee_table", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let wood = style.random_wood(&mut d.stream("wood")).clone();
    match d.below("build", 3) {
        0 => Table {
            size_m: [w, depth],
            height_m: h,
            legs: style.leg_finish().clone(),
            shelf_m: Some(0.14),
            leg_m: 0.05,
            ..Table::coffee(wood)
        }
        .build(),
        1 => splayed_leg_table(
            SizeSampler::new("round_coffee_table", key).sample_m("width"),
            h,
            style,
            &wood,
        ),
        _ => glass_table(w, h, depth, style),
    }
}

/// A round top on four splayed legs.
fn splayed_leg_table(width_m: f32, height_m: f32, style: &Style, wood: &Finish) -> Model {
    let (r, under) = (0.5 * width_m, height_m - 0.03);
    let mut body =
        PartBuilder::new("body").with(wood, cylinder(r, 0.03, 36).translated(0.0, under, 0.0));
    for k in 0..4 {
        let (sin, cos) = dwell_scene::math::sin_cos(TAU * (k as f32 + 0.5) / 4.0);
        let leg = crate::shapes::tapered_leg(
            [0.82 * r * sin, 0.0, 0.82 * r * cos],
            [0.62 * r * sin, under, 0.62 * r * cos],
            0.026,
            0.042,
        );
        body = body.with(style.leg_finish(), leg);
    }
    let half = 0.68 * r;
    Model::movable("round_coffee_table", "coffee_table")
        .part(body)
        .with_support_surface(
            "top",
            [-half, height_m, -half],
            [half, height_m + 0.6, half],
        )
}

fn glass_table(w: f32, h: f32, depth: f32, style: &Style) -> Model {
    let (x, z, t) = (0.5 * w, 0.5 * depth, 0.014);
    let top = h - 0.01;
    let mut body = PartBuilder::new("body").with(&glass(), block([-x, top, -z], [x, h, z]));
    for (sx, sz) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let (a, b) = (sx * (x - 0.04), sz * (z - 0.04));
        body = body.with_fill_fraction(
            &style.metal,
            block([a - t, 0.0, b - t], [a + t, top, b + t]),
            0.3,
        );
    }
    for y in [0.02, top - 2.0 * t] {
        for side in [-1.0_f32, 1.0] {
            let (a, b) = (side * (x - 0.04), side * (z - 0.04));
            body = body
                .with_fill_fraction(
                    &style.metal,
                    block(
                        [-x + 0.04 + t, y, b - t],
                        [x - 0.04 - t, y + 2.0 * t, b + t],
                    ),
                    0.3,
                )
                .with_fill_fraction(
                    &style.metal,
                    block(
                        [a - t, y, -z + 0.04 + t],
                        [a + t, y + 2.0 * t, z - 0.04 - t],
                    ),
                    0.3,
                );
        }
    }
    Model::movable("coffee_table", "coffee_table")
        .part(body)
        .with_support_surface("top", [-x, h, -z], [x, h + 0.6, z])
}
