//! Textures as cameras sample them: sRGB bytes with alpha, mip levels, bilinear.

#![expect(
    clippy::inline_always,
    reason = "what is not inline does not use the wider instructions of the function around it"
)]

use crate::color::SrgbTables;
use crate::error::RenderError;
use dwell_scene::bvh::flat::PackedRow;
use dwell_scene::interrupt::{self, CancelPoller};
use dwell_scene::parallel::Threads;
use dwell_scene::{House, Id, Texture, TextureId};
use glam::{Vec2, Vec4};
use std::borrow::Cow;

/// Texels between checks for cancellation.
const TEXELS_PER_CHECK: usize = 1 << 14;

/// All images of a house, side by side.
#[derive(Debug)]
pub(crate) struct Textures {
    /// R, G, B and alpha, all linear, in steps of 1 / [`FULL`]: four numbers that one instruction turns into `f32`, where
    /// sRGB bytes would ask a table for each. Shape (texel,).
    texels: Vec<[u16; 4]>,
    /// Offset of each level. Shape (image and level,).
    offsets: Vec<u32>,
    /// Shape (image,).
    images: Vec<MipImage>,
}

/// One image with its levels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MipImage {
    first_level: u32,
    pub(crate) last_level: u32,
    /// Width of the largest level.
    width: u32,
    height: u32,
    /// The one colour of all its texels.
    uniform: Option<[u8; 4]>,
    /// True if some texel lets light through.
    clear: bool,
}

/// Memory that a renderer takes for the images of a house, bytes, with what it needs while it prepares them.
///
/// An image of one colour takes nothing. One that is not painted yet counts with its pixels, too, and is not painted for this.
pub fn texture_bytes(house: &House) -> u64 {
    let textures: Vec<&Texture> = house.textures.iter().map(|texture| &**texture).collect();
    let each = Threads::default().map(textures.len(), |k| {
        let texture = textures[k];
        if !texture.is_loaded() {
            let pixels = u64::from(texture.width) * u64::from(texture.height);
            return (mip_chain_texels(image_size(texture, None)), pixels * 4);
        }
        (mip_chain_texels(image_size(texture, one_color(texture))), 0)
    });
    // While the largest is prepared, its next two levels are held as bytes, too: 5/4 bytes a pixel.
    let largest = each.iter().map(|(texels, _)| *texels).max().unwrap_or(0);
    let held: u64 = each
        .iter()
        .map(|(texels, painted)| texels * 8 + painted)
        .sum();
    held + largest
}

/// The one colour of all texels of an image.
fn one_color(texture: &Texture) -> Option<[u8; 4]> {
    let texels = texture.rgba().as_chunks::<4>().0;
    let first = texels.first().copied().unwrap_or([255; 4]);
    let mut rows = texels.chunks(TEXELS_PER_CHECK);
    let same = rows.all(|row| {
        interrupt::unwind_if_cancelled();
        row.iter().all(|texel| *texel == first)
    });
    same.then_some(first)
}

/// Texels across and down of the largest level that is held.
fn image_size(texture: &Texture, uniform: Option<[u8; 4]>) -> (usize, usize) {
    match uniform {
        Some(_) => (1, 1),
        None => (texture.width as usize, texture.height as usize),
    }
}

/// Texels of all levels of an image.
fn mip_chain_texels((mut width, mut height): (usize, usize)) -> u64 {
    let mut all = 0;
    loop {
        all += width as u64 * height as u64;
        if width <= 1 && height <= 1 {
            return all;
        }
        (width, height) = ((width / 2).max(1), (height / 2).max(1));
    }
}

/// An empty vector with room for so many elements.
fn reserved<T>(count: u64) -> Result<Vec<T>, RenderError> {
    let mut all = Vec::new();
    all.try_reserve_exact(usize::try_from(count).unwrap_or(usize::MAX))
        .map_err(|_| RenderError::Memory {
            needed: count.saturating_mul(size_of::<T>() as u64),
        })?;
    Ok(all)
}

