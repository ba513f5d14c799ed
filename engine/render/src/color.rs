//! Linear light and sRGB by table: the same bits everywhere, a few nanoseconds a pixel.

use dwell_scene::units::{linear_from_srgb, srgb_from_linear};
use std::sync::LazyLock;

/// Entries of the encoding table; neighbours are less than half an sRGB step apart.
const STEPS: usize = 8192;
/// From here on `f32` holds integers only, and their last bits are those of the number.
const INTEGERS: f32 = 8_388_608.0;

/// Both directions.
pub(crate) struct SrgbTables {
    decode: [f32; 256],
    encode: [u8; STEPS],
}

static TABLES: LazyLock<SrgbTables> = LazyLock::new(|| SrgbTables {
    decode: std::array::from_fn(|byte| linear_from_srgb(byte as f32 / 255.0)),
    encode: std::array::from_fn(|k| {
        (srgb_from_linear(k as f32 / (STEPS - 1) as f32) * 255.0 + 0.5) as u8
    }),
});

impl SrgbTables {
    /// The tables.
    pub(crate) fn tables() -> &'static Self {
        &TABLES
    }

    /// Their entries: linear light by byte, and bytes by even steps of linear light.
    pub(crate) fn entries(&self) -> (&[f32], &[u8]) {
        (&self.decode, &self.encode)
    }

    /// Linear light of a byte, 0 to 1.
    #[inline]
    pub(crate) fn decode(&self, byte: u8) -> f32 {
        self.decode[byte as usize]
    }

    /// Linear light of a colour.
    pub(crate) fn decode3(&self, srgb: [u8; 3]) -> glam::Vec3 {
        glam::Vec3::from_array(srgb.map(|byte| self.decode(byte)))
    }

    /// The byte of linear light; what is not in 0 to 1 is clamped, NaN is black.
    #[inline]
    pub(crate) fn encode(&self, linear: f32) -> u8 {
        // Not `clamp`, which keeps NaN, and no cast, which would check its range again: the sum's last bits are the
        // rounded step.
        let positive = if linear > 0.0 { linear } else { 0.0 };
        let within = if positive < 1.0 { positive } else { 1.0 };
        let step = (within * (STEPS - 1) as f32 + INTEGERS).to_bits() as usize;
        self.encode[step % STEPS]
    }

    /// As [`Self::encode`], of red, green and blue at once.
    #[inline]
    pub(crate) fn encode_vec(&self, linear: glam::Vec4) -> [u8; 3] {
        use glam::Vec4;
        // `max` of what is not a number is its argument, as above.
        let within = linear.max(Vec4::ZERO).min(Vec4::ONE);
        let [r, g, b, _] = (within * (STEPS - 1) as f32 + Vec4::splat(INTEGERS)).to_array();
        [r, g, b].map(|sum| self.encode[sum.to_bits() as usize % STEPS])
    }

    /// The bytes of a colour in linear light.
    #[inline]
    pub(crate) fn encode3(&self, linear: [f32; 3]) -> [u8; 3] {
        linear.map(|channel| self.encode(channel))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_survives_linear_light() {
        let tables = SrgbTables::tables();
        for byte in 0..=255_u8 {
            assert_eq!(tables.encode(tables.decode(byte)), byte);
        }
    }

    #[test]
    fn the_table_stays_within_a_step_of_the_formula() {
        let tables = SrgbTables::tables();
        for k in 0..=1_000_000 {
            let linear = k as f32 / 1_000_000.0;
            let exact = srgb_from_linear(linear) * 255.0;
            assert!(
                (f32::from(tables.encode(linear)) - exact).abs() < 0.95,
                "{linear}"
            );
        }
        assert_eq!(
            [
                tables.encode(-1.0),
                tables.encode(2.0),
                tables.encode(f32::NAN)
            ],
            [0, 255, 0]
        );
    }
}
