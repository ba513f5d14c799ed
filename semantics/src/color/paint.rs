//! The colours of a thing.

use super::cielab::cielab_from_linear;
use super::naming::speakers_disagree;
use super::pattern::{SurfacePattern, pattern};
use super::{ColorVocabulary, Oklab};
use dwell_scene::parallel::Threads;
use dwell_scene::units::linear_from_srgb;
use dwell_scene::{House, IdVec, MaterialId, Texture};
use glam::Vec2;

/// Share of the visible surface below which a colour is not worth a word.
pub const MENTION_SHARE: f32 = 0.2;

/// Largest distance of its shades from the colour of a sort, in `OKLab`: the grain of oak spreads 0.05 to 0.1 about its mean, neighbours
/// in a picture lie 0.2 and more apart.
const SHADE: f32 = 0.12;
/// Share of an image from which one sort of colour is that of the whole.
const DOMINANT_SHARE: f32 = 0.6;
/// Share of an image from which a sort of colour is one of a pattern.
const SORT_SHARE: f32 = 0.2;
/// Least difference in chroma between two tints of one sort, in `OKLab`: pale teal and cream are as light as shades of one colour and are
/// two to people.
const TINTS_APART: f32 = 0.04;
/// Largest number of tints of a sort.
const MOST_TINTS: usize = 3;
/// Mean distance of shades from their tint, by that of the nearest two tints, up to which they lie in heaps: evenly spread ones have 0.25.
const HEAP: f32 = 0.2;
/// Approximate number of pixels by which an image is sampled.
const PIXELS: usize = 1024;
/// Number of times that the middle of a sort is moved to the mean of its shades.
const ROUNDS: usize = 4;
/// Number of pixels from which the largest sort is sought.
const SEEDS: usize = 16;

/// A sort of colour of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorShare {
    /// Its colour, in linear light; `None` for the part of pictures and patterns that is of no sort.
    pub linear: Option<[f32; 3]>,
    /// Its fraction of the surface, weighted by opacity; the patches of a thing sum to 1.
    pub share: f32,
}

/// Returns the mean CIELAB lightness of patches by their shares; `None` where none has a colour.
pub(crate) fn lightness(patches: &[ColorShare]) -> Option<f32> {
    let colored = patches
        .iter()
        .filter_map(|patch| Some((cielab_from_linear(patch.linear?).x, patch.share)));
    let (sum, share) = colored.fold((0.0, 0.0), |(sum, share), (own, part)| {
        (sum + own * part, share + part)
    });
    (share > 0.0).then(|| sum / share)
}

/// A colour in linear light and in `OKLab`.
type Shade = ([f32; 3], Oklab);

/// The colours of a material.
#[derive(Clone, Debug, PartialEq)]
struct MaterialPalette {
    /// Its sorts of colour.
    sorts: Vec<ColorShare>,
    /// How they lie on it, where it has several.
    pattern: Option<SurfacePattern>,
}

/// The colours of each material of a house.
#[derive(Debug)]
pub(crate) struct MaterialColors(IdVec<MaterialId, MaterialPalette>);

impl MaterialColors {
    /// Finds the colours of every material of a house.
    pub(crate) fn gather(house: &House) -> Self {
        let decoded = decoded();
        let materials = house.materials.as_slice();
        let paints = Threads::resolve(None).map(materials.len(), |k| {
            let material = &materials[k];
            let base = material.base_color;
            match material.texture {
                Some(texture) => texture_palette(&house.textures[texture], base, &decoded),
                None => MaterialPalette {
                    sorts: vec![ColorShare {
                        linear: Some(base),
                        share: 1.0,
                    }],
                    pattern: None,
                },
            }
        });
        Self(paints.into())
    }

    /// How the colours of a material lie on it, where it has several.
    pub(crate) fn pattern(&self, material: MaterialId) -> Option<SurfacePattern> {
        self.0[material].pattern
    }

    /// The sorts of colour of a surface by the areas of its materials, m² or any other unit, the largest first.
    pub(crate) fn patches(
        &self,
        areas: impl IntoIterator<Item = (MaterialId, f32)>,
    ) -> Vec<ColorShare> {
        let areas: Vec<(MaterialId, f32)> = areas.into_iter().collect();
        let whole: f32 = areas.iter().map(|(_, area)| area).sum();
        let mut patches: Vec<ColorShare> = areas
            .iter()
            .flat_map(|(material, area)| {
                self.0[*material].sorts.iter().map(move |sort| ColorShare {
                    share: sort.share * area / whole,
                    ..*sort
                })
            })
            .collect();
        patches.sort_by(|p, q| q.share.total_cmp(&p.share));
        patches
    }
}

