//! A lawn mower.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, painted_steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{cylinder, rounded_block, tube};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "lawn_mower",
    "lawn_mower",
    151,
    lawn_mower,
)];

/// A lawn mower with its handle bar to the back (-Z).
fn lawn_mower(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("lawn_mower", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let deck = painted_steel(
        "mower_deck",
        d.choose(
            "tone",
            [[190, 40, 36], [50, 120, 60], [226, 120, 30], [60, 90, 140]],
        ),
    );
    let wheel = |sx: f32, b: f32| {
        cylinder(0.09, 0.04, 18)
            .rotated_z(FRAC_PI_2)
            .translated(sx * (x - 0.02) + 0.02, 0.09, b)
    };
    let (front, rear) = (z - 0.11, z - 0.62);
    let bag = Finish::plain("grass_bag", "textile", [60, 62, 64]);
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &deck,
            rounded_block(
                [-x + 0.045, 0.06, rear - 0.05],
                [x - 0.045, 0.22, z],
                0.04,
                2,
            ),
            0.1,
        )
        .with_fill_fraction(
            &black_plastic(),
            cylinder(0.13, 0.14, 20).translated(0.0, 0.22, 0.5 * (front + rear) + 0.06),
            0.8,
        )
        .with_all(
            &black_plastic(),
            [
                wheel(-1.0, front),
                wheel(1.0, front),
                wheel(-1.0, rear),
                wheel(1.0, rear),
            ],
        )
        .with_fill_fraction(
            &bag,
            rounded_block(
                [-x + 0.08, 0.1, rear - 0.5],
                [x - 0.08, 0.4, rear - 0.05],
                0.06,
                2,
            ),
            0.04,
        )
        .with_fill_fraction(
            &black_plastic(),
            tube(
                &[
                    [-x + 0.06, 0.2, rear],
                    [-x + 0.06, h - 0.012, -z + 0.012],
                    [x - 0.06, h - 0.012, -z + 0.012],
                    [x - 0.06, 0.2, rear],
                ],
                0.012,
                8,
            ),
            0.6,
        );
    Model::movable("lawn_mower", "lawn_mower")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, 0.3, front], "noise", 88.0)
}
