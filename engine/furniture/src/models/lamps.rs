//! Lamps: floor, table, desk, ceiling and wall lamps, candles.

use crate::finishes::{
    Finish, black, brass, chrome, lampshade, milk_glass, painted_steel, plastic, white_lacquer,
};
use crate::model::{Model, PartBuilder};
use crate::shapes::{
    SolidMesh, ball, block, cone, cylinder, rod, surface_of_revolution, tapered_leg, tube,
};
use dwell_scene::LightShape;
use glam::Vec3;

/// A shade open at both ends, thin, around +Y.
fn shade(lower_m: f32, upper_m: f32, height_m: f32) -> SolidMesh {
    const WALL_M: f32 = 0.003;
    let profile = [
        (lower_m - WALL_M, 0.0),
        (lower_m, 0.0),
        (upper_m, height_m),
        (upper_m - WALL_M, height_m),
        (lower_m - WALL_M, 0.0),
    ];
    surface_of_revolution(&profile, 28)
}

/// A lamp on the floor with a shade of cloth.
pub fn floor_lamp(height_m: f32, cloth: &Finish) -> Model {
    let low = height_m - 0.28;
    let body = PartBuilder::new("body")
        .with(
            &black(),
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
            &black(),
            rod([0.0, 0.026, 0.0], [0.0, height_m - 0.06, 0.0], 0.011),
        )
        .with(
            &milk_glass(),
            ball(0.04, 14).at(0.0, low + 0.14, 0.0).visual_only(),
        )
        .with(cloth, shade(0.21, 0.16, 0.28).at(0.0, low, 0.0));
    Model::movable("floor_lamp", "floor_lamp")
        .switched(true)
        .part(body)
        .with_light([0.0, low + 0.14, 0.0], 9.0)
}

/// A lamp on three legs of wood with a drum of cloth.
pub fn tripod_lamp(height_m: f32, wood: &Finish, cloth: &Finish) -> Model {
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
        .with(&black(), cylinder(0.045, 0.03, 16).at(0.0, low, 0.0))
        .with(
            &milk_glass(),
            ball(0.04, 14).at(0.0, low + 0.15, 0.0).visual_only(),
        )
        .with(cloth, shade(0.23, 0.21, 0.26).at(0.0, low + 0.04, 0.0));
    Model::movable("tripod_lamp", "floor_lamp")
        .switched(true)
        .part(body)
        .with_light([0.0, low + 0.15, 0.0], 9.0)
}

/// A lamp for a bedside table or a sideboard; `base` is its foot's finish.
pub fn table_lamp(height_m: f32, base: &Finish, cloth: &Finish) -> Model {
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
        .with_filled(base, surface_of_revolution(&foot, 24), 0.25)
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
            ball(0.028, 12).at(0.0, 0.74 * height_m, 0.0).visual_only(),
        )
        .with(
            cloth,
            shade(0.36 * height_m, 0.24 * height_m, height_m - low).at(0.0, low, 0.0),
        );
    Model::movable("table_lamp", "table_lamp")
        .switched(true)
        .part(body)
        .with_light([0.0, 0.74 * height_m, 0.0], 6.0)
}

/// A desk lamp with a bent arm whose head looks down, above its foot.
pub fn desk_lamp(lacquer: &Finish) -> Model {
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
        .with_filled(lacquer, cylinder(0.1, 0.02, 24), 0.4)
        .with(
            &chrome(),
            tube(
                &[[0.0, 0.02, -0.05], [0.0, 0.22, -0.11], [0.0, 0.4, 0.01]],
                0.007,
                8,
            ),
        )
        .with_filled(lacquer, head.about_x(-0.25).at(0.0, 0.31, 0.05), 0.3)
        .with(
            &milk_glass(),
            ball(0.025, 12).at(0.0, 0.34, 0.045).visual_only(),
        );
    let down = LightShape::Spot {
        direction: Vec3::new(0.0, -0.968, 0.25),
        cutoff_rad: 1.1,
        dropoff_rate: 1.0,
    };
    Model::movable("desk_lamp", "table_lamp")
        .switched(true)
        .part(body)
        .light([0.0, 0.33, 0.05], down, 6.0)
}

/// A pendant: a shade on a cord `drop_m` below the ceiling.
pub fn pendant(drop_m: f32, radius_m: f32, metal: &Finish, power_w: f32) -> Model {
    let top = -drop_m + 0.62 * radius_m;
    let dome = [
        (radius_m - 0.003, 0.0),
        (radius_m, 0.0),
        (0.93 * radius_m, 0.22 * radius_m),
        (0.6 * radius_m, 0.5 * radius_m),
        (0.12 * radius_m, 0.62 * radius_m),
        (0.12 * radius_m, 0.6 * radius_m),
        (0.58 * radius_m, 0.485 * radius_m),
        (0.92 * radius_m, 0.2 * radius_m),
        (radius_m - 0.003, 0.0),
    ];
    let body = PartBuilder::new("body")
        .with(metal, cylinder(0.05, 0.025, 20).at(0.0, -0.025, 0.0))
        .with(&black(), rod([0.0, top, 0.0], [0.0, -0.025, 0.0], 0.004))
        .with(
            metal,
            surface_of_revolution(&dome, 32).at(0.0, -drop_m, 0.0),
        )
        .with(
            &milk_glass(),
            ball(0.26 * radius_m, 16)
                .at(0.0, -drop_m + 0.2 * radius_m, 0.0)
                .visual_only(),
        );
    Model::fixed("pendant_lamp", "chandelier")
        .switched(true)
        .part(body)
        .with_light([0.0, -drop_m - 0.12, 0.0], power_w)
}

