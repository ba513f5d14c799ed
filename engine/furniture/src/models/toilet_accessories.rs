//! Toilet paper and its holder, toilet brush, plunger.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, chrome, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{ball, block, cylinder, rod, surface_of_revolution, vessel};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("paper_holder", "toilet_paper", 78, sample_paper_holder),
    CatalogueEntry::new("toilet_roll", "toilet_paper", 79, toilet_roll),
    CatalogueEntry::new("toilet_brush", "toiletries", 80, toilet_brush),
    CatalogueEntry::new("plunger", "toilet_plunger", 81, plunger),
];

/// A holder on the wall with a roll of paper; y = 0 is the roll's axis.
fn paper_holder() -> Model {
    let roll = Finish::plain("tissue", "paper", [244, 243, 238]);
    let body = PartBuilder::new("body")
        .with(&chrome(), block([-0.085, -0.02, 0.0], [-0.07, 0.02, 0.07]))
        .with(&chrome(), rod([-0.08, 0.0, 0.06], [0.07, 0.0, 0.06], 0.007))
        .with_fill_fraction(
            &roll,
            cylinder(0.052, 0.1, 20)
                .rotated_z(FRAC_PI_2)
                .translated(0.06, 0.0, 0.06),
            0.3,
        );
    Model::fixed("paper_holder", "toilet_paper").part(body)
}

fn sample_paper_holder(_style: &Style, key: RandomKey) -> Model {
    paper_holder().resized(SizeSampler::new("paper_holder", key).sample_m("width") / 0.155)
}

/// A spare roll of toilet paper, standing.
fn toilet_roll(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("toilet_roll", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let tissue = Finish::plain(
        "tissue",
        "paper",
        d.choose("tone", [[244, 243, 238], [232, 222, 206], [236, 214, 214]]),
    );
    let core = Finish::plain("roll_core", "paper", [176, 146, 108]);
    let roll = cylinder(0.5 * w, h, 24);
    let body = PartBuilder::new("body")
        .with_fill_fraction(&tissue, roll, 0.22)
        .with(
            &core,
            cylinder(0.021, 0.0006, 16)
                .translated(0.0, h, 0.0)
                .visual_only(),
        );
    Model::pickable("toilet_roll", "toilet_paper").part(body)
}

/// A toilet brush in its holder.
fn toilet_brush(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("toilet_brush", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let holder = if d.chance("metal", 0.5) {
        style.metal.clone()
    } else {
        plastic("white_plastic", [240, 240, 236])
    };
    let r = 0.5 * w;
    let cup = vessel(&[(0.0, 0.0), (0.9 * r, 0.0), (r, 0.4 * h)], 0.004, 18);
    let body = PartBuilder::new("body")
        .with_fill_fraction(&holder, cup, 0.3)
        .with(
            &plastic("bristles", [226, 226, 222]),
            cylinder(0.62 * r, 0.2 * h, 16)
                .translated(0.0, 0.02, 0.0)
                .visual_only(),
        )
        .with(&holder, rod([0.0, 0.03, 0.0], [0.0, h - 0.02, 0.0], 0.007))
        .with(
            &black_plastic(),
            ball(0.012, 10).translated(0.0, h - 0.012, 0.0),
        );
    Model::movable("toilet_brush", "toiletries").part(body)
}

/// A plunger.
fn plunger(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("plunger", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let r = 0.5 * w;
    let rubber = Finish::plain(
        "plunger_rubber",
        "rubber",
        d.choose("tone", [[150, 52, 40], [34, 34, 36], [60, 90, 140]]),
    );
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &rubber,
            surface_of_revolution(
                &[
                    (0.0, 0.0),
                    (r, 0.0),
                    (0.95 * r, 0.3 * r),
                    (0.6 * r, 0.9 * r),
                    (0.25 * r, 1.2 * r),
                    (0.0, 1.2 * r),
                ],
                20,
            ),
            0.35,
        )
        .with(&style.wood, rod([0.0, 1.2 * r, 0.0], [0.0, h, 0.0], 0.011));
    Model::movable("plunger", "toilet_plunger").part(body)
}
