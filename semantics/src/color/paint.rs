//! The colours of a thing.

use super::{ColorVocabulary, Oklab};
use dwell_scene::parallel::Threads;
use dwell_scene::units::linear_from_srgb;
use dwell_scene::{House, IdVec, MaterialId, Texture};

/// Share of the visible surface below which a colour is not worth a word.
pub const MENTION_SHARE: f32 = 0.2;

/// Largest distance of its shades from the colour of a sort, in `OKLab`: the grain of oak spreads 0.05 to 0.1 about its mean, neighbours
/// in a picture lie 0.2 and more apart.
const SHADE: f32 = 0.15;
/// Share of an image from which one sort of colour is that of the whole.
const DOMINANT_SHARE: f32 = 0.6;
/// Approximate number of pixels by which an image is sampled.
const PIXELS: usize = 1024;
/// Number of times that the middle of a sort is moved to the mean of its shades.
const ROUNDS: usize = 4;

/// The colour that most of each material of a house has, in linear light: the mean of that sort of colour, times base colour; `None`
/// for pictures and patterns of several sorts. Shape (material,).
pub(crate) type MaterialColors = IdVec<MaterialId, Option<[f32; 3]>>;

/// The colours of every material of a house.
pub(crate) fn material_colors(house: &House) -> MaterialColors {
    let decoded = decoded();
    let materials = house.materials.as_slice();
    Threads::resolve(None)
        .map(materials.len(), |k| {
            let material = &materials[k];
            let base = material.base_color;
            match material.texture {
                Some(texture) => dominant(&house.textures[texture], base, &decoded),
                None => Some(base),
            }
        })
        .into()
}

/// The mean of the sort of colour that at least [`DOMINANT_SHARE`] of an image has, times `base`.
///
/// A sort is what lies within [`SHADE`] of its own mean. It is sought from the image's mean and from each of its pixels that
/// lies in no sort found before, so that neither a pattern's ground nor a grain about its mean is missed.
/// `decoded`: linear light of every byte. Shape (256,).
fn dominant(texture: &Texture, base: [f32; 3], decoded: &[f32; 256]) -> Option<[f32; 3]> {
    let solid = |pixel: &&[u8]| pixel[3] > 0;
    let count = texture.width as usize * texture.height as usize;
    let step = (count / PIXELS).max(1);
    // Strides that share a factor with the width would look at a few columns only.
    let step = step | 1;
    let shades: Vec<([f32; 3], Oklab)> = texture
        .sampled_rgba(step)
        .chunks_exact(4)
        .filter(solid)
        .map(|pixel| {
            let linear = std::array::from_fn(|k| base[k] * decoded[usize::from(pixel[k])]);
            (linear, Oklab::from_linear(linear))
        })
        .collect();
    let needed = DOMINANT_SHARE * shades.len() as f32;
    let mut middle = mean(shades.iter().map(|(linear, _)| *linear))?;
    let mut left: Vec<Oklab> = shades.iter().map(|(_, lab)| *lab).collect();
    loop {
        let mut near = Vec::new();
        for _ in 0..ROUNDS {
            let lab = Oklab::from_linear(middle);
            near = shades
                .iter()
                .filter(|(_, shade)| shade.distance(lab) <= SHADE)
                .map(|(linear, _)| *linear)
                .collect();
            let Some(moved) = mean(near.iter().copied()) else {
                break;
            };
            middle = moved;
        }
        if near.len() as f32 >= needed {
            return Some(middle);
        }
        let found = Oklab::from_linear(middle);
        let before = left.len();
        left.retain(|shade| shade.distance(found) > SHADE);
        // What is left is too little to be most of it, or nothing was taken away.
        if (left.len() as f32) < needed || left.len() == before {
            return None;
        }
        let start = left[left.len() / 2];
        middle = shades.iter().find(|(_, lab)| *lab == start)?.0;
    }
}

fn mean(colors: impl Iterator<Item = [f32; 3]>) -> Option<[f32; 3]> {
    let (mut sum, mut count) = ([0.0_f32; 3], 0.0_f32);
    for color in colors {
        for (total, value) in sum.iter_mut().zip(color) {
            *total += value;
        }
        count += 1.0;
    }
    (count > 0.0).then(|| sum.map(|total| total / count))
}

