//! Image sensors: the parts common to all of them.

use super::camera::CameraConfig;
use super::picture_memory;
use super::{
    Dtype, ObservationBuffer, Sensor, SensorContext, SensorSetup, SensorSpec, parse_sensor_settings,
};
use crate::camera_capture::ImageRequest;
use crate::error::WorldError;
use crate::eye_camera::EyeCamera;
use crate::sensor_requests::SensorRequests;
use crate::world::World;
use dwell_render::{Camera, CameraLaws, ClassSet, Frame, ImageChannels, View};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use serde::Serialize;

/// The description of an image sensor.
#[derive(Debug)]
pub(crate) struct ImageSensorKind {
    pub(super) name: &'static str,
    pub(super) about: &'static str,
    pub(super) shape: ObservationShape,
    pub(super) style: DisplayStyle,
    pub(super) dtype: Dtype,
    pub(super) unit: &'static str,
    pub(super) low: f64,
    /// Highest value; for depth the camera's far end.
    pub(super) high: f64,
    /// The images that it is made of.
    pub(super) channels: ImageChannels,
    /// Writes the observation.
    pub(super) write: fn(ImageContext<'_>, ObservationBuffer<'_>),
}

/// The image sensor for a table of classes, if its classes depend on one.
pub(crate) type ClassImageSensor = fn(ClassSet) -> &'static ImageSensorKind;

/// The style in which an observation is shown to people.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum DisplayStyle {
    /// Colours as they are, sRGB.
    Colors,
    /// Distances: near is bright.
    Depth,
    /// Ids or classes: a colour for each.
    Ids,
    /// Unit vectors.
    Directions,
    /// Linear light, in the last three channels.
    Light,
    /// Movement in the image.
    Flow,
    /// No picture: a list of what is in view.
    List,
}

/// The settings of image observations beside the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageObservationOptions {
    /// Rows of those that list things, 1 to 4,096; default 64.
    pub max_objects: u32,
    /// The classes of `semantic`; default coarse ones.
    pub classes: ClassSet,
}

impl Default for ImageObservationOptions {
    fn default() -> Self {
        Self {
            max_objects: 64,
            classes: ClassSet::Coarse,
        }
    }
}

/// The shape of an observation.
#[derive(Clone, Copy, Debug)]
pub(super) enum ObservationShape {
    /// (height, width, so many numbers).
    Image(usize),
    /// (`max_objects`, so many numbers).
    List(usize),
}

impl ImageSensorKind {
    fn spec(&self, name: &str, camera: &Camera, max_objects: u32) -> SensorSpec {
        SensorSpec {
            name: name.to_owned(),
            shape: match self.shape {
                ObservationShape::Image(parts) => {
                    vec![camera.height() as usize, camera.width() as usize, parts]
                }
                ObservationShape::List(parts) => vec![max_objects as usize, parts],
            },
            dtype: self.dtype,
            unit: self.unit,
            low: self.low,
            high: if self.name == "depth" {
                f64::from(camera.far_m())
            } else {
                self.high
            },
            about: self.about,
        }
    }
}

/// The inputs of an image sensor when it writes.
#[derive(Clone, Copy)]
pub(super) struct ImageContext<'a> {
    pub(super) world: &'a World,
    pub(super) request: ImageRequest,
    /// The camera as it was for the picture.
    pub(super) camera: &'a Camera,
    /// The images, without noise.
    pub(super) frame: &'a Frame,
    /// For the noise.
    pub(super) key: RandomKey,
}

impl ImageContext<'_> {
    /// The laws of the camera.
    pub(super) fn optics(&self) -> CameraLaws<'_> {
        self.world.optics(&self.request.mount)
    }

    /// The view of the picture.
    pub(super) fn view(&self) -> View {
        self.world.moving_view(&self.request).view
    }

    /// The class of what each pixel shows.
    pub(super) fn write_classes(&self, classes: ClassSet, out: ObservationBuffer<'_>) {
        // The picture was taken with the renderer.
        if let (ObservationBuffer::Int32(out), Ok(renderer)) =
            (out, self.world.engines().cpu_renderer())
        {
            let classes = renderer.classes(classes);
            for (class, id) in out.iter_mut().zip(&self.frame.instance) {
                *class = classes.of(*id);
            }
        }
    }
}

/// One sensor.
#[derive(Debug)]
struct ImageSensor {
    kind: &'static ImageSensorKind,
    config: CameraConfig,
    eye: EyeCamera,
}

