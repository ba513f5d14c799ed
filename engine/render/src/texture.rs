//! Textures as cameras sample them: sRGB bytes with alpha, smaller and smaller copies, bilinear.

use crate::color::Srgb;
use dwell_scene::bvh::flat::Row;
use dwell_scene::parallel::Threads;
use dwell_scene::{House, Id, Texture, TextureId};
use glam::{Vec2, Vec4};

/// All images of a house, side by side.
#[derive(Debug)]
pub(crate) struct Textures {
    /// R, G, B sRGB-encoded, alpha linear. Shape (texel,).
    texels: Vec<[u8; 4]>,
    /// Shape (image and level,).
    levels: Vec<Level>,
    /// Shape (image,).
    images: Vec<Image>,
}

/// One image at one size.
#[derive(Clone, Copy, Debug)]
struct Level {
    offset: u32,
    width: u32,
    height: u32,
}

/// One image with its levels.
#[derive(Clone, Copy, Debug)]
struct Image {
    first_level: u32,
    last_level: u32,
    /// The one colour of all its texels.
    uniform: Option<[u8; 4]>,
    /// Whether some texel lets light through.
    clear: bool,
}

impl Textures {
    /// Prepares every texture of a house.
    pub(crate) fn new(house: &House) -> Self {
        let mut all = Self {
            texels: Vec::new(),
            levels: Vec::new(),
            images: Vec::new(),
        };
        // What is not painted yet is painted now, on all threads.
        let painted: Vec<&Texture> = house.textures.iter().map(|texture| &**texture).collect();
        Threads::default().map(painted.len(), |k| painted[k].rgba().len());
        for texture in painted {
            all.add(texture);
        }
        all
    }

    fn add(&mut self, texture: &Texture) {
        let first_level = self.levels.len() as u32;
        let texels: Vec<[u8; 4]> = texture.rgba().as_chunks::<4>().0.to_vec();
        let first = texels.first().copied().unwrap_or([255; 4]);
        let uniform = texels.iter().all(|texel| *texel == first).then_some(first);
        let clear = texels.iter().any(|texel| texel[3] < 255);
        let mut size = (texture.width as usize, texture.height as usize);
        let mut current = if uniform.is_some() {
            size = (1, 1);
            vec![first]
        } else {
            texels
        };
        loop {
            let offset = self.texels.len() as u32;
            self.levels.push(Level {
                offset,
                width: size.0 as u32,
                height: size.1 as u32,
            });
            self.texels.extend_from_slice(&current);
            if size == (1, 1) {
                break;
            }
            (current, size) = halve(&current, size);
        }
        let last_level = self.levels.len() as u32 - 1 - first_level;
        self.images.push(Image {
            first_level,
            last_level,
            uniform,
            clear,
        });
    }

    /// The one colour of a texture that has only one.
    pub(crate) fn uniform(&self, texture: TextureId) -> Option<[u8; 4]> {
        self.images[texture.index()].uniform
    }

    /// Whether some texel lets light through.
    pub(crate) fn is_clear(&self, texture: TextureId) -> bool {
        self.images[texture.index()].clear
    }

    /// Pixels across and down.
    pub(crate) fn size(&self, texture: TextureId) -> (f32, f32) {
        let level = self.levels[self.images[texture.index()].first_level as usize];
        (level.width as f32, level.height as f32)
    }