/// The colours of an image times `base`: the sorts of at least [`SORT_SHARE`] and what is left, or the only one, if at least
/// [`DOMINANT_SHARE`] has it.
///
/// A sort is what lies within [`SHADE`] of its own mean; one of several [`tints`] counts as several. The largest is sought from some of the pixels that lie in no sort found
/// before, so that neither a pattern's ground nor a grain about its mean is missed.
/// `decoded`: linear light of every byte. Shape (256,).
fn texture_palette(texture: &Texture, base: [f32; 3], decoded: &[f32; 256]) -> MaterialPalette {
    let count = texture.width as usize * texture.height as usize;
    // A stride that shares a factor with the width would look at some of the columns only.
    let mut step = (count / PIXELS).max(1);
    while step > 1 && common_factor(step, texture.width as usize) > 1 {
        step += 1;
    }
    let edges = [texture.width as usize, texture.height as usize];
    let sampled = texture.sampled_rgba(step);
    let solid = sampled
        .chunks_exact(4)
        .enumerate()
        .filter(|(_, pixel)| pixel[3] > 0);
    let (places, mut left): (Vec<[f32; 2]>, Vec<Shade>) = solid
        .map(|(k, pixel)| {
            let (column, row) = (k * step % edges[0], k * step / edges[0]);
            let place = [
                column as f32 / edges[0] as f32,
                row as f32 / edges[1] as f32,
            ];
            let linear = std::array::from_fn(|k| base[k] * decoded[usize::from(pixel[k])]);
            (place, (linear, Oklab::from_linear(linear)))
        })
        .unzip();
    let shades = places.into_iter().zip(left.iter().map(|(_, shade)| *shade));
    let shades: Vec<_> = shades.collect();
    let whole = left.len() as f32;
    let mut found: Vec<ColorShare> = Vec::new();
    while left.len() as f32 >= (SORT_SHARE * whole).max(1.0) {
        let middle = largest_cluster_mean(&left);
        let lab = Oklab::from_linear(middle);
        let (sort, others): (Vec<Shade>, Vec<Shade>) = left
            .into_iter()
            .partition(|(_, shade)| shade.distance(lab) <= SHADE);
        left = others;
        if (sort.len() as f32) < SORT_SHARE * whole {
            break;
        }
        let share = |count: usize| count as f32 / whole;
        match tints(&sort, SORT_SHARE * whole) {
            Some(tints) => found.extend(tints.into_iter().map(|(linear, count)| ColorShare {
                linear: Some(linear),
                share: share(count),
            })),
            None => found.push(ColorShare {
                linear: Some(middle),
                share: share(sort.len()),
            }),
        }
    }
    let pattern = (found.len() > 1).then(|| pattern(&shades));
    let sorts = if let [sort] = found[..]
        && sort.share >= DOMINANT_SHARE
    {
        vec![ColorShare { share: 1.0, ..sort }]
    } else {
        let share = 1.0 - found.iter().map(|sort| sort.share).sum::<f32>();
        found.push(ColorShare {
            linear: None,
            share,
        });
        found
    };
    MaterialPalette { sorts, pattern }
}

/// The mean of the largest sort of colour among `shades`, which are some.
fn largest_cluster_mean(shades: &[Shade]) -> [f32; 3] {
    let mut best = ([0.0; 3], 0);
    let mut found: Vec<Oklab> = Vec::new();
    // From pixels alone: the mean of two sorts may lie near enough to both.
    for k in 0..SEEDS {
        let (mut middle, seed) = shades[shades.len() * k / SEEDS];
        // What lies about the middle of a sort leads there again.
        if found.iter().any(|own| own.distance(seed) <= 0.5 * SHADE) {
            continue;
        }
        let mut size = 0;
        for _ in 0..ROUNDS {
            let lab = Oklab::from_linear(middle);
            let near = shades.iter().filter(|(_, s)| s.distance(lab) <= SHADE);
            let (moved, count) = mean(near.map(|(linear, _)| *linear));
            size = count;
            if size == 0 || moved == middle {
                break;
            }
            middle = moved;
        }
        found.push(Oklab::from_linear(middle));
        if size > best.1 {
            best = (middle, size);
        }
        // No other can be larger.
        if 2 * size > shades.len() {
            break;
        }
    }
    best.0
}

