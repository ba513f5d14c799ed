//! Distance between colours.

use dwell_scene::units::linear_from_srgb;

/// A colour in `OKLab`: lightness 0 to 1, then green to red and blue to yellow, about -0.4 to 0.4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oklab {
    /// Lightness.
    pub l: f32,
    /// Green (negative) to red.
    pub a: f32,
    /// Blue (negative) to yellow.
    pub b: f32,
}

impl Oklab {
    /// From linear light of sRGB's primaries, each 0 to 1.
    ///
    /// # Source
    /// B. Ottosson, *A perceptual color space for image processing* (2020), matrices of 2021-01-25.
    #[expect(clippy::excessive_precision, reason = "the matrices are printed so")]
    pub fn from_linear([r, g, b]: [f32; 3]) -> Self {
        let root = |x: f32| libm::cbrtf(x.max(0.0));
        let l = root(0.412_221_470_8 * r + 0.536_332_536_3 * g + 0.051_445_992_9 * b);
        let m = root(0.211_903_498_2 * r + 0.680_699_545_1 * g + 0.107_396_956_6 * b);
        let s = root(0.088_302_461_9 * r + 0.281_718_837_6 * g + 0.629_978_700_5 * b);
        Self {
            l: 0.210_454_255_3 * l + 0.793_617_785_0 * m - 0.004_072_046_8 * s,
            a: 1.977_998_495_1 * l - 2.428_592_205_0 * m + 0.450_593_709_9 * s,
            b: 0.025_904_037_1 * l + 0.782_771_766_2 * m - 0.808_675_766_0 * s,
        }
    }

    /// From sRGB-encoded values, each 0 to 1.
    pub fn from_srgb(srgb: [f32; 3]) -> Self {
        Self::from_linear(srgb.map(linear_from_srgb))
    }

    /// Distance to `other`: Euclid's. 0.02 is about just noticeable, black to white is 1.
    pub fn distance(self, other: Self) -> f32 {
        let (l, a, b) = (self.l - other.l, self.a - other.a, self.b - other.b);
        (l * l + a * a + b * b).sqrt()
    }

    /// Returns the distance from grey, 0 to about 0.33.
    pub fn chroma(self) -> f32 {
        (self.a * self.a + self.b * self.b).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The values printed beside the definition: XYZ of the D65 white and of the unit vectors.
    #[test]
    fn the_published_test_pairs_are_met() {
        // sRGB's linear values of these XYZ points (IEC 61966-2-1, inverse matrix).
        let linear_from_xyz = |[x, y, z]: [f32; 3]| {
            [
                3.240_97 * x - 1.537_383 * y - 0.498_611 * z,
                -0.969_244 * x + 1.875_968 * y + 0.041_555 * z,
                0.055_63 * x - 0.203_977 * y + 1.056_972 * z,
            ]
        };
        let white = Oklab::from_linear(linear_from_xyz([0.950, 1.0, 1.089]));
        assert!(
            (white.l - 1.0).abs() < 2e-3 && white.chroma() < 2e-3,
            "{white:?}"
        );
        let red = Oklab::from_srgb([1.0, 0.0, 0.0]);
        assert!(
            red.distance(Oklab {
                l: 0.628,
                a: 0.2249,
                b: 0.1258
            }) < 1e-3,
            "{red:?}"
        );
        let blue = Oklab::from_srgb([0.0, 0.0, 1.0]);
        assert!(
            blue.distance(Oklab {
                l: 0.452,
                a: -0.0325,
                b: -0.3115
            }) < 1e-3,
            "{blue:?}"
        );
    }

    #[test]
    fn greys_have_no_chroma_and_rise_in_lightness() {
        let mut last = -1.0;
        for k in 0..=255_u8 {
            let grey = Oklab::from_srgb([f32::from(k) / 255.0; 3]);
            assert!(grey.chroma() < 1e-3 && grey.l > last);
            last = grey.l;
        }
    }
}
