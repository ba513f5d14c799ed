//! Units and the few constants that more than one engine uses. SI and radians inside.

/// Standard gravity, m/s² (CGPM 1901).
pub const STANDARD_GRAVITY_M_S2: f32 = 9.806_65;
/// Reference sound pressure, Pa (ISO 1683): 0 dB SPL.
pub const REFERENCE_PRESSURE_PA: f32 = 20e-6;

/// Returns the root-mean-square pressure in pascals of a level in dB SPL.
pub fn pa_from_db_spl(level_db: f32) -> f32 {
    REFERENCE_PRESSURE_PA * crate::math::pow(10.0, level_db / 20.0)
}

/// Returns the level in dB SPL of a root-mean-square pressure in pascals; minus infinity for silence.
pub fn db_spl_from_pa(pressure_pa: f32) -> f32 {
    20.0 * libm::log10f(pressure_pa.abs() / REFERENCE_PRESSURE_PA)
}

/// Returns the linear light of an sRGB-encoded value, both in [0, 1].
///
/// # Source
/// IEC 61966-2-1:1999.
pub fn linear_from_srgb(encoded: f32) -> f32 {
    if encoded <= 0.04045 {
        encoded / 12.92
    } else {
        crate::math::pow((encoded + 0.055) / 1.055, 2.4)
    }
}

/// Returns the sRGB-encoded value of linear light, both in [0, 1].
///
/// # Source
/// IEC 61966-2-1:1999.
pub fn srgb_from_linear(linear: f32) -> f32 {
    if linear <= 0.003_130_8 {
        linear * 12.92
    } else {
        1.055 * crate::math::pow(linear, 1.0 / 2.4) - 0.055
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_pascal_is_94_db() {
        assert!((db_spl_from_pa(1.0) - 93.979_4).abs() < 1e-3);
        assert!((pa_from_db_spl(94.0) - 1.002_374_5).abs() < 1e-5);
    }

    #[test]
    fn srgb_round_trips_every_byte() {
        for byte in 0..=255_u8 {
            let back = srgb_from_linear(linear_from_srgb(f32::from(byte) / 255.0)) * 255.0;
            assert_eq!(back.round() as u8, byte);
        }
    }
}
