//! The memory of a house's images in a renderer, checked against the machine before it is taken.

use crate::error::WorldError;
use crate::free_memory::{free_bytes, mib};
use dwell_render::texture_bytes;
use dwell_scene::House;

/// Pixels of a house's images from which on the system is asked whether a renderer's memory holds them.
const PIXELS_ASKED_ABOUT: u64 = 8 << 20;

/// Refuses the images of a house that the free memory cannot hold in a renderer. Nothing is refused where the system does not
/// say how much is free.
///
/// # Errors
/// [`WorldError::Config`] with what they take and what is free.
pub(crate) fn check(house: &House) -> Result<(), WorldError> {
    let textures = house.textures.iter();
    let pixels: u64 = textures
        .map(|texture| u64::from(texture.width) * u64::from(texture.height))
        .sum();
    if pixels < PIXELS_ASKED_ABOUT {
        return Ok(());
    }
    let need = texture_bytes(house);
    free_bytes().map_or(Ok(()), |free| check_against(pixels, need, free))
}

fn check_against(pixels: u64, need: u64, free: u64) -> Result<(), WorldError> {
    if need <= free {
        return Ok(());
    }
    Err(WorldError::Config {
        field: "the house",
        found: format!("one whose images have {pixels} pixels"),
        allowed: format!(
            "what the memory of this machine holds: a renderer takes {} for them, and {} are free; take smaller images",
            mib(need),
            mib(free)
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_that_cannot_be_held_are_refused_with_what_they_take() {
        let refused =
            |free| check_against(1 << 26, 1 << 30, free).map_err(|error| error.to_string());
        assert_eq!(refused(1 << 30), Ok(()));
        assert_eq!(
            refused(50 << 20).unwrap_err(),
            "the house is one whose images have 67108864 pixels; allowed is what the memory of this machine holds: a renderer \
             takes 1024.0 MiB for them, and 50.0 MiB are free; take smaller images"
        );
    }
}
