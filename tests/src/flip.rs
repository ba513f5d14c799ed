//! Perceived difference of two pictures to a person who flips between them.
//!
//! # Source
//! P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström and M. D. Fairchild, "FLIP: A Difference Evaluator for
//! Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020 (LDR-FLIP; sections 4.1 to 4.4). Written after
//! the paper; the tests compare with what its authors' program answers.

use std::f64::consts::PI;

/// A display of 3,840 pixels and 0.7 m, looked at from 0.7 m: pixels a degree.
pub const PIXELS_PER_DEG: f64 = 3840.0 * PI / 180.0;

/// D65, XYZ.
const WHITE: [f64; 3] = [0.950_428_545, 1.0, 1.088_900_371];
/// Linear sRGB to XYZ (D65).
const XYZ_FROM_RGB: [[f64; 3]; 3] = [
    [
        10_135_552.0 / 24_577_794.0,
        8_788_810.0 / 24_577_794.0,
        4_435_075.0 / 24_577_794.0,
    ],
    [
        2_613_072.0 / 12_288_897.0,
        8_788_810.0 / 12_288_897.0,
        887_015.0 / 12_288_897.0,
    ],
    [
        1_425_312.0 / 73_733_382.0,
        8_788_810.0 / 73_733_382.0,
        70_074_185.0 / 73_733_382.0,
    ],
];
/// Contrast sensitivity of lightness, red-green and blue-yellow: two bells each, (height, width) of table 1.
const SENSITIVITY: [[(f64, f64); 2]; 3] = [
    [(1.0, 0.0047), (0.0, 1e-5)],
    [(1.0, 0.0053), (0.0, 1e-5)],
    [(34.1, 0.04), (13.5, 0.025)],
];
/// Exponent of colour differences, and the share of the largest one that is mapped to [`KNEE`].
const COLOR_EXPONENT: f64 = 0.7;
const KNEE_AT: f64 = 0.4;
const KNEE: f64 = 0.95;
/// Exponent of differences of features, and the width of what finds them, degrees.
const FEATURE_EXPONENT: f64 = 0.5;
const FEATURE_WIDTH_DEG: f64 = 0.082;

type Color = [f64; 3];

/// The difference of every pixel, 0 (none) to 1; shape (height, width).
///
/// `reference`, `test`: sRGB, shape (height, `width`, 3), of one size; a shorter one cuts the other.
pub fn flip(reference: &[u8], test: &[u8], width: usize) -> Vec<f64> {
    let [seen, other] = [reference, test].map(|rgb| Picture::new(rgb, width));
    let [colors, other_colors] = [&seen, &other].map(Picture::perceived);
    let [features, other_features] = [&seen, &other].map(Picture::features);
    let largest = hyab(hunt(lab([0.0, 1.0, 0.0])), hunt(lab([0.0, 0.0, 1.0]))).powf(COLOR_EXPONENT);
    let color_difference = |k: usize| {
        let difference = hyab(colors[k], other_colors[k]).powf(COLOR_EXPONENT);
        let knee = KNEE_AT * largest;
        if difference < knee {
            KNEE / knee * difference
        } else {
            KNEE + (difference - knee) / (largest - knee) * (1.0 - KNEE)
        }
    };
    let feature_difference = |k: usize| {
        let [edge, point] = [0, 1].map(|kind| (features[k][kind] - other_features[k][kind]).abs());
        (edge.max(point) / 2.0_f64.sqrt()).powf(FEATURE_EXPONENT)
    };
    (0..colors.len().min(other_colors.len()))
        .map(|k| color_difference(k).powf(1.0 - feature_difference(k).min(1.0)))
        .collect()
}

/// A picture in the opponent space `YCxCz`.
struct Picture {
    width: usize,
    pixels: Vec<Color>,
}

