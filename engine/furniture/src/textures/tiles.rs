//! Things laid with joints: tiles and bricks.

use super::TexturePaint;
use super::canvas::{PixelCanvas, mix, shade, smooth_step};

/// Two by two square tiles; colours: tile, joint, cloud in the tile.
pub(super) fn tile(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [tile, joint, cloud] = paint.colors;
    canvas.fill(|u, v| {
        let (x, y) = (u * 2.0, v * 2.0);
        let (dx, dy) = (x - x.floor(), y - y.floor());
        let tone = paint.noise.lattice_value(x as i32 + 3, y as i32 * 2 + 5);
        let veil = paint.noise.fractal(u, v, 6, 6, 3);
        let edge = dx.min(1.0 - dx).min(dy).min(1.0 - dy);
        let body = shade(
            mix(tile, cloud, 0.7 * smooth_step(0.45, 0.8, veil)),
            0.95 + 0.08 * tone,
        );
        mix(joint, body, smooth_step(0.012, 0.022, edge))
    });
}

/// Bricks in running bond, six courses of two: on half a metre those of DIN 4172, 25 cm long and twelve to a metre high with
/// their joints. Colours: brick, joint, burnt brick.
pub(super) fn brick(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [brick, joint, burnt] = paint.colors;
    canvas.fill(|u, v| {
        let y = v * 6.0;
        let course = y.floor();
        let x = u * 2.0 + if course as i32 % 2 == 0 { 0.0 } else { 0.5 };
        let (dx, dy) = (x - x.floor(), y - course);
        let tone = paint
            .noise
            .lattice_value((x.floor() as i32).rem_euclid(2) * 3 + 1, course as i32 * 7);
        let rough = paint.noise.fractal(u, v, 16, 16, 3);
        let edge = (dx.min(1.0 - dx) * 3.0).min(dy.min(1.0 - dy));
        let body = shade(mix(brick, burnt, 0.6 * tone), 0.85 + 0.3 * rough);
        mix(
            joint,
            body,
            smooth_step(0.05, 0.09, edge + 0.03 * (rough - 0.5)),
        )
    });
}

/// Glazed tiles twice as wide as high in running bond, four courses of two; colours: tile, joint, cloud.
pub(super) fn metro(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [tile, joint, cloud] = paint.colors;
    canvas.fill(|u, v| {
        let y = v * 4.0;
        let course = y as i32;
        let x = u * 2.0 + if course % 2 == 0 { 0.0 } else { 0.5 };
        let (dx, dy) = (x - x.floor(), y - course as f32);
        let tone = paint.noise.lattice_value(x as i32 % 2 * 3 + 1, course * 7);
        // The glaze is thinner towards the rims.
        let edge = (dx.min(1.0 - dx) * 2.0).min(dy.min(1.0 - dy));
        let body = shade(
            mix(cloud, tile, smooth_step(0.02, 0.12, edge)),
            0.97 + 0.05 * tone,
        );
        mix(joint, body, smooth_step(0.02, 0.04, edge))
    });
}
