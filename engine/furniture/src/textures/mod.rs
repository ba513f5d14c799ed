//! Procedural images. Each recipe is one function and one line in `recipes`; the same pattern gives the same bytes.

mod boards;
mod canvas;
mod cloth;
mod noise;
mod papers;
mod pictures;
mod prints;
mod screens;
mod stones;
mod tiles;

use canvas::PixelCanvas;
use dwell_scene::Texture;
use dwell_scene::random::RandomKey;
use noise::ValueNoise;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// A colour, sRGB-encoded, each 0 to 255.
pub type Srgb = [u8; 3];

/// An image to be made: a recipe, its colours and its seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct TexturePattern {
    /// A name of the list of recipes.
    pub generator: &'static str,
    /// Ground, second and third colour.
    pub colors: [Srgb; 3],
    /// Same seed, same image.
    pub seed: u64,
}

/// The inputs of a recipe: colours, noise and random key.
struct TexturePaint {
    colors: [[f32; 3]; 3],
    noise: ValueNoise,
    key: RandomKey,
}

/// The recipe of one kind of image.
struct TextureGenerator {
    name: &'static str,
    /// Pixels across and down.
    size_px: [u32; 2],
    draw: fn(&mut PixelCanvas, &TexturePaint),
}

/// All kinds of images.
fn recipes() -> &'static [TextureGenerator] {
    const fn recipe(
        name: &'static str,
        width_px: u32,
        height_px: u32,
        draw: fn(&mut PixelCanvas, &TexturePaint),
    ) -> TextureGenerator {
        TextureGenerator {
            name,
            size_px: [width_px, height_px],
            draw,
        }
    }
    const ALL: &[TextureGenerator] = &[
        recipe("wood", 256, 256, boards::wood),
        recipe("planks", 384, 384, boards::planks),
        recipe("herringbone", 384, 384, boards::herringbone),
        recipe("tile", 256, 256, tiles::tile),
        recipe("brick", 256, 256, tiles::brick),
        recipe("metro", 128, 128, tiles::metro),
        recipe("plaster", 128, 128, stones::plaster),
        recipe("marble", 256, 256, stones::marble),
        recipe("speckle", 128, 128, stones::speckle),
        recipe("carpet", 128, 128, cloth::carpet),
        recipe("weave", 64, 64, cloth::weave),
        recipe("leather", 128, 128, cloth::leather),
        recipe("stripes", 128, 128, cloth::stripes),
        recipe("checks", 128, 128, cloth::checks),
        recipe("wicker", 64, 64, cloth::wicker),
        recipe("rug", 256, 256, cloth::rug),
        recipe("leaves", 256, 256, papers::leaves),
        recipe("stars", 256, 256, papers::stars),
        recipe("pinstripe", 128, 128, papers::pinstripe),
        recipe("landscape", 256, 192, pictures::landscape),
        recipe("shapes", 192, 256, pictures::shapes),
        recipe("branch", 192, 256, pictures::branch),
        recipe("planets", 256, 192, pictures::planets),
        recipe("fields", 192, 256, pictures::color_fields),
        recipe("rings", 192, 256, pictures::rings),
        recipe("waves", 192, 256, pictures::waves),
        recipe("television", 256, 144, screens::television),
        recipe("desktop", 256, 160, screens::desktop),
        recipe("keyboard", 256, 128, screens::keyboard),
        recipe("dial", 128, 128, screens::dial),
        recipe("clock", 128, 128, screens::clock),
        recipe("grille", 64, 64, screens::grille),
        recipe("cover", 96, 128, prints::cover),
        recipe("pages", 32, 128, prints::page_edges),
        recipe("foliage", 64, 64, prints::foliage),
        recipe("peel", 64, 64, prints::peel),
    ];
    ALL
}

impl TexturePattern {
    /// Every `step`-th pixel of the image, from the first; all of them for 1.
    fn paint(&self, step: usize) -> Vec<u8> {
        let key = RandomKey::root(self.seed)
            .child("texture")
            .child(self.generator);
        let colors = self.colors.map(|color| color.map(|c| f32::from(c) / 255.0));
        let paint = TexturePaint {
            colors,
            noise: ValueNoise::new(key.child("noise")),
            key,
        };
        let generator = self.recipe();
        let [width, height] = generator.map_or([1, 1], |generator| generator.size_px);
        let mut canvas = PixelCanvas::new(width, height, step);
        if let Some(generator) = generator {
            (generator.draw)(&mut canvas, &paint);
        }
        canvas.into_rgba()
    }