impl Picture {
    fn new(rgb: &[u8], width: usize) -> Self {
        let linear: Vec<f64> = (0..=255_u8)
            .map(|byte| decode(f64::from(byte) / 255.0))
            .collect();
        let pixels = rgb.chunks_exact(3);
        let pixels = pixels.map(|rgb| {
            let [x, y, z] = xyz([0, 1, 2].map(|k| linear[usize::from(rgb[k])]));
            [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
        });
        Self {
            width: width.max(1),
            pixels: pixels.collect(),
        }
    }

    /// The sum of `weigh` over a window around each pixel; beyond the border the picture goes on as at it.
    fn convolved<T: Default>(&self, radius: usize, weigh: impl Fn(&mut T, Color, usize)) -> Vec<T> {
        let (width, height) = (self.width, self.pixels.len() / self.width);
        let edge = 2 * radius + 1;
        let at =
            |k: usize, shift: usize, size: usize| (k + shift).saturating_sub(radius).min(size - 1);
        let pixel = |k: usize| {
            let mut sum = T::default();
            for cell in 0..edge * edge {
                let x = at(k % width, cell % edge, width);
                let y = at(k / width, cell / edge, height);
                weigh(&mut sum, self.pixels[y * width + x], cell);
            }
            sum
        };
        (0..width * height).map(pixel).collect()
    }

    /// Colours as they are seen from the distance, in Hunt-adjusted `L*a*b*` (section 4.1).
    fn perceived(&self) -> Vec<Color> {
        let widest = SENSITIVITY.iter().flatten().map(|(_, width)| *width);
        let deviation = (widest.fold(0.0, f64::max) / (2.0 * PI * PI)).sqrt();
        let radius = (3.0 * deviation * PIXELS_PER_DEG).ceil() as usize;
        let kernels = SENSITIVITY.map(|bells| {
            let bell = |x: f64, y: f64| {
                let squared = (x * x + y * y) / (PIXELS_PER_DEG * PIXELS_PER_DEG);
                let part = |(height, width): (f64, f64)| {
                    height * (PI / width).sqrt() * (-PI * PI * squared / width).exp()
                };
                part(bells[0]) + part(bells[1])
            };
            normalized(&kernel(radius, bell))
        });
        let filtered = self.convolved(radius, |sum: &mut Color, color, cell| {
            for k in 0..3 {
                sum[k] += kernels[k][cell] * color[k];
            }
        });
        let adjusted = filtered.into_iter().map(|[lightness, cx, cz]| {
            let y = (lightness + 16.0) / 116.0;
            let rgb = rgb([cx / 500.0 + y, y, y - cz / 200.0]);
            hunt(lab(rgb.map(|part| part.clamp(0.0, 1.0))))
        });
        adjusted.collect()
    }

    /// Returns how strong edges and points are at each pixel, in lightness (section 4.2).
    fn features(&self) -> Vec<[f64; 2]> {
        let deviation = 0.5 * FEATURE_WIDTH_DEG * PIXELS_PER_DEG;
        let radius = (3.0 * deviation).ceil() as usize;
        let squared = deviation * deviation;
        let bell = |x: f64, y: f64| (-(x * x + y * y) / (2.0 * squared)).exp();
        let kernels = [
            kernel(radius, |x, y| -x * bell(x, y)),
            kernel(radius, |x, y| -y * bell(x, y)),
            kernel(radius, |x, y| (x * x / squared - 1.0) * bell(x, y)),
            kernel(radius, |x, y| (y * y / squared - 1.0) * bell(x, y)),
        ]
        .map(|kernel| normalized(&kernel));
        let found = self.convolved(radius, |sum: &mut [f64; 4], color, cell| {
            for (sum, kernel) in sum.iter_mut().zip(&kernels) {
                *sum += kernel[cell] * (color[0] + 16.0) / 116.0;
            }
        });
        let strengths = found.into_iter();
        strengths
            .map(|[ex, ey, px, py]| [ex.hypot(ey), px.hypot(py)])
            .collect()
    }
}

fn kernel(radius: usize, value: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let edge = 2 * radius + 1;
    let from_middle = |k: usize| k as f64 - radius as f64;
    let cells = 0..edge * edge;
    cells
        .map(|cell| value(from_middle(cell % edge), from_middle(cell / edge)))
        .collect()
}

/// With the positive weights summing to 1, and the negative ones to -1.
fn normalized(kernel: &[f64]) -> Vec<f64> {
    let above: f64 = kernel.iter().filter(|weight| **weight > 0.0).sum();
    let below: f64 = -kernel.iter().filter(|weight| **weight < 0.0).sum::<f64>();
    let scaled = kernel.iter().map(|weight| {
        weight
            / if *weight > 0.0 {
                above
            } else {
                below.max(1e-300)
            }
    });
    scaled.collect()
}

/// IEC 61966-2-1.
fn decode(encoded: f64) -> f64 {
    if encoded <= 0.040_45 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    }
}

