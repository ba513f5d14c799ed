//! An office chair on castors.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, chrome};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{ball, block, cushion, cylinder, rod, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::TAU;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "office_chair",
    "office_chair",
    3,
    sample_office_chair,
)];

/// A swivel chair on five castors.
fn office_chair(cloth: &Finish) -> Model {
    let dark = black_plastic();
    let mut body = PartBuilder::new("body").with(
        &chrome(),
        cylinder(0.025, 0.34, 14).translated(0.0, 0.09, 0.0),
    );
    for k in 0..5 {
        let (sin, cos) = dwell_scene::math::sin_cos(TAU * k as f32 / 5.0);
        let (x, z) = (0.28 * sin, 0.28 * cos);
        body = body
            .with(&dark, rod([0.0, 0.1, 0.0], [x, 0.07, z], 0.016))
            .with(&dark, ball(0.03, 12).translated(x, 0.03, z));
    }
    let body = body
        .with(&dark, block([-0.2, 0.43, -0.2], [0.2, 0.445, 0.2]))
        .with_fill_fraction(
            cloth,
            cushion([-0.24, 0.445, -0.23], [0.24, 0.52, 0.25]),
            0.7 * cloth.padded_fill_fraction(),
        )
        .with(&dark, block([-0.03, 0.43, -0.27], [0.03, 0.72, -0.245]))
        .with_fill_fraction(
            cloth,
            cushion([-0.22, 0.62, -0.245], [0.22, 1.08, -0.175]),
            0.7 * cloth.padded_fill_fraction(),
        );
    let mut body = body;
    for side in [-1.0, 1.0] {
        body = body
            .with(
                &dark,
                block(
                    [side * 0.26 - 0.012, 0.43, -0.04],
                    [side * 0.26 + 0.012, 0.66, 0.0],
                ),
            )
            .with(
                &dark,
                block(
                    [side * 0.23 - 0.03, 0.43, -0.04],
                    [side * 0.23 + 0.03, 0.445, 0.0],
                ),
            )
            .with(
                &dark,
                rounded_block(
                    [side * 0.26 - 0.03, 0.66, -0.12],
                    [side * 0.26 + 0.03, 0.69, 0.14],
                    0.012,
                    1,
                ),
            );
    }
    Model::movable("office_chair", "office_chair")
        .part(body)
        .with_support_surface("seat", [-0.2, 0.52, -0.16], [0.2, 0.9, 0.22])
}

fn sample_office_chair(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("office_chair", key);
    office_chair(style.random_upholstery(&mut d.stream("cover")))
        .resized(d.sample_m("height") / 1.08)
}
