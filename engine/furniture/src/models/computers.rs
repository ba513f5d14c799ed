//! Desktop computers, towers and laptops.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, electronics};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cylinder, panel, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("computer", "computer", 118, computer),
    CatalogueEntry::new("computer_tower", "computer", 119, computer_tower),
    CatalogueEntry::new("laptop", "laptop", 120, sample_laptop),
];

/// A glowing picture of a screen.
pub(super) fn screen_finish(name: &'static str, d: &SizeSampler) -> Finish {
    let ground = d.choose(
        "desktop",
        [[52, 96, 150], [38, 60, 70], [110, 70, 110], [60, 120, 100]],
    );
    Finish::picture(
        name,
        "glass",
        "desktop",
        [ground, [240, 240, 240], [90, 90, 96]],
        1 + d.below("icons", 4) as u64,
    )
    .transparent(1.0)
    .emissive([0.08, 0.1, 0.13])
}

/// A monitor with keyboard and mouse before it.
fn computer(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("computer", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let z = 0.5 * depth;
    let case = if d.chance("light", 0.3) {
        electronics("light_case", [206, 208, 212])
    } else {
        electronics("black_case", [28, 28, 31])
    };
    let low = h - 0.59 * w;
    let at = -z + 0.1;
    let keys = Finish::picture(
        "keyboard",
        "electronics",
        "keyboard",
        [[70, 72, 76], [30, 30, 33], [60, 62, 66]],
        1,
    );
    let (kw, kd, kz) = (0.43_f32.min(w), 0.13, z - 0.14);
    let body = PartBuilder::new("body")
        .with_fill_fraction(
            &case,
            block([-0.16 * w, 0.0, -z], [0.16 * w, 0.012, -z + 0.2]),
            0.6,
        )
        .with_fill_fraction(
            &case,
            block([-0.03, 0.012, at - 0.05], [0.03, low + 0.1, at - 0.025]),
            0.6,
        )
        .with_fill_fraction(
            &case,
            rounded_block(
                [-0.5 * w, low, at - 0.025],
                [0.5 * w, h, at + 0.015],
                0.006,
                1,
            ),
            0.35,
        )
        .with(
            &screen_finish("desktop", &d),
            panel(w - 0.02, h - low - 0.035, 0.002)
                .translated(0.0, low + 0.022, at + 0.015)
                .visual_only(),
        )
        .with_fill_fraction(
            &case,
            block(
                [-0.5 * kw - 0.04, 0.0, kz],
                [0.5 * kw - 0.04, 0.018, kz + kd],
            ),
            0.5,
        )
        .with(
            &keys,
            panel(kw - 0.01, kd - 0.01, 0.004)
                .rotated_x(-FRAC_PI_2)
                .translated(-0.04, 0.018, kz + kd - 0.005)
                .visual_only(),
        )
        .with_fill_fraction(
            &case,
            rounded_block(
                [0.5 * kw, 0.0, kz + 0.02],
                [0.5 * kw + 0.06, 0.032, kz + 0.12],
                0.014,
                2,
            ),
            0.5,
        );
    Model::movable("computer", "computer")
        .with_switch_state(true)
        .part(body)
}

/// The tower of a computer.
fn computer_tower(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("computer_tower", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let case = electronics(
        "tower_case",
        d.choose("tone", [[34, 34, 37], [206, 208, 210], [60, 62, 66]]),
    );
    let light = Finish::plain("power_light", "plastic", [90, 160, 240]).emissive([0.05, 0.15, 0.4]);
    let body = PartBuilder::new("body")
        .with_fill_fraction(&case, block([-x, 0.012, -z], [x, h, z - 0.01]), 0.35)
        .with(
            &black_plastic(),
            block(
                [-x + 0.012, 0.05, z - 0.01],
                [x - 0.012, h - 0.03, z - 0.004],
            ),
        )
        .with(
            &black_plastic(),
            block([-x + 0.02, 0.0, -z + 0.02], [x - 0.02, 0.012, z - 0.04]),
        )
        .with(
            &light,
            cylinder(0.012, 0.003, 14)
                .rotated_x(FRAC_PI_2)
                .translated(0.0, h - 0.07, z - 0.004)
                .visual_only(),
        );
    Model::movable("computer_tower", "computer")
        .with_switch_state(true)
        .part(body)
        .with_sound([0.0, 0.5 * h, -z], "fan", 34.0)
}

/// A laptop, open.
fn laptop() -> Model {
    let case = electronics("grey_case", [150, 152, 156]);
    let keys = Finish::picture(
        "keyboard",
        "electronics",
        "keyboard",
        [[150, 152, 156], [40, 40, 44], [136, 138, 142]],
        1,
    );
    let desktop = Finish::picture(
        "desktop",
        "glass",
        "desktop",
        [[52, 96, 150], [240, 240, 240], [90, 90, 96]],
        4,
    )
    .transparent(1.0)
    .emissive([0.08, 0.1, 0.13]);
    let (w, d) = (0.33, 0.23);
    let lid = panel(w - 0.02, 0.2, 0.0015).translated(0.0, 0.012, 0.007);
    let shell = block([-0.5 * w, 0.0, 0.0], [0.5 * w, 0.222, 0.007]);
    let tilt = -0.32;
    let body = PartBuilder::new("body")
        .with(
            &case,
            rounded_block(
                [-0.5 * w, 0.0, -0.5 * d],
                [0.5 * w, 0.016, 0.5 * d],
                0.005,
                1,
            ),
        )
        .with(
            &keys,
            panel(w - 0.02, d - 0.03, 0.001)
                .rotated_x(-FRAC_PI_2)
                .translated(0.0, 0.016, 0.5 * d - 0.012)
                .visual_only(),
        )
        .with(
            &case,
            shell
                .rotated_x(tilt)
                .translated(0.0, 0.016, -0.5 * d + 0.004),
        )
        .with(
            &desktop,
            lid.rotated_x(tilt)
                .translated(0.0, 0.016, -0.5 * d + 0.004)
                .visual_only(),
        );
    Model::pickable("laptop", "laptop")
        .with_switch_state(true)
        .part(body)
        .with_sound([0.0, 0.01, 0.0], "fan", 28.0)
}

fn sample_laptop(_style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("laptop", key);
    let case = crate::finishes::electronics(
        "laptop_case",
        d.choose(
            "case",
            [
                [150, 152, 156],
                [54, 56, 60],
                [206, 206, 208],
                [190, 160, 150],
            ],
        ),
    );
    laptop()
        .resized(d.sample_m("width") / 0.33)
        .with_finish_replaced("grey_case", &case)
}
