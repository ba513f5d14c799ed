//! Depth image.

use super::image::{self, Kind, Look, Shape};
use super::{Dtype, Out, Sensor, SensorKind, Site};
use crate::error::WorldError;
use dwell_render::ImageChannels;

const ABOUT: &str = "Depth image: metres along the camera's -Z (range for fisheyes and cameras that see all around), \
                     shape (height, width, 1); misses are clamped to `far_m`.";

pub(super) const KIND: SensorKind = SensorKind {
    name: IMAGE.name,
    about: ABOUT,
    build,
    image: Some(&IMAGE),
};

static IMAGE: Kind = Kind {
    name: "depth",
    about: ABOUT,
    shape: Shape::Image(1),
    dtype: Dtype::Float32,
    unit: "m",
    low: 0.0,
    high: 1e6,
    channels: ImageChannels {
        depth: true,
        ..ImageChannels::NONE
    },
    write,
};

fn build(value: &serde_json::Value, site: Site<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    image::build(&IMAGE, value, site)
}

fn write(look: Look<'_>, out: Out<'_>) {
    if let Out::Float32(out) = out {
        let (frame, camera) = (look.frame, look.camera);
        out.copy_from_slice(&frame.depth);
        look.optics().depth(camera, &frame.normals, look.key, out);
    }
}
