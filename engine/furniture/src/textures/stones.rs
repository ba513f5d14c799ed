//! Plaster, marble, speckled stone.

use super::TexturePaint;
use super::canvas::{PixelCanvas, mix, shade, smooth_step};
use dwell_scene::math;
use std::f32::consts::TAU;

/// Rolled paint on plaster: the ground colour with a faint grain.
pub(super) fn plaster(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    canvas.fill(|u, v| {
        let grain = paint.noise.fractal(u, v, 8, 8, 4);
        let fine = paint.noise.value_at(u, v, 64, 64);
        shade(paint.colors[0], 0.965 + 0.05 * grain + 0.02 * fine)
    });
}

/// Veined stone; colours: ground, vein, cloud.
pub(super) fn marble(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [ground, vein, cloud] = paint.colors;
    canvas.fill(|u, v| {
        let warp = paint.noise.fractal(u, v, 3, 3, 4);
        let line = math::sin(TAU * (u + 2.0 * v + 2.4 * warp)).abs();
        let thin = 1.0 - smooth_step(0.0, 0.16, line);
        let body = mix(ground, cloud, smooth_step(0.4, 0.8, warp));
        mix(body, vein, 0.75 * thin * paint.noise.value_at(u, v, 4, 4))
    });
}

/// Granite or terrazzo: ground with grains of two colours.
pub(super) fn speckle(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [ground, dark, light] = paint.colors;
    canvas.fill(|u, v| {
        let (coarse, fine) = (
            paint.noise.value_at(u, v, 40, 40),
            paint.noise.value_at(v, u, 64, 64),
        );
        let body = mix(ground, dark, smooth_step(0.62, 0.8, coarse));
        mix(body, light, smooth_step(0.7, 0.86, fine))
    });
}
