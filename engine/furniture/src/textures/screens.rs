//! Faces of devices.

use super::TexturePaint;
use super::canvas::{PixelCanvas, mix, shade, smooth_step};
use dwell_scene::math;
use std::f32::consts::TAU;

/// A television programme: a harbour at dusk and a caption below.
pub(super) fn television(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [sky, sea, caption] = paint.colors;
    let noise = &paint.noise;
    canvas.fill(|u, v| {
        if v < 0.42 {
            mix(sea, sky, 0.6 * noise.value_at(u, v, 8, 70))
        } else {
            mix(
                [1.0, 0.72, 0.45],
                sky,
                smooth_step(0.42, 0.85, v + 0.1 * noise.fractal(u, v, 4, 6, 3)),
            )
        }
    });
    canvas.disc([0.62, 0.5], 0.1, [1.0, 0.9, 0.7]);
    canvas.map_pixels(|u, v, old| {
        let roof = 0.42
            + 0.2
                * noise.lattice_value((u * 26.0) as i32, 4)
                * smooth_step(0.05, 0.3, (u - 0.55).abs());
        if v > 0.4 && v < roof {
            shade(sea, 0.35)
        } else {
            old
        }
    });
    canvas.rectangle([0.0, 0.06], [1.0, 0.2], caption);
    canvas.rectangle([0.04, 0.09], [0.5, 0.12], [0.95, 0.95, 0.97]);
    canvas.rectangle([0.04, 0.14], [0.72, 0.17], [0.95, 0.95, 0.97]);
    canvas.rectangle([0.87, 0.86], [0.95, 0.93], [0.9, 0.2, 0.2]);
}

/// A computer's desktop with a window of text.
pub(super) fn desktop(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [ground, window, text] = paint.colors;
    canvas.fill(|u, v| {
        mix(
            ground,
            shade(ground, 0.5),
            smooth_step(0.2, 0.9, v + 0.3 * paint.noise.fractal(u, v, 2, 2, 3)),
        )
    });
    canvas.rectangle([0.12, 0.14], [0.82, 0.88], window);
    canvas.rectangle([0.12, 0.82], [0.82, 0.88], shade(window, 0.8));
    for line in 0..12 {
        let (v, width) = (
            0.76 - 0.05 * line as f32,
            0.2 + 0.42 * paint.noise.lattice_value(line, 2),
        );
        canvas.rectangle([0.16, v], [0.16 + width, v + 0.02], text);
    }
    canvas.rectangle([0.0, 0.0], [1.0, 0.05], shade(ground, 0.35));
}

/// Keys in rows and a touch pad. Colours: case, key, pad.
pub(super) fn keyboard(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [case, key, pad] = paint.colors;
    canvas.fill(|u, v| {
        let (x, y) = ((u - 0.06) / 0.88 * 15.0, (v - 0.42) / 0.52 * 5.0);
        let in_keys = (0.0..15.0).contains(&x) && (0.0..5.0).contains(&y);
        let (dx, dy) = (x - x.floor(), y - y.floor());
        let space_bar = (0.0..1.0).contains(&y) && (4.0..10.0).contains(&x);
        let side = if space_bar { 0.5 } else { dx.min(1.0 - dx) };
        if in_keys && side > 0.1 && dy.min(1.0 - dy) > 0.12 {
            key
        } else {
            case
        }
    });
    canvas.rectangle([0.34, 0.06], [0.66, 0.36], pad);
}

/// A tuning dial: a scale and a pointer. Colours: face, ink, pointer.
pub(super) fn dial(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [face, ink, pointer] = paint.colors;
    canvas.fill(|u, v| {
        let tick = ((u * 20.0).fract() - 0.5).abs() > 0.42;
        let long = ((u * 5.0).fract() - 0.5).abs() > 0.44;
        let band = (0.2..0.5).contains(&v) || ((0.2..0.7).contains(&v) && long);
        if (u - 0.63).abs() < 0.012 {
            pointer
        } else if tick && band && (0.06..0.94).contains(&u) {
            ink
        } else {
            face
        }
    });
}

/// A clock that shows ten past ten. Colours: face, ink, second hand.
pub(super) fn clock(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [face, ink, second] = paint.colors;
    canvas.fill(|u, v| {
        let (x, y) = (u - 0.5, v - 0.5);
        let radius = (x * x + y * y).sqrt();
        let hour = (math::atan2(x, y) / TAU * 12.0).rem_euclid(12.0);
        let mark =
            ((hour + 0.5).fract() - 0.5).abs() * radius < 0.03 && (0.38..0.44).contains(&radius);
        // A hand from the middle towards a clock angle.
        let hand = |turn: f32, length: f32, half: f32| {
            let (sin, cos) = math::sin_cos(TAU * turn);
            let (along, across) = (x * sin + y * cos, x * cos - y * sin);
            (-0.04..length).contains(&along) && across.abs() < half
        };
        match () {
            () if radius < 0.02 || hand(0.58, 0.38, 0.005) => second,
            () if mark || hand(10.17 / 12.0, 0.22, 0.014) || hand(10.0 / 60.0, 0.34, 0.01) => ink,
            () => face,
        }
    });
}

/// Perforated metal or loudspeaker cloth. Colours: metal, hole.
pub(super) fn grille(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [metal, hole, _] = paint.colors;
    canvas.fill(|u, v| {
        let row = (v * 8.0).floor();
        let (x, y) = (
            u * 8.0 + if row as i32 % 2 == 0 { 0.0 } else { 0.5 },
            v * 8.0,
        );
        let (dx, dy) = (x - x.floor() - 0.5, y - row - 0.5);
        mix(
            hole,
            metal,
            smooth_step(0.26, 0.36, (dx * dx + dy * dy).sqrt()),
        )
    });
}
