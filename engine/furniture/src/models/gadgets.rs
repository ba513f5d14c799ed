//! Small devices: laptop, telephone, remote control, alarm clock, wall clock.

use crate::finishes::{Finish, black, device, lacquer, plastic};
use crate::model::{Model, PartBuilder};
use crate::shapes::{block, cylinder, panel, ring, rounded_block};
use std::f32::consts::FRAC_PI_2;

/// A laptop, open.
pub fn laptop() -> Model {
    let case = device("grey_case", [150, 152, 156]);
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
    .clear(1.0)
    .glowing([0.08, 0.1, 0.13]);
    let (w, d) = (0.33, 0.23);
    let lid = panel(w - 0.02, 0.2, 0.0015).at(0.0, 0.012, 0.007);
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
                .about_x(-FRAC_PI_2)
                .at(0.0, 0.016, 0.5 * d - 0.012)
                .visual_only(),
        )
        .with(&case, shell.about_x(tilt).at(0.0, 0.016, -0.5 * d + 0.004))
        .with(
            &desktop,
            lid.about_x(tilt)
                .at(0.0, 0.016, -0.5 * d + 0.004)
                .visual_only(),
        );
    Model::pickable("laptop", "laptop")
        .switched(true)
        .part(body)
        .with_sound([0.0, 0.01, 0.0], "fan", 28.0)
}

/// A telephone with a receiver on its cradle.
pub fn telephone() -> Model {
    let red = plastic("red_plastic", [170, 36, 34]);
    let ear = |x: f32| {
        rounded_block(
            [x - 0.026, 0.062, -0.028],
            [x + 0.026, 0.098, 0.028],
            0.012,
            1,
        )
    };
    let dial = Finish::picture(
        "telephone_dial",
        "plastic",
        "clock",
        [[236, 232, 222], [60, 60, 60], [120, 120, 120]],
        1,
    );
    let face = panel(0.09, 0.09, 0.004)
        .about_x(-FRAC_PI_2 + 0.45)
        .at(0.0, 0.03, 0.082);
    let body = PartBuilder::new("body")
        .with_filled(
            &red,
            rounded_block([-0.09, 0.0, -0.09], [0.09, 0.055, 0.09], 0.016, 1),
            0.4,
        )
        .with_all(&red, [ear(-0.085), ear(0.085)])
        .with(
            &red,
            rounded_block([-0.09, 0.078, -0.018], [0.09, 0.104, 0.018], 0.01, 1),
        )
        .with(&dial, face.visual_only());
    Model::pickable("telephone", "telephone")
        .switched(false)
        .part(body)
        .with_sound([0.0, 0.03, 0.0], "phone", 74.0)
}

/// A remote control.
pub fn remote_control() -> Model {
    let key = |k: usize| {
        let (x, z) = (
            (k % 3) as f32 * 0.013 - 0.013,
            (k / 3) as f32 * 0.017 - 0.06,
        );
        block(
            [x - 0.004, 0.018, z - 0.005],
            [x + 0.004, 0.0195, z + 0.005],
        )
        .visual_only()
    };
    let body = PartBuilder::new("body")
        .with(
            &black(),
            rounded_block([-0.024, 0.0, -0.085], [0.024, 0.018, 0.085], 0.006, 1),
        )
        .with_all(&plastic("grey_plastic", [150, 150, 154]), (0..9).map(key));
    Model::pickable("remote_control", "household_appliance").part(body)
}

/// An alarm clock with bells' colour and a ticking work.
pub fn alarm_clock() -> Model {
    let mint = plastic("mint_plastic", [120, 182, 164]);
    let dial = Finish::picture(
        "clock_face",
        "plastic",
        "clock",
        [[246, 244, 236], [40, 40, 44], [200, 60, 50]],
        1,
    );
    let body = PartBuilder::new("body")
        .with(
            &mint,
            cylinder(0.05, 0.045, 24)
                .about_x(FRAC_PI_2)
                .at(0.0, 0.06, -0.022),
        )
        .with(
            &dial,
            panel(0.07, 0.07, 0.001).at(0.0, 0.025, 0.023).visual_only(),
        )
        .with_all(
            &black(),
            [-0.03, 0.03].map(|x| block([x - 0.006, 0.0, -0.018], [x + 0.006, 0.025, 0.018])),
        );
    Model::pickable("alarm_clock", "clock")
        .part(body)
        .with_sound([0.0, 0.06, 0.0], "clock", 32.0)
}

/// A round clock on a wall.
pub fn wall_clock(radius_m: f32) -> Model {
    let frame = lacquer("black_lacquer", [38, 38, 40]);
    let dial = Finish::picture(
        "clock_face",
        "plastic",
        "clock",
        [[246, 244, 236], [40, 40, 44], [200, 60, 50]],
        1,
    );
    let edge = 2.0 * radius_m * 0.7;
    let plate = plastic("white_plastic", [246, 244, 236]);
    let body = PartBuilder::new("body")
        .with(&plate, cylinder(radius_m, 0.022, 32).about_x(FRAC_PI_2))
        .with(
            &frame,
            ring(radius_m, 0.012, 32)
                .about_x(FRAC_PI_2)
                .at(0.0, 0.0, 0.014)
                .visual_only(),
        )
        .with(
            &dial,
            panel(edge, edge, 0.002)
                .at(0.0, -0.5 * edge, 0.022)
                .visual_only(),
        );
    Model::fixed("wall_clock", "clock")
        .part(body)
        .with_sound([0.0, 0.0, 0.03], "clock", 34.0)
}
