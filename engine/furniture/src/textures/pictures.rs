//! Pictures for walls; they fill their frame.

use super::TexturePaint;
use super::canvas::{PixelCanvas, mix, shade, smooth_step};
use dwell_scene::math;
use std::f32::consts::TAU;

/// Sky, sun, three ranges of hills, a lake. Colours: sky, hills, sun.
pub(super) fn landscape(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [sky, hill, sun] = paint.colors;
    let noise = &paint.noise;
    let light = mix(sky, [1.0, 0.96, 0.88], 0.75);
    canvas.fill(|u, v| {
        let cloud = smooth_step(0.5, 0.75, noise.fractal(u, v * 0.6, 3, 6, 4));
        mix(
            mix(light, sky, smooth_step(0.4, 1.0, v)),
            [1.0; 3],
            0.5 * cloud,
        )
    });
    canvas.disc([0.7, 0.72], 0.08, sun);
    canvas.map_pixels(|u, v, old| {
        let ridge = |base: f32, size: f32, cells: i32| {
            base + size * noise.fractal(u, 0.37 * base, cells, 1, 4)
        };
        let far = mix(hill, light, 0.55);
        let near = shade(hill, 0.6);
        match v {
            v if v < ridge(0.05, 0.16, 4) => shade(near, 0.8 + 0.4 * noise.value_at(u, v, 40, 40)),
            v if v < 0.24 => mix(shade(sky, 0.75), light, 0.35 * noise.value_at(u, v, 6, 60)),
            v if v < ridge(0.22, 0.24, 5) => hill,
            v if v < ridge(0.34, 0.3, 3) => far,
            _ => old,
        }
    });
}

/// Overlapping arcs and blocks in the manner of a modern print.
pub(super) fn shapes(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [a, b, c] = paint.colors;
    let paper = [0.95, 0.93, 0.88];
    canvas.fill(|u, v| shade(paper, 0.97 + 0.04 * paint.noise.value_at(u, v, 60, 60)));
    let mut random = paint.key.child("shapes").stream();
    let mut jitter = || random.range(-0.05, 0.05);
    canvas.rectangle([0.12 + jitter(), 0.08], [0.62, 0.46 + jitter()], a);
    canvas.disc([0.6 + jitter(), 0.62 + jitter()], 0.2, b);
    canvas.disc([0.34 + jitter(), 0.42 + jitter()], 0.15, mix(b, a, 0.5));
    canvas.rectangle([0.55, 0.14 + jitter()], [0.86 + jitter(), 0.32], c);
    for k in 0..5 {
        let x = 0.2 + 0.03 * k as f32;
        canvas.rectangle([x, 0.6], [x + 0.01, 0.88], shade(c, 0.5));
    }
    canvas.disc([0.72, 0.24], 0.06, paper);
}

/// A botanical print: one branch with leaves on paper. Colours: paper, leaf, stalk.
pub(super) fn branch(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [paper, leaf, stalk] = paint.colors;
    canvas.fill(|u, v| {
        let x = (u - 0.5) * 0.75 - 0.08 * math::sin(3.0 * v);
        let mut color = shade(paper, 0.97 + 0.04 * paint.noise.value_at(u, v, 48, 48));
        if (0.08..0.9).contains(&v) {
            color = mix(color, stalk, 1.0 - smooth_step(0.004, 0.009, x.abs()));
        }
        for k in 0..11 {
            let side = if k % 2 == 0 { 1.0 } else { -1.0 };
            let foot = 0.16 + 0.065 * k as f32;
            let (along, across) = (
                (x * side * 0.8 + (v - foot) * 0.6),
                ((v - foot) * 0.8 - x * side * 0.6),
            );
            let length = 0.26 - 0.012 * k as f32;
            let t = along / length;
            if (0.0..1.0).contains(&t) && across.abs() < 0.2 * length {
                let half = 0.2 * length * math::sin(std::f32::consts::PI * math::pow(t, 0.8));
                let rib = 1.0 - 0.25 * (1.0 - smooth_step(0.002, 0.006, across.abs()));
                let inside = 1.0 - smooth_step(half - 0.006, half, across.abs());
                color = mix(color, shade(leaf, rib * (0.8 + 0.03 * k as f32)), inside);
            }
        }
        color
    });
}

