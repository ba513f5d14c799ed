//! A dining chair.

use crate::finishes::{Finish, cloth, oak};
use crate::model::{Model, PartBuilder};
use crate::shapes::{block, rounded_block, tapered_leg};

/// A chair with four legs and a back of slats.
#[derive(Clone, Debug)]
pub struct Chair {
    /// m.
    pub width_m: f32,
    /// Height of the seat, m.
    pub seat_m: f32,
    /// Height of the back, m.
    pub back_m: f32,
    /// Number of level slats in the back.
    pub slats: usize,
    /// What the body is made of.
    pub wood: Finish,
    /// A flat cushion on the seat.
    pub pad: Option<Finish>,
}

impl Default for Chair {
    fn default() -> Self {
        let pad = Some(cloth("sage_cloth", [138, 154, 128]));
        Self {
            width_m: 0.44,
            seat_m: 0.45,
            back_m: 0.88,
            slats: 3,
            wood: oak(),
            pad,
        }
    }
}

impl Chair {
    /// The model of these sizes and finishes.
    pub fn build(&self) -> Model {
        let (x, z) = (0.5 * self.width_m, 0.215);
        let board = self.seat_m - 0.015;
        let mut body = PartBuilder::new("body").with(
            &self.wood,
            rounded_block([-x, board - 0.025, -z], [x, board, z], 0.012, 1),
        );
        let inset = 0.035;
        for side in [-1.0, 1.0] {
            let leg = side * (x - inset);
            let front = tapered_leg(
                [leg * 1.04, 0.0, z - inset + 0.01],
                [leg, board - 0.025, z - inset],
                0.026,
                0.04,
            );
            let rear = tapered_leg(
                [leg * 1.04, 0.0, -z + inset - 0.04],
                [leg, board - 0.025, -z + inset - 0.01],
                0.026,
                0.04,
            );
            let post = tapered_leg(
                [leg, board, -z + 0.02],
                [leg * 0.98, self.back_m, -z - 0.06],
                0.036,
                0.026,
            );
            body = body.with_all(&self.wood, [front, rear, post]);
            let rail = side * (x - inset);
            body = body.with(
                &self.wood,
                block(
                    [rail - 0.01, board - 0.075, -z + inset],
                    [rail + 0.01, board - 0.025, z - inset],
                ),
            );
        }
        for k in 0..self.slats {
            let share = (k as f32 + 0.6) / self.slats as f32;
            let y = board + share * (self.back_m - board) + 0.02;
            let back = -z + 0.02 - 0.08 * share;
            let half = x - inset - 0.012;
            body = body.with(
                &self.wood,
                rounded_block(
                    [-half, y - 0.03, back - 0.008],
                    [half, y + 0.03, back + 0.008],
                    0.006,
                    1,
                ),
            );
        }
        let seat = match &self.pad {
            Some(pad) => {
                body = body.with_filled(
                    pad,
                    rounded_block(
                        [-x + 0.02, board, -z + 0.035],
                        [x - 0.02, board + 0.03, z - 0.01],
                        0.014,
                        2,
                    ),
                    0.3,
                );
                board + 0.03
            }
            None => board,
        };
        Model::movable("dining_chair", "chair").part(body).top(
            "seat",
            [-x + 0.03, seat, -z + 0.05],
            [x - 0.03, seat + 0.4, z - 0.02],
        )
    }
}
