//! Jars for provisions.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, glass, steel};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cylinder, vessel};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("jar", "containers", 162, sample_jar),
    CatalogueEntry::new("clip_jar", "containers", 163, clip_jar),
];

/// A round tin or storage jar with a lid.
fn jar(height_m: f32, body: &Finish, lid: &Finish) -> Model {
    let r = 0.32 * height_m;
    let part = PartBuilder::new("body")
        .with_fill_fraction(body, cylinder(r, 0.86 * height_m, 20), 0.2)
        .with_fill_fraction(
            lid,
            cylinder(r * 1.04, 0.14 * height_m, 20).translated(0.0, 0.86 * height_m, 0.0),
            0.15,
        );
    Model::pickable("jar", "containers").part(part)
}

fn sample_jar(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("jar", key);
    let lid = if d.chance("wood", 0.5) {
        style.wood.clone()
    } else {
        steel()
    };
    jar(
        d.sample_m("height"),
        style.random_glaze(&mut d.stream("glaze")),
        &lid,
    )
}

/// A jar for flour, tea or sweets; its lid turns up on a clip at the back.
fn clip_jar(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("clip_jar", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let (r, rim) = (0.5 * w, 0.86 * h);
    let stuff = if d.chance("glass", 0.5) {
        glass()
    } else {
        style.random_glaze(&mut d.stream("glaze")).clone()
    };
    let cover = if d.chance("wood", 0.5) {
        style.wood.clone()
    } else {
        stuff.clone()
    };
    let shell = vessel(
        &[
            (0.0, 0.0),
            (0.94 * r, 0.0),
            (r, 0.06 * h),
            (r, 0.97 * rim),
            (0.96 * r, rim),
        ],
        0.004,
        22,
    );
    let clip = block([-0.012, 0.9 * rim, -r - 0.006], [0.012, rim, -r]);
    let body = PartBuilder::new("body")
        .with(&stuff, shell)
        .with(&steel(), clip);
    let lid = PartBuilder::new("lid")
        .with(
            &cover,
            cylinder(r, 0.09 * h, 22).translated(0.0, rim + 0.001, 0.0),
        )
        .with(
            &cover,
            cylinder(0.25 * r, 0.045 * h, 14).translated(0.0, 0.955 * h, 0.0),
        );
    let half = 0.6 * r;
    Model::pickable("clip_jar", "containers")
        .part(body)
        .with_container_space("inside", [-half, 0.006, -half], [half, rim, half])
        .part(lid)
        .hinged("lid", [0.0, rim + 0.001, -r], Vec3::NEG_X, 1.5)
}
