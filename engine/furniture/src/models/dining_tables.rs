//! Dining tables: on four legs, on a column, on trestles.

use super::four_legged_table::Table;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::Finish;
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cylinder, rounded_block, surface_of_revolution};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "dining_table",
    "dining_table",
    10,
    dining_table,
)];

/// A dining table: on four legs, on a column, or on trestles.
fn dining_table(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("dining_table", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let wood = style.random_wood(&mut d.stream("wood")).clone();
    match d.below("build", 4) {
        0 => column_table(
            "round_dining_table",
            "dining_table",
            SizeSampler::new("round_dining_table", key).sample_m("width"),
            h,
            style,
            &wood,
        ),
        1 => trestle_table(w, h, depth, style, &wood),
        _ => Table {
            size_m: [w, depth],
            height_m: h,
            leg_m: d.range("leg", 0.05, 0.08),
            top: wood,
            legs: style.leg_finish().clone(),
            ..Table::default()
        }
        .build(),
    }
}

/// A round top on one column with a foot.
pub(super) fn column_table(
    name: &'static str,
    category: &'static str,
    width_m: f32,
    height_m: f32,
    style: &Style,
    wood: &Finish,
) -> Model {
    let (r, h) = (0.5 * width_m, height_m);
    let foot = [
        (0.0, 0.0),
        (0.62 * r, 0.0),
        (0.62 * r, 0.02),
        (0.16 * r, 0.06),
        (0.09 * r, 0.4 * h),
        (0.16 * r, h - 0.03),
        (0.0, h - 0.03),
    ];
    let body = PartBuilder::new("body")
        .with_hollow(style.leg_finish(), surface_of_revolution(&foot, 24))
        .with(wood, cylinder(r, 0.03, 36).translated(0.0, h - 0.03, 0.0));
    let half = 0.68 * r;
    Model::movable(name, category)
        .part(body)
        .with_support_surface("top", [-half, h, -half], [half, h + 0.6, half])
}

fn trestle_table(w: f32, h: f32, depth: f32, style: &Style, wood: &Finish) -> Model {
    let (x, z, under) = (0.5 * w, 0.5 * depth, h - 0.04);
    let legs = style.leg_finish();
    let mut body =
        PartBuilder::new("body").with(wood, rounded_block([-x, under, -z], [x, h, z], 0.01, 1));
    for side in [-1.0_f32, 1.0] {
        let a = side * (x - 0.28);
        body = body
            .with_hollow(
                legs,
                block([a - 0.04, 0.0, -z + 0.08], [a + 0.04, 0.05, z - 0.08]),
            )
            .with_hollow(
                legs,
                block([a - 0.035, 0.05, -0.08], [a + 0.035, under - 0.04, 0.08]),
            )
            .with_hollow(
                legs,
                block(
                    [a - 0.04, under - 0.04, -z + 0.1],
                    [a + 0.04, under, z - 0.1],
                ),
            );
    }
    body = body.with_hollow(
        legs,
        block([-x + 0.315, 0.3, -0.02], [x - 0.315, 0.38, 0.02]),
    );
    Model::movable("dining_table", "dining_table")
        .part(body)
        .with_support_surface("top", [-x, h, -z], [x, h + 0.6, z])
}
