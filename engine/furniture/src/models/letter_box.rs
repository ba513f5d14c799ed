//! A letter box.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, painted_steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{SolidMesh, block};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "letter_box",
    "mailbox",
    152,
    letter_box,
)];

/// A letter box on the wall; its flap turns up. y = 0 is its lower edge.
fn letter_box(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("letter_box", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let x = 0.5 * w;
    let paint = painted_steel(
        "letter_box_paint",
        d.choose(
            "tone",
            [
                [40, 44, 48],
                [170, 36, 38],
                [226, 190, 60],
                [70, 96, 82],
                [230, 230, 226],
            ],
        ),
    );
    let t = 0.008;
    let face = depth - 0.012;
    let shell = [
        block([-x, 0.0, 0.0], [x, t, face]),
        block([-x, t, 0.0], [-x + t, h - 0.02, face]),
        block([x - t, t, 0.0], [x, h - 0.02, face]),
        block([-x + t, t, 0.0], [x - t, h - 0.02, t]),
        block([-x + t, t, face - t], [x - t, 0.72 * h, face]),
    ];
    let plate = Finish::plain("name_plate", "paper", [236, 234, 226]);
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &paint,
            shell
                .into_iter()
                .fold(SolidMesh::default(), SolidMesh::merged),
            0.15,
        )
        .with(
            &plate,
            block([-0.2 * w, 0.3 * h, face], [0.2 * w, 0.4 * h, face + 0.002]).visual_only(),
        );
    let flap = PartBuilder::new("flap").with_fill_fraction(
        &paint,
        block([-x, h - 0.018, 0.004], [x, h, depth]),
        0.3,
    );
    Model::articulated("letter_box", "mailbox")
        .part(body)
        .with_container_space("inside", [-x + t, t, t], [x - t, 0.72 * h, face - t])
        .part(flap)
        .hinged("flap", [0.0, h - 0.018, 0.004], Vec3::NEG_X, 1.2)
}
