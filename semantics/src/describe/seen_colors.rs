//! Whether a picture shows the colours that a text tells.

use crate::color::speakers_disagree;
use crate::form::RoomSurfaceKind;
use crate::scene::SemanticScene;
use crate::view::ViewSurvey;
use dwell_scene::{MaterialId, ObjectId, RoomId, StructureKind};

/// Rays from which on colours are held against what is seen: of a speck anything may be so.
const LEAST_RAYS: f32 = 6.0;
/// Share of what is seen from which one colour is told of it alone.
const LEAST_ONLY_COLOR: f32 = 0.75;
/// The same of walls, of which a tenth is a wall of its own.
const LEAST_ONLY_WALLS: f32 = 0.9;

/// Returns whether a thing has the colours by which it is told, as far as it is seen: a cooker of white sheet may show its black glass
/// alone.
pub(super) fn thing_shows(
    scene: &SemanticScene<'_>,
    survey: &ViewSurvey,
    object: ObjectId,
    told: &[String],
) -> bool {
    let rays = survey.materials_of(scene.house(), object);
    if told.is_empty() || is_speck(&rays) {
        return true;
    }
    // Against the light a gray frame is darker than it is.
    if scene.facts(object).is_window() && told.iter().any(|word| word.contains("gray")) {
        return false;
    }
    let paints = scene.semantics.material_colors();
    let facts = scene.facts(object);
    let seen = facts.colors_in_view(scene.house(), paints, &rays);
    agree(told, &seen, LEAST_ONLY_COLOR)
}

/// Returns whether floor or walls of a room have a colour, as far as they are seen: white tiles below yellow paint are no white walls.
pub(super) fn surface_shows(
    scene: &SemanticScene<'_>,
    survey: &ViewSurvey,
    (room, surface): (RoomId, RoomSurfaceKind),
    told: &String,
) -> bool {
    let (kind, least_only) = match surface {
        RoomSurfaceKind::Floor => (StructureKind::Floor, LEAST_ONLY_COLOR),
        RoomSurfaceKind::Walls => (StructureKind::Wall, LEAST_ONLY_WALLS),
    };
    let rays = survey.materials_of_structure(scene.house(), room, kind);
    let told = std::slice::from_ref(told);
    let seen = scene.semantics.surface_color_words(&rays);
    is_speck(&rays) || agree(told, &seen, least_only)
}

fn is_speck(rays: &[(MaterialId, f32)]) -> bool {
    rays.iter().map(|(_, count)| count).sum::<f32>() < LEAST_RAYS
}

/// Returns whether a reader who sees the colours `seen`, with their shares, agrees with those told: the only one is that of at least
/// `least_only` or one between it and another, and each of two is there. What has no colour is not judged.
fn agree(told: &[String], seen: &[(&'static str, f32)], least_only: f32) -> bool {
    let is = |word: &str, own: &str| word == own || speakers_disagree(own, word);
    match (told, seen) {
        (_, []) => true,
        ([only], [(largest, share), ..]) => is(only, largest) && *share >= least_only,
        (all, seen) => all
            .iter()
            .all(|word| seen.iter().any(|(own, _)| is(word, own))),
    }
}
