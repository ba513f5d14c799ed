//! Small things: book covers, page edges, leaves, peel.

use super::TexturePaint;
use super::canvas::{PixelCanvas, mix, shade, smooth_step};

/// The cover of a book: cloth, a label with two lines, a band. Colours: cloth, label, band.
pub(super) fn cover(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [cloth, label, band] = paint.colors;
    canvas.fill(|u, v| shade(cloth, 0.92 + 0.12 * paint.noise.value_at(u, v, 48, 64)));
    canvas.rectangle([0.14, 0.58], [0.86, 0.82], label);
    canvas.rectangle([0.22, 0.73], [0.78, 0.76], shade(cloth, 0.6));
    canvas.rectangle([0.3, 0.65], [0.7, 0.67], shade(cloth, 0.6));
    canvas.rectangle([0.0, 0.16], [1.0, 0.22], band);
}

/// The edges of many pages, lines along u.
pub(super) fn page_edges(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    canvas.fill(|u, v| {
        shade(
            paint.colors[0],
            0.8 + 0.25 * paint.noise.value_at(u, v, 2, 64),
        )
    });
}

/// The green of leaves with lighter ribs.
pub(super) fn foliage(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [green, rib, _] = paint.colors;
    canvas.fill(|u, v| {
        let side = (v * 8.0 + 3.0 * (u - 0.5).abs()).fract();
        let line = 1.0 - smooth_step(0.05, 0.16, (side - 0.5).abs());
        shade(
            mix(green, rib, 0.4 * line),
            0.85 + 0.3 * paint.noise.fractal(u, v, 4, 4, 3),
        )
    });
}

/// The skin of a fruit: ground, blush, freckles.
pub(super) fn peel(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [ground, blush, freckle] = paint.colors;
    canvas.fill(|u, v| {
        let body = mix(
            ground,
            blush,
            smooth_step(0.35, 0.7, paint.noise.fractal(u, v, 3, 2, 3)),
        );
        mix(
            body,
            freckle,
            0.6 * smooth_step(0.8, 0.95, paint.noise.value_at(u, v, 32, 32)),
        )
    });
}
