//! What sensors ask of the engines, and what they get.

use crate::sensors::EyeCamera;
use dwell_scene::AgentId;

/// One image of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// sRGB bytes, three a pixel.
    Rgb,
    /// Metres.
    Depth,
    /// Entity ids.
    Instance,
    /// Class ids.
    Semantic,
}

/// A view that some sensor wants.
#[derive(Clone, Debug)]
pub struct ViewRequest {
    /// From where.
    pub eye: EyeCamera,
    /// Which images.
    pub channels: Vec<Channel>,
}

/// All that the sensors of one world want in one step. Equal wishes are merged.
#[derive(Clone, Debug, Default)]
pub struct Requests {
    /// Pictures.
    pub views: Vec<ViewRequest>,
    /// Agents who listen, with the longest window asked for, samples.
    pub ears: Vec<(AgentId, usize)>,
}

impl Requests {
    /// Asks for one image of a view.
    pub fn view(&mut self, eye: &EyeCamera, channel: Channel) {
        match self.views.iter_mut().find(|view| view.eye == *eye) {
            Some(view) if view.channels.contains(&channel) => {}
            Some(view) => view.channels.push(channel),
            None => self.views.push(ViewRequest {
                eye: eye.clone(),
                channels: vec![channel],
            }),
        }
    }

    /// Asks for the sound at an agent's ears.
    pub fn ears(&mut self, agent: AgentId, samples: usize) {
        match self.ears.iter_mut().find(|(other, _)| *other == agent) {
            Some((_, longest)) => *longest = samples.max(*longest),
            None => self.ears.push((agent, samples)),
        }
    }
}

/// The images of one view; those that nobody asked for are empty.
#[derive(Clone, Debug)]
pub struct Picture {
    /// From where.
    pub eye: EyeCamera,
    /// Shape (height, width, 3).
    pub rgb: Vec<u8>,
    /// Shape (height, width), m.
    pub depth: Vec<f32>,
    /// Shape (height, width).
    pub instance: Vec<i32>,
    /// Shape (height, width).
    pub semantic: Vec<i32>,
}

/// What the engines computed for one world. Buffers are kept from step to step.
#[derive(Clone, Debug, Default)]
pub struct Results {
    /// Pictures, in the order of the requests.
    pub pictures: Vec<Picture>,
}

impl Results {
    /// The picture of a view.
    pub fn view(&self, eye: &EyeCamera) -> Option<&Picture> {
        self.pictures.iter().find(|picture| picture.eye == *eye)
    }

    /// Makes room for what is asked for; allocates only when the requests differ from the last ones.
    pub(crate) fn prepare(&mut self, requests: &Requests) {
        let fits = self.pictures.len() == requests.views.len()
            && self
                .pictures
                .iter()
                .zip(&requests.views)
                .all(|(picture, view)| picture.eye == view.eye);
        if fits {
            return;
        }
        self.pictures = requests
            .views
            .iter()
            .map(|view| {
                let pixels = view.eye.camera.pixels();
                let room = |channel, per_pixel| {
                    if view.channels.contains(&channel) {
                        pixels * per_pixel
                    } else {
                        0
                    }
                };
                Picture {
                    eye: view.eye.clone(),
                    rgb: vec![0; room(Channel::Rgb, 3)],
                    depth: vec![0.0; room(Channel::Depth, 1)],
                    instance: vec![0; room(Channel::Instance, 1)],
                    semantic: vec![0; room(Channel::Semantic, 1)],
                }
            })
            .collect();
    }
}