/// Three soft fields of colour, one over the other.
pub(super) fn color_fields(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [a, b, c] = paint.colors;
    let ground = mix(shade(b, 0.75), [0.9, 0.86, 0.8], 0.35);
    canvas.fill(|u, v| {
        let soft = 0.02 + 0.02 * paint.noise.fractal(u, v, 8, 8, 3);
        let inside = |low: f32, high: f32, x: f32| {
            smooth_step(low - soft, low + soft, x)
                * (1.0 - smooth_step(high - soft, high + soft, x))
        };
        let mut color = ground;
        for (low, high, field) in [
            (0.06, 0.36, a),
            (0.4, 0.56, c),
            (0.6, 0.94, mix(a, c, 0.45)),
        ] {
            let there = inside(0.09, 0.91, u) * inside(low, high, v);
            let rubbed = 0.9 + 0.2 * paint.noise.fractal(u, v, 24, 10, 3);
            color = mix(color, shade(field, rubbed), 0.92 * there);
        }
        color
    });
}

/// Rings and half rings on a grid of squares.
pub(super) fn rings(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let colors = paint.colors;
    let paper = [0.94, 0.92, 0.87];
    canvas.fill(|u, v| {
        let (x, y) = (u * 3.0, v * 4.0);
        let (column, row) = (x as i32, y as i32);
        let pick = paint.noise.lattice_value(column * 5 + 2, row * 9 + 4);
        let index = (pick * 2.999) as usize;
        let (dx, dy) = (x - column as f32, y - row as f32);
        // The middle of the rings: a corner of the square, or the middle of an edge.
        let (cx, cy) = [(0.0, 0.0), (1.0, 0.0), (0.5, 0.0)][(column + 2 * row) as usize % 3];
        let radius = ((dx - cx) * (dx - cx) + (dy - cy) * (dy - cy)).sqrt();
        let band = (radius * 4.0) as usize;
        match band {
            0 | 2 => colors[index],
            1 => paper,
            3 => shade(colors[(index + 1) % 3], 1.1),
            _ => shade(paper, 0.96),
        }
    });
}

/// Dunes or waves under a pale sky, each line in front of the last.
pub(super) fn waves(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [a, b, c] = paint.colors;
    let sky = mix(c, [0.97, 0.95, 0.9], 0.8);
    canvas.fill(|u, v| {
        let mut color = shade(sky, 0.96 + 0.06 * paint.noise.value_at(u, v, 50, 50));
        for k in 0..7 {
            let depth = k as f32 / 6.0;
            let crest = 0.78 - 0.12 * k as f32
                + 0.05 * math::sin(TAU * (u * (0.8 + 0.25 * depth) + 0.37 * k as f32))
                + 0.03 * (paint.noise.fractal(u, 0.13 * k as f32, 3, 1, 2) - 0.5);
            let tone = shade(mix(a, b, depth), 0.75 + 0.1 * (k % 3) as f32);
            color = mix(
                color,
                tone,
                1.0 - smooth_step(crest - 0.004, crest + 0.004, v),
            );
        }
        color
    });
}

/// A poster for a child: planets on their ways round the sun.
pub(super) fn planets(canvas: &mut PixelCanvas, paint: &TexturePaint) {
    let [space, a, b] = paint.colors;
    canvas.fill(|u, v| {
        let star = smooth_step(0.93, 0.97, paint.noise.value_at(u, v, 60, 45));
        mix(mix(shade(space, 0.7), space, v), [1.0, 1.0, 0.9], star)
    });
    let aspect = canvas.aspect();
    canvas.map_pixels(|u, v, old| {
        let (x, y) = (u * aspect, v - 0.5);
        let radius = (x * x + y * y).sqrt();
        let near = (0..5)
            .map(|k| (radius - 0.38 - 0.2 * k as f32).abs())
            .fold(1.0, f32::min);
        mix(
            old,
            [0.8, 0.85, 0.95],
            0.5 * (1.0 - smooth_step(0.003, 0.007, near)),
        )
    });
    canvas.disc([0.0, 0.5], 0.24, [1.0, 0.85, 0.3]);
    for k in 0..5 {
        let radius = 0.38 + 0.2 * k as f32;
        let (sin, cos) = math::sin_cos(TAU * (0.09 * ((k * 7) % 5) as f32 - 0.17));
        let color = mix(a, b, 0.25 * k as f32);
        let center = [radius * cos / aspect, 0.5 + 0.62 * radius.min(0.7) * sin];
        canvas.disc(center, 0.035 + 0.018 * ((k * 3) % 4) as f32, color);
    }
}
