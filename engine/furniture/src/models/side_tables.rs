//! Side tables and console tables.

use super::dining_tables::column_table;
use super::four_legged_table::Table;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::Finish;
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{cylinder, tapered_leg};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("side_table", "table", 12, side_table),
    CatalogueEntry::new("console_table", "table", 13, console_table),
];

/// A small table beside a sofa or a chair.
fn side_table(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("side_table", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let wood = style.random_wood(&mut d.stream("wood")).clone();
    match d.below("build", 3) {
        0 => three_legged_table(0.5 * w, h, &wood),
        1 => column_table("side_table", "table", w, h, style, &wood),
        _ => Table {
            name: "side_table",
            category: "table",
            size_m: [w, w],
            height_m: h,
            top_m: 0.022,
            leg_m: 0.034,
            top: wood,
            legs: style.leg_finish().clone(),
            shelf_m: d.chance("shelf", 0.4).then_some(0.16),
        }
        .build(),
    }
}

/// A round side table on three legs.
fn three_legged_table(radius_m: f32, height_m: f32, wood: &Finish) -> Model {
    let under = height_m - 0.022;
    let mut body = PartBuilder::new("body").with(
        wood,
        cylinder(radius_m, 0.022, 28).translated(0.0, under, 0.0),
    );
    for k in 0..3 {
        let (sin, cos) = dwell_scene::math::sin_cos(std::f32::consts::TAU * k as f32 / 3.0);
        let (r0, r1) = (radius_m * 0.85, radius_m * 0.55);
        body = body.with(
            wood,
            tapered_leg(
                [r0 * sin, 0.0, r0 * cos],
                [r1 * sin, under, r1 * cos],
                0.022,
                0.036,
            ),
        );
    }
    let half = radius_m * 0.7;
    Model::movable("side_table", "table")
        .part(body)
        .with_support_surface(
            "top",
            [-half, height_m, -half],
            [half, height_m + 0.5, half],
        )
}

/// A narrow table for a hall or behind a sofa.
fn console_table(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("console_table", key);
    Table {
        name: "console_table",
        category: "table",
        size_m: [d.sample_m("width"), d.sample_m("depth")],
        height_m: d.sample_m("height"),
        top_m: 0.026,
        leg_m: 0.04,
        top: style.random_wood(&mut d.stream("wood")).clone(),
        legs: style.leg_finish().clone(),
        shelf_m: d.chance("shelf", 0.5).then_some(0.18),
    }
    .build()
}
