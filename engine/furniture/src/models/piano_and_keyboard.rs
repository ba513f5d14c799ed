//! A piano and an electronic keyboard.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, brass, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{SolidMesh, block, rod, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use glam::Vec3;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("piano", "piano", 130, piano),
    CatalogueEntry::new("keyboard", "keyboard", 131, keyboard),
];

/// Keys of a piano from -`half` to `half`: one white board with gaps painted by black keys; front at `z`.
fn keys(half: f32, y: f32, z: f32, depth: f32) -> [(Finish, SolidMesh); 2] {
    let ivory = plastic("ivory_keys", [244, 242, 234]);
    let count = ((2.0 * half) / 0.0235) as usize;
    let wide = 2.0 * half / count as f32;
    let mut white = SolidMesh::default();
    let mut dark = SolidMesh::default();
    for k in 0..count {
        let from = -half + wide * k as f32;
        white = white.merged(
            block(
                [from + 0.0006, y, z - depth],
                [from + wide - 0.0006, y + 0.012, z],
            )
            .visual_only(),
        );
        // Two and three black keys in turn, as on every keyboard.
        if ![2, 6].contains(&(k % 7)) && k + 1 < count {
            let at = from + wide;
            dark = dark.merged(
                block(
                    [at - 0.006, y + 0.012, z - depth],
                    [at + 0.006, y + 0.022, z - 0.36 * depth],
                )
                .visual_only(),
            );
        }
    }
    white.colliders = block([-half, y, z - depth], [half, y + 0.012, z]).colliders;
    [(ivory, white), (black_plastic(), dark)]
}

/// An upright piano; the lid over its keys turns up.
fn piano(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("piano", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let lacquer = match d.below("finish", 3) {
        0 => Finish::plain("piano_black", "wood", [24, 24, 26]),
        1 => Finish::plain("piano_white", "wood", [240, 238, 232]),
        _ => style.wood.clone(),
    };
    let front = -z + 0.36;
    let (bed, bed_top, board) = (0.6, 0.65, 0.68);
    let half = x - 0.12;
    let key_front = z - 0.05;
    let [white, dark] = keys(half, 0.655, key_front, 0.15);
    let cheek = |side: f32| {
        let (a, b) = (side * half, side * (x - 0.03));
        block([a.min(b), bed_top, front], [a.max(b), board + 0.04, z])
    };
    let pedal = |a: f32| block([a - 0.012, 0.05, front], [a + 0.012, 0.06, front + 0.09]);
    let side = |s: f32| {
        let (a, b) = (s * (x - 0.03), s * x);
        block([a.min(b), 0.0, -z], [a.max(b), h - 0.03, front])
    };
    let toe = |s: f32| {
        let (a, b) = (s * (x - 0.1), s * (x - 0.04));
        block([a.min(b), 0.0, front], [a.max(b), 0.06, z])
            .merged(block([a.min(b), 0.06, z - 0.08], [a.max(b), bed, z - 0.02]))
    };
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &lacquer,
            block([-x + 0.03, 0.06, -z], [x - 0.03, h - 0.03, front]),
            0.7,
        )
        .with_all(
            &lacquer,
            [
                side(-1.0),
                side(1.0),
                toe(-1.0),
                toe(1.0),
                cheek(-1.0),
                cheek(1.0),
            ],
        )
        .with(
            &lacquer,
            rounded_block(
                [-x - 0.01, h - 0.03, -z],
                [x + 0.01, h, front + 0.02],
                0.006,
                1,
            ),
        )
        .with(
            &lacquer,
            block([-x + 0.03, bed, front], [x - 0.03, bed_top, z]),
        )
        .with(
            &lacquer,
            block(
                [-0.4, board + 0.3, front],
                [0.4, board + 0.32, front + 0.05],
            ),
        )
        .with(&white.0, white.1)
        .with(&dark.0, dark.1)
        .with_all(&brass(), [-0.12, 0.0, 0.12].map(pedal));
    let hinge = front + 0.03;
    let lid = PartBuilder::new("lid").with(
        &lacquer,
        block(
            [-half + 0.003, board + 0.005, hinge],
            [half - 0.003, board + 0.02, z - 0.02],
        ),
    );
    Model::articulated("piano", "piano")
        .part(body)
        .with_support_surface("top", [-x + 0.02, h, -z + 0.02], [x - 0.02, h + 0.4, front])
        .part(lid)
        .hinged("lid", [0.0, board + 0.02, hinge], Vec3::NEG_X, 1.5)
}

/// An electric piano on a crossed stand.
fn keyboard(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("keyboard", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let case = plastic(
        "keyboard_case",
        d.choose("tone", [[34, 34, 37], [222, 222, 220], [120, 40, 44]]),
    );
    let under = h - 0.09;
    let [white, dark] = keys(x - 0.03, h - 0.012, z - 0.012, 0.14);
    let stand = 0.36 * w;
    let bar = |s: f32, b: f32| rod([-s * stand, 0.02, b], [s * stand, under - 0.02, b], 0.014);
    let foot = |s: f32| rod([s * stand, 0.015, -z], [s * stand, 0.015, z], 0.015);
    let top = |s: f32| {
        rod(
            [s * stand, under - 0.015, -z + 0.02],
            [s * stand, under - 0.015, z - 0.02],
            0.015,
        )
    };
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &case,
            rounded_block([-x, under, -z], [x, h - 0.012, z], 0.012, 1),
            0.35,
        )
        .with_fill_fraction(&case, block([-x, h - 0.012, -z], [x, h, z - 0.16]), 0.5)
        .with(&white.0, white.1)
        .with(&dark.0, dark.1)
        .with_fill_fraction(
            &black_plastic(),
            bar(1.0, -0.03).merged(bar(-1.0, 0.03)),
            0.8,
        )
        .with_all(
            &black_plastic(),
            [foot(-1.0), foot(1.0), top(-1.0), top(1.0)],
        );
    Model::movable("keyboard", "keyboard")
        .with_switch_state(false)
        .part(body)
}
