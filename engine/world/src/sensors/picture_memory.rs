//! The memory of pictures, checked against the machine before it is taken.

use super::{Dtype, SensorSpec};
use crate::error::WorldError;
use crate::free_memory::{free_bytes, mib};
use dwell_render::{Camera, ImageChannels};

/// Size of a picture from which on the system is asked whether it fits, bytes.
const PICTURE_BYTES_ASKED_ABOUT: u64 = 64 << 20;

/// The memory of the images of a picture, bytes.
pub(crate) fn image_bytes(camera: &Camera, channels: ImageChannels) -> u64 {
    let ImageChannels {
        rgb,
        depth,
        instance,
        semantic,
        normals,
        albedo,
        flow,
    } = channels;
    let images = [
        (rgb, 3),
        (depth, 4),
        (instance, 4),
        (semantic, 4),
        (normals, 12),
        (albedo, 12),
        (flow, 8),
    ];
    let pixel: u64 = images.iter().map(|(on, size)| u64::from(*on) * size).sum();
    camera.pixels() as u64 * pixel
}

/// The memory of an observation, bytes.
pub(crate) fn observation_bytes(spec: &SensorSpec) -> u64 {
    let bytes = match spec.dtype {
        Dtype::Uint8 => 1,
        Dtype::Float32 | Dtype::Int32 | Dtype::Text => 4,
    };
    spec.len() as u64 * bytes
}

/// Refuses a picture with its observations that the free memory cannot hold. Nothing is refused where the system does not say
/// how much is free.
///
/// # Errors
/// [`WorldError::Config`] with what it takes and what is free.
pub(super) fn check_image_memory(
    camera: &Camera,
    channels: ImageChannels,
    specs: &[SensorSpec],
) -> Result<(), WorldError> {
    let observations = specs.iter().map(observation_bytes);
    let need = image_bytes(camera, channels) + observations.sum::<u64>();
    // Small ones are made without asking the system.
    if need < PICTURE_BYTES_ASKED_ABOUT {
        return Ok(());
    }
    free_bytes().map_or(Ok(()), |free| check_picture_against(camera, need, free))
}

fn check_picture_against(camera: &Camera, need: u64, free: u64) -> Result<(), WorldError> {
    if need <= free {
        return Ok(());
    }
    Err(WorldError::Config {
        field: "camera",
        found: format!("{} by {} pixels", camera.width(), camera.height()),
        allowed: format!(
            "what the memory of this machine holds: they take {}, and {} are free; take a smaller image or fewer channels",
            mib(need),
            mib(free)
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_that_cannot_be_held_is_refused_with_what_it_takes() {
        let camera = Camera::from_fov(8000, 4000, 90.0).unwrap();
        let channels = ImageChannels {
            rgb: true,
            ..ImageChannels::NONE
        };
        let need = image_bytes(&camera, channels);
        assert_eq!(need, 3 * 8000 * 4000);
        let refused = |free| check_picture_against(&camera, need, free).map_err(|e| e.to_string());
        assert_eq!(refused(need), Ok(()));
        assert_eq!(
            refused(50 << 20).unwrap_err(),
            "camera is 8000 by 4000 pixels; allowed is what the memory of this machine holds: they take 91.6 MiB, and 50.0 MiB \
             are free; take a smaller image or fewer channels"
        );
    }
}
