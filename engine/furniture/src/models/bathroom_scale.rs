//! A bathroom scale.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "scale",
    "weight_scale",
    85,
    sample_scale,
)];

/// A bathroom scale.
fn scale() -> Model {
    let body = PartBuilder::new("body")
        .with(
            &black_plastic(),
            block([-0.13, 0.0, -0.13], [0.13, 0.012, 0.13]),
        )
        .with(
            &Finish::plain("green_glass", "glass", [150, 186, 180]).transparent(1.0),
            rounded_block([-0.15, 0.012, -0.15], [0.15, 0.022, 0.15], 0.004, 1),
        )
        .with(
            &black_plastic(),
            block([-0.04, 0.022, -0.12], [0.04, 0.0225, -0.08]).visual_only(),
        );
    Model::movable("bathroom_scale", "weight_scale").part(body)
}

fn sample_scale(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("scale", key);
    let pane = Finish::plain(
        "scale_glass",
        "glass",
        d.choose(
            "tone",
            [
                [150, 186, 180],
                [230, 232, 232],
                [40, 42, 46],
                [196, 170, 170],
            ],
        ),
    )
    .transparent(1.0);
    scale()
        .resized(d.sample_m("width") / 0.3)
        .with_finish_replaced("green_glass", &pane)
}
