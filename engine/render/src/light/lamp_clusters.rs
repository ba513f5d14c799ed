//! Shadow casters: the lamps of one thing as one point.
//!
//! A chandelier's bulbs or the quarters of a line hang so near to one another that one ray stands for all of them.

use super::indirect::luminance;
use super::lamps::PointLamp;
use dwell_scene::House;
use glam::Vec3;

/// Casts no shadows.
pub(crate) const NONE: u32 = u32::MAX;

/// Distance below a lamp, or above a low one, of the places that test whether its light gets out, m.
const BELOW_M: f32 = 0.8;
const ABOVE_M: f32 = 0.5;
/// Lamps that hang higher than this over the floor are looked at from below, m.
const LOW_M: f32 = 1.2;
/// Horizontal distance of these places, m.
const ASIDE_M: f32 = 0.6;

/// Lamps of one thing in one room.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LampCluster {
    /// The middle of its lamps by their light.
    pub(crate) center: Vec3,
    /// Index of its first lamp among all, and their number.
    pub(super) lamps: (usize, usize),
    /// The thing; it casts no shadow of this light.
    pub(crate) entity: i32,
}

/// Assigns each lamp its caster. `lamps`: those of one thing in one room side by side. `passes`: whether light comes from one point
/// to another past a thing.
///
/// Lamps whose light cannot leave, such as one above the ceiling that it should light, cast no shadows: their light passes all.
pub(crate) fn cluster_lamps(
    house: &House,
    lamps: &mut [PointLamp],
    casters: &mut Vec<LampCluster>,
    passes: impl Fn(Vec3, Vec3, i32) -> bool,
) {
    casters.clear();
    let mut first = 0;
    for group in lamps.chunk_by_mut(|a, b| (a.room, a.entity) == (b.room, b.entity)) {
        let weight = |lamp: &PointLamp| luminance(lamp.flux_lm).max(1e-6);
        let all: f32 = group.iter().map(weight).sum();
        let middle = group
            .iter()
            .fold(Vec3::ZERO, |sum, lamp| sum + lamp.position * weight(lamp));
        let center = middle / all;
        let caster = LampCluster {
            center,
            lamps: (first, group.len()),
            entity: group[0].entity,
        };
        first += group.len();
        let floor_y = group[0].room.and_then(|room| house.rooms.iter().nth(room));
        let is_low = floor_y.is_some_and(|room| caster.center.y - room.floor_y < LOW_M);
        let beside = |[x, z]: [f32; 2]| {
            let up = if is_low { ABOVE_M } else { -BELOW_M };
            caster.center + Vec3::new(x * ASIDE_M, up, z * ASIDE_M)
        };
        let places = [
            [0.0, 0.0],
            [1.0, 1.0],
            [-1.0, 1.0],
            [-1.0, -1.0],
            [1.0, -1.0],
        ];
        if places
            .into_iter()
            .any(|place| passes(caster.center, beside(place), caster.entity))
        {
            let next = casters.len() as u32;
            casters.push(caster);
            for lamp in group {
                lamp.cluster = next;
            }
        }
    }
}
