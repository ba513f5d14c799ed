//! Windows with their frames and sills.

use crate::finishes::{Finish, chrome, plastic};
use crate::model::{Model, PartBuilder};
use crate::shapes::{block, frame};

/// A window in an opening of a wall: x = 0, y = 0 its middle, z = 0 the wall's middle, the room at +Z.
#[derive(Clone, Debug)]
pub struct Window {
    /// Of the opening, m.
    pub width_m: f32,
    /// Of the opening, m.
    pub height_m: f32,
    /// Thickness of the wall, m.
    pub wall_m: f32,
    /// Number of casements side by side.
    pub casements: usize,
    /// The glass.
    pub pane: Finish,
    /// Depth of the sill into the room, m.
    pub sill_m: f32,
}

impl Window {
    /// The model of these sizes and finishes.
    pub fn build(&self) -> Model {
        let (w, h, z) = (self.width_m, self.height_m, 0.5 * self.wall_m);
        let white = plastic("window_white", [240, 240, 238]);
        let (depth, back) = (0.07, -0.035);
        let mut body = PartBuilder::new("frame")
            .with(&white, frame(w, h, 0.05, depth).translated(0.0, 0.0, back))
            .with(
                &white,
                block(
                    [-0.5 * w, -0.5 * h - 0.0, -back],
                    [0.5 * w, -0.5 * h + 0.02, z + self.sill_m],
                ),
            )
            .with(
                &white,
                block(
                    [-0.5 * w, -0.5 * h, -z - 0.03],
                    [0.5 * w, -0.5 * h + 0.02, back],
                ),
            );
        let mut panes = PartBuilder::new("glass");
        let (iw, ih) = (w - 0.1, h - 0.1);
        let step = iw / self.casements as f32;
        for k in 0..self.casements {
            let x = -0.5 * iw + step * (k as f32 + 0.5);
            body = body.with(
                &white,
                frame(step - 0.004, ih - 0.004, 0.045, 0.05).translated(x, 0.0, -0.02),
            );
            let (px, py) = (0.5 * step - 0.047, 0.5 * ih - 0.047);
            panes = panes.with(
                &self.pane,
                block([x - px, -py, -0.006], [x + px, py, 0.012]),
            );
            let lever = x + (0.5 * step - 0.025) * if k % 2 == 0 { 1.0 } else { -1.0 };
            body = body.with(
                &chrome(),
                block([lever - 0.008, -0.06, 0.03], [lever + 0.008, 0.06, 0.05]).visual_only(),
            );
        }
        Model::fixed("window", "window").part(body).part(panes)
    }
}

/// Clear double glazing.
pub const fn clear_pane() -> Finish {
    Finish::plain("window_glass", "double_glazing", [206, 226, 232]).transparent(0.12)
}

/// Frosted double glazing.
pub const fn frosted_pane() -> Finish {
    Finish::plain("frosted_glass", "double_glazing", [224, 234, 236]).transparent(0.85)
}
