//! A table with a leg at each corner, which dining, coffee, side, writing and garden tables share.

use crate::finishes::{Finish, oak};
use crate::model::{Model, PartBuilder};
use crate::shapes::{block, rounded_block, tapered_leg};

/// A rectangular table.
#[derive(Clone, Debug)]
pub(super) struct Table {
    /// Name of the instances: `"dining_table"`.
    pub(super) name: &'static str,
    /// A row of `assets/categories.csv`.
    pub(super) category: &'static str,
    /// Along x, along z, m.
    pub(super) size_m: [f32; 2],
    /// Height of the top above the floor, m.
    pub(super) height_m: f32,
    /// Thickness of the top, m.
    pub(super) top_m: f32,
    /// Width of a leg at its top, m.
    pub(super) leg_m: f32,
    /// A board between the legs at this height, m.
    pub(super) shelf_m: Option<f32>,
    /// Finish of the top.
    pub(super) top: Finish,
    /// Finish of the legs.
    pub(super) legs: Finish,
}

impl Default for Table {
    fn default() -> Self {
        Self {
            name: "dining_table",
            category: "dining_table",
            size_m: [1.7, 0.9],
            height_m: 0.75,
            top_m: 0.03,
            leg_m: 0.065,
            shelf_m: None,
            top: oak(),
            legs: oak(),
        }
    }
}

impl Table {
    /// A low table with a shelf for magazines.
    pub(super) fn coffee(wood: Finish) -> Self {
        Self {
            name: "coffee_table",
            category: "coffee_table",
            size_m: [1.1, 0.6],
            height_m: 0.42,
            leg_m: 0.05,
            shelf_m: Some(0.14),
            top: wood.clone(),
            legs: wood,
            ..Self::default()
        }
    }

    /// The model of these sizes and finishes.
    pub(super) fn build(&self) -> Model {
        let (x, z) = (0.5 * self.size_m[0], 0.5 * self.size_m[1]);
        let under = self.height_m - self.top_m;
        let inset = 0.5 * self.leg_m + 0.015;
        let mut body = PartBuilder::new("body").with(
            &self.top,
            rounded_block([-x, under, -z], [x, self.height_m, z], 0.008, 1),
        );
        for (sx, sz) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            let (a, b) = (sx * (x - inset), sz * (z - inset));
            body = body.with_hollow(
                &self.legs,
                tapered_leg([a, 0.0, b], [a, under, b], self.leg_m * 0.7, self.leg_m),
            );
        }
        let (ax, az, low) = (
            x - inset - 0.5 * self.leg_m,
            z - inset - 0.5 * self.leg_m,
            under - 0.1 * self.height_m,
        );
        for side in [-1.0_f32, 1.0] {
            let (bz, bx) = (side * (z - inset), side * (x - inset));
            body = body
                .with_hollow(
                    &self.legs,
                    block([-ax, low, bz - 0.01], [ax, under, bz + 0.01]),
                )
                .with_hollow(
                    &self.legs,
                    block([bx - 0.01, low, -az], [bx + 0.01, under, az]),
                );
        }
        if let Some(shelf) = self.shelf_m {
            body = body.with(
                &self.top,
                block([-ax, shelf - 0.02, -z + 0.03], [ax, shelf, z - 0.03]),
            );
        }
        let mut model = Model::movable(self.name, self.category)
            .part(body)
            .with_support_surface("top", [-x, self.height_m, -z], [x, self.height_m + 0.6, z]);
        if let Some(shelf) = self.shelf_m {
            model = model.with_support_surface(
                "shelf",
                [-ax, shelf, -z + 0.03],
                [ax, low - 0.01, z - 0.03],
            );
        }
        model
    }
}
