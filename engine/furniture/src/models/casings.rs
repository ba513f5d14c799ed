//! Colours of the casings of appliances and devices.

use crate::finishes::Finish;
use crate::sampling::SizeSampler;
use crate::style::Style;

/// The casing of an appliance: the style's, or white, or steel.
pub(super) fn casing_finish(style: &Style, d: &SizeSampler, name: &'static str) -> Finish {
    let white = Finish {
        name,
        srgb: [238, 239, 240],
        ..style.appliance.clone()
    };
    let metal = Finish {
        name,
        srgb: [172, 174, 178],
        ..style.appliance.clone()
    };
    match d.below("casing", 4) {
        0 => white,
        1 => metal,
        _ => Finish {
            name,
            ..style.appliance.clone()
        },
    }
}

/// Common colours of small machines' plastic.
pub(super) const CASING_COLORS: [[u8; 3]; 6] = [
    [236, 234, 228],
    [52, 54, 58],
    [176, 44, 46],
    [120, 170, 176],
    [226, 190, 90],
    [186, 190, 196],
];