/// Builds a sensor from its settings.
pub(super) fn build(
    of: ClassImageSensor,
    value: &serde_json::Value,
    site: SensorSetup<'_>,
) -> Result<Box<dyn Sensor>, WorldError> {
    let config: CameraConfig = parse_sensor_settings(value)?;
    let kind = of(config.classes);
    let eye = config.build(site)?;
    Ok(Box::new(ImageSensor { kind, config, eye }))
}

impl Sensor for ImageSensor {
    fn spec(&self) -> SensorSpec {
        let name = self.config.name.as_deref().unwrap_or(self.kind.name);
        let camera = &self.eye.camera;
        self.kind.spec(name, camera, self.config.max_objects)
    }

    fn camera(&self) -> Option<&EyeCamera> {
        Some(&self.eye)
    }

    fn request(&self, _world: &World, requests: &mut SensorRequests) {
        requests.request_view(&self.eye, self.kind.channels);
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        if let Some(picture) = seen.results.image_of(&self.eye) {
            let look = ImageContext {
                world: seen.world,
                request: self.eye.request(seen.world.state()),
                camera: &picture.camera,
                frame: &picture.frame,
                key: seen.key,
            };
            (self.kind.write)(look, out);
        }
    }
}

/// The numbers of an observation.
#[derive(Clone, Debug, PartialEq)]
pub enum ObservationData {
    /// Of [`Dtype::Uint8`].
    Uint8(Vec<u8>),
    /// Of [`Dtype::Float32`].
    Float32(Vec<f32>),
    /// Of [`Dtype::Int32`].
    Int32(Vec<i32>),
}

/// The observation of an image sensor for a camera anywhere in a world.
#[derive(Clone, Debug, PartialEq)]
pub struct Observation {
    /// Shape, type, unit and range.
    pub spec: SensorSpec,
    /// Its numbers.
    pub data: ObservationData,
}

impl World {
    /// Returns the observations of image sensors, by name, for a camera: one picture for all of them.
    ///
    /// # Errors
    /// [`WorldError::Unknown`] lists the sensors there are; [`WorldError::Config`] for a wrong `max_objects`;
    /// [`WorldError::Render`] for a pose that is not finite.
    ///
    /// # Determinism
    /// The random draws of laws depend on the episode, the step and the sensor's name alone.
    pub fn image_observations(
        &self,
        request: &ImageRequest,
        names: &[String],
        settings: ImageObservationOptions,
        threads: Threads,
    ) -> Result<Vec<Observation>, WorldError> {
        let ImageObservationOptions {
            max_objects,
            classes,
        } = settings;
        if !(1..=4096).contains(&max_objects) {
            return Err(WorldError::Config {
                field: "max_objects",
                found: max_objects.to_string(),
                allowed: "1 to 4096".to_owned(),
            });
        }
        let images = || super::all().iter().filter(|kind| kind.is_image_sensor());
        let find = |name: &String| {
            let kind = images().find(|kind| kind.name == name);
            let image = kind.and_then(|kind| kind.image);
            image
                .map(|of| of(classes))
                .ok_or_else(|| super::unknown("image", name, images()))
        };
        let kinds: Vec<&ImageSensorKind> = names.iter().map(find).collect::<Result<_, _>>()?;
        let wanted = kinds.iter().map(|kind| kind.channels);
        let channels = wanted.fold(ImageChannels::NONE, ImageChannels::union);
        let specs = kinds.iter();
        let specs = specs.map(|kind| kind.spec(kind.name, &request.camera, max_objects));
        picture_memory::check_image_memory(&request.camera, channels, &specs.collect::<Vec<_>>())?;
        let (camera, frame) = self.render_image(request, channels, threads)?;
        let key = self.key.child("picture").child(self.state().step);
        let observe = |kind: &&ImageSensorKind| {
            let spec = kind.spec(kind.name, &camera, max_objects);
            let look = ImageContext {
                world: self,
                request: *request,
                camera: &camera,
                frame: &frame,
                key: key.child(kind.name),
            };
            let data = match kind.dtype {
                Dtype::Uint8 => {
                    let mut data = vec![0; spec.len()];
                    (kind.write)(look, ObservationBuffer::Uint8(&mut data));
                    ObservationData::Uint8(data)
                }
                Dtype::Int32 => {
                    let mut data = vec![0; spec.len()];
                    (kind.write)(look, ObservationBuffer::Int32(&mut data));
                    ObservationData::Int32(data)
                }
                Dtype::Float32 | Dtype::Text => {
                    let mut data = vec![0.0; spec.len()];
                    (kind.write)(look, ObservationBuffer::Float32(&mut data));
                    ObservationData::Float32(data)
                }
            };
            Observation { spec, data }
        };
        Ok(kinds.iter().map(observe).collect())
    }
}
