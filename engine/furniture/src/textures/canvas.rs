//! A picture under construction.

use dwell_scene::interrupt;

/// A colour while it is mixed: sRGB-encoded, each 0 to 1.
pub(super) type EncodedColor = [f32; 3];

/// Mixes two colours: 0 gives `a`, 1 gives `b`.
pub(super) fn mix(a: EncodedColor, b: EncodedColor, amount: f32) -> EncodedColor {
    let t = amount.clamp(0.0, 1.0);
    [
        a[0] + (b[0] - a[0]) * t,
        a[1] + (b[1] - a[1]) * t,
        a[2] + (b[2] - a[2]) * t,
    ]
}

/// The same colour lighter (above 1) or darker.
pub(super) fn shade(color: EncodedColor, factor: f32) -> EncodedColor {
    color.map(|c| c * factor)
}

/// 0 below `low`, 1 above `high`, smooth between.
pub(super) fn smooth_step(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Number of pixels between two looks whether to stop.
const CHECK_PIXELS: usize = 256;

/// Rows of pixels from the top, or every so many-th of them.
pub(super) struct PixelCanvas {
    width: u32,
    height: u32,
    /// From one pixel to the next: 1 for a whole picture.
    step: usize,
    pixels: Vec<EncodedColor>,
}

impl PixelCanvas {
    /// A black picture, of which every `step`-th pixel from the first is drawn.
    pub(super) fn new(width: u32, height: u32, step: usize) -> Self {
        Self {
            width,
            height,
            step,
            pixels: vec![[0.0; 3]; ((width * height) as usize).div_ceil(step)],
        }
    }

    /// Colours each pixel anew by its place, u to the right and v up, each 0 to 1.
    pub(super) fn fill(&mut self, mut color: impl FnMut(f32, f32) -> EncodedColor) {
        self.map_pixels(|u, v, _| color(u, v));
    }

    /// Colours each pixel by its place and the colour that it has.
    pub(super) fn map_pixels(
        &mut self,
        mut color: impl FnMut(f32, f32, EncodedColor) -> EncodedColor,
    ) {
        let (du, dv) = (1.0 / self.width as f32, 1.0 / self.height as f32);
        let width = self.width as usize;
        let (mut row, mut column) = (0, 0);
        for pixels in self.pixels.chunks_mut(CHECK_PIXELS) {
            interrupt::unwind_if_cancelled();
            for pixel in pixels {
                let v = 1.0 - (row as f32 + 0.5) * dv;
                *pixel = color((column as f32 + 0.5) * du, v, *pixel);
                column += self.step;
                while column >= width {
                    column -= width;
                    row += 1;
                }
            }
        }
    }

    /// A filled rectangle from its lower left to its upper right corner.
    pub(super) fn rectangle(&mut self, low: [f32; 2], high: [f32; 2], color: EncodedColor) {
        self.map_pixels(|u, v, old| {
            let inside = u >= low[0] && u < high[0] && v >= low[1] && v < high[1];
            if inside { color } else { old }
        });
    }

    /// A filled disc; `radius` in units of the height.
    pub(super) fn disc(&mut self, center: [f32; 2], radius: f32, color: EncodedColor) {
        let aspect = self.aspect();
        let edge = 1.5 / self.height as f32;
        self.map_pixels(|u, v, old| {
            let (x, y) = ((u - center[0]) * aspect, v - center[1]);
            let distance = (x * x + y * y).sqrt();
            mix(
                old,
                color,
                1.0 - smooth_step(radius - edge, radius + edge, distance),
            )
        });
    }

    /// Width over height.
    pub(super) fn aspect(&self) -> f32 {
        self.width as f32 / self.height as f32
    }

    /// The bytes of a texture.
    pub(super) fn into_rgba(self) -> Vec<u8> {
        let byte = |c: f32| (c.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
        self.pixels
            .iter()
            .flat_map(|[r, g, b]| [byte(*r), byte(*g), byte(*b), 255])
            .collect()
    }
}
