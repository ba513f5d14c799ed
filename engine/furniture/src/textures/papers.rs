//! Wallpapers.

use super::TexturePaint;
use super::canvas::{PixelCanvas, mix, shade, smooth_step};
use dwell_scene::math;
use std::f32::consts::TAU;

/// Sprigs of paired leaves on a half-drop repeat; colours: ground, leaf, stalk.
pub(super) fn leaves(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [ground, leaf, stalk] = paint.colors;
    canvas.fill(|u, v| {
        let column = (u * 4.0).floor();
        let drop = if column as i32 % 2 == 0 { 0.0 } else { 0.5 };
        let x = u * 4.0 - column - 0.5;
        let y = (v * 4.0 + drop).fract();
        // The stalk sways; leaves sit on it in pairs and point up and out.
        let sway = 0.05 * math::sin(TAU * y);
        let dx = x - sway;
        let mut color = mix(
            ground,
            stalk,
            0.7 * (1.0 - smooth_step(0.012, 0.03, dx.abs())),
        );
        for row in 0..4 {
            let foot = 0.06 + 0.24 * row as f32;
            for wrap in [-1.0, 0.0, 1.0] {
                let (along, across) = {
                    let (a, b) = (dx.abs(), y - foot - wrap);
                    ((a + b) * 0.707, (b - a) * 0.707)
                };
                let t = along / 0.3;
                if (0.0..1.0).contains(&t) {
                    let half = 0.065 * math::sin(std::f32::consts::PI * t);
                    color = mix(
                        color,
                        leaf,
                        0.85 * (1.0 - smooth_step(half * 0.7, half, across.abs())),
                    );
                }
            }
        }
        shade(color, 0.97 + 0.05 * paint.noise.value_at(u, v, 64, 64))
    });
}

/// Scattered stars of two colours.
pub(super) fn stars(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [ground, a, b] = paint.colors;
    canvas.fill(|u, v| {
        let (x, y) = (u * 4.0, v * 4.0);
        let (i, j) = (x.floor() as i32, y.floor() as i32);
        let jitter = |k: i32| 0.5 + 0.36 * (paint.noise.lattice_value(i * 4 + k, j * 9) - 0.5);
        let (dx, dy) = (x - i as f32 - jitter(1), y - j as f32 - jitter(2));
        let angle = math::atan2(dx, dy) + TAU * jitter(3);
        let radius = (dx * dx + dy * dy).sqrt();
        let rim = 0.13 + 0.05 * math::cos(5.0 * angle);
        let color = if (i + j) % 2 == 0 { a } else { b };
        mix(
            shade(ground, 0.97 + 0.05 * paint.noise.value_at(u, v, 64, 64)),
            color,
            1.0 - smooth_step(rim - 0.02, rim, radius),
        )
    });
}

/// Fine upright stripes.
pub(super) fn pinstripe(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [ground, stripe, line] = paint.colors;
    canvas.fill(|u, v| {
        let x = (u * 4.0).fract();
        let broad = mix(ground, stripe, f32::from(x < 0.5));
        let color = if (x - 0.5).abs() < 0.03 || !(0.03..0.97).contains(&x) {
            line
        } else {
            broad
        };
        shade(color, 0.97 + 0.05 * paint.noise.value_at(u, v, 64, 64))
    });
}
