//! Test bodies: the calls that are made with every input.

use std::sync::Arc;

use dwell::{CameraMount, DiscreteAction, Engines, ImageRequest, StepSizes, World, WorldConfig};
use dwell_houses::{HousesError, LoadReport};
use dwell_render::{Camera, ImageChannels, Preset};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, House, Pose};

use super::samples::Sample;

/// Reads the sample with one of its files changed. The error's sentence, or the report's, is made too.
///
/// # Errors
/// Those of [`dwell_houses::open`].
///
/// # Panics
/// When the sentence is missing.
pub fn read(
    sample: &Sample,
    file: usize,
    bytes: &[u8],
) -> Result<(House, LoadReport), HousesError> {
    let opened = sample.open_with(file, bytes);
    match &opened {
        Ok((_, report)) => assert_eq!(report.to_string().is_empty(), report.is_empty()),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
    opened
}

/// Makes a world of a house, walks a step in it and takes a picture of 24 by 16 pixels. What a house does not allow ends in an
/// error, as an agent without a floor to stand on.
pub fn exercise_house(house: House) {
    let engines = Engines::new(Arc::new(house));
    let Ok(mut world) = World::new(engines, &WorldConfig::default()) else {
        return;
    };
    if world.reset(RandomKey::root(1)).is_err() {
        return;
    }
    let step = DiscreteAction::ALL[1];
    let _ = world.act_discrete(AgentId(0), step, &StepSizes::default());
    let Ok(camera) = Camera::from_fov(24, 16, 90.0) else {
        return;
    };
    let request = ImageRequest {
        camera,
        mount: CameraMount::Agent(AgentId(0), Pose::IDENTITY),
        preset: Preset::Lit,
    };
    let channels = ImageChannels {
        rgb: true,
        depth: true,
        ..ImageChannels::default()
    };
    let _ = world.render_image(&request, channels, Threads::ONE);
}
