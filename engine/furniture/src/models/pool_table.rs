//! A pool table.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::Finish;
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{ball, block, cylinder};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "pool_table",
    "game_table",
    19,
    pool_table,
)];

/// A pool table with cushions, pockets and balls racked up.
fn pool_table(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("pool_table", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let felt = Finish::plain(
        "billiard_cloth",
        "felt",
        d.choose("cloth", [[34, 110, 70], [40, 84, 130], [130, 36, 44]]),
    );
    let rail = 0.11;
    let bed = h - 0.045;
    let wood = &style.wood;
    let slate = Finish::plain("slate", "stone", [80, 84, 88]);
    let mut body = PartBuilder::new("body")
        .with_fill_fraction(
            wood,
            block(
                [-x + 0.05, bed - 0.24, -z + 0.05],
                [x - 0.05, bed - 0.03, z - 0.05],
            ),
            0.12,
        )
        .with(
            &slate,
            block(
                [-x + 0.06, bed - 0.03, -z + 0.06],
                [x - 0.06, bed - 0.004, z - 0.06],
            ),
        )
        .with(
            &felt,
            block(
                [-x + rail, bed - 0.004, -z + rail],
                [x - rail, bed, z - rail],
            ),
        )
        .with(wood, block([-x, bed - 0.06, -z], [x, h, -z + rail - 0.03]))
        .with(wood, block([-x, bed - 0.06, z - rail + 0.03], [x, h, z]))
        .with(
            wood,
            block(
                [-x, bed - 0.06, -z + rail - 0.03],
                [-x + rail - 0.03, h, z - rail + 0.03],
            ),
        )
        .with(
            wood,
            block(
                [x - rail + 0.03, bed - 0.06, -z + rail - 0.03],
                [x, h, z - rail + 0.03],
            ),
        )
        .with(
            &felt,
            block(
                [-x + rail - 0.03, bed, -z + rail - 0.03],
                [x - rail + 0.03, h - 0.006, -z + rail],
            ),
        )
        .with(
            &felt,
            block(
                [-x + rail - 0.03, bed, z - rail],
                [x - rail + 0.03, h - 0.006, z - rail + 0.03],
            ),
        )
        .with(
            &felt,
            block(
                [-x + rail - 0.03, bed, -z + rail],
                [-x + rail, h - 0.006, z - rail],
            ),
        )
        .with(
            &felt,
            block(
                [x - rail, bed, -z + rail],
                [x - rail + 0.03, h - 0.006, z - rail],
            ),
        );
    body = body.with_all_hollow(
        style.leg_finish(),
        style.legs([x - 0.2, z - 0.2], bed - 0.24, 0.13),
    );
    let pocket = Finish::plain("pocket", "leather", [20, 20, 22]);
    for sx in [-1.0_f32, 0.0, 1.0] {
        for sz in [-1.0_f32, 1.0] {
            let hole = cylinder(0.055, 0.003, 16).translated(
                sx * (x - rail + 0.015),
                h - 0.0005,
                sz * (z - rail + 0.015),
            );
            body = body.with(&pocket, hole.visual_only());
        }
    }
    let tones = [
        [226, 180, 40],
        [30, 60, 140],
        [180, 36, 34],
        [84, 40, 110],
        [220, 110, 34],
        [30, 100, 60],
    ];
    for row in 0..4 {
        for k in 0..=row {
            let (a, b) = (
                0.25 * w + 0.0505 * row as f32,
                0.0585 * (k as f32 - 0.5 * row as f32),
            );
            let color = Finish::plain(
                "billiard_ball",
                "plastic",
                tones[(row * 2 + k) % tones.len()],
            );
            body = body.with(
                &color,
                ball(0.0285, 10)
                    .translated(a, bed + 0.0285, b)
                    .visual_only(),
            );
        }
    }
    let white = Finish::plain("cue_ball", "plastic", [244, 242, 232]);
    body = body.with(
        &white,
        ball(0.0285, 12)
            .translated(-0.25 * w, bed + 0.0285, 0.0)
            .visual_only(),
    );
    Model::fixed("pool_table", "game_table")
        .part(body)
        .with_support_surface(
            "bed",
            [-0.2 * w, bed, -z + rail + 0.02],
            [0.2 * w, bed + 0.4, z - rail - 0.02],
        )
}
