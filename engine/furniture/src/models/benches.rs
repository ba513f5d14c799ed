//! Benches: at a table, for putting on shoes, with a chest under the seat.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::Finish;
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, open_top_box, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("bench", "bench_chair", 7, bench),
    CatalogueEntry::new("shoe_bench", "bench_chair", 8, sample_shoe_bench),
    CatalogueEntry::new("storage_bench", "storage_bench", 9, storage_bench),
];

/// A plain bench: for a long table, a hall or the foot of a bed.
fn bench(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("bench", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let padded = d.chance("padded", 0.4);
    let board = if padded { h - 0.05 } else { h };
    let wood = style.random_wood(&mut d.stream("wood"));
    let mut body = PartBuilder::new("body")
        .with(
            wood,
            rounded_block([-x, board - 0.035, -z], [x, board, z], 0.008, 1),
        )
        .with(
            wood,
            block(
                [-x + 0.08, board - 0.1, -0.012],
                [x - 0.08, board - 0.035, 0.012],
            ),
        )
        .with_all_hollow(
            style.leg_finish(),
            style.legs([x - 0.06, z - 0.05], board - 0.035, 0.05),
        );
    if padded {
        let pad = rounded_block(
            [-x + 0.004, board, -z + 0.004],
            [x - 0.004, h, z - 0.004],
            0.02,
            2,
        );
        let cover = style.random_upholstery(&mut d.stream("cover"));
        body = body.with_fill_fraction(cover, pad, 0.4 * cover.padded_fill_fraction());
    }
    Model::movable("bench", "bench_chair")
        .part(body)
        .with_support_surface(
            "seat",
            [-x + 0.02, h, -z + 0.02],
            [x - 0.02, h + 0.45, z - 0.02],
        )
}

/// A bench with a shelf for shoes and a cushion.
fn shoe_bench(width_m: f32, wood: &Finish, cloth: &Finish) -> Model {
    let (x, z, h) = (0.5 * width_m, 0.17, 0.43);
    let slat = |k: usize| {
        let a = -z + 0.02 + 0.08 * k as f32;
        block([-x + 0.025, 0.14, a], [x - 0.025, 0.158, a + 0.055])
    };
    let body = PartBuilder::new("body")
        .with(wood, block([-x, 0.0, -z], [-x + 0.025, h, z]))
        .with(wood, block([x - 0.025, 0.0, -z], [x, h, z]))
        .with(wood, block([-x + 0.025, h - 0.025, -z], [x - 0.025, h, z]))
        .with_all(wood, (0..4).map(slat))
        .with_fill_fraction(
            cloth,
            rounded_block(
                [-x + 0.01, h, -z + 0.01],
                [x - 0.01, h + 0.05, z - 0.01],
                0.02,
                2,
            ),
            0.5 * cloth.padded_fill_fraction(),
        );
    Model::movable("shoe_bench", "bench_chair")
        .part(body)
        .with_support_surface(
            "seat",
            [-x + 0.02, h + 0.05, -z + 0.02],
            [x - 0.02, h + 0.5, z - 0.02],
        )
        .with_support_surface(
            "shelf",
            [-x + 0.03, 0.158, -z + 0.02],
            [x - 0.03, h - 0.03, z],
        )
}

fn sample_shoe_bench(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("shoe_bench", key);
    let (wood, cloth) = (
        style.random_wood(&mut d.stream("wood")),
        style.random_cloth(&mut d.stream("cloth")),
    );
    shoe_bench(d.sample_m("width"), wood, cloth)
}

/// A chest to sit on; its lid turns up about the back edge.
fn storage_bench(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("storage_bench", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let (cushion, lid) = (0.05, 0.02);
    let under = h - cushion - lid;
    let wood = style.random_wood(&mut d.stream("wood"));
    let feet = style.legs([x - 0.06, z - 0.06], 0.06, 0.045);
    let low = 0.06;
    let body = PartBuilder::new("body")
        .with(wood, open_top_box([-x, low, -z], [x, under, z], 0.02))
        .with_all_hollow(style.leg_finish(), feet);
    let cover = style.random_upholstery(&mut d.stream("cover"));
    let top = PartBuilder::new("lid")
        .with(wood, block([-x, under + 0.001, -z], [x, under + lid, z]))
        .with_fill_fraction(
            cover,
            rounded_block(
                [-x + 0.005, under + lid, -z + 0.01],
                [x - 0.005, h, z - 0.005],
                0.02,
                2,
            ),
            0.4 * cover.padded_fill_fraction(),
        );
    Model::articulated("storage_bench", "storage_bench")
        .part(body)
        .with_container_space(
            "chest",
            [-x + 0.02, low + 0.02, -z + 0.02],
            [x - 0.02, under - 0.005, z - 0.02],
        )
        .part(top)
        .hinged("lid", [0.0, under + 0.001, -z], Vec3::NEG_X, 1.3)
        .with_support_surface(
            "seat",
            [-x + 0.02, h, -z + 0.02],
            [x - 0.02, h + 0.5, z - 0.02],
        )
}