/// Linear light of every byte of an image.
fn decoded() -> [f32; 256] {
    std::array::from_fn(|byte| linear_from_srgb(byte as f32 / 255.0))
}

/// One material's part of a thing's surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePatch {
    /// The material.
    pub material: MaterialId,
    /// The colour that most of it has, in linear light; `None` for pictures and patterns of several sorts of colour.
    pub linear: Option<[f32; 3]>,
    /// Its fraction of the surface, weighted by opacity; the patches of a thing sum to 1.
    pub share: f32,
}

/// The words for the colours of `patches`, the largest share first.
///
/// Patches of equal words count together; pictures and patterns have none; words under [`MENTION_SHARE`] are dropped, unless
/// that leaves none of a thing without pictures and patterns.
pub fn color_words(
    patches: &[SurfacePatch],
    vocabulary: ColorVocabulary,
) -> Vec<(&'static str, f32)> {
    let mut words: Vec<(&'static str, f32)> = Vec::new();
    for patch in patches {
        let Some(linear) = patch.linear else {
            continue;
        };
        let word = vocabulary.word(linear);
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
    let plain = patches.iter().all(|patch| patch.linear.is_some());
    words.truncate(mentioned.max(usize::from(plain)));
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    fn patch(linear: [f32; 3], share: f32) -> SurfacePatch {
        SurfacePatch {
            material: MaterialId(0),
            linear: Some(linear),
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
        let words: Vec<_> = color_words(&patches, ColorVocabulary::Plain)
            .iter()
            .map(|w| w.0)
            .collect();
        assert_eq!(words, ["blue", "red"]);
        let one = color_words(&[patch([1.0; 3], 0.1)], ColorVocabulary::Plain);
        assert_eq!(one[0].0, "white");
        assert!(color_words(&[], ColorVocabulary::Plain).is_empty());
    }

    #[test]
    fn a_picture_in_a_thin_frame_has_no_word() {
        let picture = SurfacePatch {
            linear: None,
            ..patch([0.0; 3], 0.9)
        };
        let frame = patch([0.0, 0.0, 0.6], 0.1);
        assert!(color_words(&[picture, frame], ColorVocabulary::Plain).is_empty());
        let wide = patch([0.0, 0.0, 0.6], 0.4);
        assert_eq!(
            color_words(&[picture, wide], ColorVocabulary::Plain)[0].0,
            "blue"
        );
    }

    /// An image of 64 by 64 pixels.
    fn image(color: impl Fn(usize, usize) -> [u8; 3]) -> Texture {
        let pixels = (0..64 * 64).flat_map(|k| {
            let [r, g, b] = color(k % 64, k / 64);
            [r, g, b, 255]
        });
        Texture::new("image".to_owned(), 64, 64, pixels.collect())
    }

    fn word(texture: &Texture) -> Option<&'static str> {
        dominant(texture, [1.0; 3], &decoded()).map(|linear| ColorVocabulary::Plain.word(linear))
    }

    #[test]
    fn a_sort_of_colour_is_found_where_it_prevails() {
        let grain = |x: usize, _| [150 + (x % 5) as u8 * 5, 111 + (x % 5) as u8 * 4, 72];
        assert_eq!(word(&image(grain)), Some("brown"));
        // Red dots on white; the mean is pink.
        let dots = |x: usize, y: usize| {
            if x.is_multiple_of(4) || y.is_multiple_of(8) {
                [190, 20, 25]
            } else {
                [250; 3]
            }
        };
        assert_eq!(word(&image(dots)), Some("white"));
        let stripes = |x: usize, _| {
            if x % 16 < 8 {
                [190, 20, 25]
            } else {
                [30, 60, 150]
            }
        };
        assert_eq!(word(&image(stripes)), None);
        let thirds = |_, y: usize| [[188, 212, 226], [72, 110, 52], [176, 40, 44]][y * 3 / 64];
        assert_eq!(word(&image(thirds)), None);
        // All of it see-through.
        assert_eq!(
            word(&Texture::new("none".to_owned(), 1, 1, vec![0; 4])),
            None
        );
    }
}