/// The tints of a sort of colour with their numbers of shades, the largest first, if its shades lie in two or three heaps of at least
/// `least` by their chroma; else none.
fn tints(shades: &[Shade], least: f32) -> Option<Vec<([f32; 3], usize)>> {
    let number = shades.len() as f32;
    let mut sums = [Vec2::ZERO; 2];
    for (_, shade) in shades {
        let chroma = Vec2::new(shade.a, shade.b);
        sums[0] += chroma;
        sums[1] += chroma * chroma;
    }
    let [mean, squares] = sums.map(|sum| sum / number);
    let variance = (squares - mean * mean).element_sum();
    // Two heaps with shares p and 1 - p that lie d apart have at least p (1 - p) d^2: grain has less.
    let share = least / number;
    if variance < share * (1.0 - share) * TINTS_APART * TINTS_APART {
        return None;
    }
    let mut fits = (2..=MOST_TINTS).take_while(|count| *count as f32 * least <= number);
    fits.find_map(|count| heaps(shades, count, least))
}

/// As [`tints`], of `count` heaps: k-means, from shades each farthest from those before.
fn heaps(shades: &[Shade], count: usize, least: f32) -> Option<Vec<([f32; 3], usize)>> {
    let chroma = |shade: &Shade| Vec2::new(shade.1.a, shade.1.b);
    let nearest = |at: Vec2, middles: &[Vec2]| {
        let all = middles.iter().map(|middle| middle.distance(at)).enumerate();
        all.min_by(|p, q| p.1.total_cmp(&q.1)).unwrap_or((0, 0.0))
    };
    let mut middles = vec![chroma(shades.first()?)];
    for k in 0..=count {
        let all = shades.iter().map(chroma);
        let distance = |at: &Vec2| nearest(*at, &middles).1;
        middles.extend(all.max_by(|p, q| distance(p).total_cmp(&distance(q))));
        if k == 0 {
            // The first shade is as good as any; the one farthest from it lies at an end.
            middles.remove(0);
        }
    }
    middles.truncate(count);
    let mut own = vec![0; shades.len()];
    for _ in 0..ROUNDS {
        let mut sums = vec![(Vec2::ZERO, 0_usize); count];
        for (shade, own) in shades.iter().zip(&mut own) {
            *own = nearest(chroma(shade), &middles).0;
            sums[*own].0 += chroma(shade);
            sums[*own].1 += 1;
        }
        if sums.iter().any(|(_, count)| (*count as f32) < least) {
            return None;
        }
        let moved = sums.into_iter().map(|(sum, count)| sum / count as f32);
        middles = moved.collect();
    }
    let pairs = (0..count).flat_map(|p| (0..p).map(move |q| (p, q)));
    let apart = pairs.map(|(p, q)| middles[p].distance(middles[q]));
    let apart = apart.fold(f32::INFINITY, f32::min);
    let spread = shades.iter().zip(&own);
    let spread = spread.map(|(shade, own)| chroma(shade).distance(middles[*own]));
    let spread = spread.sum::<f32>() / shades.len() as f32;
    if apart < TINTS_APART || spread > HEAP * apart {
        return None;
    }
    let tint = |k: usize| {
        let members = shades.iter().zip(&own).filter(|(_, own)| **own == k);
        mean(members.map(|((linear, _), _)| *linear))
    };
    let mut tints: Vec<_> = (0..count).map(tint).collect();
    tints.sort_by_key(|tint| std::cmp::Reverse(tint.1));
    Some(tints)
}

/// The greatest common divisor (Euclid).
fn common_factor(p: usize, q: usize) -> usize {
    if q == 0 { p } else { common_factor(q, p % q) }
}

/// The mean of colours and their number; zero of none.
fn mean(colors: impl Iterator<Item = [f32; 3]>) -> ([f32; 3], usize) {
    let (mut sum, mut count) = ([0.0_f32; 3], 0);
    for color in colors {
        for (total, value) in sum.iter_mut().zip(color) {
            *total += value;
        }
        count += 1;
    }
    (sum.map(|total| total / count.max(1) as f32), count)
}

/// Linear light of every byte of an image.
fn decoded() -> [f32; 256] {
    std::array::from_fn(|byte| linear_from_srgb(byte as f32 / 255.0))
}

