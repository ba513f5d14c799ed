//! A home bar and a serving cart.

use super::cabinet_parts::SHELVES;
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{black_plastic, brass};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{block, cylinder, rod, rounded_block};
use crate::style::Style;
use dwell_scene::random::RandomKey;
use std::f32::consts::FRAC_PI_2;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("home_bar", "drinkbar", 17, home_bar),
    CatalogueEntry::new("serving_cart", "cart", 18, serving_cart),
];

/// A bar for the living room: a counter towards the guests (+Z) with a foot rail, shelves towards the host (-Z).
fn home_bar(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("home_bar", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let wood = style.random_wood(&mut d.stream("wood"));
    let (back, face, low) = (-z + 0.06, z - 0.16, 0.06);
    let (half, under) = (x - 0.02, h - 0.04);
    let shelves = [low, 0.5 * under, under - 0.3];
    let shelf = |y: f32| block([-half + 0.02, y, back], [half - 0.02, y + 0.02, face]);
    let panel = |k: usize| {
        let wide = 2.0 * half / 3.0;
        let from = -half + wide * k as f32;
        block(
            [from + 0.04, 0.14, face + 0.02],
            [from + wide - 0.04, under - 0.08, face + 0.032],
        )
    };
    let rail = |a: f32| rod([a, 0.18, face + 0.02], [a, 0.18, z - 0.02], 0.008);
    let body = PartBuilder::new("body")
        .with(wood, block([-half, 0.0, face], [half, under, face + 0.02]))
        .with(wood, block([-half, 0.0, back], [-half + 0.02, under, face]))
        .with(wood, block([half - 0.02, 0.0, back], [half, under, face]))
        .with_all(wood, shelves.map(shelf))
        .with_all(&style.front, (0..3).map(panel))
        .with_hollow(
            &style.worktop,
            rounded_block([-x, under, -z], [x, h, z], 0.01, 1),
        )
        .with(
            &brass(),
            rod([-half, 0.18, z - 0.02], [half, 0.18, z - 0.02], 0.014),
        )
        .with_all(&brass(), [-half + 0.1, half - 0.1].map(rail));
    let inner = half - 0.03;
    let mut model = Model::fixed("home_bar", "drinkbar")
        .part(body)
        .with_support_surface(
            "counter",
            [-x + 0.02, h, -z + 0.02],
            [x - 0.02, h + 0.5, z - 0.02],
        );
    let ceilings = [shelves[1], shelves[2], under];
    for (k, name) in ["lower_shelf", "middle_shelf", "upper_shelf"]
        .into_iter()
        .enumerate()
    {
        let (from, to) = (shelves[k] + 0.02, ceilings[k] - 0.01);
        model =
            model.with_support_surface(name, [-inner, from, back + 0.01], [inner, to, face - 0.01]);
    }
    model
}

/// A trolley on castors with two or three trays and a bar to push.
fn serving_cart(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("serving_cart", key);
    let (w, h, depth) = (
        d.sample_m("width"),
        d.sample_m("height"),
        d.sample_m("depth"),
    );
    let (x, z) = (0.5 * w, 0.5 * depth);
    let levels = d.choose("levels", [2, 3]);
    let brass_like = d.chance("brass", 0.3);
    let metal = if brass_like {
        brass()
    } else {
        style.metal.clone()
    };
    let mut body = PartBuilder::new("body");
    for (sx, sz) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let (a, b) = (sx * (x - 0.02), sz * (z - 0.02));
        let wheel = cylinder(0.03, 0.02, 16).rotated_z(FRAC_PI_2);
        body = body
            .with_fill_fraction(&metal, rod([a, 0.055, b], [a, h - 0.01, b], 0.01), 0.4)
            .with(&black_plastic(), wheel.translated(a + 0.01, 0.03, b));
    }
    for side in [-1.0, 1.0] {
        let a = side * (x - 0.02);
        body = body.with_fill_fraction(
            &metal,
            rod([a, h - 0.01, -z + 0.02], [a, h - 0.01, z - 0.02], 0.01),
            0.4,
        );
    }
    let level = |k: usize| 0.12 + (h - 0.22) * k as f32 / (levels - 1) as f32;
    let wood = style.random_wood(&mut d.stream("wood"));
    for k in 0..levels {
        let y = level(k);
        body = body.with(
            wood,
            block([-x + 0.03, y, -z + 0.012], [x - 0.03, y + 0.018, z - 0.012]),
        );
    }
    let mut model = Model::movable("serving_cart", "cart").part(body);
    for (k, name) in SHELVES.into_iter().take(levels).enumerate() {
        let ceiling = if k + 1 < levels {
            level(k + 1)
        } else {
            h + 0.3
        };
        let low = [-x + 0.035, level(k) + 0.018, -z + 0.03];
        model = model.with_support_surface(name, low, [x - 0.035, ceiling, z - 0.03]);
    }
    model
}
