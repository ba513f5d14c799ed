//! A light switch.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::plastic;
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::block;
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "light_switch",
    "switch",
    69,
    sample_light_switch,
)];

/// A light switch on the wall; y = 0 is its middle.
fn light_switch() -> Model {
    let white = plastic("white_plastic", [240, 240, 236]);
    let body = PartBuilder::new("body")
        .with(&white, block([-0.04, -0.04, 0.0], [0.04, 0.04, 0.008]))
        .with(
            &white,
            block([-0.028, -0.028, 0.008], [0.028, 0.028, 0.012]),
        );
    Model::fixed("light_switch", "switch").part(body)
}

fn sample_light_switch(_style: &Style, key: RandomKey) -> Model {
    light_switch().resized(SizeSampler::new("light_switch", key).sample_m("width") / 0.08)
}
