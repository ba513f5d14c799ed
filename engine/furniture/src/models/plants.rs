//! Plants in pots.

use crate::catalogue_entry::CatalogueEntry;
use crate::finishes::{Finish, foliage as green, soil};
use crate::model::{Model, PartBuilder};
use crate::sampling::SizeSampler;
use crate::shapes::{axis_rotation, cylinder, foliage, leaf, rod, surface_of_revolution, vessel};
use crate::style::Style;
use dwell_scene::Pose;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use std::f32::consts::TAU;

pub(super) const ENTRIES: &[CatalogueEntry] = &[
    CatalogueEntry::new("plant", "plant", 178, plant),
    CatalogueEntry::new("snake_plant", "plant", 179, snake_plant),
    CatalogueEntry::new("small_plant", "plant", 180, small_plant),
];

/// A plant in a pot: a crown of leaves on a stem.
#[derive(Clone, Debug)]
struct Plant {
    /// Of the whole, m.
    height_m: f32,
    /// Radius of the pot, m.
    pot_m: f32,
    /// Length and width of a leaf, m.
    leaf_m: [f32; 2],
    /// Number of leaves.
    leaves: usize,
    /// Bare stem between soil and crown, m.
    stem_m: f32,
    /// Finish of the pot.
    pot: Finish,
    /// Finish of the leaves.
    leaf: Finish,
    /// Random key of the leaves' shapes.
    key: RandomKey,
}

impl Plant {
    /// The model of these sizes and finishes.
    fn build(&self) -> Model {
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
            .with_fill_fraction(
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
            .with(&self.leaf, crown.translated(0.0, top, 0.0));
        let model = if r < 0.09 {
            Model::pickable("small_plant", "plant")
        } else {
            Model::movable("plant", "plant")
        };
        model.part(body)
    }
}

/// Deep green leaves.
const fn deep_green() -> Finish {
    green("deep_green_leaves", [52, 96, 48], [110, 150, 80])
}

/// Fresh green leaves.
pub(super) const fn fresh_foliage() -> Finish {
    green("fresh_green_leaves", [92, 140, 62], [160, 190, 104])
}

fn leaf_green(d: &SizeSampler) -> Finish {
    if d.chance("deep", 0.5) {
        deep_green()
    } else {
        fresh_foliage()
    }
}

fn plant(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("plant", key);
    let height = d.sample_m("height");
    let pot = style.random_glaze(&mut d.stream("pot")).clone();
    Plant {
        height_m: height,
        pot_m: 0.5 * d.sample_m("pot"),
        leaf_m: [0.26 * height, d.range("leaf", 0.09, 0.13) * height],
        leaves: 14 + d.below("leaves", 8),
        stem_m: d.range("stem", 0.2, 0.32) * height,
        pot,
        leaf: leaf_green(&d),
        key: key.child("crown"),
    }
    .build()
}

fn small_plant(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("small_plant", key);
    let height = d.sample_m("height");
    Plant {
        height_m: height,
        pot_m: 0.5 * d.sample_m("pot"),
        leaf_m: [0.42 * height, 0.17 * height],
        leaves: 9 + d.below("leaves", 5),
        stem_m: 0.08 * height,
        pot: style.random_glaze(&mut d.stream("pot")).clone(),
        leaf: leaf_green(&d),
        key: key.child("crown"),
    }
    .build()
}

/// A plant of upright sword-like leaves.
fn sansevieria(height_m: f32, pot: &Finish) -> Model {
    let r = 0.11;
    let shell = vessel(&[(0.0, 0.0), (0.8 * r, 0.0), (r, 0.17)], 0.007, 24);
    let mut body = PartBuilder::new("body")
        .with(pot, shell)
        .with_fill_fraction(
            &soil(),
            cylinder(0.82 * r, 0.14, 20).translated(0.0, 0.008, 0.0),
            0.7,
        );
    let mut random = RandomKey::root(11).child("sansevieria").stream();
    let mut crown = crate::shapes::SolidMesh::default();
    for k in 0..11 {
        let size = (height_m - 0.15) * random.range(0.6, 1.0);
        let spin = axis_rotation(Vec3::Y, TAU * 0.381_966 * k as f32);
        let blade = leaf(size, 0.055, 0.42);
        // Leaves grow upwards: the leaf's own +Z is turned up, a little outwards.
        let pose = Pose::new(
            spin * Vec3::Z * 0.03 + Vec3::Y * 0.14,
            spin * axis_rotation(Vec3::X, -1.42 + random.range(0.0, 0.16)),
        );
        crown = crown.merged(blade.transformed(&pose));
    }
    let bounds = crown.mesh.bounds();
    let (w, h) = (0.6 * bounds.size().x, bounds.size().y);
    crown.colliders = cylinder(0.5 * w, h * 0.95, 8)
        .translated(bounds.center().x, 0.145, bounds.center().z)
        .colliders;
    body = body.with(&deep_green(), crown);
    Model::movable("sansevieria", "plant").part(body)
}

fn snake_plant(style: &Style, key: RandomKey) -> Model {
    let d = SizeSampler::new("snake_plant", key);
    sansevieria(
        d.sample_m("height"),
        style.random_glaze(&mut d.stream("pot")),
    )
}