    /// Memory held, bytes.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.texels.as_slice())
    }

    /// As rows: of each level its first texel, width and height; of each image its first level, last level and whether some
    /// texel lets light through. Then all texels, as bytes R, G, B, A.
    pub(crate) fn flat(&self) -> (Vec<Row>, Vec<Row>, &[[u8; 4]]) {
        let level = |level: &Level| [level.offset, level.width, level.height, 0];
        let image = |image: &Image| {
            [
                image.first_level,
                image.last_level,
                u32::from(image.clear),
                0,
            ]
        };
        (
            self.levels.iter().map(level).collect(),
            self.images.iter().map(image).collect(),
            &self.texels,
        )
    }

    /// Linear colour and alpha at `uv` (v up, repeating), of the level whose texels are about as large as the pixel:
    /// `texels_per_pixel` is the area of a pixel in texels of the largest level.
    #[inline]
    pub(crate) fn sample(
        &self,
        srgb: &Srgb,
        texture: u32,
        uv: Vec2,
        texels_per_pixel: f32,
    ) -> Vec4 {
        let image = &self.images[texture as usize];
        let level = level_of(texels_per_pixel).min(image.last_level);
        let Level {
            offset,
            width,
            height,
        } = self.levels[image.first_level.wrapping_add(level) as usize];
        let (x0, x1, fx) = neighbours(uv.x, width);
        let (y0, y1, fy) = neighbours(-uv.y, height);
        let row = |y: u32| offset.wrapping_add(y.wrapping_mul(width));
        let (row0, row1) = (row(y0), row(y1));
        let texel = |row: u32, x: u32| self.texels[row.wrapping_add(x) as usize];
        let corners = [
            texel(row0, x0),
            texel(row0, x1),
            texel(row1, x0),
            texel(row1, x1),
        ];
        let weights = [
            (1.0 - fx) * (1.0 - fy),
            fx * (1.0 - fy),
            (1.0 - fx) * fy,
            fx * fy,
        ];
        let mut sum = Vec4::ZERO;
        for ([r, g, b, _], weight) in corners.into_iter().zip(weights) {
            sum += Vec4::new(srgb.decode(r), srgb.decode(g), srgb.decode(b), 1.0) * weight;
        }
        if image.clear {
            sum.w = corners
                .iter()
                .zip(weights)
                .map(|(corner, weight)| f32::from(corner[3]) * weight)
                .sum::<f32>()
                / 255.0;
        }
        sum
    }
}

/// The level on which one pixel covers about one texel: half the binary logarithm of the area, rounded.
#[inline]
fn level_of(texels_per_pixel: f32) -> u32 {
    // The exponent of twice the area, halved: 0 below 2 texels, 1 below 8, 2 below 32.
    if texels_per_pixel < 2.0 {
        return 0;
    }
    let exponent = (texels_per_pixel.to_bits() >> 23) & 255;
    exponent.saturating_sub(126) / 2
}

/// Adding this to a number of less than 2^21 rounds it to an integer, which the sum's last bits hold.
const INTEGERS: f32 = 12_582_912.0;

/// The nearest integer, as itself and as a number.
#[inline]
fn nearest(number: f32) -> (f32, i32) {
    let sum = number + INTEGERS;
    (
        sum - INTEGERS,
        (sum.to_bits() as i32).wrapping_sub(INTEGERS.to_bits() as i32),
    )
}

/// The two texels beside a repeating coordinate, and the weight of the second.
#[inline]
fn neighbours(coordinate: f32, size: u32) -> (u32, u32, f32) {
    // Nothing repeats a million times; what is not a number becomes one.
    let coordinate = if coordinate > -1e6 { coordinate } else { -1e6 };
    let coordinate = if coordinate < 1e6 { coordinate } else { 1e6 };
    // From the middle of the image: -1/2 to 1/2.
    let place = (coordinate - nearest(coordinate).0) * size as f32 - 0.5;
    let (below, first) = nearest(place - 0.5);
    let (size, last) = (size as i32, size.wrapping_sub(1));
    let wrap = |k: i32| {
        let k = if k < 0 { k.wrapping_add(size) } else { k };
        // Images of one texel fall short once more.
        if k < 0 { last } else { (k as u32).min(last) }
    };
    (wrap(first), wrap(first.wrapping_add(1)), place - below)
}

