//! A fireplace.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::Finish;
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, rod, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;

pub(super) const ENTRIES: &[CatalogueEntry] = &[CatalogueEntry::new(
    "fireplace",
    "fireplace",
    103,
    fireplace,
)];

/// A fireplace on the wall with logs that glow when it burns; its back is at -Z.
fn fireplace(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("fireplace", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let stone = match d.below("stone", 3) {
        0 => crate::finishes::marble(),
        1 => Finish::tiled(
            "fire_brick",
            "brick",
            "brick",
            [[158, 84, 62], [190, 180, 168], [112, 56, 46]],
            0.5,
        ),
        _ => Finish::plain("white_surround", "plaster", [236, 232, 224]),
    };
    let soot = Finish::plain("soot", "brick", [38, 34, 32]);
    let bark = Finish::plain("logs", "wood", [84, 58, 40]);
    let ember = Finish::plain("embers", "wood", [214, 86, 30]).emissive([0.5, 0.14, 0.03]);
    let (leg, beam, deck) = (0.2 * w, 0.24, h - 0.05);
    let (inner, top) = (x - leg, deck - beam);
    let hearth = 0.06;
    let face = z - 0.04;
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &stone,
            block([-x + 0.04, hearth, -z], [-inner, deck, face]),
            0.55,
        )
        .with_fill_fraction(
            &stone,
            block([inner, hearth, -z], [x - 0.04, deck, face]),
            0.55,
        )
        .with_fill_fraction(&stone, block([-inner, top, -z], [inner, deck, face]), 0.55)
        .with(&stone, rounded_block([-x, deck, -z], [x, h, z], 0.01, 1))
        .with_fill_fraction(
            &stone,
            block([-x + 0.02, 0.0, -z], [x - 0.02, hearth, z]),
            0.8,
        )
        .with(&soot, block([-inner, hearth, -z], [inner, top, -z + 0.04]))
        .with(
            &soot,
            block(
                [-inner, hearth, -z + 0.04],
                [-inner + 0.02, top, face - 0.03],
            ),
        )
        .with(
            &soot,
            block([inner - 0.02, hearth, -z + 0.04], [inner, top, face - 0.03]),
        );
    let log = |a: f32, y: f32, b: f32, spin: f32, long: f32| {
        rod([-0.5 * long, 0.0, 0.0], [0.5 * long, 0.0, 0.0], 0.045)
            .rotated_y(spin)
            .translated(a, y, b)
    };
    let long = (1.2 * inner).min(0.5);
    let body = body
        .with(&bark, log(0.0, hearth + 0.045, -0.3 * z, 0.1, long))
        .with(&bark, log(0.0, hearth + 0.045, 0.25 * z, -0.12, long))
        .with(&bark, log(0.02, hearth + 0.13, 0.0, 0.5, 0.8 * long))
        .with(
            &ember,
            block(
                [-0.3 * long, hearth, -0.2 * z],
                [0.3 * long, hearth + 0.02, 0.15 * z],
            )
            .visual_only(),
        );
    Model::fixed("fireplace", "fireplace")
        .with_switch_state(false)
        .part(body)
        .with_light([0.0, hearth + 0.3, 0.1 * z], 20.0)
        .with_sound([0.0, hearth + 0.1, 0.0], "noise", 40.0)
        .with_support_surface(
            "mantelpiece",
            [-x + 0.03, h, -z + 0.01],
            [x - 0.03, h + 0.5, z - 0.01],
        )
}
