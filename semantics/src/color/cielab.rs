//! CIELAB: the space in which names of colours were counted.

use glam::{Mat3, Vec3};

/// A colour in CIELAB under D65, as (L*, a*, b*): lightness 0 to 100, then green to red and blue to yellow, about -100 to 100.
///
/// `linear`: linear light of sRGB's primaries, each 0 to 1, as reflected by a surface under white light.
///
/// # Source
/// IEC 61966-2-1 (sRGB to XYZ); ISO/CIE 11664-4:2019, equations 1 to 5.
pub(super) fn cielab_from_linear(linear: [f32; 3]) -> Vec3 {
    const XYZ_FROM_LINEAR: Mat3 = Mat3::from_cols_array(&[
        0.412_456_4,
        0.212_672_9,
        0.019_333_9,
        0.357_576_1,
        0.715_152_2,
        0.119_192,
        0.180_437_5,
        0.072_175,
        0.950_304_1,
    ]);
    const WHITE: Vec3 = Vec3::new(0.950_47, 1.0, 1.088_83);
    let root = |t: f32| {
        if t > 216.0 / 24_389.0 {
            libm::cbrtf(t)
        } else {
            (24_389.0 / 27.0 * t + 16.0) / 116.0
        }
    };
    let light = Vec3::from(linear).clamp(Vec3::ZERO, Vec3::ONE);
    let [x, y, z] = (XYZ_FROM_LINEAR * light / WHITE).to_array().map(root);
    Vec3::new(116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::units::linear_from_srgb;

    /// Values of the same equations in double precision (NumPy): a check of arithmetic and constants, not of the equations.
    #[test]
    fn known_colours_have_their_coordinates() {
        let cases: [([u8; 3], [f32; 3]); 6] = [
            ([255, 255, 255], [100.0, 0.0, 0.0]),
            ([0, 0, 0], [0.0, 0.0, 0.0]),
            ([255, 0, 0], [53.24, 80.09, 67.20]),
            ([0, 0, 255], [32.30, 79.19, -107.86]),
            ([0, 128, 0], [46.23, -51.70, 49.90]),
            ([10, 10, 10], [2.74, 0.0, 0.0]),
        ];
        for (srgb, lab) in cases {
            let linear = srgb.map(|byte| linear_from_srgb(f32::from(byte) / 255.0));
            let found = cielab_from_linear(linear);
            assert!(found.distance(Vec3::from(lab)) < 0.05, "{srgb:?}: {found}");
        }
    }
}
