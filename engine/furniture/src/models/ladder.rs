//! A stepladder.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::Finish;
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::block;
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] =
    &[CatalogueEntry::new("ladder", "ladder", 140, ladder)];

/// A stepladder, opened out.
fn ladder(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("ladder", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let alloy = Finish::plain(
        "ladder_alloy",
        "aluminium",
        d.choose("tone", [[196, 198, 202], [214, 160, 60], [170, 60, 50]]),
    );
    let leg = |from: [f32; 3], to: [f32; 3]| crate::shapes::tapered_leg(from, to, 0.03, 0.03);
    let mut body = PartBuilder::new("body");
    for side in [-1.0_f32, 1.0] {
        let a = side * (x - 0.02);
        let b = side * (x - 0.045);
        body = body
            .with_fill_fraction(&alloy, leg([a, 0.0, z - 0.02], [b, h - 0.03, 0.05]), 0.25)
            .with_fill_fraction(&alloy, leg([a, 0.0, -z + 0.02], [b, h - 0.03, -0.1]), 0.25);
    }
    let steps = ((h / 0.24) as usize).max(2);
    for k in 1..steps {
        let share = k as f32 / steps as f32;
        let (y, at) = (share * h, (z - 0.02) * (1.0 - share) + 0.05 * share);
        let half = x - 0.04 - 0.025 * share;
        body = body.with_fill_fraction(
            &alloy,
            block([-half, y - 0.02, at - 0.045], [half, y, at + 0.045]),
            0.3,
        );
    }
    let body = body.with_fill_fraction(
        &alloy,
        block([-x + 0.03, h - 0.03, -0.13], [x - 0.03, h, 0.1]),
        0.4,
    );
    Model::movable("stepladder", "ladder").part(body)
}
