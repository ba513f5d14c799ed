//! The colours of a thing.

use super::Vocabulary;
use dwell_scene::{House, IdVec, MaterialId, TextureId};

/// Share of the visible surface below which a colour is not worth a word.
pub const MENTION_SHARE: f32 = 0.2;

/// Mean colour of every material of a house, linear light. Shape (material,).
pub(crate) fn material_colors(house: &House) -> IdVec<MaterialId, [f32; 3]> {
    let textures: IdVec<TextureId, [f32; 3]> = house
        .textures
        .iter()
        .map(|texture| texture.mean_linear())
        .collect();
    house
        .materials
        .iter()
        .map(|material| {
            let image = material
                .texture
                .map_or([1.0; 3], |texture| textures[texture]);
            std::array::from_fn(|k| material.base_color[k] * image[k])
        })
        .collect()
}

/// One material's part of a thing's surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// The material.
    pub material: MaterialId,
    /// Its mean colour in linear light (texture times base colour).
    pub linear: [f32; 3],
    /// Its fraction of the surface, weighted by opacity; the patches of a thing sum to 1.
    pub share: f32,
}

/// The words for the colours of `patches`, the largest share first.
///
/// Patches of equal words count together; words under [`MENTION_SHARE`] are dropped, unless that leaves none.
pub fn color_words(patches: &[Patch], vocabulary: Vocabulary) -> Vec<(&'static str, f32)> {
    let mut words: Vec<(&'static str, f32)> = Vec::new();
    for patch in patches {
        let word = vocabulary.word(patch.linear);
        match words.iter_mut().find(|(known, _)| *known == word) {
            Some((_, share)) => *share += patch.share,
            None => words.push((word, patch.share)),
        }
    }
    words.sort_by(|p, q| q.1.total_cmp(&p.1).then(p.0.cmp(q.0)));
    let mentioned = words
        .iter()
        .filter(|(_, share)| *share >= MENTION_SHARE)
        .count();
    words.truncate(mentioned.max(1));
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    fn patch(linear: [f32; 3], share: f32) -> Patch {
        Patch {
            material: MaterialId(0),
            linear,
            share,
        }
    }

    #[test]
    fn equal_words_add_up_and_small_shares_are_dropped() {
        let patches = [
            patch([0.6, 0.0, 0.0], 0.15),
            patch([0.5, 0.0, 0.0], 0.15),
            patch([0.0, 0.0, 0.6], 0.55),
            patch([0.9, 0.9, 0.9], 0.15),
        ];
        let words: Vec<_> = color_words(&patches, Vocabulary::Plain)
            .iter()
            .map(|w| w.0)
            .collect();
        assert_eq!(words, ["blue", "red"]);
        let one = color_words(&[patch([1.0; 3], 0.1)], Vocabulary::Plain);
        assert_eq!(one[0].0, "white");
        assert!(color_words(&[], Vocabulary::Plain).is_empty());
    }
}