impl Textures {
    /// Prepares every texture of a house.
    ///
    /// # Errors
    /// [`RenderError::Memory`] where the system refuses the memory.
    pub(crate) fn new(house: &House) -> Result<Self, RenderError> {
        // What is not painted yet is painted now, on all threads.
        let painted: Vec<&Texture> = house.textures.iter().map(|texture| &**texture).collect();
        let uniform = Threads::default().map(painted.len(), |k| one_color(painted[k]));
        let sizes = painted.iter().zip(&uniform);
        let texels =
            sizes.map(|(texture, uniform)| mip_chain_texels(image_size(texture, *uniform)));
        let mut all = Self {
            texels: reserved(texels.sum())?,
            offsets: Vec::new(),
            images: Vec::new(),
        };
        for (texture, uniform) in painted.into_iter().zip(uniform) {
            all.add(texture, uniform)?;
        }
        Ok(all)
    }

    fn add(&mut self, texture: &Texture, uniform: Option<[u8; 4]>) -> Result<(), RenderError> {
        let srgb = SrgbTables::tables();
        let first_level = self.offsets.len() as u32;
        let texels = texture.rgba().as_chunks::<4>().0;
        let clear = texels.iter().any(|texel| texel[3] < 255);
        let mut size = image_size(texture, uniform);
        let mut current = match uniform {
            Some(color) => Cow::Owned(vec![color]),
            None => Cow::Borrowed(texels),
        };
        let (width, height) = (size.0 as u32, size.1 as u32);
        loop {
            self.offsets.push(self.texels.len() as u32);
            for texels in current.chunks(TEXELS_PER_CHECK) {
                interrupt::unwind_if_cancelled();
                self.texels
                    .extend(texels.iter().map(|texel| linear(srgb, *texel)));
            }
            if size == (1, 1) {
                break;
            }
            let (halved, smaller) = next_mip_level(&current, size)?;
            (current, size) = (Cow::Owned(halved), smaller);
        }
        let last_level = self.offsets.len() as u32 - 1 - first_level;
        self.images.push(MipImage {
            first_level,
            last_level,
            width,
            height,
            uniform,
            clear,
        });
        Ok(())
    }

    /// The one colour of a texture that has only one.
    pub(crate) fn uniform_color(&self, texture: TextureId) -> Option<[u8; 4]> {
        self.images[texture.index()].uniform
    }

    /// Returns whether some texel lets light through.
    pub(crate) fn has_transparency(&self, texture: TextureId) -> bool {
        self.images[texture.index()].clear
    }

    /// Pixels across and down.
    pub(crate) fn size(&self, texture: TextureId) -> (f32, f32) {
        let image = &self.images[texture.index()];
        (image.width as f32, image.height as f32)
    }

    /// Memory held, bytes.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.texels.as_slice())
    }

    /// As rows: of each level its first texel, width and height; of each image its first level, last level and whether some
    /// texel lets light through. Then all texels, as bytes R, G, B, A.
    pub(crate) fn to_rows(&self) -> (Vec<PackedRow>, Vec<PackedRow>, Vec<[u8; 4]>) {
        let srgb = SrgbTables::tables();
        let levels = self.images.iter().flat_map(|image| {
            (0..=image.last_level).map(|level| {
                let offset = self.offsets[(image.first_level + level) as usize];
                let size = |edge: u32| (edge >> level).max(1);
                [offset, size(image.width), size(image.height), 0]
            })
        });
        let image = |image: &MipImage| {
            [
                image.first_level,
                image.last_level,
                u32::from(image.clear),
                0,
            ]
        };
        (
            levels.collect(),
            self.images.iter().map(image).collect(),
            self.texels
                .iter()
                .map(|texel| encoded(srgb, *texel))
                .collect(),
        )
    }

    /// Linear colour and alpha at `uv` (v up, repeating), of the level whose texels are about as large as the pixel:
    /// `texels_per_pixel` is the area of a pixel in texels of the largest level.
    #[inline]
    pub(crate) fn sample(&self, texture: u32, uv: Vec2, texels_per_pixel: f32) -> Vec4 {
        let image = self.image(texture);
        let level = mip_level(texels_per_pixel).min(image.last_level);
        self.bilinear(image, level, image.bilinear_taps(level, uv.x, uv.y))
    }

    #[inline]
    pub(crate) fn image(&self, texture: u32) -> &MipImage {
        &self.images[texture as usize]
    }

    /// Linear colour and alpha between four texels of a level.
    #[inline]
    pub(crate) fn bilinear(&self, image: &MipImage, level: u32, at: BilinearTaps) -> Vec4 {
        let offset = self.offsets[image.first_level.wrapping_add(level) as usize];
        let [a, b, c, d] = at.texels.map(|texel| {
            let [r, g, b, a] = self.texels[offset.wrapping_add(texel) as usize];
            Vec4::new(f32::from(r), f32::from(g), f32::from(b), f32::from(a))
        });
        let [across, down] = at.weights;
        mix(mix(a, b, across), mix(c, d, across), down) * (1.0 / FULL)
    }
}

