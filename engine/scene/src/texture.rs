//! Texture images.

use crate::error::SceneError;
use serde::{Deserialize, Serialize};

/// An image that materials show, sRGB-encoded with straight alpha.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Texture {
    /// The name in the source, without folder and ending.
    pub name: String,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Rows from the top, four bytes a pixel (R, G, B, A). Shape (height, width, 4).
    pub rgba: Vec<u8>,
}

impl Texture {
    /// Checks that the size fits the data and is at most 16,384 a side.
    ///
    /// # Errors
    /// [`SceneError::Texture`] with what was found.
    pub fn check(&self, at: &str) -> Result<(), SceneError> {
        let expected = self.width as usize * self.height as usize * 4;
        if self.width == 0
            || self.height == 0
            || self.width > 16_384
            || self.height > 16_384
            || self.rgba.len() != expected
        {
            let what = format!(
                "{} by {} pixels with {} bytes",
                self.width,
                self.height,
                self.rgba.len()
            );
            return Err(SceneError::Texture {
                at: at.to_owned(),
                what,
            });
        }
        Ok(())
    }

    /// The plain mean of all pixels' sRGB-encoded values, each 0 to 255. Shape (3,).
    pub fn mean_srgb(&self) -> [f64; 3] {
        let mut sum = [0_u64; 3];
        for pixel in self.rgba.chunks_exact(4) {
            for (total, value) in sum.iter_mut().zip(pixel) {
                *total += u64::from(*value);
            }
        }
        let count = (self.rgba.len() / 4).max(1) as f64;
        sum.map(|total| total as f64 / count)
    }

    /// The mean colour in linear light, each 0 to 1; pixels that are fully transparent are left out. Shape (3,).
    pub fn mean_linear(&self) -> [f32; 3] {
        let decode: Vec<f64> = (0..=255_u8)
            .map(|b| f64::from(crate::units::linear_from_srgb(f32::from(b) / 255.0)))
            .collect();
        let (mut sum, mut count) = ([0.0_f64; 3], 0_u64);
        for pixel in self.rgba.chunks_exact(4).filter(|p| p[3] > 0) {
            for (total, value) in sum.iter_mut().zip(pixel) {
                *total += decode[usize::from(*value)];
            }
            count += 1;
        }
        sum.map(|total| (total / count.max(1) as f64) as f32)
    }
}
