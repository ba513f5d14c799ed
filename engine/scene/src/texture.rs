//! Texture images.

use crate::error::SceneError;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt;
use std::sync::{Arc, OnceLock};

/// Function that makes every so many-th pixel of a texture.
type TexturePainter = Arc<dyn Fn(usize) -> Vec<u8> + Send + Sync>;

/// An image for materials, sRGB-encoded with straight alpha.
///
/// Its pixels are present from the start, or painted at first use.
#[derive(Clone, Serialize, Deserialize)]
#[serde(from = "StoredTexture", into = "StoredTexture")]
pub struct Texture {
    /// The name in the source, without folder and ending.
    pub name: String,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    pixels: OnceLock<Vec<u8>>,
    painter: Option<TexturePainter>,
}

/// A texture as data.
#[derive(Serialize, Deserialize)]
#[serde(rename = "Texture")]
struct StoredTexture {
    name: String,
    width: u32,
    height: u32,
    rgba: Vec<u8>,
}

impl From<StoredTexture> for Texture {
    fn from(stored: StoredTexture) -> Self {
        Self::new(stored.name, stored.width, stored.height, stored.rgba)
    }
}

impl From<Texture> for StoredTexture {
    fn from(texture: Texture) -> Self {
        Self {
            rgba: texture.rgba().to_vec(),
            name: texture.name,
            width: texture.width,
            height: texture.height,
        }
    }
}

impl PartialEq for Texture {
    fn eq(&self, other: &Self) -> bool {
        (&self.name, self.width, self.height) == (&other.name, other.width, other.height)
            && self.rgba() == other.rgba()
    }
}

impl Eq for Texture {}

impl fmt::Debug for Texture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Texture")
            .field("name", &self.name)
            .field("width", &self.width)
            .field("height", &self.height)
            .field("painted", &self.is_loaded())
            .finish_non_exhaustive()
    }
}

impl Texture {
    /// A texture of these pixels: rows from the top, four bytes a pixel (R, G, B, A). Shape (height, width, 4).
    pub fn new(name: String, width: u32, height: u32, rgba: Vec<u8>) -> Self {
        Self {
            name,
            width,
            height,
            pixels: OnceLock::from(rgba),
            painter: None,
        }
    }

    /// A texture whose pixels `painter` makes at first use; it must always make the same. Missing pixels are transparent
    /// black, surplus ones are dropped.
    ///
    /// `painter(step)` makes every `step`-th pixel from the first, rows from the top, four bytes each; all of them for 1.
    pub fn lazy(
        name: String,
        width: u32,
        height: u32,
        painter: impl Fn(usize) -> Vec<u8> + Send + Sync + 'static,
    ) -> Self {
        Self {
            name,
            width,
            height,
            pixels: OnceLock::new(),
            painter: Some(Arc::new(painter)),
        }
    }

    /// Returns rows from the top, four bytes a pixel (R, G, B, A). Shape (height, width, 4).
    pub fn rgba(&self) -> &[u8] {
        self.pixels.get_or_init(|| self.paint(1))
    }

