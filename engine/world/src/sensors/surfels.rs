//! Surface elements.

use super::camera::CameraConfig;
use super::image::{self, DisplayStyle, ImageContext, ImageSensorKind, ObservationShape};
use super::{Dtype, ObservationBuffer, Sensor, SensorKind, SensorSetup};
use crate::error::WorldError;
use crate::schema;
use dwell_render::ImageChannels;
use glam::Vec2;

const ABOUT: &str = "Surface elements in the camera's frame: position in m (to the right, up, back), unit normal, \
                     reflectance 0 to 1 of red, green and blue; zeros where nothing is seen; shape (height, width, 9).";

pub(super) const KIND: SensorKind = SensorKind {
    name: IMAGE.name,
    about: ABOUT,
    build,
    settings: schema::fields_of::<CameraConfig>,
    image: Some(|_| &IMAGE),
    goal_part: None,
};

static IMAGE: ImageSensorKind = ImageSensorKind {
    name: "surfels",
    about: ABOUT,
    shape: ObservationShape::Image(9),
    style: DisplayStyle::Light,
    dtype: Dtype::Float32,
    unit: "m, 1, 1",
    low: -1e6,
    high: 1e6,
    channels: ImageChannels {
        depth: true,
        instance: true,
        normals: true,
        albedo: true,
        ..ImageChannels::NONE
    },
    write,
};

fn build(value: &serde_json::Value, site: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    image::build(|_| &IMAGE, value, site)
}

fn write(look: ImageContext<'_>, out: ObservationBuffer<'_>) {
    let ObservationBuffer::Float32(out) = out else {
        return;
    };
    let (frame, camera) = (look.frame, look.camera);
    let width = camera.width() as usize;
    for (pixel, out) in out.chunks_exact_mut(9).enumerate() {
        if frame.instance[pixel] == 0 {
            out.fill(0.0);
            continue;
        }
        let image = Vec2::new((pixel % width) as f32 + 0.5, (pixel / width) as f32 + 0.5);
        let (start, direction) = camera.ray_in_camera(image);
        let position = start + direction * frame.depth[pixel];
        out[..3].copy_from_slice(&position.to_array());
        out[3..6].copy_from_slice(&frame.normals[3 * pixel..3 * pixel + 3]);
        out[6..].copy_from_slice(&frame.albedo[3 * pixel..3 * pixel + 3]);
    }
}
