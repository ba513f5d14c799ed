//! Laundry baskets, waste bins and storage boxes.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, rattan};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, surface_of_revolution, torus, vessel};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("laundry_basket", "basket", 86, sample_laundry_basket),
    CatalogueEntry::new("waste_bin", "trash_can", 87, waste_bin),
    CatalogueEntry::new("storage_box", "box", 191, storage_box),
];

/// Opening angle of the lids of bins, rad: beyond upright, so that they stay up.
const LID_RAD: f32 = 1.6;

/// A basket for laundry with a lid that turns up.
fn laundry_basket() -> Model {
    let (r, h) = (0.2, 0.55);
    let woven = vessel(&[(0.0, 0.0), (0.88 * r, 0.0), (r, h)], 0.008, 24);
    let body = PartBuilder::new("body").with_fill_fraction(&rattan(), woven, 0.6);
    let (low, high) = (h + 0.001, h + 0.02);
    let cover = surface_of_revolution(
        &[
            (0.0, low),
            (1.04 * r, low),
            (1.04 * r, high),
            (0.0, high + 0.012),
        ],
        24,
    );
    let grip = torus(0.04, 0.006, 14)
        .rotated_x(FRAC_PI_2)
        .translated(0.0, h + 0.06, 0.0);
    let lid = PartBuilder::new("lid")
        .with_fill_fraction(&rattan(), cover, 0.3)
        .with(&rattan(), grip);
    let half = 0.58 * r;
    Model::movable("laundry_basket", "basket")
        .part(body)
        .with_container_space("inside", [-half, 0.008, -half], [half, h, half])
        .part(lid)
        .hinged("lid", [0.0, low, -r], Vec3::NEG_X, LID_RAD)
}

fn sample_laundry_basket(_style: &Style, key: RandomKey) -> Model {
    laundry_basket().resized(SizeSampler::new("laundry_basket", key).sample_m("height") / 0.6)
}

/// A bin with a pedal and a lid that turns up.
fn pedal_bin(height_m: f32, color: &Finish) -> Model {
    const WALL_M: f32 = 0.004;
    let r = 0.3 * height_m;
    let (z, h) = (0.85 * r, height_m);
    let rim = 0.9 * h;
    let pail = vessel(&[(0.0, 0.0), (r, 0.0), (r, rim)], WALL_M, 26);
    let body = PartBuilder::new("body")
        .with_fill_fraction(color, pail, 0.35)
        .with(
            &black_plastic(),
            block([-0.03, 0.01, z], [0.03, 0.02, z + 0.06]).visual_only(),
        );
    let low = rim + 0.001;
    let cover = surface_of_revolution(
        &[
            (0.0, low),
            (1.02 * r, low),
            (1.0 * r, 0.95 * h),
            (0.6 * r, 0.99 * h),
            (0.0, h),
        ],
        26,
    );
    let half = 0.6 * r;
    Model::movable("trash_can", "trash_can")
        .part(body)
        .with_container_space("inside", [-half, WALL_M, -half], [half, rim, half])
        .part(PartBuilder::new("lid").with_fill_fraction(&black_plastic(), cover, 0.1))
        .hinged("lid", [0.0, low, -r], Vec3::NEG_X, LID_RAD)
}

fn waste_bin(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("waste_bin", key);
    let tone = style.random_cloth(&mut d.stream("tone")).srgb;
    let metal = Finish {
        substance: "steel",
        ..style.metal.clone()
    };
    let color = if d.chance("metal", 0.5) {
        metal
    } else {
        Finish::plain("bin_paint", "steel", tone)
    };
    pedal_bin(d.sample_m("height"), &color)
}

/// A box of card or wood without a lid.
fn open_box(size_m: [f32; 3], material: &Finish) -> Model {
    let [w, h, d] = size_m;
    let (x, z, t) = (0.5 * w, 0.5 * d, 0.01);
    let walls = [
        block([-x, 0.0, -z], [x, t, z]),
        block([-x, t, -z], [-x + t, h, z]),
        block([x - t, t, -z], [x, h, z]),
        block([-x + t, t, -z], [x - t, h, -z + t]),
        block([-x + t, t, z - t], [x - t, h, z]),
    ];
    Model::pickable("storage_box", "box")
        .part(PartBuilder::new("body").with_all(material, walls))
        .with_container_space("inside", [-x + t, t, -z + t], [x - t, h, z - t])
}

fn storage_box(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("storage_box", key);
    let card = Finish::plain(
        "storage_card",
        "paper",
        d.choose(
            "card",
            [
                [176, 138, 96],
                [226, 222, 212],
                [96, 120, 140],
                [150, 150, 148],
            ],
        ),
    );
    let stuff = if d.chance("card", 0.5) {
        card
    } else {
        style.random_wood(&mut d.stream("wood")).clone()
    };
    open_box(
        [
            d.sample_m("width"),
            d.sample_m("height"),
            d.sample_m("depth"),
        ],
        &stuff,
    )
}
