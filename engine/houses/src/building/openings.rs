//! Doors and windows in holes of walls.

use std::f32::consts::FRAC_PI_2;

use super::assembly::HouseAssembly;
use dwell_furniture::model_cache::cached_custom_model;
use dwell_furniture::models::doors::Door;
use dwell_furniture::models::windows::Window;
use dwell_scene::{Pose, RoomId};

/// Hangs a door into a hole, open by `openness` (0 to 1). `square`: the leaf opens to a right angle, as beside an outer wall,
/// which is thicker.
pub(crate) fn add_door(
    assembly: &mut HouseAssembly,
    door: &Door,
    square: bool,
    pose: Pose,
    room: RoomId,
    openness: f32,
) {
    let settings = format!("{door:?} square {square}");
    let kind = assembly.add_model(cached_custom_model(settings, || {
        let mut model = door.build();
        for joint in model.joints.iter_mut().filter(|_| square) {
            joint.open = joint.open.min(FRAC_PI_2);
        }
        model
    }));
    assembly.add_instance(&kind, pose, room, openness);
}

/// Puts a window into a hole; `pose` is its middle, the room at +Z.
pub(crate) fn add_window(assembly: &mut HouseAssembly, window: &Window, pose: Pose, room: RoomId) {
    let kind = assembly.add_model(cached_custom_model(format!("{window:?}"), || {
        window.build()
    }));
    assembly.add_instance(&kind, pose, room, 0.0);
}
