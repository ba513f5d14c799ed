//! Small things of a bathroom.

use crate::finishes::{Finish, black, chrome, glass, mirror, plastic, rattan, terry};
use crate::model::{Model, PartBuilder};
use crate::shapes::{
    block, cylinder, frame, ring, rod, rounded_block, surface_of_revolution, vessel,
};
use glam::Vec3;
use std::f32::consts::FRAC_PI_2;

/// How far the lids of bins turn, rad: beyond upright, so that they stay up.
const LID_RAD: f32 = 1.6;

/// A mirror on the wall in a thin frame; y = 0 is its middle.
pub fn wall_mirror(width_m: f32, height_m: f32, rim: &Finish) -> Model {
    let (x, y) = (0.5 * width_m - 0.02, 0.5 * height_m - 0.02);
    let body = PartBuilder::new("body")
        .with(rim, frame(width_m, height_m, 0.02, 0.025))
        .with(&mirror(), block([-x, -y, 0.004], [x, y, 0.014]));
    Model::fixed("mirror", "mirror").part(body)
}

/// A rail on the wall with a towel over it; y = 0 is the rail's height. Rail and towel hang as one.
pub fn towel_rail(width_m: f32, towel: &Finish) -> Model {
    let x = 0.5 * width_m;
    let hold = |at: f32| rod([at, 0.0, 0.0], [at, 0.0, 0.08], 0.009);
    let drape = rounded_block([-x + 0.08, -0.46, 0.088], [x - 0.1, 0.012, 0.102], 0.006, 1)
        .and(rounded_block(
            [-x + 0.08, -0.4, 0.058],
            [x - 0.1, 0.012, 0.072],
            0.006,
            1,
        ))
        .and(rounded_block(
            [-x + 0.08, 0.006, 0.058],
            [x - 0.1, 0.02, 0.102],
            0.006,
            1,
        ));
    let body = PartBuilder::new("body")
        .with_all(
            &chrome(),
            [
                hold(-x),
                hold(x),
                rod([-x, 0.0, 0.08], [x, 0.0, 0.08], 0.007),
            ],
        )
        .with(towel, drape);
    Model::fixed("towel_rail", "towel_rack").part(body)
}

/// A folded towel.
pub fn folded_towel(cloth: &Finish) -> Model {
    let body = PartBuilder::new("body")
        .with_filled(
            cloth,
            rounded_block([-0.17, 0.0, -0.12], [0.17, 0.035, 0.12], 0.016, 2),
            0.3,
        )
        .with_filled(
            cloth,
            rounded_block([-0.165, 0.035, -0.115], [0.165, 0.07, 0.12], 0.016, 2),
            0.3,
        );
    Model::pickable("towel", "towel").part(body)
}

/// A holder on the wall with a roll of paper; y = 0 is the roll's axis.
pub fn paper_holder() -> Model {
    let roll = Finish::plain("tissue", "paper", [244, 243, 238]);
    let body = PartBuilder::new("body")
        .with(&chrome(), block([-0.085, -0.02, 0.0], [-0.07, 0.02, 0.07]))
        .with(&chrome(), rod([-0.08, 0.0, 0.06], [0.07, 0.0, 0.06], 0.007))
        .with_filled(
            &roll,
            cylinder(0.052, 0.1, 20)
                .about_z(FRAC_PI_2)
                .at(0.06, 0.0, 0.06),
            0.3,
        );
    Model::fixed("paper_holder", "toilet_paper").part(body)
}

/// A soap dispenser.
pub fn soap_dispenser(color: &Finish) -> Model {
    let body = PartBuilder::new("body")
        .with_filled(
            color,
            surface_of_revolution(
                &[
                    (0.0, 0.0),
                    (0.032, 0.0),
                    (0.034, 0.01),
                    (0.034, 0.1),
                    (0.014, 0.125),
                    (0.0, 0.125),
                ],
                18,
            ),
            0.7,
        )
        .with(&chrome(), cylinder(0.006, 0.035, 10).at(0.0, 0.125, 0.0))
        .with(
            &chrome(),
            rounded_block([-0.008, 0.16, -0.01], [0.008, 0.172, 0.045], 0.004, 1),
        );
    Model::pickable("soap_dispenser", "soap_dispenser").part(body)
}

