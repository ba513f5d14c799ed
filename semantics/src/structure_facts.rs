//! Colours and substances of walls, floors and ceilings.

use crate::color::{ColorVocabulary, color_words};
use crate::facts::shows_color;
use crate::material_family::family_of;
use crate::semantics::Semantics;
use crate::truth::Truth;
use dwell_scene::material::library;
use dwell_scene::{MaterialId, StructureId, StructureKind};
use std::collections::BTreeMap;

/// Smallest share of a piece's surface that gives it a colour or substance, as with objects.
const LEAST_SHARE: f32 = 0.2;

/// The shares of a piece's surface by material; of floors the upper side alone counts.
fn shares(semantics: &Semantics, piece: StructureId) -> BTreeMap<MaterialId, f32> {
    let house = semantics.house();
    let piece = &house.structure[piece];
    let mesh = &house.meshes[piece.mesh];
    let mut areas: BTreeMap<MaterialId, f32> = BTreeMap::new();
    for triangle in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(triangle);
        let normal = (b - a).cross(c - a);
        let is_seen = piece.kind != StructureKind::Floor || normal.y > 0.5 * normal.length();
        if let Some(id) = piece.materials.get(usize::from(mesh.slot(triangle)))
            && is_seen
        {
            *areas.entry(*id).or_insert(0.0) += 0.5 * normal.length();
        }
    }
    let whole: f32 = areas.values().sum();
    for area in areas.values_mut() {
        *area /= whole.max(f32::MIN_POSITIVE);
    }
    areas
}

/// Returns whether a piece of the building shows a colour; undecided where people divide on it.
pub(crate) fn has_color(semantics: &Semantics, piece: StructureId, word: &str) -> Truth {
    let patches = semantics
        .material_colors()
        .patches(shares(semantics, piece));
    let words = color_words(&patches, ColorVocabulary::Surface);
    let large = words.iter().filter(|(_, share)| *share >= LEAST_SHARE);
    shows_color(large.map(|(own, _)| *own), word)
}

/// Returns whether a piece of the building is made of a substance, or of one of its family.
pub(crate) fn has_material(semantics: &Semantics, piece: StructureId, word: &str) -> bool {
    let house = semantics.house();
    let large = shares(semantics, piece).into_iter();
    let mut large = large.filter(|(_, share)| *share >= LEAST_SHARE);
    large.any(|(material, _)| {
        let substance = library().get(&house.materials[material].substance);
        substance.is_some_and(|substance| {
            let own = substance.adjective.as_str();
            own == word || family_of(own) == Some(word)
        })
    })
}
