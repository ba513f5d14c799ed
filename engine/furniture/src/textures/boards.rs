//! Wood: boards, plank floors, herringbone parquet. The grain runs along u.

use super::canvas::{EncodedColor, PixelCanvas, mix, shade, smooth_step};
use super::noise::floor;
use super::{TexturePaint, ValueNoise};

/// The colour of wood at a place; `rings` year rings cross the square.
fn grain(
    noise: &ValueNoise,
    [light, dark, _]: [EncodedColor; 3],
    u: f32,
    v: f32,
    rings: f32,
) -> EncodedColor {
    let bend = noise.value_at(u, v, 2, 5) + 0.3 * noise.value_at(u, v, 3, 11);
    let ring = wave(rings * v + 1.1 * bend);
    let (tone, fibre, pore) = (
        noise.value_at(u, v, 1, 7),
        noise.value_at(u, v, 5, 96),
        noise.value_at(u, v, 16, 200),
    );
    let dark_share =
        0.25 * tone + 0.3 * ring * ring + 0.3 * fibre + 0.15 * smooth_step(0.72, 0.95, pore);
    mix(light, dark, dark_share)
}

/// A smooth wave from 0 to 1 and back over each whole step of `x`, quicker than a sine.
fn wave(x: f32) -> f32 {
    let t = (2.0 * (x - floor(x) as f32) - 1.0).abs();
    t * t * (3.0 - 2.0 * t)
}

/// One board.
pub(super) fn wood(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    canvas.fill(|u, v| grain(&paint.noise, paint.colors, u, v, 9.0));
}

/// Floor boards along u: eight courses, each course a board and a half long.
pub(super) fn planks(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    const COURSES: f32 = 8.0;
    let noise = &paint.noise;
    canvas.fill(|u, v| {
        let course = (v * COURSES).floor();
        let shift = noise.lattice_value(course as i32, 7);
        let along = (u + shift) * 2.0;
        let board = along.floor().rem_euclid(2.0);
        let tone = noise.lattice_value(course as i32 * 5 + board as i32, 31);
        // Each board shows another piece of the tree.
        let color = grain(noise, paint.colors, u + tone, v + tone * 3.0, 8.0);
        let (x, y) = (along - along.floor(), v * COURSES - course);
        let gap = (y.min(1.0 - y) / 0.03).min(x.min(1.0 - x) * 4.0 / 0.03);
        shade(
            color,
            (0.86 + 0.24 * tone) * (0.62 + 0.38 * smooth_step(0.3, 1.0, gap)),
        )
    });
}

/// Herringbone: boards four times as long as wide, two directions.
pub(super) fn herringbone(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    const CELLS: i32 = 16;
    const LONG: i32 = 4;
    let noise = &paint.noise;
    canvas.fill(|u, v| {
        let (x, y) = (u * CELLS as f32, v * CELLS as f32);
        let (i, j) = (x.floor() as i32, y.floor() as i32);
        // Along the diagonal i - j the pattern repeats every eight cells: four of a lying board, four of a standing one.
        let place = (i - j).rem_euclid(2 * LONG);
        let lying = place < LONG;
        let (start_i, start_j) = if lying {
            (i - place, j)
        } else {
            (i, j - (2 * LONG - 1 - place))
        };
        let tone = noise.lattice_value(
            start_i.rem_euclid(CELLS) + 17 * start_j.rem_euclid(CELLS),
            i32::from(lying),
        );
        let (dx, dy) = (x - start_i as f32, y - start_j as f32);
        let (along, across) = if lying { (dx, dy) } else { (dy, dx) };
        let color = grain(
            noise,
            paint.colors,
            along / 16.0 + tone,
            across / 16.0 + tone * 5.0,
            14.0,
        );
        let gap = across.min(1.0 - across).min(along).min(LONG as f32 - along) / 0.07;
        shade(
            color,
            (0.84 + 0.28 * tone) * (0.6 + 0.4 * smooth_step(0.2, 1.0, gap)),
        )
    });
}