/// Half the size in either direction, each texel the mean of those that it covers, in linear light and weighted by alpha.
fn halve(texels: &[[u8; 4]], (width, height): (usize, usize)) -> (Vec<[u8; 4]>, (usize, usize)) {
    let srgb = Srgb::tables();
    let size = ((width / 2).max(1), (height / 2).max(1));
    let mut halved = Vec::with_capacity(size.0 * size.1);
    // An odd edge gives its last row to its neighbours.
    let covers =
        |k: usize, from: usize, to: usize| (k * from / to, ((k + 1) * from).div_ceil(to).min(from));
    for y in 0..size.1 {
        let (top, bottom) = covers(y, height, size.1);
        for x in 0..size.0 {
            let (left, right) = covers(x, width, size.0);
            let (mut color, mut plain, mut alpha, mut count) =
                ([0.0_f32; 3], [0.0_f32; 3], 0.0_f32, 0.0_f32);
            for row in top..bottom {
                for texel in &texels[row * width + left..row * width + right] {
                    let weight = f32::from(texel[3]) / 255.0;
                    for k in 0..3 {
                        let light = srgb.decode(texel[k]);
                        color[k] += light * weight;
                        plain[k] += light;
                    }
                    alpha += weight;
                    count += 1.0;
                }
            }
            let mean = if alpha > 0.0 {
                color.map(|c| c / alpha)
            } else {
                plain.map(|c| c / count)
            };
            let [r, g, b] = srgb.encode3(mean);
            halved.push([r, g, b, (alpha / count * 255.0 + 0.5) as u8]);
        }
    }
    (halved, size)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn single(width: u32, height: u32, rgba: Vec<u8>) -> Textures {
        let mut all = Textures {
            texels: Vec::new(),
            levels: Vec::new(),
            images: Vec::new(),
        };
        all.add(&Texture::new("t".into(), width, height, rgba));
        all
    }

    fn bytes(all: &Textures, uv: Vec2, area: f32) -> [u8; 3] {
        let [r, g, b, _] = all.sample(Srgb::tables(), 0, uv, area).to_array();
        Srgb::tables().encode3([r, g, b])
    }

    #[test]
    fn v_points_up_and_u_to_the_right() {
        let (red, green, blue, white) = (
            [255, 0, 0, 255],
            [0, 255, 0, 255],
            [0, 0, 255, 255],
            [255; 4],
        );
        // Upper row red green, lower row blue white.
        let all = single(2, 2, [red, green, blue, white].concat());
        assert_eq!(bytes(&all, Vec2::new(0.25, 0.75), 0.0), [255, 0, 0]);
        assert_eq!(bytes(&all, Vec2::new(0.75, 0.75), 0.0), [0, 255, 0]);
        assert_eq!(bytes(&all, Vec2::new(0.25, 0.25), 0.0), [0, 0, 255]);
        assert_eq!(bytes(&all, Vec2::new(0.75, 0.25), 0.0), [255, 255, 255]);
        // Repeats, also to the negative side.
        assert_eq!(bytes(&all, Vec2::new(-0.75, 5.75), 0.0), [255, 0, 0]);
        // Half way between red and green, in linear light.
        assert_eq!(bytes(&all, Vec2::new(0.5, 0.75), 0.0), [188, 188, 0]);
    }

    #[test]
    fn the_smallest_level_is_the_mean_in_linear_light() {
        let rgba: Vec<u8> = (0..35_u32)
            .flat_map(|k| [(k * 7) as u8, 255 - (k * 5) as u8, 40, 255])
            .collect();
        let texture = Texture::new("t".into(), 7, 5, rgba);
        let mean = texture.mean_linear();
        let all = single(7, 5, texture.rgba().to_vec());
        let found = bytes(&all, Vec2::new(0.3, 0.9), 1e9);
        let expected = Srgb::tables().encode3(mean);
        for k in 0..3 {
            // Odd edges weigh the middle texels a little more, and each level rounds.
            assert!(
                found[k].abs_diff(expected[k]) <= 12,
                "{found:?} {expected:?}"
            );
        }
    }

    #[test]
    fn levels_change_where_a_pixel_covers_two_eight_and_32_texels() {
        for (area, level) in [
            (0.0, 0),
            (1.0, 0),
            (1.99, 0),
            (2.0, 1),
            (7.9, 1),
            (8.0, 2),
            (31.0, 2),
            (32.0, 3),
        ] {
            assert_eq!(level_of(area), level, "{area}");
        }
        assert_eq!(level_of(f32::NAN), level_of(f32::INFINITY));
    }

    #[test]
    fn no_coordinate_leaves_the_image() {
        for size in [1, 2, 3, 300] {
            for coordinate in [
                0.0,
                -0.0,
                1.0,
                -1e-9,
                0.999_999_94,
                1e30,
                -1e30,
                f32::NAN,
                f32::INFINITY,
                2.147_483_6e9,
            ] {
                let (a, b, weight) = neighbours(coordinate, size);
                assert!(
                    a < size && b < size && (0.0..=1.0).contains(&weight),
                    "{coordinate} {size}"
                );
            }
        }
    }

    #[test]
    fn transparent_texels_do_not_tint_their_neighbours() {
        let clear_green = [0, 255, 0, 0];
        let red = [255, 0, 0, 255];
        let all = single(2, 2, [red, clear_green, red, clear_green].concat());
        let [r, g, b, a] = all.sample(Srgb::tables(), 0, Vec2::ZERO, 100.0).to_array();
        assert!(r > 0.99 && g == 0.0 && b == 0.0 && (a - 0.5).abs() < 0.01);
        assert!(all.is_clear(TextureId(0)));
    }
}
