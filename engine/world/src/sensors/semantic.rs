//! Semantic classes.

use super::camera::CameraConfig;
use super::image::{self, DisplayStyle, ImageContext, ImageSensorKind, ObservationShape};
use super::{Dtype, ObservationBuffer, Sensor, SensorKind, SensorSetup};
use crate::error::WorldError;
use crate::schema;
use dwell_render::{ClassSet, ImageChannels};

const NAME: &str = "semantic";
const COARSE_ABOUT: &str = "Coarse semantic classes: 0 void, then the rows of the category table, then the house's own \
                            (House.semantic_classes); shape (height, width, 1).";

pub(super) const KIND: SensorKind = SensorKind {
    name: NAME,
    about: COARSE_ABOUT,
    build,
    settings: schema::fields_of::<CameraConfig>,
    image: Some(of_classes),
    goal_part: None,
};

static COARSE: ImageSensorKind = ImageSensorKind {
    name: NAME,
    about: COARSE_ABOUT,
    shape: ObservationShape::Image(1),
    style: DisplayStyle::Ids,
    dtype: Dtype::Int32,
    unit: "class",
    low: 0.0,
    high: i32::MAX as f64,
    channels: ImageChannels {
        semantic: true,
        ..ImageChannels::NONE
    },
    write: write_coarse,
};

static FINE: ImageSensorKind = ImageSensorKind {
    about: "Semantic classes by the finest name of each thing: 0 void, then the rows of the category table, then the \
            house's own (House.semantic_classes); shape (height, width, 1).",
    channels: ImageChannels {
        instance: true,
        ..ImageChannels::NONE
    },
    write: |look, out| look.write_classes(ClassSet::Fine, out),
    ..COARSE
};

static NYU40: ImageSensorKind = ImageSensorKind {
    about: "NYU-40 classes: 0 void, 1 wall, 2 floor to 40 otherprop (House.semantic_classes); shape (height, width, 1).",
    write: |look, out| look.write_classes(ClassSet::Nyu40, out),
    ..FINE
};

/// The sensor whose classes are those of a table.
fn of_classes(classes: ClassSet) -> &'static ImageSensorKind {
    match classes {
        ClassSet::Coarse => &COARSE,
        ClassSet::Fine => &FINE,
        ClassSet::Nyu40 => &NYU40,
    }
}

fn build(value: &serde_json::Value, site: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    image::build(of_classes, value, site)
}

fn write_coarse(look: ImageContext<'_>, out: ObservationBuffer<'_>) {
    if let ObservationBuffer::Int32(out) = out {
        out.copy_from_slice(&look.frame.semantic);
    }
}

/// The setting that an earlier name of a sensor of classes stands for.
pub(super) fn setting_of_deprecated_name(name: &str) -> Option<&'static str> {
    match name {
        "semantic_fine" => Some("fine"),
        "semantic_nyu40" => Some("nyu40"),
        _ => None,
    }
}
