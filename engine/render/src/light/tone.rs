//! Tone mapping: from light to display.

use super::indirect::luminance;
use dwell_scene::math;
use glam::Vec3;

/// Illuminance at which exposure is neither raised nor lowered, lx.
const MIDDLE_LX: f32 = 150.0;
/// Degree of adaptation of the eyes: 1 would make every room equally bright.
const ADAPTATION: f32 = 0.85;
/// Pixel value of white under the mean illuminance of the room, before tone mapping.
const GAIN: f32 = 1.2;
/// The value that tone mapping maps to display white.
const WHITE: f32 = 8.0;

/// Units of display white per lx of a room with this mean illuminance.
pub(crate) fn exposure_per_lx(mean_lx: f32) -> f32 {
    GAIN / (MIDDLE_LX * math::pow(mean_lx.max(1.0) / MIDDLE_LX, ADAPTATION))
}

/// Compresses bright light: 0 to 0, [`WHITE`] and more to 1, never falling.
///
/// # Source
/// E. Reinhard et al., "Photographic Tone Reproduction for Digital Images" (2002), equation 4, for each channel.
#[inline]
fn compress(light: f32) -> f32 {
    (light * (1.0 + light * (1.0 / (WHITE * WHITE))) / (1.0 + light)).min(1.0)
}

/// Light as a display shows it, each channel 0 to 1.
///
/// Halfway between compressing each channel, which bleaches bright colours, and the luminance alone, which lets them
/// glow.
#[inline]
pub(crate) fn tone_map(light: Vec3) -> Vec3 {
    let each = Vec3::new(compress(light.x), compress(light.y), compress(light.z));
    let bright = luminance(light);
    let whole = light * (compress(bright) / bright.max(1e-6));
    ((each + whole) * 0.5).min(Vec3::ONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brighter_light_is_never_darker_on_display() {
        assert!(compress(0.0).abs() < 1e-9);
        assert!((compress(WHITE) - 1.0).abs() < 1e-6);
        let mut last = 0.0;
        for k in 1..1000 {
            let now = compress(k as f32 * 0.01);
            assert!(now >= last);
            last = now;
            // Grey stays grey.
            let grey = tone_map(Vec3::splat(k as f32 * 0.01));
            assert!((grey - now).abs().max_element() < 1e-5);
        }
    }

    #[test]
    fn a_brighter_room_looks_brighter_but_less_than_it_is() {
        let (dim, bright) = (
            20.0 * exposure_per_lx(20.0),
            2000.0 * exposure_per_lx(2000.0),
        );
        assert!(bright > dim && bright < 5.0 * dim);
    }
}