/// The words for the colours of `patches`, the largest share first.
///
/// Patches of equal words count together, as do those of a word and one between it and another, by the larger; pictures and patterns have none; words under [`MENTION_SHARE`] are dropped, unless
/// that leaves none of a thing without pictures and patterns.
pub fn color_words(
    patches: &[ColorShare],
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
    if [ColorVocabulary::Spoken, ColorVocabulary::Surface].contains(&vocabulary) {
        merge_divided(&mut words);
    }
    let mentioned = words
        .iter()
        .filter(|(_, share)| *share >= MENTION_SHARE)
        .count();
    let plain = patches.iter().all(|patch| patch.linear.is_some());
    words.truncate(mentioned.max(usize::from(plain)));
    words
}

/// Counts what people may call by a larger share's word with it: a cream thing with white parts is cream. Of the words on both sides
/// of one between them only the larger: white and gray parts do not make a light gray thing.
fn merge_divided(words: &mut Vec<(&'static str, f32)>) {
    // Each word with its share, and the share of the one that was counted with it.
    let mut merged: Vec<(&'static str, f32, f32)> = Vec::new();
    for (word, share) in words.drain(..) {
        let mut known = merged.iter_mut();
        match known.find(|(known, _, joined)| *joined == 0.0 && speakers_disagree(known, word)) {
            Some((_, _, joined)) => *joined = share,
            None => merged.push((word, share, 0.0)),
        }
    }
    let merged = merged.into_iter();
    words.extend(merged.map(|(word, share, joined)| (word, share + joined)));
    words.sort_by(|p, q| q.1.total_cmp(&p.1).then(p.0.cmp(q.0)));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn patch(linear: [f32; 3], share: f32) -> ColorShare {
        ColorShare {
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
        let picture = ColorShare {
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

    /// The words for the colours of an image.
    fn words(texture: &Texture) -> Vec<&'static str> {
        let words = color_words(
            &texture_palette(texture, [1.0; 3], &decoded()).sorts,
            ColorVocabulary::Plain,
        );
        words.into_iter().map(|(word, _)| word).collect()
    }

    #[test]
    fn the_sorts_of_colour_of_an_image_are_found() {
        let grain = |x: usize, _| [150 + (x % 5) as u8 * 5, 111 + (x % 5) as u8 * 4, 72];
        assert_eq!(words(&image(grain)), ["brown"]);
        // Red dots on white; the mean is pink.
        let dots = |x: usize, y: usize| {
            if x.is_multiple_of(4) || y.is_multiple_of(8) {
                [190, 20, 25]
            } else {
                [250; 3]
            }
        };
        assert_eq!(words(&image(dots)), ["white", "red"]);
        let stripes = |x: usize, _| {
            if x % 16 < 8 {
                [190, 20, 25]
            } else {
                [30, 60, 150]
            }
        };
        assert_eq!(words(&image(stripes)), ["blue", "red"]);
        // Seven sorts, each of a seventh of the image.
        let palette = [
            [188, 212, 226],
            [72, 110, 52],
            [176, 40, 44],
            [240, 220, 60],
            [20, 20, 22],
            [30, 60, 140],
            [230, 150, 180],
        ];
        let picture = |_, y: usize| palette[y * 7 / 64];
        assert!(words(&image(picture)).is_empty());
        // Pale teal and cream, as light as each other, each with a grain; a grain alone makes no two.
        let rug = |x: usize, y: usize| {
            let grain = (x * 7 % 5) as u8 * 3;
            let tint: [u8; 3] = if y % 16 < 8 {
                [158, 183, 177]
            } else {
                [214, 203, 182]
            };
            tint.map(|channel| channel + grain)
        };
        // Basic terms have no teal.
        assert_eq!(words(&image(rug)), ["blue", "white"]);
        // Crimson and dark green between brown ones, all of them dark.
        let plaid = |x: usize, y: usize| match (x % 16 < 8, y % 16 < 8) {
            (true, true) => [124, 45, 53],
            (false, false) => [60, 90, 69],
            _ => [93, 68, 61],
        };
        assert_eq!(words(&image(plaid)), ["brown", "green", "red"]);
        let thirds = |_, y: usize| [[150, 190, 230], [40, 110, 50], [180, 30, 30]][y * 3 / 64];
        assert_eq!(words(&image(thirds)), ["blue", "green", "red"]);
        // All of it see-through.
        assert!(words(&Texture::new("none".to_owned(), 1, 1, vec![0; 4])).is_empty());
    }
}
