//! A bed with bars for a small child.

use super::bedding::foam_fill_fraction;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::cloth;
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cylinder, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new("cot", "baby_bed", 34, cot)];

/// A cot: bars all round a small mattress. The head is at -Z.
fn cot(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("cot", key);
    let (w, h, length) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * length);
    let wood = style.random_wood(&mut d.stream("wood"));
    let sheet = cloth(
        "cot_sheet",
        d.choose(
            "sheet",
            [
                [240, 238, 232],
                [214, 226, 236],
                [240, 226, 216],
                [226, 236, 220],
            ],
        ),
    );
    let base = 0.3;
    let post = |sx: f32, sz: f32| {
        let (a, b) = (sx * (x - 0.02), sz * (z - 0.02));
        block([a - 0.02, 0.0, b - 0.02], [a + 0.02, h, b + 0.02])
    };
    let side_rail = |sx: f32, y: f32| {
        let a = sx * (x - 0.02);
        block([a - 0.014, y, -z + 0.04], [a + 0.014, y + 0.035, z - 0.04])
    };
    let end = |sz: f32| {
        let b = sz * (z - 0.02);
        block(
            [-x + 0.04, base - 0.06, b - 0.01],
            [x - 0.04, h - 0.01, b + 0.01],
        )
    };
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let bars = |sx: f32| {
        let count = ((length - 0.08) / 0.075) as usize;
        (1..count).map(move |k| {
            let at = -z + 0.04 + (length - 0.08) * k as f32 / count as f32;
            // Square bars collide through the panel that stands for all of them.
            cylinder(0.008, h - base - 0.05, 6)
                .translated(sx * (x - 0.02), base - 0.02, at)
                .visual_only()
        })
    };
    let panel = |sx: f32| {
        let a = sx * (x - 0.02);
        block(
            [a - 0.008, base - 0.02, -z + 0.04],
            [a + 0.008, h - 0.035, z - 0.04],
        )
        .collision_only()
    };
    let body = PartBuilder::new("body")
        .with_all(wood, corners.map(|(a, b)| post(a, b)))
        .with_all(wood, [-1.0, 1.0].map(|s| side_rail(s, h - 0.04)))
        .with_all(wood, [-1.0, 1.0].map(|s| side_rail(s, base - 0.055)))
        .with_all(wood, [-1.0, 1.0].map(end))
        .with_all(wood, bars(-1.0).chain(bars(1.0)))
        .with_all(wood, [-1.0, 1.0].map(panel))
        .with(
            wood,
            block(
                [-x + 0.034, base - 0.05, -z + 0.03],
                [x - 0.034, base - 0.035, z - 0.03],
            ),
        )
        .with_fill_fraction(
            &sheet,
            rounded_block(
                [-x + 0.045, base - 0.035, -z + 0.04],
                [x - 0.045, base + 0.065, z - 0.04],
                0.03,
                2,
            ),
            foam_fill_fraction(&sheet),
        );
    Model::fixed("cot", "baby_bed")
        .part(body)
        .with_support_surface(
            "mattress",
            [-x + 0.06, base + 0.065, -z + 0.06],
            [x - 0.06, h, z - 0.06],
        )
}
