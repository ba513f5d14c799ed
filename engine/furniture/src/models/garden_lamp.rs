//! A garden lamp.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{milk_glass, painted_steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{cylinder, surface_of_revolution};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "garden_lamp",
    "outdoor_lamp",
    150,
    garden_lamp,
)];

/// A lamp on a post beside a path.
fn garden_lamp(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("garden_lamp", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let r = 0.5 * w;
    let iron = painted_steel(
        "lamp_iron",
        d.choose("tone", [[36, 38, 38], [70, 80, 76], [150, 150, 152]]),
    );
    let head = h - 1.9 * r;
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &iron,
            surface_of_revolution(
                &[
                    (0.0, 0.0),
                    (0.9 * r, 0.0),
                    (0.7 * r, 0.06),
                    (0.25 * r, 0.12),
                    (0.2 * r, head),
                    (0.0, head),
                ],
                18,
            ),
            0.35,
        )
        .with_fill_fraction(
            &iron,
            cylinder(0.75 * r, 0.02, 18).translated(0.0, head, 0.0),
            0.8,
        )
        .with_fill_fraction(
            &milk_glass(),
            cylinder(0.65 * r, 1.2 * r, 18).translated(0.0, head + 0.02, 0.0),
            0.15,
        )
        .with_fill_fraction(
            &iron,
            surface_of_revolution(
                &[(0.0, 0.0), (r, 0.0), (0.35 * r, 0.45 * r), (0.0, 0.6 * r)],
                18,
            )
            .translated(0.0, head + 0.02 + 1.2 * r, 0.0),
            0.3,
        );
    Model::fixed("garden_lamp", "outdoor_lamp")
        .with_switch_state(true)
        .part(body)
        .with_light([0.0, h + 0.05, 0.0], 8.0)
}
