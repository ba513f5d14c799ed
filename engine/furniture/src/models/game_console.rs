//! A game console with its controller.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{black_plastic, electronics, plastic};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cylinder, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "game_console",
    "game_console",
    125,
    game_console,
)];

/// A games console with a pad lying on it.
fn game_console(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("game_console", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let (tone, other) = d.choose(
        "tone",
        [
            ([30, 30, 33], [236, 236, 234]),
            ([236, 236, 234], [36, 36, 40]),
            ([60, 62, 66], [170, 40, 44]),
        ],
    );
    let (case, pad) = (electronics("console_case", tone), plastic("pad", other));
    let top = h - 0.035;
    let grip = |side: f32| {
        rounded_block(
            [side * 0.055 - 0.018, top, 0.0],
            [side * 0.055 + 0.018, h, 0.075],
            0.014,
            2,
        )
    };
    let stick = |a: f32| {
        cylinder(0.009, 0.012, 12)
            .translated(a, h - 0.004, 0.02)
            .visual_only()
    };
    let body = PartBuilder::new("body")
        .with_fill_fraction(&case, block([-x, 0.006, -z], [x, 0.46 * top, z]), 0.6)
        .with_fill_fraction(&case, block([-x, 0.54 * top, -z], [x, top, z - 0.01]), 0.6)
        .with_fill_fraction(
            &black_plastic(),
            block(
                [-x + 0.012, 0.46 * top, -z + 0.01],
                [x - 0.012, 0.54 * top, z - 0.02],
            ),
            0.6,
        )
        .with(
            &black_plastic(),
            block([-x + 0.02, 0.0, -z + 0.02], [x - 0.02, 0.006, z - 0.02]),
        )
        .with_fill_fraction(
            &pad,
            rounded_block([-0.07, top, -0.03], [0.07, h, 0.03], 0.014, 2),
            0.5,
        )
        .with_all(&pad, [grip(-1.0), grip(1.0)])
        .with_all(&black_plastic(), [stick(-0.03), stick(0.03)]);
    Model::movable("game_console", "game_console")
        .with_switch_state(false)
        .part(body)
        .with_sound([0.0, 0.3 * h, -z], "fan", 36.0)
}
