//! Requests to a renderer, and the buffers that it writes into.

use crate::camera::Camera;
use crate::error::RenderError;
use dwell_scene::rays::CAPSULE_PIECES;
use dwell_scene::{AgentId, EntityId, Id, PartId, Pose};
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// The amount of light transport in a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Preset {
    /// Texture times colour, no lamps: fast, and the same for every time of day.
    #[default]
    Flat,
    /// Lamps, sun and sky with at most two shadow rays a surface, indirect light of rooms, tone-mapped. See the crate's page.
    Lit,
    /// All light: sixteen rays a pixel, soft shadows of every lamp, window and the sun, light that surfaces reflect on one another,
    /// glossy reflections. For pictures, not for training: some 600 times the cost of `lit`. Always by the `cpu` back end.
    Full,
}

impl Preset {
    /// Every preset, cheapest first.
    pub const ALL: [Self; 3] = [Self::Flat, Self::Lit, Self::Full];

    /// Its name in files and commands.
    pub fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Lit => "lit",
            Self::Full => "full",
        }
    }

    /// The preset of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|preset| preset.name() == name)
    }
}

/// One picture: a camera, its pose, and the light transport.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The camera.
    pub camera: Camera,
    /// The camera's pose; it looks along -Z with +X to the right.
    pub world_from_camera: Pose,
    /// The light.
    pub preset: Preset,
    /// A thing that the camera does not see: the body that carries it.
    pub hidden_entity: Option<EntityId>,
}

impl View {
    /// A view with [`Preset::Flat`] that sees everything.
    pub fn new(camera: Camera, world_from_camera: Pose) -> Self {
        Self {
            camera,
            world_from_camera,
            preset: Preset::Flat,
            hidden_entity: None,
        }
    }
}

/// The set of images to render.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[expect(clippy::struct_excessive_bools, reason = "a set of images")]
pub struct ImageChannels {
    /// Colour.
    pub rgb: bool,
    /// Depth.
    pub depth: bool,
    /// Ids of things.
    pub instance: bool,
    /// Ids of classes of things.
    pub semantic: bool,
    /// Normals of surfaces.
    pub normals: bool,
    /// Reflectance of surfaces.
    pub albedo: bool,
    /// Motion of surfaces in the image.
    pub flow: bool,
}

impl ImageChannels {
    /// Every image.
    pub const ALL: Self = Self {
        rgb: true,
        depth: true,
        instance: true,
        semantic: true,
        normals: true,
        albedo: true,
        flow: true,
    };
    /// No image.
    pub const NONE: Self = Self {
        rgb: false,
        depth: false,
        instance: false,
        semantic: false,
        normals: false,
        albedo: false,
        flow: false,
    };

    /// The union of both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            rgb: self.rgb | other.rgb,
            depth: self.depth | other.depth,
            instance: self.instance | other.instance,
            semantic: self.semantic | other.semantic,
            normals: self.normals | other.normals,
            albedo: self.albedo | other.albedo,
            flow: self.flow | other.flow,
        }
    }
}

impl Default for ImageChannels {
    /// Colour, depth and instance.
    fn default() -> Self {
        Self {
            rgb: true,
            depth: true,
            instance: true,
            ..Self::NONE
        }
    }
}

/// Earlier poses of camera and parts, for [`FrameMut::flow`].
#[derive(Clone, Copy, Debug)]
pub struct PreviousPoses<'a> {
    /// The camera's earlier pose.
    pub world_from_camera: Pose,
    /// Earlier poses of the parts that have moved since, by part; the others have not moved.
    pub moved_parts: &'a [(PartId, Pose)],
    /// Earlier positions of the agents' feet, m. Shape (agent,); those beyond its end have not moved.
    pub agents: &'a [Vec3],
    /// Earlier poses of the pieces of agents that are persons, by agent; the pieces of others have not moved. Shape of each
    /// (piece,).
    pub persons: &'a [(AgentId, Vec<Pose>)],
}

impl PreviousPoses<'_> {
    /// The earlier pose of a piece of an agent's body, if it is a person's and known.
    pub(crate) fn person_piece(&self, agent: usize, piece: usize) -> Option<Pose> {
        let own = piece.checked_sub(CAPSULE_PIECES)?;
        let found = self.persons.iter().find(|(id, _)| id.index() == agent)?;
        found.1.get(own).copied()
    }
}

