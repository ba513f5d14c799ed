//! Anisotropic texture filtering: a pixel's footprint on an image that is seen at an angle, and its average.

use crate::texture::{Textures, mip_level};
use crate::triangle_table::PosedTriangleShading;
use glam::{Vec2, Vec3, Vec4};

/// The least cosine between ray and normal at which a pixel's footprint still grows.
pub(crate) const MIN_FOOTPRINT_COSINE: f32 = 0.05;
/// Most samples along the longer axis of a footprint; a longer one is averaged more coarsely in both directions.
pub(crate) const MAX_ANISOTROPIC_TAPS: f32 = 8.0;

/// Sine below which a surface is seen straight on.
const STRAIGHT: f32 = 1e-3;

/// A pixel's footprint on an image: a strip of samples, each about as wide as long.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TextureFootprint {
    /// Number of samples, at least 1.
    taps: u32,
    /// Step from one to the next, in texture coordinates.
    step: Vec2,
    /// Width of one sample, texels of the largest level.
    texels: f32,
}

impl TextureFootprint {
    /// The footprint of a ray that is `width_m` wide where it meets a triangle. `size`: pixels of the image, across and down.
    ///
    /// # Source
    /// The axes: T. Akenine-Möller et al., *Improved Shader and Texture Level of Detail Using Ray Cones*, JCGT 10(1), 2021,
    /// section 5: a cone meets a plane in an ellipse, which is as wide as the cone across its direction and, along it, wider
    /// by the inverse of the cosine. The samples: `GL_EXT_texture_filter_anisotropic`, after P. S. Heckbert, *Fundamentals of
    /// Texture Mapping and Image Warping*, 1989; their places are the middles of equal parts of the longer axis.
    #[inline]
    pub(crate) fn new(
        standing: &PosedTriangleShading,
        direction: Vec3,
        width_m: f32,
        size: Vec2,
    ) -> Self {
        let normal = standing.normal;
        let along = normal.dot(direction);
        let ahead = direction - normal * along;
        let sine = ahead.length();
        // Seen straight on it is round: any axis will do.
        let ahead = if sine > STRAIGHT {
            ahead / sine
        } else {
            normal.any_orthonormal_vector()
        };
        let beside = normal.cross(ahead);
        let texels = |axis: Vec3| standing.uv_along(axis) * size;
        let long = standing.uv_along(ahead) * (width_m / along.abs().max(MIN_FOOTPRINT_COSINE));
        let (a, b) = ((long * size).length(), (texels(beside) * width_m).length());
        // A texture that is stretched may turn them around.
        let (long, most, least) = if a >= b {
            (long, a, b)
        } else {
            (standing.uv_along(beside) * width_m, b, a)
        };
        let wide = least.max(most * (1.0 / MAX_ANISOTROPIC_TAPS)).max(1.0);
        // One sample may cover a quarter more than its part; a cast makes 0 of what is not a number.
        let taps = ((most / wide + 0.75) as u32).clamp(1, MAX_ANISOTROPIC_TAPS as u32);
        Self {
            taps,
            step: long / taps as f32,
            texels: wide * wide,
        }
    }

    /// Linear colour and alpha of an image around `uv`.
    #[inline]
    pub(crate) fn sample(&self, textures: &Textures, texture: u32, uv: Vec2) -> Vec4 {
        let image = textures.image(texture);
        let level = mip_level(self.texels).min(image.last_level);
        let mut at = uv - self.step * (0.5 * (self.taps - 1) as f32);
        let mut sum = Vec4::ZERO;
        for _ in 0..self.taps {
            sum += textures.bilinear(image, level, image.bilinear_taps(level, at.x, at.y));
            at += self.step;
        }
        sum * (1.0 / self.taps as f32)
    }
}
