//! Stairs between storeys, and the railing where they end.

use std::sync::Arc;

use super::assembly::HouseAssembly;
use super::yaw::yaw_rotation;
use dwell_furniture::finishes::Finish;
use dwell_furniture::model::Model;
use dwell_furniture::model_cache::cached_custom_model;
use dwell_furniture::models::stairs::{Stairs, railing};
use dwell_furniture::style::Style;
use dwell_scene::{Pose, RoomId};
use glam::Vec3;

/// Half of the thickness of a railing with its distance from the edge, m.
pub(crate) const RAILING_INSET_M: f32 = 0.05;

/// The pose of two flights beside each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StairPlacement {
    /// The middle of the front edge on the storey's floor, m.
    pub(crate) front: Vec3,
    /// The direction in which the first flight climbs, (x, z): one step along an axis.
    pub(crate) climb: [i32; 2],
    /// True if the first flight is at the right, seen along it, instead of at the left.
    pub(crate) mirrored: bool,
    /// Width of both flights together, m.
    pub(crate) width_m: f32,
    /// Depth from the front edge to the landing's far end, m.
    pub(crate) depth_m: f32,
}

impl StairPlacement {
    fn climb(&self) -> Vec3 {
        Vec3::new(self.climb[0] as f32, 0.0, self.climb[1] as f32)
    }

    /// The model climbs towards -Z.
    fn yaw_deg(&self) -> f32 {
        match (self.climb[0], self.climb[1]) {
            (0, -1) => 0.0,
            (-1, _) => 90.0,
            (0, _) => 180.0,
            _ => -90.0,
        }
    }
}

/// Puts stairs to the next storey, `rise_m` higher. `goes_on`: another flight starts there.
pub(crate) fn add_stairs(
    assembly: &mut HouseAssembly,
    flights: &StairPlacement,
    rise_m: f32,
    goes_on: bool,
    style: &Style,
    room: RoomId,
) {
    let model = Stairs {
        width_m: flights.width_m,
        depth_m: flights.depth_m,
        rise_m,
        continues_up: goes_on,
        mirrored: flights.mirrored,
        wood: style.wood.clone(),
        paint: Finish::plain("stair_white", "wood", [238, 236, 230]),
    };
    let kind = assembly.add_model(cached_custom_model(format!("{model:?}"), || model.build()));
    let pose = Pose::new(flights.front, yaw_rotation(flights.yaw_deg()));
    assembly.add_instance(&kind, pose, room, 0.0);
}

/// Puts a railing where a first flight would start on the storey where the stairs end.
pub(crate) fn add_railing(
    assembly: &mut HouseAssembly,
    flights: &StairPlacement,
    style: &Style,
    room: RoomId,
) {
    let climb = flights.climb();
    // From the first flight to the second.
    let across = if flights.mirrored {
        Vec3::Y.cross(climb)
    } else {
        climb.cross(Vec3::Y)
    };
    let side = -across * 0.25 * flights.width_m;
    let kind = assembly.add_model(railing_model(0.5 * flights.width_m, style));
    let back = climb * (RAILING_INSET_M - 0.1);
    let pose = Pose::new(flights.front + side + back, yaw_rotation(flights.yaw_deg()));
    assembly.add_instance(&kind, pose, room, 0.0);
}

/// A railing of a length.
pub(crate) fn railing_model(length_m: f32, style: &Style) -> Arc<Model> {
    let metal = &style.metal;
    cached_custom_model(format!("railing {length_m} {metal:?}"), || {
        railing(length_m, metal)
    })
}
