//! Cloth, carpet, leather, wicker.

use super::TexturePaint;
use super::canvas::{PixelCanvas, mix, shade, smooth_step};
use dwell_scene::math;
use std::f32::consts::TAU;

/// Cut pile: the ground colour in many tufts.
pub(super) fn carpet(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [ground, second, _] = paint.colors;
    canvas.fill(|u, v| {
        let tuft = paint.noise.value_at(u, v, 64, 64);
        let patch = paint.noise.fractal(u, v, 4, 4, 3);
        shade(
            mix(ground, second, 0.5 * smooth_step(0.6, 0.95, tuft)),
            0.82 + 0.2 * tuft + 0.14 * patch,
        )
    });
}

/// Plain weave of 8 by 8 threads.
pub(super) fn weave(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [ground, second, _] = paint.colors;
    canvas.fill(|u, v| {
        let (x, y) = (u * 16.0, v * 16.0);
        let over = (x as i32 + y as i32) % 2 == 0;
        let across = if over { y } else { x };
        let round = math::sin(std::f32::consts::PI * (across - across.floor()));
        let yarn = paint
            .noise
            .lattice_value(if over { y as i32 } else { 40 + x as i32 }, 3);
        let color = if over {
            ground
        } else {
            mix(ground, second, 0.5)
        };
        shade(color, 0.8 + 0.14 * round + 0.12 * yarn)
    });
}

/// Grained hide.
pub(super) fn leather(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    canvas.fill(|u, v| {
        // Distance to the nearest of jittered points, one in each of 24 by 24 cells, makes the pebbles.
        let (x, y) = (u * 24.0, v * 24.0);
        let (i, j) = (x.floor() as i32, y.floor() as i32);
        let mut nearest = 4.0_f32;
        for (di, dj) in [
            (-1, -1),
            (0, -1),
            (1, -1),
            (-1, 0),
            (0, 0),
            (1, 0),
            (-1, 1),
            (0, 1),
            (1, 1),
        ] {
            let (a, b) = ((i + di).rem_euclid(24), (j + dj).rem_euclid(24));
            let px = (i + di) as f32 + paint.noise.lattice_value(a, b * 2);
            let py = (j + dj) as f32 + paint.noise.lattice_value(a + 60, b * 2 + 1);
            nearest = nearest.min((px - x) * (px - x) + (py - y) * (py - y));
        }
        let worn = paint.noise.fractal(u, v, 3, 3, 3);
        shade(
            paint.colors[0],
            1.06 - 0.28 * nearest.min(1.0) + 0.16 * (worn - 0.5),
        )
    });
}

/// Broad stripes of three colours along v, woven.
pub(super) fn stripes(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [a, b, c] = paint.colors;
    canvas.fill(|u, v| {
        let color = match (u * 8.0) as i32 {
            1 | 2 => b,
            5 => c,
            _ => a,
        };
        shade(color, 0.92 + 0.1 * paint.noise.value_at(u, v, 64, 64))
    });
}

/// A tartan of crossing bands.
pub(super) fn checks(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [ground, band, line] = paint.colors;
    canvas.fill(|u, v| {
        let band_at = |x: f32| f32::from((x * 2.0) as i32 % 2 == 0);
        let line_at = |x: f32| {
            let d = (x * 2.0 - (x * 2.0).floor() - 0.5).abs();
            1.0 - smooth_step(0.03, 0.05, d)
        };
        let base = mix(ground, band, 0.5 * (band_at(u) + band_at(v)));
        let color = mix(base, line, 0.45 * (line_at(u) + line_at(v)));
        shade(color, 0.93 + 0.09 * paint.noise.value_at(u, v, 64, 64))
    });
}

/// Basket work: rods over and under stakes.
pub(super) fn wicker(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [light, dark, _] = paint.colors;
    canvas.fill(|u, v| {
        let (x, y) = (u * 4.0, v * 8.0);
        let front = math::sin(TAU * 0.5 * (x + if y as i32 % 2 == 0 { 0.0 } else { 1.0 }));
        let round = math::sin(std::f32::consts::PI * (y - y.floor()));
        let rod = paint.noise.lattice_value(y as i32, 9);
        mix(
            dark,
            light,
            0.15 + 0.35 * round + 0.3 * front.abs() * round + 0.25 * rod,
        )
    });
}

/// A whole rug: border, field with a lattice of rhombs, medallion. Colours: field, border, motif.
pub(super) fn rug(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [field, border, motif] = paint.colors;
    canvas.fill(|u, v| {
        let edge = u.min(1.0 - u).min(v.min(1.0 - v));
        let (x, y) = ((u - 0.5).abs(), (v - 0.5).abs());
        let rhomb = x + y;
        let lattice = {
            let (a, b) = ((u + v) * 10.0, (u - v) * 10.0);
            let near = |t: f32| (t - t.floor() - 0.5).abs();
            near(a).min(near(b)) < 0.07
        };
        let color = match () {
            () if edge < 0.02 => motif,
            () if edge < 0.1 => {
                let along = if u.min(1.0 - u) < v.min(1.0 - v) {
                    v
                } else {
                    u
                };
                let tooth = ((along * 16.0).fract() - 0.5).abs();
                if tooth < 0.5 - (edge - 0.02) / 0.16 {
                    border
                } else {
                    motif
                }
            }
            () if edge < 0.12 => motif,
            () if rhomb < 0.1 => motif,
            () if rhomb < 0.17 => border,
            () if rhomb < 0.19 => motif,
            () if lattice => mix(field, border, 0.7),
            () => field,
        };
        shade(color, 0.84 + 0.22 * paint.noise.value_at(u, v, 110, 110))
    });
}
