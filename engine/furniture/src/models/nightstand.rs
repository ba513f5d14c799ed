//! A bedside table with a drawer.

use super::cabinet_parts::{Carcass, drawer, drawer_space};
use crate::finishes::{Finish, brass};
use crate::model::{Model, PartBuilder};
use crate::shapes::tapered_leg;
use crate::style::FrontStyle;
use glam::Vec3;

/// A small cupboard on legs: an open shelf below a drawer.
pub fn nightstand(width_m: f32, height_m: f32, wood: &Finish) -> Model {
    let front = FrontStyle::plain(wood.clone(), brass());
    nightstand_with(width_m, height_m, wood, &front)
}

/// The same with a front of another look.
pub fn nightstand_with(width_m: f32, height_m: f32, wood: &Finish, front: &FrontStyle) -> Model {
    const DEPTH_M: f32 = 0.38;
    const SHARE: f32 = 0.52;
    let carcass = Carcass::standing(width_m, 0.14, height_m, DEPTH_M);
    let (x, z) = (0.5 * width_m - 0.03, 0.5 * DEPTH_M - 0.03);
    let legs = [(-x, -z), (x, -z), (x, z), (-x, z)]
        .map(|(a, b)| tapered_leg([a, 0.0, b], [a, 0.14, b], 0.024, 0.036));
    let body = PartBuilder::new("body")
        .with_all(wood, carcass.boards(&[SHARE], &[]))
        .with_all(wood, legs);
    let (low, high) = carcass.space(0.0, SHARE);
    let (x, face) = (0.5 * width_m, 0.5 * DEPTH_M);
    let split = carcass.min[1] + SHARE * (height_m - carcass.min[1]);
    let (front_low, front_high) = ([-x, split], [x, height_m - 0.002]);
    let (min, max) = drawer_space(front_low, front_high, face, 0.3);
    Model::articulated("nightstand", "stand")
        .part(body)
        .top("top", [-x, height_m, -face], [x, height_m + 0.6, face])
        .top("shelf", low, high)
        .part(drawer("drawer", front_low, front_high, face, 0.3, front))
        .sliding("drawer", Vec3::Z, 0.24)
        .inside("drawer", min, max)
}