/// Four texels of a level, the upper two first, and the weights of the right and the lower ones.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BilinearTaps {
    pub(crate) texels: [u32; 4],
    pub(crate) weights: [f32; 2],
}

impl MipImage {
    /// Pixels across and down.
    #[inline]
    pub(crate) fn size(&self) -> Vec2 {
        Vec2::new(self.width as f32, self.height as f32)
    }

    /// The texels around texture coordinates, of a level.
    #[inline(always)]
    pub(crate) fn bilinear_taps(&self, level: u32, u: f32, v: f32) -> BilinearTaps {
        // As [`next_mip_level`] makes them.
        let size = |edge: u32| edge.wrapping_shr(level).max(1);
        let (width, height) = (size(self.width), size(self.height));
        let (left, right, across) = neighbours(u, width);
        let (upper, lower, down) = neighbours(-v, height);
        let (upper, lower) = (upper.wrapping_mul(width), lower.wrapping_mul(width));
        BilinearTaps {
            texels: [
                upper.wrapping_add(left),
                upper.wrapping_add(right),
                lower.wrapping_add(left),
                lower.wrapping_add(right),
            ],
            weights: [across, down],
        }
    }
}

/// From `a` to `b`, and exactly `a` where they are equal.
#[inline]
fn mix(a: Vec4, b: Vec4, weight: f32) -> Vec4 {
    a + (b - a) * weight
}

/// All light, of a texel.
const FULL: f32 = 65_535.0;

/// A texel of bytes: R, G, B sRGB-encoded, alpha linear.
fn linear(srgb: &SrgbTables, [r, g, b, a]: [u8; 4]) -> [u16; 4] {
    let light = |byte: u8| (srgb.decode(byte) * FULL + 0.5) as u16;
    [light(r), light(g), light(b), u16::from(a) * 257]
}

/// The bytes of which [`linear`] makes a texel.
fn encoded(srgb: &SrgbTables, [r, g, b, a]: [u16; 4]) -> [u8; 4] {
    let [r, g, b] = srgb.encode3([r, g, b].map(|light| f32::from(light) / FULL));
    [r, g, b, (a / 257) as u8]
}

/// The level on which one pixel covers about one texel: half the binary logarithm of the area, rounded.
#[inline(always)]
pub(crate) fn mip_level(texels_per_pixel: f32) -> u32 {
    // The exponent of twice the area, halved: 0 below 2 texels, 1 below 8, 2 below 32.
    let exponent = (texels_per_pixel.to_bits() >> 23) & 255;
    exponent.max(126).wrapping_sub(126) / 2
}

/// Adding this to a number of less than 2^21 rounds it to an integer, which the sum's last bits hold.
const INTEGERS: f32 = 12_582_912.0;

/// The nearest integer, as itself and as a number.
#[inline(always)]
fn nearest(number: f32) -> (f32, i32) {
    let sum = number + INTEGERS;
    (
        sum - INTEGERS,
        (sum.to_bits() as i32).wrapping_sub(INTEGERS.to_bits() as i32),
    )
}

/// The two texels beside a repeating coordinate, and the weight of the second.
#[inline(always)]
fn neighbours(coordinate: f32, size: u32) -> (u32, u32, f32) {
    // Nothing repeats a million times; what is not a number becomes one.
    let coordinate = if coordinate > -1e6 { coordinate } else { -1e6 };
    let coordinate = if coordinate < 1e6 { coordinate } else { 1e6 };
    // From the middle of the image: -1/2 to 1/2.
    let place = (coordinate - nearest(coordinate).0) * (size as i32) as f32 - 0.5;
    let (below, first) = nearest(place - 0.5);
    let (size, last) = (size as i32, size.wrapping_sub(1));
    let wrap = |k: i32| {
        // Below the first texel stands the last; images of one texel fall short once more.
        let k = k.wrapping_add(size & (k >> 31));
        (k as u32).min(last)
    };
    (wrap(first), wrap(first.wrapping_add(1)), place - below)
}