    /// Returns every `step`-th pixel (each, for 0) of [`rgba`](Self::rgba), from the first. Shape (pixel, 4).
    ///
    /// Of a texture that is not painted yet, only these are painted, and not kept.
    pub fn sampled_rgba(&self, step: usize) -> Cow<'_, [u8]> {
        match self.pixels.get() {
            Some(rgba) if step <= 1 => Cow::Borrowed(rgba),
            Some(rgba) => {
                let pixels = rgba.chunks_exact(4).step_by(step);
                Cow::Owned(pixels.flatten().copied().collect())
            }
            None => Cow::Owned(self.paint(step.max(1))),
        }
    }

    fn paint(&self, step: usize) -> Vec<u8> {
        let mut rgba = self
            .painter
            .as_ref()
            .map_or_else(Vec::new, |paint| paint(step));
        rgba.resize((self.size_bytes() / 4).div_ceil(step) * 4, 0);
        rgba
    }

    /// Returns whether the pixels are in memory.
    pub fn is_loaded(&self) -> bool {
        self.pixels.get().is_some()
    }

    fn size_bytes(&self) -> usize {
        self.width as usize * self.height as usize * 4
    }

    /// Checks that the size fits the data and is at most 16,384 a side.
    ///
    /// # Errors
    /// [`SceneError::Texture`] with the fault.
    pub fn check(&self, at: &str) -> Result<(), SceneError> {
        let expected = self.size_bytes();
        // A painter's output has the right size.
        let found = self.pixels.get().map_or(expected, Vec::len);
        if self.width == 0
            || self.height == 0
            || self.width > 16_384
            || self.height > 16_384
            || found != expected
        {
            let what = format!(
                "{} by {} pixels with {found} bytes",
                self.width, self.height,
            );
            return Err(SceneError::Texture {
                at: at.to_owned(),
                what,
            });
        }
        Ok(())
    }

    /// Returns the plain mean of all pixels' sRGB-encoded values, each 0 to 255. Shape (3,).
    pub fn mean_srgb(&self) -> [f64; 3] {
        let mut sum = [0_u64; 3];
        for pixel in self.rgba().chunks_exact(4) {
            for (total, value) in sum.iter_mut().zip(pixel) {
                *total += u64::from(*value);
            }
        }
        let count = (self.rgba().len() / 4).max(1) as f64;
        sum.map(|total| total as f64 / count)
    }

    /// Returns the mean colour in linear light, each 0 to 1; fully transparent pixels are left out. Shape (3,).
    pub fn mean_linear(&self) -> [f32; 3] {
        let decode: Vec<f64> = (0..=255_u8)
            .map(|b| f64::from(crate::units::linear_from_srgb(f32::from(b) / 255.0)))
            .collect();
        let (mut sum, mut count) = ([0.0_f64; 3], 0_u64);
        for pixel in self.rgba().chunks_exact(4).filter(|p| p[3] > 0) {
            for (total, value) in sum.iter_mut().zip(pixel) {
                *total += decode[usize::from(*value)];
            }
            count += 1;
        }
        sum.map(|total| (total / count.max(1) as f64) as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn pixels_are_painted_once_and_only_when_asked_for() {
        let painted = Arc::new(AtomicUsize::new(0));
        let count = painted.clone();
        let later = Texture::lazy("later".to_owned(), 2, 1, move |_| {
            count.fetch_add(1, Ordering::SeqCst);
            vec![9; 8]
        });
        later.check("later").unwrap();
        assert!(!later.is_loaded() && painted.load(Ordering::SeqCst) == 0);
        assert_eq!(later.rgba(), [9; 8]);
        assert_eq!(later.mean_srgb(), [9.0; 3]);
        assert_eq!(painted.load(Ordering::SeqCst), 1);
        assert_eq!(later, Texture::new("later".to_owned(), 2, 1, vec![9; 8]));
    }

    #[test]
    fn a_sample_is_every_so_many_th_pixel_and_paints_no_other() {
        let painted = Arc::new(AtomicUsize::new(0));
        let count = painted.clone();
        let later = Texture::lazy("later".to_owned(), 5, 3, move |step| {
            let pixels = (0..15).step_by(step);
            count.fetch_add(pixels.len(), Ordering::SeqCst);
            pixels.flat_map(|k| [k; 4]).collect()
        });
        let sample: Vec<u8> = [0, 4, 8, 12].into_iter().flat_map(|k| [k; 4]).collect();
        assert_eq!(*later.sampled_rgba(4), sample);
        assert_eq!(painted.load(Ordering::SeqCst), 4);
        assert!(!later.is_loaded());
        later.rgba();
        assert_eq!(*later.sampled_rgba(4), sample);
        assert_eq!(*later.sampled_rgba(0), *later.rgba());
        assert_eq!(painted.load(Ordering::SeqCst), 4 + 15);
    }

    #[test]
    fn a_painter_of_another_size_is_cut_or_filled_up() {
        let short = Texture::lazy("short".to_owned(), 2, 1, |_| vec![9; 5]);
        assert_eq!(short.rgba(), [9, 9, 9, 9, 9, 0, 0, 0]);
        let long = Texture::lazy("long".to_owned(), 1, 1, |_| vec![9; 5]);
        assert_eq!(long.rgba(), [9; 4]);
        assert!(
            Texture::new("bad".to_owned(), 1, 1, vec![9; 5])
                .check("bad")
                .is_err()
        );
    }
}