/// The images of one view in the caller's memory; `None`: not wanted. Rows from the top, without gaps.
#[derive(Debug, Default)]
pub struct FrameMut<'a> {
    /// Colour, sRGB-encoded. Shape (height, width, 3).
    pub rgb: Option<&'a mut [u8]>,
    /// Depth along the camera's axis (range for cameras that see all around), m; `far_m` where nothing is seen. Shape (height,
    /// width).
    pub depth: Option<&'a mut [f32]>,
    /// [`EntityId`] of what is seen; 0 for nothing. Shape (height, width).
    pub instance: Option<&'a mut [i32]>,
    /// Class of the visible surface, a position in [`crate::semantic_classes`]; 0 for nothing. Shape (height, width).
    pub semantic: Option<&'a mut [i32]>,
    /// Unit normal of the surface in camera space, on the side that is seen; zeros for nothing. Shape (height, width, 3).
    pub normals: Option<&'a mut [f32]>,
    /// Reflectance of the surface, linear, 0 to 1; zeros for nothing. Shape (height, width, 3).
    pub albedo: Option<&'a mut [f32]>,
    /// Motion of the seen point in the image since [`PreviousPoses`], pixels to the right and down; zeros where it was not seen
    /// by the camera. Shape (height, width, 2).
    pub flow: Option<&'a mut [f32]>,
}

/// Applies a macro to every image of a frame, with its elements per pixel.
macro_rules! each_image {
    ($visit:ident) => {
        $visit!(rgb, 3);
        $visit!(depth, 1);
        $visit!(instance, 1);
        $visit!(semantic, 1);
        $visit!(normals, 3);
        $visit!(albedo, 3);
        $visit!(flow, 2);
    };
}

pub(crate) use each_image;

impl<'a> FrameMut<'a> {
    /// Reborrows the frame.
    pub fn reborrow(&mut self) -> FrameMut<'_> {
        let mut frame = FrameMut::default();
        macro_rules! lend {
            ($image:ident, $parts:expr) => {
                frame.$image = self.$image.as_deref_mut();
            };
        }
        each_image!(lend);
        frame
    }

    /// Splits the first `pixels` pixels off, such as those of the first rows; a shorter frame gives nothing.
    #[must_use]
    pub fn split_off_pixels(&mut self, pixels: usize) -> FrameMut<'a> {
        let mut frame = FrameMut::default();
        macro_rules! cut {
            ($image:ident, $parts:expr) => {
                if let Some((first, rest)) = self
                    .$image
                    .take()
                    .and_then(|all| all.split_at_mut_checked(pixels * $parts))
                {
                    (frame.$image, self.$image) = (Some(first), Some(rest));
                }
            };
        }
        each_image!(cut);
        frame
    }

    /// Checks every length against a number of pixels.
    pub(crate) fn check(&self, view: usize, pixels: usize) -> Result<(), RenderError> {
        macro_rules! check {
            ($image:ident, $parts:expr) => {
                if let Some(buffer) = &self.$image
                    && buffer.len() != pixels * $parts
                {
                    return Err(RenderError::Length {
                        view,
                        channel: stringify!($image),
                        found: buffer.len(),
                        expected: pixels * $parts,
                    });
                }
            };
        }
        each_image!(check);
        Ok(())
    }
}

/// The images of one view, in memory of their own. Those that are not wanted are empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// As [`FrameMut::rgb`].
    pub rgb: Vec<u8>,
    /// As [`FrameMut::depth`].
    pub depth: Vec<f32>,
    /// As [`FrameMut::instance`].
    pub instance: Vec<i32>,
    /// As [`FrameMut::semantic`].
    pub semantic: Vec<i32>,
    /// As [`FrameMut::normals`].
    pub normals: Vec<f32>,
    /// As [`FrameMut::albedo`].
    pub albedo: Vec<f32>,
    /// As [`FrameMut::flow`].
    pub flow: Vec<f32>,
}

impl Frame {
    /// Black images of the right size.
    pub fn new(camera: &Camera, channels: ImageChannels) -> Self {
        Self::with_pixel_count(camera.pixels(), channels)
    }

    /// Black images of so many pixels, such as those of some rows.
    pub(crate) fn with_pixel_count(pixels: usize, channels: ImageChannels) -> Self {
        let mut frame = Self::default();
        macro_rules! fill {
            ($image:ident, $parts:expr) => {
                if channels.$image {
                    // Zeroed memory that the system gives at first use: nothing to wait for here.
                    frame.$image = vec![Default::default(); pixels * $parts];
                }
            };
        }
        each_image!(fill);
        frame
    }

    /// The images that it holds.
    pub fn channels(&self) -> ImageChannels {
        let mut channels = ImageChannels::NONE;
        macro_rules! note {
            ($image:ident, $parts:expr) => {
                channels.$image = !self.$image.is_empty();
            };
        }
        each_image!(note);
        channels
    }

    /// The images to write into; an empty one is not wanted.
    pub fn as_mut(&mut self) -> FrameMut<'_> {
        let mut frame = FrameMut::default();
        macro_rules! lend {
            ($image:ident, $parts:expr) => {
                if !self.$image.is_empty() {
                    frame.$image = Some(&mut self.$image);
                }
            };
        }
        each_image!(lend);
        frame
    }
}
