//! A garden table and a parasol.

use super::four_legged_table::Table;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, plastic, teak};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{loft, rod, surface_of_revolution};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::TAU;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("garden_table", "table", 147, garden_table),
    CatalogueEntry::new("parasol", "umbrella", 148, parasol),
];

/// A table for balcony or terrace.
fn garden_table(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("garden_table", key);
    let plastic_top = plastic("garden_plastic", [236, 236, 230]);
    let top = if d.chance("plastic", 0.25) {
        plastic_top
    } else {
        teak()
    };
    Table {
        name: "garden_table",
        category: "table",
        size_m: [d.sample_m("width"), d.sample_m("depth")],
        height_m: d.sample_m("height"),
        legs: if d.chance("metal", 0.5) {
            style.metal.clone()
        } else {
            top.clone()
        },
        top,
        leg_m: 0.05,
        ..Table::default()
    }
    .build()
}

/// A parasol on a heavy foot, open.
fn parasol(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("parasol", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let r = 0.5 * w;
    let cover = style.random_cloth(&mut d.stream("cover"));
    let stone = Finish::plain("parasol_foot", "concrete", [150, 148, 144]);
    // A ring of eight corners, a tip above, and the same again a hand below: thin cloth, closed.
    let ring = |radius: f32, y: f32| -> Vec<Vec3> {
        (0..8)
            .map(|k| {
                let (sin, cos) = dwell_scene::math::sin_cos(TAU * k as f32 / 8.0);
                Vec3::new(radius * sin, y, radius * cos)
            })
            .collect()
    };
    let roof = loft(&[ring(r, h - 0.42), ring(0.02, h - 0.05)]);
    let post = if d.chance("wood", 0.5) {
        style.wood.clone()
    } else {
        style.metal.clone()
    };
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &stone,
            surface_of_revolution(
                &[
                    (0.0, 0.0),
                    (0.24, 0.0),
                    (0.24, 0.05),
                    (0.06, 0.08),
                    (0.0, 0.08),
                ],
                24,
            ),
            0.5,
        )
        .with_fill_fraction(&post, rod([0.0, 0.08, 0.0], [0.0, h, 0.0], 0.02), 0.4)
        .with_fill_fraction(cover, roof, 0.008);
    Model::movable("parasol", "umbrella").part(body)
}
