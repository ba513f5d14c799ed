//! Rugs, curtains, pillows, blankets.

use crate::finishes::{Finish, black, oak};
use crate::model::{Model, PartBuilder};
use crate::shapes::{
    SolidMesh, ball, block, curtain as folds, loft, oval, panel, pillow as cushion, rod,
    rounded_block, tube,
};
use std::f32::consts::FRAC_PI_2;

/// A rug whose picture fills it.
pub fn rug(width_m: f32, depth_m: f32, weave: &Finish) -> Model {
    let flat = panel(width_m, depth_m, 0.009)
        .about_x(-FRAC_PI_2)
        .at(0.0, 0.0, 0.5 * depth_m);
    Model::movable("rug", "rug").part(PartBuilder::new("body").with(weave, flat))
}

/// A round or square rug of one colour, pile up.
pub fn round_rug(radius_m: f32, pile: &Finish) -> Model {
    let disc = crate::shapes::cylinder(radius_m, 0.012, 40);
    Model::movable("round_rug", "rug").part(PartBuilder::new("body").with(pile, disc))
}

/// A pair of curtains on a rod, drawn to the sides; x = 0 is the window's middle, y = 0 the rod, z = 0 the wall.
#[derive(Clone, Debug)]
pub struct Curtains {
    /// Length of the rod, m.
    pub width_m: f32,
    /// From the rod to the hem, m.
    pub height_m: f32,
    /// Share of the window that each curtain covers, 0.1 to 0.5.
    pub drawn: f32,
    /// What hangs.
    pub cloth: Finish,
}

impl Curtains {
    /// The model of these sizes and finishes.
    pub fn build(&self) -> Model {
        const OFF_M: f32 = 0.085;
        let x = 0.5 * self.width_m;
        let wide = self.width_m * self.drawn;
        let side = |sign: f32| {
            let folded = folds(
                wide,
                self.height_m - 0.03,
                0.07,
                ((wide / 0.075) as usize).max(3),
            );
            folded.at(sign * (x - 0.5 * wide - 0.02), -0.03, OFF_M)
        };
        let hold = |at: f32| rod([at, 0.0, 0.0], [at, 0.0, OFF_M], 0.008);
        let end = |at: f32| ball(0.022, 12).at(at, 0.0, OFF_M);
        let pole: SolidMesh = rod([-x - 0.03, 0.0, OFF_M], [x + 0.03, 0.0, OFF_M], 0.012);
        let body = PartBuilder::new("rod")
            .with(&black(), pole)
            .with_all(
                &black(),
                [
                    hold(-x + 0.01),
                    hold(x - 0.01),
                    end(-x - 0.04),
                    end(x + 0.04),
                ],
            )
            .with_all(&self.cloth, [side(-1.0), side(1.0)]);
        Model::fixed("curtains", "curtain").part(body)
    }
}

/// A pillow or cushion: width, thickness, depth in m.
pub fn pillow(size_m: [f32; 3], cloth: &Finish) -> Model {
    Model::pickable("pillow", "pillow").part(PartBuilder::new("body").with_filled(
        cloth,
        cushion(size_m),
        0.12,
    ))
}

/// A folded throw.
pub fn folded_blanket(width_m: f32, depth_m: f32, cloth: &Finish) -> Model {
    let (x, z) = (0.5 * width_m, 0.5 * depth_m);
    let layer = |k: usize| {
        let y = 0.028 * k as f32;
        let slack = 0.006 * (k % 2) as f32;
        rounded_block([-x + slack, y, -z], [x, y + 0.028, z - slack], 0.012, 1)
    };
    Model::pickable("folded_blanket", "blanket").part(
        (0..3)
            .map(layer)
            .fold(PartBuilder::new("body"), |part, fold| {
                part.with_filled(cloth, fold, 0.4)
            }),
    )
}

/// A clothes rack on the wall: hooks on a board with a coat and a scarf; y = 0 is the board's middle.
pub fn coat_rack(width_m: f32, coat: &Finish, scarf: &Finish) -> Model {
    let x = 0.5 * width_m;
    let hook = |k: usize| {
        let at = -x + 0.1 + (width_m - 0.2) * k as f32 / 4.0;
        rod([at, -0.01, 0.02], [at, 0.02, 0.075], 0.006).and(ball(0.011, 10).at(at, 0.02, 0.075))
    };
    let at = -x + 0.1 + (width_m - 0.2) * 0.25;
    let ring = |half_x: f32, half_z: f32, y: f32| oval(half_x, half_z, y, 0.026 + half_z, 20);
    let garment = loft(&[
        ring(0.23, 0.055, -1.0),
        ring(0.19, 0.05, -0.55),
        ring(0.2, 0.05, -0.24),
        ring(0.17, 0.04, -0.1),
        ring(0.06, 0.03, -0.03),
        ring(0.05, 0.025, 0.015),
    ]);
    let sleeve = |side: f32| {
        tube(
            &[
                [side * 0.17, -0.13, 0.075],
                [side * 0.23, -0.35, 0.08],
                [side * 0.235, -0.68, 0.09],
            ],
            0.04,
            10,
        )
    };
    let garment = garment
        .and(sleeve(-1.0).visual_only())
        .and(sleeve(1.0).visual_only())
        .at(at, 0.0, 0.0);
    let wrap = -x + 0.1 + (width_m - 0.2) * 0.75;
    let shawl = rounded_block(
        [wrap - 0.05, -0.75, 0.03],
        [wrap + 0.01, 0.02, 0.06],
        0.014,
        1,
    )
    .and(rounded_block(
        [wrap - 0.005, -0.6, 0.06],
        [wrap + 0.055, 0.02, 0.085],
        0.012,
        1,
    ));
    let body = PartBuilder::new("body")
        .with(&oak(), block([-x, -0.05, 0.0], [x, 0.05, 0.02]))
        .with_all(&black(), (0..5).map(hook))
        .with_filled(coat, garment, 0.15)
        .with_filled(scarf, shawl, 0.3);
    Model::fixed("coat_rack", "hanger").part(body)
}
