//! Knives, forks and spoons.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::steel;
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, extrude, loft, oval};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("knife", "knife", 169, knife),
    CatalogueEntry::new("fork", "fork", 170, fork),
    CatalogueEntry::new("spoon", "spoon", 171, spoon),
];

/// A knife, a fork or a spoon, seen as a bar with a head; it points towards -Z.
fn cutlery(name: &'static str) -> Model {
    let handle = block([-0.006, 0.0, 0.0], [0.006, 0.0035, 0.1]);
    let head = match name {
        "knife" => extrude(
            &[
                [-0.008, 0.0],
                [0.008, 0.0],
                [0.009, 0.06],
                [0.004, 0.1],
                [-0.005, 0.112],
                [-0.008, 0.108],
            ],
            0.0025,
        )
        .rotated_x(-std::f32::consts::FRAC_PI_2),
        "fork" => block([-0.004, 0.0, -0.05], [0.004, 0.003, 0.0])
            .merged(block([-0.012, 0.0, -0.06], [0.012, 0.003, -0.05]))
            .merged(block([-0.012, 0.0, -0.1], [-0.008, 0.003, -0.06]))
            .merged(block([-0.002, 0.0, -0.1], [0.002, 0.003, -0.06]))
            .merged(block([0.008, 0.0, -0.1], [0.012, 0.003, -0.06])),
        _ => block([-0.004, 0.0, -0.05], [0.004, 0.003, 0.0]).merged(loft(&[
            oval(0.01, 0.018, 0.0, -0.077, 14),
            oval(0.02, 0.03, 0.007, -0.077, 14),
        ])),
    };
    Model::pickable(name, name).part(PartBuilder::new("body").with(&steel(), handle.merged(head)))
}

fn knife(_style: &Style, key: RandomKey) -> Model {
    cutlery("knife").resized(SizeSampler::new("knife", key).sample_m("depth") / 0.21)
}

fn fork(_style: &Style, key: RandomKey) -> Model {
    cutlery("fork").resized(SizeSampler::new("fork", key).sample_m("depth") / 0.2)
}

fn spoon(_style: &Style, key: RandomKey) -> Model {
    cutlery("spoon").resized(SizeSampler::new("spoon", key).sample_m("depth") / 0.205)
}
