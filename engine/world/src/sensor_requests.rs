//! Requests of sensors to the engines, and their results.

use crate::eye_camera::EyeCamera;
use crate::listener::Listener;
use crate::world::World;
use dwell_render::{Camera, Frame, ImageChannels};

/// A view that some sensor wants.
#[derive(Clone, Debug)]
pub struct ViewRequest {
    /// The camera.
    pub eye: EyeCamera,
    /// The images.
    pub channels: ImageChannels,
}

/// All requests of one world's sensors in one step. Equal ones are merged.
#[derive(Clone, Debug, Default)]
pub struct SensorRequests {
    /// Pictures.
    pub views: Vec<ViewRequest>,
    /// Agents that listen with a receiver, with the longest requested window, samples.
    pub listeners: Vec<(Listener, usize)>,
}

impl SensorRequests {
    /// Requests images of a view.
    pub fn request_view(&mut self, eye: &EyeCamera, channels: ImageChannels) {
        match self.views.iter_mut().find(|view| view.eye == *eye) {
            Some(view) => view.channels = view.channels.union(channels),
            None => self.views.push(ViewRequest {
                eye: eye.clone(),
                channels,
            }),
        }
    }

    /// Requests the sound at a receiver of an agent.
    pub fn request_sound(&mut self, listener: &Listener, samples: usize) {
        let mut listeners = self.listeners.iter_mut();
        match listeners.find(|(other, _)| other == listener) {
            Some((_, longest)) => *longest = samples.max(*longest),
            None => self.listeners.push((listener.clone(), samples)),
        }
    }
}

/// The images of one view; those that were not requested are empty.
#[derive(Clone, Debug)]
pub struct RenderedView {
    /// The requested camera.
    pub eye: EyeCamera,
    /// The camera as it was for this picture.
    pub camera: Camera,
    /// The images, without the noise that laws add.
    pub frame: Frame,
}

/// The engines' results for one world. Buffers are kept from step to step.
#[derive(Clone, Debug, Default)]
pub struct RenderedImages {
    /// Pictures, in the order of the requests.
    pub images: Vec<RenderedView>,
}

impl RenderedImages {
    /// The picture of a view.
    pub fn image_of(&self, eye: &EyeCamera) -> Option<&RenderedView> {
        self.images.iter().find(|picture| picture.eye == *eye)
    }

    /// Allocates the buffers for the requests, if these are other than the last time.
    pub(crate) fn allocate(&mut self, requests: &SensorRequests, world: &World) {
        self.images.truncate(requests.views.len());
        for (k, request) in requests.views.iter().enumerate() {
            let mut channels = request.channels;
            // Laws come and go while a world runs.
            channels.normals |= channels.depth && world.needs_normals(request.eye.agent);
            let camera = request.eye.camera;
            match self.images.get_mut(k) {
                Some(picture) if picture.eye == request.eye => {
                    if picture.frame.channels() != channels {
                        picture.frame = Frame::new(&camera, channels);
                    }
                }
                found => {
                    let picture = RenderedView {
                        eye: request.eye.clone(),
                        camera,
                        frame: Frame::new(&camera, channels),
                    };
                    match found {
                        Some(place) => *place = picture,
                        None => self.images.push(picture),
                    }
                }
            }
        }
    }
}