/// Texels of a level, and how many there are across and down.
type MipLevel = (Vec<[u8; 4]>, (usize, usize));

/// Half the size in either direction, each texel the mean of those that it covers, in linear light and weighted by alpha.
fn next_mip_level(
    texels: &[[u8; 4]],
    (width, height): (usize, usize),
) -> Result<MipLevel, RenderError> {
    let srgb = SrgbTables::tables();
    let size = ((width / 2).max(1), (height / 2).max(1));
    let mut halved = reserved(size.0 as u64 * size.1 as u64)?;
    // An odd edge gives its last row to its neighbours.
    let covers =
        |k: usize, from: usize, to: usize| (k * from / to, ((k + 1) * from).div_ceil(to).min(from));
    let mut pace = CancelPoller::new(TEXELS_PER_CHECK);
    for y in 0..size.1 {
        pace.count_many(width);
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
    Ok((halved, size))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn single(width: u32, height: u32, rgba: Vec<u8>) -> Textures {
        let mut all = Textures {
            texels: Vec::new(),
            offsets: Vec::new(),
            images: Vec::new(),
        };
        let texture = Texture::new("t".into(), width, height, rgba);
        all.add(&texture, one_color(&texture)).unwrap();
        all
    }

    fn bytes(all: &Textures, uv: Vec2, area: f32) -> [u8; 3] {
        let [r, g, b, _] = all.sample(0, uv, area).to_array();
        SrgbTables::tables().encode3([r, g, b])
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
    fn memory_that_is_not_there_is_an_error_and_what_is_needed_is_told_before() {
        let error = reserved::<[u16; 4]>(1 << 58).unwrap_err().to_string();
        assert!(error.contains("2199023255552.0 MiB"), "{error}");
        let materials = dwell_scene::ShoeboxMaterials::default();
        let house = |textures: Vec<Vec<u8>>| {
            let house = House::shoebox([4.0, 3.0, 5.0], &materials).unwrap();
            let texture = |rgba| std::sync::Arc::new(Texture::new("t".to_owned(), 64, 32, rgba));
            let mut data = house.data().clone();
            data.textures = textures.into_iter().map(texture).collect();
            House::new(data).unwrap()
        };
        let (plain, noise) = (
            vec![9; 64 * 32 * 4],
            (0..64 * 32 * 4_u32).map(|k| (k * 7) as u8).collect(),
        );
        assert_eq!(texture_bytes(&house(vec![])), 0);
        assert_eq!(texture_bytes(&house(vec![plain.clone()])), 9);
        let house = house(vec![plain, noise]);
        // 64 x 32, 32 x 16, and on to 2 x 1 and 1 x 1.
        let texels = (2048 * 4 - 2) / 3 + 1;
        assert_eq!(mip_chain_texels((64, 32)), texels);
        assert_eq!(texture_bytes(&house), 8 + texels * 9);
        let all = Textures::new(&house).unwrap();
        assert_eq!(all.bytes() as u64, 8 + texels * 8);
        assert_eq!(all.texels.capacity(), all.texels.len());
    }

    #[test]
    fn every_byte_survives_as_linear_light() {
        let srgb = SrgbTables::tables();
        for byte in 0..=255_u8 {
            let texel = [byte, 255 - byte, byte, byte];
            assert_eq!(encoded(srgb, linear(srgb, texel)), texel);
            let light = Vec4::splat(f32::from(linear(srgb, texel)[0]) / FULL);
            assert_eq!(srgb.encode_vec(light), [byte; 3]);
        }
        let nothing = Vec4::new(f32::NAN, -1.0, 2.0, 0.0);
        assert_eq!(srgb.encode_vec(nothing), [0, 0, 255]);
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
        let expected = SrgbTables::tables().encode3(mean);
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
            assert_eq!(mip_level(area), level, "{area}");
        }
        assert_eq!(mip_level(f32::NAN), mip_level(f32::INFINITY));
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
        let [r, g, b, a] = all.sample(0, Vec2::ZERO, 100.0).to_array();
        assert!(r > 0.99 && g == 0.0 && b == 0.0 && (a - 0.5).abs() < 0.01);
        assert!(all.has_transparency(TextureId(0)));
    }
}
