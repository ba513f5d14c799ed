//! Sofas and armchairs: the same build with more or fewer seats.

use crate::furniture::finish::{Finish, oak, upholstery};
use crate::furniture::model::{Model, Part};
use crate::furniture::shapes::{cushion, rounded_block, tapered_leg};

/// An upholstered seat for one or more.
#[derive(Clone, Debug)]
pub(crate) struct Sofa {
    pub(crate) seats: usize,
    /// Width of one seat, m.
    pub(crate) seat_width_m: f32,
    /// m.
    pub(crate) depth_m: f32,
    /// Height of the back, m.
    pub(crate) back_m: f32,
    pub(crate) cover: Finish,
    pub(crate) wood: Finish,
}

impl Default for Sofa {
    fn default() -> Self {
        let cover = upholstery("slate_blue_cloth", [92, 112, 134]);
        Self {
            seats: 3,
            seat_width_m: 0.62,
            depth_m: 0.92,
            back_m: 0.82,
            cover,
            wood: oak(),
        }
    }
}

impl Sofa {
    /// An armchair of the same family.
    pub(crate) fn armchair(cover: Finish) -> Self {
        Self {
            seats: 1,
            seat_width_m: 0.56,
            depth_m: 0.82,
            back_m: 0.86,
            cover,
            ..Self::default()
        }
    }

    pub(crate) fn build(&self) -> Model {
        const ARM_M: f32 = 0.15;
        let inner = 0.5 * self.seat_width_m * self.seats as f32;
        let (x, z) = (inner + ARM_M, 0.5 * self.depth_m);
        let mut body = Part::new("body")
            .with_padding(
                &self.cover,
                rounded_block([-x, 0.12, -z], [x, 0.28, z - 0.03], 0.03, 1),
            )
            .with_padding(
                &self.cover,
                rounded_block([-x, 0.28, -z], [x, self.back_m - 0.06, -z + 0.16], 0.06, 2),
            );
        for side in [-1.0_f32, 1.0] {
            let (a, b) = (side * x, side * inner);
            body = body.with_padding(
                &self.cover,
                rounded_block(
                    [a.min(b), 0.28, -z + 0.16],
                    [a.max(b), 0.6, z - 0.02],
                    0.06,
                    2,
                ),
            );
            for depth in [-z + 0.1, z - 0.12] {
                let leg = side * (x - 0.1);
                body = body.with(
                    &self.wood,
                    tapered_leg([leg, 0.0, depth], [leg, 0.12, depth], 0.03, 0.05),
                );
            }
        }
        for k in 0..self.seats {
            let left = -inner + self.seat_width_m * k as f32 + 0.004;
            let right = left + self.seat_width_m - 0.008;
            body = body
                .with_padding(
                    &self.cover,
                    cushion([left, 0.28, -z + 0.16], [right, 0.45, z]),
                )
                .with_padding(
                    &self.cover,
                    cushion([left, 0.44, -z + 0.15], [right, self.back_m, -z + 0.34]),
                );
        }
        let (name, category) = if self.seats == 1 {
            ("armchair", "armchair")
        } else {
            ("sofa", "sofa")
        };
        Model::movable(name, category).part(body).top(
            "seat",
            [-inner + 0.02, 0.45, -z + 0.34],
            [inner - 0.02, 0.95, z - 0.04],
        )
    }
}