/// A beaker with two toothbrushes.
pub fn toothbrushes() -> Model {
    let brush = |name: &'static str, srgb, x: f32, tilt: f32| {
        (
            plastic(name, srgb),
            rod([0.0, 0.01, 0.0], [0.0, 0.18, 0.0], 0.004)
                .visual_only()
                .about_z(tilt)
                .at(x, 0.0, 0.0),
        )
    };
    let (green, a) = brush("green_plastic", [88, 168, 112], 0.012, 0.13);
    let (blue, b) = brush("blue_plastic", [66, 120, 186], -0.012, -0.13);
    let cup = vessel(&[(0.0, 0.0), (0.034, 0.0), (0.038, 0.1)], 0.003, 18);
    let body = PartBuilder::new("body")
        .with(&glass(), cup)
        .with(&green, a)
        .with(&blue, b);
    Model::pickable("toothbrushes", "toiletries").part(body)
}

/// A basket for laundry with a lid that turns up.
pub fn laundry_basket() -> Model {
    let (r, h) = (0.2, 0.55);
    let woven = vessel(&[(0.0, 0.0), (0.88 * r, 0.0), (r, h)], 0.008, 24);
    let body = PartBuilder::new("body").with_filled(&rattan(), woven, 0.6);
    let (low, high) = (h + 0.001, h + 0.02);
    let cover = surface_of_revolution(
        &[
            (0.0, low),
            (1.04 * r, low),
            (1.04 * r, high),
            (0.0, high + 0.012),
        ],
        24,
    );
    let grip = ring(0.04, 0.006, 14)
        .about_x(FRAC_PI_2)
        .at(0.0, h + 0.06, 0.0);
    let lid = PartBuilder::new("lid")
        .with_filled(&rattan(), cover, 0.3)
        .with(&rattan(), grip);
    let half = 0.58 * r;
    Model::movable("laundry_basket", "basket")
        .part(body)
        .inside("inside", [-half, 0.008, -half], [half, h, half])
        .part(lid)
        .hinged("lid", [0.0, low, -r], Vec3::NEG_X, LID_RAD)
}

/// A bathroom scale.
pub fn scale() -> Model {
    let body = PartBuilder::new("body")
        .with(&black(), block([-0.13, 0.0, -0.13], [0.13, 0.012, 0.13]))
        .with(
            &Finish::plain("green_glass", "glass", [150, 186, 180]).clear(1.0),
            rounded_block([-0.15, 0.012, -0.15], [0.15, 0.022, 0.15], 0.004, 1),
        )
        .with(
            &black(),
            block([-0.04, 0.022, -0.12], [0.04, 0.0225, -0.08]).visual_only(),
        );
    Model::movable("bathroom_scale", "weight_scale").part(body)
}

/// A bath mat of terry.
pub fn bath_mat(width_m: f32, depth_m: f32) -> Model {
    let (x, z) = (0.5 * width_m, 0.5 * depth_m);
    let cloth = terry("aqua_terry", [126, 172, 178]);
    Model::movable("bath_mat", "rug").part(PartBuilder::new("body").with_filled(
        &cloth,
        rounded_block([-x, 0.0, -z], [x, 0.014, z], 0.006, 1),
        0.5,
    ))
}

/// A bin with a pedal and a lid that turns up.
pub fn pedal_bin(height_m: f32, color: &Finish) -> Model {
    const WALL_M: f32 = 0.004;
    let r = 0.3 * height_m;
    let (z, h) = (0.85 * r, height_m);
    let rim = 0.9 * h;
    let pail = vessel(&[(0.0, 0.0), (r, 0.0), (r, rim)], WALL_M, 26);
    let body = PartBuilder::new("body")
        .with_filled(color, pail, 0.35)
        .with(
            &black(),
            block([-0.03, 0.01, z], [0.03, 0.02, z + 0.06]).visual_only(),
        );
    let low = rim + 0.001;
    let cover = surface_of_revolution(
        &[
            (0.0, low),
            (1.02 * r, low),
            (1.0 * r, 0.95 * h),
            (0.6 * r, 0.99 * h),
            (0.0, h),
        ],
        26,
    );
    let half = 0.6 * r;
    Model::movable("trash_can", "trash_can")
        .part(body)
        .inside("inside", [-half, WALL_M, -half], [half, rim, half])
        .part(PartBuilder::new("lid").with_filled(&black(), cover, 0.1))
        .hinged("lid", [0.0, low, -r], Vec3::NEG_X, LID_RAD)
}
