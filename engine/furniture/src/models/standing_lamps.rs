//! Floor lamps, table lamps and desk lamps.

use super::lampshades::{shade_finish, shade_mesh};
use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, black_plastic, brass, chrome, milk_glass};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{ball, cylinder, rod, surface_of_revolution, tapered_leg, tube};
use crate::style::Style;
use dwell_scene::LightShape;
use dwell_scene::random::RandomKey;
use glam::Vec3;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("floor_lamp", "floor_lamp", 96, sample_floor_lamp),
    CatalogueEntry::new("table_lamp", "table_lamp", 97, sample_table_lamp),
    CatalogueEntry::new("desk_lamp", "table_lamp", 98, sample_desk_lamp),
];

/// A lamp on the floor with a shade of cloth.
fn floor_lamp(height_m: f32, cloth: &Finish) -> Model {
    let low = height_m - 0.28;
    let body = PartBuilder::new("body")
        .with(
            &black_plastic(),
            surface_of_revolution(
                &[
                    (0.0, 0.0),
                    (0.15, 0.0),
                    (0.15, 0.012),
                    (0.03, 0.026),
                    (0.0, 0.026),
                ],
                28,
            ),
        )
        .with(
            &black_plastic(),
            rod([0.0, 0.026, 0.0], [0.0, height_m - 0.06, 0.0], 0.011),
        )
        .with(
            &milk_glass(),
            ball(0.04, 14)
                .translated(0.0, low + 0.14, 0.0)
                .visual_only(),
        )
        .with(
            cloth,
            shade_mesh(0.21, 0.16, 0.28).translated(0.0, low, 0.0),
        );
    Model::movable("floor_lamp", "floor_lamp")
        .with_switch_state(true)
        .part(body)
        .with_light([0.0, low + 0.14, 0.0], 9.0)
}

/// A lamp on three legs of wood with a drum of cloth.
fn tripod_lamp(height_m: f32, wood: &Finish, cloth: &Finish) -> Model {
    let low = height_m - 0.3;
    let mut body = PartBuilder::new("body");
    for k in 0..3 {
        let (sin, cos) = dwell_scene::math::sin_cos(std::f32::consts::TAU * (k as f32 + 0.5) / 3.0);
        let (foot, top) = (
            [0.27 * sin, 0.0, 0.27 * cos],
            [0.025 * sin, low + 0.02, 0.025 * cos],
        );
        body = body.with(wood, tapered_leg(foot, top, 0.022, 0.032));
    }
    let body = body
        .with(
            &black_plastic(),
            cylinder(0.045, 0.03, 16).translated(0.0, low, 0.0),
        )
        .with(
            &milk_glass(),
            ball(0.04, 14)
                .translated(0.0, low + 0.15, 0.0)
                .visual_only(),
        )
        .with(
            cloth,
            shade_mesh(0.23, 0.21, 0.26).translated(0.0, low + 0.04, 0.0),
        );
    Model::movable("tripod_lamp", "floor_lamp")
        .with_switch_state(true)
        .part(body)
        .with_light([0.0, low + 0.15, 0.0], 9.0)
}

fn sample_floor_lamp(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("floor_lamp", key);
    let cloth = shade_finish(style, &d);
    if d.chance("tripod", 0.35) {
        let legs = style.random_wood(&mut d.stream("legs"));
        return tripod_lamp(d.sample_m("height"), legs, &cloth);
    }
    let foot = Finish {
        name: "lamp_foot",
        ..style.metal.clone()
    };
    floor_lamp(d.sample_m("height"), &cloth).with_finish_replaced("black_plastic", &foot)
}

/// A lamp for a bedside table or a sideboard; `base` is its foot's finish.
fn table_lamp(height_m: f32, base: &Finish, cloth: &Finish) -> Model {
    let low = height_m * 0.56;
    let r = height_m * 0.17;
    let foot = [
        (0.0, 0.0),
        (0.9 * r, 0.0),
        (0.95 * r, 0.03 * height_m),
        (r, 0.2 * height_m),
        (0.5 * r, 0.42 * height_m),
        (0.25 * r, 0.5 * height_m),
        (0.0, 0.5 * height_m),
    ];
    let body = PartBuilder::new("body")
        .with_fill_fraction(base, surface_of_revolution(&foot, 24), 0.25)
        .with(
            &brass(),
            rod(
                [0.0, 0.5 * height_m, 0.0],
                [0.0, 0.8 * height_m, 0.0],
                0.006,
            )
            .visual_only(),
        )
        .with(
            &milk_glass(),
            ball(0.028, 12)
                .translated(0.0, 0.74 * height_m, 0.0)
                .visual_only(),
        )
        .with(
            cloth,
            shade_mesh(0.36 * height_m, 0.24 * height_m, height_m - low).translated(0.0, low, 0.0),
        );
    Model::movable("table_lamp", "table_lamp")
        .with_switch_state(true)
        .part(body)
        .with_light([0.0, 0.74 * height_m, 0.0], 6.0)
}

fn sample_table_lamp(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("table_lamp", key);
    let base = style.random_glaze(&mut d.stream("base"));
    table_lamp(d.sample_m("height"), base, &shade_finish(style, &d))
}

/// A desk lamp with a bent arm whose head looks down, above its foot.
fn desk_lamp(lacquer: &Finish) -> Model {
    let head = surface_of_revolution(
        &[
            (0.07, 0.0),
            (0.075, 0.0),
            (0.03, 0.09),
            (0.0, 0.1),
            (0.0, 0.094),
            (0.025, 0.085),
            (0.07, 0.0),
        ],
        20,
    );
    let body = PartBuilder::new("body")
        .with_fill_fraction(lacquer, cylinder(0.1, 0.02, 24), 0.4)
        .with(
            &chrome(),
            tube(
                &[[0.0, 0.02, -0.05], [0.0, 0.22, -0.11], [0.0, 0.4, 0.01]],
                0.007,
                8,
            ),
        )
        .with_fill_fraction(
            lacquer,
            head.rotated_x(-0.25).translated(0.0, 0.31, 0.05),
            0.3,
        )
        .with(
            &milk_glass(),
            ball(0.025, 12).translated(0.0, 0.34, 0.045).visual_only(),
        );
    let down = LightShape::Spot {
        direction: Vec3::new(0.0, -0.968, 0.25),
        cutoff_rad: 1.1,
        dropoff_rate: 1.0,
    };
    Model::movable("desk_lamp", "table_lamp")
        .with_switch_state(true)
        .part(body)
        .with_light_shape([0.0, 0.33, 0.05], down, 6.0)
}

fn sample_desk_lamp(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("desk_lamp", key);
    let accent = Finish::plain(
        "lamp_lacquer",
        "steel",
        style.random_cloth(&mut d.stream("tone")).srgb,
    );
    let lacquer = if d.chance("metal", 0.5) {
        style.metal.clone()
    } else {
        accent
    };
    desk_lamp(&lacquer).resized(d.sample_m("height") / 0.42)
}
