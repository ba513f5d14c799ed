//! Radios and loudspeakers.

use crate::finishes::{Finish, black, chrome, device, walnut};
use crate::model::{Model, PartBuilder};
use crate::shapes::{block, cylinder, rod, rounded_block};
use std::f32::consts::FRAC_PI_2;

/// The cloth or metal in front of a loudspeaker.
const fn grille(dark: bool) -> Finish {
    let colors = if dark {
        [[70, 70, 74], [22, 22, 24], [0; 3]]
    } else {
        [[206, 196, 176], [120, 108, 90], [0; 3]]
    };
    Finish::tiled("grille", "electronics", "grille", colors, 0.06)
}

/// A kitchen radio with a wooden case, a dial and two knobs.
pub fn radio(on: bool) -> Model {
    let (x, h, z) = (0.15, 0.17, 0.055);
    let dial = Finish::picture(
        "dial",
        "electronics",
        "dial",
        [[240, 226, 186], [60, 44, 30], [196, 40, 36]],
        1,
    );
    let scale = crate::shapes::panel(0.11, 0.05, 0.004).at(0.075, 0.1, z);
    let knob = |at: f32| {
        cylinder(0.015, 0.016, 12)
            .about_x(FRAC_PI_2)
            .at(at, 0.055, z)
    };
    let body = PartBuilder::new("body")
        .with_filled(
            &walnut(),
            rounded_block([-x, 0.006, -z], [x, h, z], 0.018, 2),
            0.6,
        )
        .with(
            &black(),
            block([-x + 0.02, 0.0, -z + 0.01], [x - 0.02, 0.006, z - 0.01]),
        )
        .with(
            &grille(false),
            block([-x + 0.018, 0.028, z], [0.008, h - 0.025, z + 0.003]),
        )
        .with(&dial, scale)
        .with_all(&chrome(), [knob(0.045), knob(0.105)])
        .with(
            &chrome(),
            rod([0.13, h - 0.01, -0.03], [0.13, h + 0.2, -0.05], 0.0025).visual_only(),
        );
    Model::pickable("radio", "radio")
        .switched(on)
        .part(body)
        .with_sound([-0.06, 0.09, z + 0.01], "radio", 63.0)
}

/// A loudspeaker on the floor.
pub fn loudspeaker(height_m: f32) -> Model {
    let case = device("black_case", [26, 26, 29]);
    let cone = |y: f32, r: f32| {
        cylinder(r, 0.006, 20)
            .about_x(FRAC_PI_2)
            .at(0.0, y, 0.125)
            .visual_only()
    };
    let body = PartBuilder::new("body")
        .with_filled(
            &walnut(),
            rounded_block([-0.1, 0.0, -0.125], [0.1, height_m, 0.125], 0.008, 1),
            0.35,
        )
        .with_all(
            &case,
            [
                cone(height_m * 0.42, 0.07),
                cone(height_m * 0.66, 0.07),
                cone(height_m * 0.86, 0.028),
            ],
        );
    Model::movable("loudspeaker", "loudspeaker").part(body)
}
