//! Maps and doll's houses of a world, checked against the free memory before their pictures are made.

use crate::error::WorldError;
use crate::free_memory::{free_bytes, mib};
use crate::world::World;
use dwell_render::{Camera, Dollhouse, DollhouseConfig, StoreyMap};
use dwell_scene::LevelId;
use dwell_scene::parallel::Threads;

/// Size of the pictures from which on the system is asked whether they fit, bytes.
const BYTES_ASKED_ABOUT: u64 = 64 << 20;
/// Memory of a strip of rows in the making, bytes.
const STRIP_BYTES: u64 = 32 << 20;
/// Bytes of a pixel.
const PIXEL_BYTES: u64 = 3;

/// A storey from above, and its map. Shape (height, width, 3) of the map's camera.
///
/// # Errors
/// [`WorldError::Render`] for a storey that the house does not have or an edge that is not 1 to 16,384 pixels long;
/// [`WorldError::Config`] for a picture that the free memory cannot hold.
pub fn map_picture(
    world: &World,
    level: LevelId,
    longest_edge: u32,
    threads: Threads,
) -> Result<(Vec<u8>, StoreyMap), WorldError> {
    let map = StoreyMap::new(world.house(), level, longest_edge)?;
    // Its walls are drawn on a picture of their own.
    let bytes = 2 * picture_bytes(&map.view.camera);
    check(("longest_edge", longest_edge), bytes)?;
    let renderer = world.engines().cpu_renderer()?;
    let rgb = map.render(renderer, world.rays(), world.state(), threads)?;
    Ok((rgb, map))
}

/// A storey from outside, cut open, and its camera and pose. Shape (height, width, 3) of the camera.
///
/// # Errors
/// Those of [`map_picture`], and [`WorldError::Render`] for a number out of range.
pub fn dollhouse_picture(
    world: &World,
    level: LevelId,
    config: &DollhouseConfig,
    threads: Threads,
) -> Result<(Vec<u8>, Dollhouse), WorldError> {
    let doll = Dollhouse::new(world.house(), level, config)?;
    let bytes = picture_bytes(&doll.view.camera) + picture_bytes(doll.plan_camera());
    check(("width", config.width), bytes)?;
    let renderer = world.engines().cpu_renderer()?;
    let rgb = doll.render(renderer, world.rays(), world.state(), threads)?;
    Ok((rgb, doll))
}

fn picture_bytes(camera: &Camera) -> u64 {
    camera.pixels() as u64 * PIXEL_BYTES
}

/// Refuses pictures that the free memory cannot hold. Nothing is refused where the system does not say how much is free.
fn check(pixels: (&'static str, u32), bytes: u64) -> Result<(), WorldError> {
    if bytes < BYTES_ASKED_ABOUT {
        return Ok(());
    }
    let need = bytes + STRIP_BYTES;
    free_bytes().map_or(Ok(()), |free| check_against(pixels, need, free))
}

fn check_against(
    (field, pixels): (&'static str, u32),
    need: u64,
    free: u64,
) -> Result<(), WorldError> {
    if need <= free {
        return Ok(());
    }
    Err(WorldError::Config {
        field,
        found: pixels.to_string(),
        allowed: format!(
            "what the memory of this machine holds: such a picture takes {} in the making, and {} are free; take fewer pixels",
            mib(need),
            mib(free)
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_that_cannot_be_held_is_refused_with_what_it_takes() {
        let refused = |free| {
            check_against(("longest_edge", 16_384), 900 << 20, free).map_err(|e| e.to_string())
        };
        assert_eq!(refused(900 << 20), Ok(()));
        assert_eq!(
            refused(500 << 20).unwrap_err(),
            "longest_edge is 16384; allowed is what the memory of this machine holds: such a picture takes 900.0 MiB in the \
             making, and 500.0 MiB are free; take fewer pixels"
        );
    }
}
