//! Plants in pots, vases with flowers.

use crate::finishes::{Finish, foliage as green, soil};
use crate::model::{Model, PartBuilder};
use crate::shapes::{ball, cylinder, foliage, leaf, rod, surface_of_revolution, turn, vessel};
use dwell_scene::Pose;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::TAU;

/// A plant in a pot: a crown of leaves on a stem.
#[derive(Clone, Debug)]
pub struct Plant {
    /// Of the whole, m.
    pub height_m: f32,
    /// Radius of the pot, m.
    pub pot_m: f32,
    /// Length and width of a leaf, m.
    pub leaf_m: [f32; 2],
    /// How many leaves.
    pub leaves: usize,
    /// Bare stem between soil and crown, m.
    pub stem_m: f32,
    /// What the pot is made of.
    pub pot: Finish,
    /// What the leaves look like.
    pub leaf: Finish,
    /// What the shapes of the leaves are drawn by.
    pub key: RandomKey,
}

/// Deep green leaves.
pub const fn deep_green() -> Finish {
    green("deep_green_leaves", [52, 96, 48], [110, 150, 80])
}

/// Fresh green leaves.
pub const fn fresh_green() -> Finish {
    green("fresh_green_leaves", [92, 140, 62], [160, 190, 104])
}

impl Plant {
    /// The model of these sizes and finishes.
    pub fn build(&self) -> Model {
        let r = self.pot_m;
        let pot_height = 1.55 * r;
        let shell = vessel(
            &[
                (0.0, 0.0),
                (0.74 * r, 0.0),
                (0.95 * r, pot_height * 0.9),
                (r, pot_height),
            ],
            0.008,
            24,
        );
        let level = pot_height - 0.03;
        let top = level + self.stem_m;
        let crown = foliage(
            self.leaves,
            self.leaf_m[0],
            self.leaf_m[1],
            self.height_m - top,
            self.key,
        );
        let bark = Finish::plain("stem", "wood", [96, 84, 52]);
        let body = PartBuilder::new("body")
            .with(&self.pot, shell)
            .with_filled(
                &soil(),
                surface_of_revolution(
                    &[(0.0, 0.01), (0.7 * r, 0.01), (0.9 * r, level), (0.0, level)],
                    20,
                ),
                0.7,
            )
            .with(
                &bark,
                rod(
                    [0.0, level - 0.01, 0.0],
                    [0.0, top + 0.3 * (self.height_m - top), 0.0],
                    0.008,
                )
                .visual_only(),
            )
            .with(&self.leaf, crown.at(0.0, top, 0.0));
        let model = if r < 0.09 {
            Model::pickable("small_plant", "plant")
        } else {
            Model::movable("plant", "plant")
        };
        model.part(body)
    }
}

/// A plant of upright sword-like leaves.
pub fn sansevieria(height_m: f32, pot: &Finish) -> Model {
    let r = 0.11;
    let shell = vessel(&[(0.0, 0.0), (0.8 * r, 0.0), (r, 0.17)], 0.007, 24);
    let mut body = PartBuilder::new("body").with(pot, shell).with_filled(
        &soil(),
        cylinder(0.82 * r, 0.14, 20).at(0.0, 0.008, 0.0),
        0.7,
    );
    let mut random = RandomKey::root(11).child("sansevieria").stream();
    let mut crown = crate::shapes::SolidMesh::default();
    for k in 0..11 {
        let size = (height_m - 0.15) * random.range(0.6, 1.0);
        let spin = turn(Vec3::Y, TAU * 0.381_966 * k as f32);
        let blade = leaf(size, 0.055, 0.42);
        // Leaves grow upwards: the leaf's own +Z is turned up, a little outwards.
        let pose = Pose::new(
            spin * Vec3::Z * 0.03 + Vec3::Y * 0.14,
            spin * turn(Vec3::X, -1.42 + random.range(0.0, 0.16)),
        );
        crown = crown.and(blade.placed(&pose));
    }
    let bounds = crown.mesh.bounds();
    let (w, h) = (0.6 * bounds.size().x, bounds.size().y);
    crown.colliders = cylinder(0.5 * w, h * 0.95, 8)
        .at(bounds.center().x, 0.145, bounds.center().z)
        .colliders;
    body = body.with(&deep_green(), crown);
    Model::movable("sansevieria", "plant").part(body)
}

/// A vase; with flowers of `bloom` where given.
pub fn vase(height_m: f32, glaze: &Finish, bloom: Option<&Finish>) -> Model {
    let (h, r) = (height_m, 0.3 * height_m);
    let shell = vessel(
        &[
            (0.0, 0.0),
            (0.6 * r, 0.0),
            (r, 0.35 * h),
            (0.85 * r, 0.6 * h),
            (0.42 * r, 0.88 * h),
            (0.5 * r, h),
        ],
        0.005,
        24,
    );
    let mut body = PartBuilder::new("body").with(glaze, shell);
    if let Some(bloom) = bloom {
        let stem = fresh_green();
        let mut random = RandomKey::root(23).child("vase").stream();
        for k in 0..9 {
            let (sin, cos) = dwell_scene::math::sin_cos(TAU * 0.381_966 * k as f32);
            let out = 0.42 * r * (0.4 + random.range(0.0, 1.6));
            let top = [
                out * 1.6 * sin,
                h * random.range(1.35, 1.75),
                out * 1.6 * cos,
            ];
            body = body
                .with(
                    &stem,
                    rod([0.1 * r * sin, 0.2 * h, 0.1 * r * cos], top, 0.0022).visual_only(),
                )
                .with_filled(
                    bloom,
                    ball(0.026, 10).at(top[0], top[1], top[2]).visual_only(),
                    0.1,
                );
            let low = Vec3::new(0.3 * r * sin, 0.95 * h, 0.3 * r * cos);
            let pose = Pose::new(
                low,
                turn(Vec3::Y, TAU * 0.381_966 * k as f32) * turn(Vec3::X, -0.7),
            );
            body = body.with(&stem, leaf(0.12, 0.03, 0.5).placed(&pose));
        }
    }
    let neck = 0.24 * r;
    Model::pickable("vase", "vase").part(body).inside(
        "inside",
        [-neck, 0.008, -neck],
        [neck, h, neck],
    )
}