/// A drum of cloth on a cord.
pub fn drum(drop_m: f32, radius_m: f32, cloth: &Finish, power_w: f32) -> Model {
    let height = 0.65 * radius_m;
    let body = PartBuilder::new("body")
        .with(
            &white_lacquer(),
            cylinder(0.05, 0.025, 20).at(0.0, -0.025, 0.0),
        )
        .with(
            &black(),
            rod(
                [0.0, -drop_m + 0.5 * height, 0.0],
                [0.0, -0.025, 0.0],
                0.004,
            ),
        )
        .with(
            cloth,
            shade(radius_m, radius_m, height).at(0.0, -drop_m, 0.0),
        )
        .with(
            &milk_glass(),
            cylinder(radius_m - 0.006, 0.004, 28)
                .at(0.0, -drop_m + 0.02, 0.0)
                .visual_only(),
        );
    Model::fixed("drum_lamp", "chandelier")
        .switched(true)
        .part(body)
        .with_light([0.0, -drop_m - 0.02, 0.0], power_w)
}

/// A flat dome of milk glass on the ceiling.
pub fn ceiling_dome(radius_m: f32, power_w: f32) -> Model {
    let glass = surface_of_revolution(
        &[
            (0.0, -0.1),
            (0.5 * radius_m, -0.088),
            (0.85 * radius_m, -0.055),
            (radius_m, -0.02),
            (0.0, -0.02),
        ],
        28,
    );
    let body = PartBuilder::new("body")
        .with_filled(
            &chrome(),
            cylinder(radius_m, 0.02, 28).at(0.0, -0.02, 0.0),
            0.1,
        )
        .with_filled(&milk_glass(), glass, 0.08);
    Model::fixed("ceiling_dome", "chandelier")
        .switched(true)
        .part(body)
        .with_light([0.0, -0.13, 0.0], power_w)
}

/// A bar of light over a mirror.
pub fn mirror_lamp(width_m: f32) -> Model {
    let x = 0.5 * width_m;
    let bar = cylinder(0.022, width_m, 14)
        .about_z(std::f32::consts::FRAC_PI_2)
        .at(x, 0.0, 0.07);
    let body = PartBuilder::new("body")
        .with(&chrome(), block([-0.06, -0.03, 0.0], [0.06, 0.03, 0.05]))
        .with_filled(&milk_glass(), bar, 0.3);
    let line = LightShape::Line {
        end: Vec3::new(x, 0.0, 0.1),
    };
    Model::fixed("mirror_lamp", "wall_lamp")
        .switched(true)
        .part(body)
        .light([-x, 0.0, 0.1], line, 6.0)
}

/// A night light in the shape of a mushroom.
pub fn night_light() -> Model {
    let red = plastic("red_glow", [226, 74, 60]).glowing([0.3, 0.06, 0.04]);
    let cap = surface_of_revolution(
        &[
            (0.0, 0.07),
            (0.06, 0.07),
            (0.066, 0.085),
            (0.045, 0.12),
            (0.0, 0.132),
        ],
        22,
    );
    let body = PartBuilder::new("body")
        .with(&milk_glass(), cone(0.034, 0.026, 0.07, 18))
        .with(&red, cap);
    Model::pickable("night_light", "table_lamp")
        .switched(true)
        .part(body)
        .with_light([0.0, 0.15, 0.0], 1.0)
}

/// A candle in a dish.
pub fn candle(height_m: f32) -> Model {
    let wax = Finish::plain("wax", "wax", [240, 230, 204]);
    let body = PartBuilder::new("body")
        .with(
            &painted_steel("black_steel", [40, 40, 42]),
            surface_of_revolution(&[(0.0, 0.0), (0.055, 0.0), (0.06, 0.012), (0.0, 0.008)], 20),
        )
        .with(&wax, cylinder(0.032, height_m, 18).at(0.0, 0.008, 0.0))
        .with(
            &black(),
            rod(
                [0.0, height_m + 0.008, 0.0],
                [0.0, height_m + 0.016, 0.0],
                0.0012,
            )
            .visual_only(),
        );
    Model::pickable("candle", "candle")
        .switched(false)
        .part(body)
        .with_light([0.0, height_m + 0.04, 0.0], 0.5)
}

/// Shade of natural linen, for those who need a default.
pub const fn linen_shade() -> Finish {
    lampshade("linen_shade", [240, 226, 196])
}