/// XYZ against white.
fn xyz(rgb: Color) -> Color {
    [0, 1, 2].map(|k| (0..3).map(|j| XYZ_FROM_RGB[k][j] * rgb[j]).sum::<f64>() / WHITE[k])
}

/// The inverse of [`xyz`], by Cramer's rule.
fn rgb(xyz: Color) -> Color {
    let m = XYZ_FROM_RGB;
    let goal = [0, 1, 2].map(|k| xyz[k] * WHITE[k]);
    let determinant = |m: [[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let whole = determinant(m);
    [0, 1, 2].map(|column| {
        let mut replaced = m;
        for row in 0..3 {
            replaced[row][column] = goal[row];
        }
        determinant(replaced) / whole
    })
}

/// CIE 1976 `L*a*b*` of linear sRGB.
fn lab(rgb: Color) -> Color {
    let bend = |part: f64| {
        let delta: f64 = 6.0 / 29.0;
        if part > delta.powi(3) {
            part.cbrt()
        } else {
            part / (3.0 * delta * delta) + 4.0 / 29.0
        }
    };
    let [x, y, z] = xyz(rgb).map(bend);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Colours fade in the dark (equation 7).
fn hunt([lightness, a, b]: Color) -> Color {
    [lightness, 0.01 * lightness * a, 0.01 * lightness * b]
}

/// Abasi, Tehran and Fairchild's distance for large differences (equation 8).
fn hyab(a: Color, b: Color) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: (usize, usize) = (64, 48);

    fn picture(color: impl Fn(usize, usize) -> [u8; 3]) -> Vec<u8> {
        let pixels = (0..SIZE.0 * SIZE.1).map(|k| color(k % SIZE.0, k / SIZE.0));
        pixels.flatten().collect()
    }

    fn pattern(x: usize, y: usize) -> [u8; 3] {
        [4 * x, 5 * y, 3 * (x ^ y)].map(|value| (value % 256) as u8)
    }

    /// Means and two pixels, (32, 24) and (0, 0), as the authors' program gives them (`flip-evaluator` 1.7, LDR, 67.02 pixels a
    /// degree), which computes in 32 bits.
    #[test]
    fn differences_are_those_of_the_authors_program() {
        let base = picture(pattern);
        let changed = |change: fn([u8; 3]) -> [u8; 3]| picture(|x, y| change(pattern(x, y)));
        let plain = |color: [u8; 3]| picture(|_, _| color);
        let square = picture(|x, y| {
            let inside = (30..38).contains(&x) && (20..28).contains(&y);
            if inside { [255, 0, 0] } else { pattern(x, y) }
        });
        let cases = [
            ("same", base.clone(), base.clone(), [0.0, 0.0, 0.0]),
            (
                "brighter",
                base.clone(),
                changed(|color| color.map(|part| part.saturating_add(3))),
                [0.090_784, 0.076_677, 0.053_154],
            ),
            (
                "shifted",
                base.clone(),
                picture(|x, y| pattern((x + 1).min(SIZE.0 - 1), y)),
                [0.088_012, 0.211_690, 0.024_243],
            ),
            (
                "grey",
                plain([100; 3]),
                plain([120; 3]),
                [0.247_940, 0.247_941, 0.247_941],
            ),
            (
                "black and white",
                plain([0; 3]),
                plain([255; 3]),
                [0.967_365, 0.967_388, 0.967_388],
            ),
            (
                "green and blue",
                plain([0, 255, 0]),
                plain([0, 0, 255]),
                [1.0; 3],
            ),
            (
                "swapped",
                base.clone(),
                changed(|[r, g, b]| [b, g, r]),
                [0.508_501, 0.151_372, 0.003_358],
            ),
            ("square", base, square, [0.030_800, 0.859_198, 0.0]),
        ];
        for (name, reference, test, expected) in cases {
            let found = flip(&reference, &test, SIZE.0);
            let mean = found.iter().sum::<f64>() / found.len() as f64;
            let found = [mean, found[24 * SIZE.0 + 32], found[0]];
            for (found, expected) in found.into_iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 5e-4,
                    "{name}: {found} {expected}"
                );
            }
        }
    }
}
