//! Colour image.

use super::image::{self, Kind, Look, Shape};
use super::{Dtype, Out, Sensor, SensorKind, Site};
use crate::error::WorldError;
use dwell_render::ImageChannels;

const ABOUT: &str = "Colour image: shape (height, width, 3), sRGB bytes.";

pub(super) const KIND: SensorKind = SensorKind {
    name: IMAGE.name,
    about: ABOUT,
    build,
    image: Some(&IMAGE),
};

static IMAGE: Kind = Kind {
    name: "rgb",
    about: ABOUT,
    shape: Shape::Image(3),
    dtype: Dtype::Uint8,
    unit: "sRGB",
    low: 0.0,
    high: 255.0,
    channels: ImageChannels {
        rgb: true,
        ..ImageChannels::NONE
    },
    write,
};

fn build(value: &serde_json::Value, site: Site<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    image::build(&IMAGE, value, site)
}

fn write(look: Look<'_>, out: Out<'_>) {
    if let Out::Uint8(out) = out {
        out.copy_from_slice(&look.frame.rgb);
        look.optics().color(look.camera, look.key, out);
    }
}
