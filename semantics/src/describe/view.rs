//! The description of a view.

use super::contents::grouped;
use crate::english::{capitalized, list};
use crate::scene::{SemanticScene, Viewer};
use dwell_scene::ObjectId;
use dwell_scene::space::azimuth_elevation;

/// Half the width of "ahead", rad: 12 degrees.
const AHEAD_RAD: f32 = 0.21;

/// The description of a view, given the objects that are visible in it (as pixel counts or rays say), nearest sides
/// named: "In the kitchen. To the left there is a table; ahead there are two chairs."
pub fn describe_view(scene: &SemanticScene<'_>, viewer: &Viewer, visible: &[ObjectId]) -> String {
    let mut sides: [(&str, Vec<ObjectId>); 3] = [
        ("to the left", Vec::new()),
        ("ahead", Vec::new()),
        ("to the right", Vec::new()),
    ];
    for object in visible {
        let (azimuth, _) =
            azimuth_elevation(viewer.upright_from_world(scene.extent(*object).bounds.center()));
        let side = match azimuth {
            a if a > AHEAD_RAD => 0,
            a if a < -AHEAD_RAD => 2,
            _ => 1,
        };
        sides[side].1.push(*object);
    }
    let mut sentences = Vec::new();
    let here = scene.house().room_at(viewer.world_from_camera.position);
    sentences.extend(here.map(|room| format!("You are {}.", scene.semantics.room(room).place())));
    for (words, objects) in &sides {
        if !objects.is_empty() {
            let texts: Vec<String> = grouped(scene, objects)
                .iter()
                .map(|group| group.text(scene))
                .collect();
            sentences.push(format!("{} you see {}.", capitalized(words), list(&texts)));
        }
    }
    if visible.is_empty() {
        sentences.push("You see nothing but walls.".to_owned());
    }
    sentences.join(" ")
}
