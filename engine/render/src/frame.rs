//! What is asked of a renderer, and where it writes.

use crate::camera::Camera;
use crate::error::RenderError;
use dwell_scene::{EntityId, Pose};
use serde::{Deserialize, Serialize};

/// How much light there is in a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Preset {
    /// Texture times colour, no lamps: fast, and the same for every time of day.
    #[default]
    Flat,
    /// Lamps, sun and sky, light that rooms throw back, tone-mapped; only the sun casts shadows. See the crate's page.
    Lit,
}

/// One picture: a camera, where it stands, and how much light there is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The camera.
    pub camera: Camera,
    /// Where the camera stands; it looks along -Z with +X to the right.
    pub world_from_camera: Pose,
    /// The light.
    pub preset: Preset,
    /// A thing that the camera does not see: the body that carries it.
    pub hide: Option<EntityId>,
}

impl View {
    /// A view with [`Preset::Flat`] that sees everything.
    pub fn new(camera: Camera, world_from_camera: Pose) -> Self {
        Self {
            camera,
            world_from_camera,
            preset: Preset::Flat,
            hide: None,
        }
    }
}

/// Which images are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[expect(clippy::struct_excessive_bools, reason = "a set of four images")]
pub struct Channels {
    /// Colour.
    pub rgb: bool,
    /// Depth.
    pub depth: bool,
    /// Ids of things.
    pub instance: bool,
    /// Ids of classes of things.
    pub semantic: bool,
}

impl Channels {
    /// Every image.
    pub const ALL: Self = Self {
        rgb: true,
        depth: true,
        instance: true,
        semantic: true,
    };
}

impl Default for Channels {
    /// Colour, depth and instance.
    fn default() -> Self {
        Self {
            semantic: false,
            ..Self::ALL
        }
    }
}

/// The images of one view in memory of the caller; `None`: not wanted. Rows from the top, without gaps.
#[derive(Debug, Default)]
pub struct FrameMut<'a> {
    /// Colour, sRGB-encoded. Shape (height, width, 3).
    pub rgb: Option<&'a mut [u8]>,
    /// Depth along the camera's axis, m; `far_m` where nothing is seen. Shape (height, width).
    pub depth: Option<&'a mut [f32]>,
    /// [`EntityId`] of what is seen; 0 for nothing. Shape (height, width).
    pub instance: Option<&'a mut [i32]>,
    /// Class of what is seen, a position in [`crate::semantic_classes`]; 0 for nothing. Shape (height, width).
    pub semantic: Option<&'a mut [i32]>,
}

impl FrameMut<'_> {
    /// The same frame for a shorter time.
    pub fn reborrow(&mut self) -> FrameMut<'_> {
        FrameMut {
            rgb: self.rgb.as_deref_mut(),
            depth: self.depth.as_deref_mut(),
            instance: self.instance.as_deref_mut(),
            semantic: self.semantic.as_deref_mut(),
        }
    }

    /// Checks every length against the camera's image.
    pub(crate) fn check(&self, view: usize, camera: &Camera) -> Result<(), RenderError> {
        let pixels = camera.pixels();
        let lengths = [
            ("rgb", self.rgb.as_ref().map(|b| b.len()), pixels * 3),
            ("depth", self.depth.as_ref().map(|b| b.len()), pixels),
            ("instance", self.instance.as_ref().map(|b| b.len()), pixels),
            ("semantic", self.semantic.as_ref().map(|b| b.len()), pixels),
        ];
        for (channel, found, expected) in lengths {
            if let Some(found) = found
                && found != expected
            {
                return Err(RenderError::Length {
                    view,
                    channel,
                    found,
                    expected,
                });
            }
        }
        Ok(())
    }
}

/// The images of one view, in memory of their own.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Colour, sRGB-encoded. Shape (height, width, 3), or empty.
    pub rgb: Vec<u8>,
    /// Depth along the camera's axis, m; `far_m` where nothing is seen. Shape (height, width), or empty.
    pub depth: Vec<f32>,
    /// [`EntityId`] of what is seen; 0 for nothing. Shape (height, width), or empty.
    pub instance: Vec<i32>,
    /// Class of what is seen, a position in [`crate::semantic_classes`]; 0 for nothing. Shape (height, width), or empty.
    pub semantic: Vec<i32>,
}

impl Frame {
    /// Black images of the right size.
    pub fn new(camera: &Camera, channels: Channels) -> Self {
        let pixels = |wanted: bool| if wanted { camera.pixels() } else { 0 };
        Self {
            rgb: vec![0; pixels(channels.rgb) * 3],
            depth: vec![0.0; pixels(channels.depth)],
            instance: vec![0; pixels(channels.instance)],
            semantic: vec![0; pixels(channels.semantic)],
        }
    }

    /// The images to write into; an empty one is not wanted.
    pub fn as_mut(&mut self) -> FrameMut<'_> {
        fn wanted<T>(buffer: &mut [T]) -> Option<&mut [T]> {
            if buffer.is_empty() {
                None
            } else {
                Some(buffer)
            }
        }
        FrameMut {
            rgb: wanted(&mut self.rgb),
            depth: wanted(&mut self.depth),
            instance: wanted(&mut self.instance),
            semantic: wanted(&mut self.semantic),
        }
    }
}