    /// The image as a texture that is painted when someone first looks at it; mid-grey for a recipe that does not exist.
    pub fn texture(self) -> Texture {
        let [width, height] = self.recipe().map_or([1, 1], |generator| generator.size_px);
        Texture::lazy(self.generator.to_owned(), width, height, move |step| {
            self.paint(step)
        })
    }

    fn recipe(&self) -> Option<&'static TextureGenerator> {
        recipes()
            .iter()
            .find(|generator| generator.name == self.generator)
    }
}

/// The images of patterns, in their order. Each exists once in a process, shared by all houses, and is painted when someone
/// first looks at it.
pub fn textures(patterns: &[TexturePattern]) -> Vec<Arc<Texture>> {
    static KNOWN: Mutex<BTreeMap<TexturePattern, Arc<Texture>>> = Mutex::new(BTreeMap::new());
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let texture = |pattern: &TexturePattern| {
        let texture = known.entry(*pattern);
        texture
            .or_insert_with(|| Arc::new(pattern.texture()))
            .clone()
    };
    patterns.iter().map(texture).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pattern(generator: &'static str) -> TexturePattern {
        TexturePattern {
            generator,
            colors: [[200, 170, 120], [90, 60, 40], [60, 90, 150]],
            seed: 5,
        }
    }

    #[test]
    fn every_recipe_gives_the_same_bytes_twice_and_is_no_plain_colour() {
        for generator in recipes() {
            let texture = pattern(generator.name).texture();
            texture.check(generator.name).unwrap();
            assert_eq!(
                texture,
                pattern(generator.name).texture(),
                "{}",
                generator.name
            );
            let first = &texture.rgba()[..4];
            assert!(
                texture.rgba().chunks_exact(4).any(|pixel| pixel != first),
                "{}",
                generator.name
            );
            assert!(
                texture.rgba().chunks_exact(4).all(|pixel| pixel[3] == 255),
                "{}",
                generator.name
            );
        }
    }

    #[test]
    fn a_sample_of_an_image_has_its_pixels() {
        for generator in recipes() {
            let texture = pattern(generator.name).texture();
            let sample = texture.sampled_rgba(65).into_owned();
            let all = texture.rgba().chunks_exact(4);
            let expected: Vec<u8> = all.step_by(65).flatten().copied().collect();
            assert_eq!(sample, expected, "{}", generator.name);
        }
    }

    /// The step from the last column to the first (and rows alike) is no larger than the steps inside.
    #[test]
    fn surfaces_repeat_without_a_seam() {
        for name in [
            "wood",
            "planks",
            "herringbone",
            "tile",
            "brick",
            "metro",
            "plaster",
            "marble",
            "speckle",
            "carpet",
            "weave",
            "leather",
            "stripes",
            "checks",
            "wicker",
            "leaves",
            "stars",
            "pinstripe",
            "grille",
        ] {
            let texture = pattern(name).texture();
            let (width, height) = (texture.width as usize, texture.height as usize);
            let at = |x: usize, y: usize| {
                f64::from(texture.rgba()[((y % height) * width + x % width) * 4 + 1])
            };
            let step_x = |x: usize| {
                (0..height)
                    .map(|y| (at(x + 1, y) - at(x, y)).abs())
                    .sum::<f64>()
            };
            let step_y = |y: usize| {
                (0..width)
                    .map(|x| (at(x, y + 1) - at(x, y)).abs())
                    .sum::<f64>()
            };
            let inside_x = (0..width - 1).map(step_x).fold(0.0, f64::max);
            let inside_y = (0..height - 1).map(step_y).fold(0.0, f64::max);
            assert!(
                step_x(width - 1) <= 1.1 * inside_x,
                "{name}: seam {} across, inside {inside_x}",
                step_x(width - 1)
            );
            assert!(
                step_y(height - 1) <= 1.1 * inside_y,
                "{name}: seam {} down, inside {inside_y}",
                step_y(height - 1)
            );
        }
    }
}
