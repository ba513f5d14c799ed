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
    agree(told, &seen)
}

/// Returns whether floor or walls of a room have a colour, as far as they are seen: white tiles below yellow paint are no white walls, nor
/// are three white walls and one of brick, whichever room that one is listed with.
pub(super) fn surface_shows(
    scene: &SemanticScene<'_>,
    survey: &ViewSurvey,
    (room, surface): (RoomId, RoomSurfaceKind),
    told: &String,
) -> bool {
    let (kind, room) = match surface {
        RoomSurfaceKind::Floor => (StructureKind::Floor, Some(room)),
        RoomSurfaceKind::Walls => (StructureKind::Wall, None),
    };
    let rays = survey.materials_of_structure(scene.house(), room, kind);
    if is_speck(&rays) {
        return true;
    }
    if surface == RoomSurfaceKind::Floor {
        let seen = scene.semantics.surface_color_words(&rays);
        return agree(std::slice::from_ref(told), &seen);
    }
    // Each material by its own word: what is white below and cream above is of two colours, though a cream thing may be called white.
    let is_told = |(material, _): &&(MaterialId, f32)| {
        let words = scene.semantics.surface_color_words(&[(*material, 1.0)]);
        words.first().is_none_or(|(word, _)| word == told)
    };
    let whole: f32 = rays.iter().map(|(_, count)| count).sum();
    let same: f32 = rays.iter().filter(is_told).map(|(_, count)| count).sum();
    same >= LEAST_ONLY_COLOR * whole
}

fn is_speck(rays: &[(MaterialId, f32)]) -> bool {
    rays.iter().map(|(_, count)| count).sum::<f32>() < LEAST_RAYS
}

/// Returns whether a reader who sees the colours `seen`, with their shares, agrees with those told: the only one is that of at least
/// [`LEAST_ONLY_COLOR`] or one between it and another, and each of two is there. What has no colour is not judged.
fn agree(told: &[String], seen: &[(&'static str, f32)]) -> bool {
    let is = |word: &str, own: &str| word == own || speakers_disagree(own, word);
    match (told, seen) {
        (_, []) => true,
        ([only], [(largest, share), ..]) => is(only, largest) && *share >= LEAST_ONLY_COLOR,
        (all, seen) => all
            .iter()
            .all(|word| seen.iter().any(|(own, _)| is(word, own))),
    }
}
