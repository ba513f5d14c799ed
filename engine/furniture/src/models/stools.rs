//! Stools, bar stools and ottomans.

use super::dining_chairs::CORNERS;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::Finish;
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{cylinder, rod, rounded_block, tapered_leg};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("stool", "stool", 4, sample_stool),
    CatalogueEntry::new("bar_stool", "stool", 5, bar_stool),
    CatalogueEntry::new("ottoman", "ottoman", 6, ottoman),
];

/// A round stool on four legs.
fn stool(height_m: f32, wood: &Finish, legs: &Finish) -> Model {
    let under = height_m - 0.035;
    let mut body =
        PartBuilder::new("body").with(wood, cylinder(0.17, 0.035, 26).translated(0.0, under, 0.0));
    for (x, z) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        body = body.with_hollow(
            legs,
            tapered_leg(
                [0.15 * x, 0.0, 0.15 * z],
                [0.09 * x, under, 0.09 * z],
                0.024,
                0.034,
            ),
        );
    }
    let bar = height_m * 0.3;
    let out = 0.13;
    body = body.with_all_hollow(
        legs,
        [
            rod([-out, bar, -out], [out, bar, -out], 0.009),
            rod([-out, bar, out], [out, bar, out], 0.009),
            rod([-out, bar, -out], [-out, bar, out], 0.009),
            rod([out, bar, -out], [out, bar, out], 0.009),
        ],
    );
    Model::movable("stool", "stool")
        .part(body)
        .with_support_surface(
            "seat",
            [-0.12, height_m, -0.12],
            [0.12, height_m + 0.4, 0.12],
        )
}

fn sample_stool(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("stool", key);
    let wood = style.random_wood(&mut d.stream("wood"));
    stool(d.sample_m("height"), wood, style.leg_finish())
}

/// A high stool for a counter, with a ring or bars for the feet.
fn bar_stool(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("bar_stool", key);
    let (w, h) = (d.sample_m("width"), d.sample_m("height"));
    let (out, inner, under) = (0.5 * w - 0.014, 0.32 * w, h - 0.05);
    let legs = style.leg_finish();
    let cover = style.random_upholstery(&mut d.stream("cover"));
    let mut body = PartBuilder::new("body");
    for (sx, sz) in CORNERS {
        let leg = tapered_leg(
            [sx * out, 0.0, sz * out],
            [sx * inner, under, sz * inner],
            0.026,
            0.03,
        );
        body = body.with_hollow(legs, leg);
    }
    let y = 0.32 * h;
    let r = out + (inner - out) * y / under;
    body = body.with_all_hollow(
        legs,
        [
            rod([-r, y, -r], [r, y, -r], 0.009),
            rod([-r, y, r], [r, y, r], 0.009),
            rod([-r, y, -r], [-r, y, r], 0.009),
            rod([r, y, -r], [r, y, r], 0.009),
        ],
    );
    body = if d.chance("round", 0.5) {
        body.with_fill_fraction(
            cover,
            cylinder(0.46 * w, 0.05, 24).translated(0.0, under, 0.0),
            0.5 * cover.padded_fill_fraction(),
        )
    } else {
        let s = 0.44 * w;
        body.with_fill_fraction(
            cover,
            rounded_block([-s, under, -s], [s, h, s], 0.018, 2),
            0.5 * cover.padded_fill_fraction(),
        )
    };
    let half = 0.3 * w;
    Model::movable("bar_stool", "stool")
        .part(body)
        .with_support_surface("seat", [-half, h, -half], [half, h + 0.4, half])
}

/// A round footstool of cloth.
fn pouf(radius_m: f32, height_m: f32, cloth: &Finish) -> Model {
    let (r, h) = (radius_m, height_m);
    let shape = [
        (0.0, 0.0),
        (0.86 * r, 0.0),
        (r, 0.18 * h),
        (1.02 * r, 0.5 * h),
        (r, 0.82 * h),
        (0.86 * r, h),
        (0.0, h),
    ];
    let body = PartBuilder::new("body")
        .with_padding(cloth, crate::shapes::surface_of_revolution(&shape, 28));
    let half = 0.5 * r;
    Model::movable("pouf", "ottoman")
        .part(body)
        .with_support_surface("top", [-half, h, -half], [half, h + 0.4, half])
}

fn ottoman(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("ottoman", key);
    let cover = style.random_upholstery(&mut d.stream("cover"));
    pouf(0.5 * d.sample_m("width"), d.sample_m("height"), cover)
}
