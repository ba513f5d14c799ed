//! Cameras: images by the `cpu` back end, and by graphics cards.
//!
//! A [`CpuRenderer`] is made once for a house and renders [`View`]s of any world over it into memory of the caller:
//! colour, depth, ids of things, ids of their classes. [`StoreyMap`] is a storey from above, [`Dollhouse`] one from outside.
//!
//! # Textures
//! Bilinear on the level of an image whose texels are about as large as what a pixel covers; on lit pictures up to eight
//! samples along the longer axis of that, so that floors far away keep their pattern.
//!
//! # Light
//! [`Preset::Flat`] shows texture times colour: no lamps, the same at every time of day, the sky where nothing is.
//!
//! [`Preset::Lit`] adds light. Each surface in a pixel (one, unless it is seen through glass or in a mirror) asks for shadows of the two
//! strongest sources that shine on it, by a ray each: the sun of a
//! house that knows its sky, or all lamps of one thing as a point in their middle. Other light is stopped by the walls of its room
//! only. Glass and the shade of a lamp let its light pass; a lamp that is walled in, as some of SUNCG's above their ceilings, casts
//! no shadows. In linear light it sums up
//!
//! - lamps that are on: a watt counts as 100 lm, sent evenly by points and lines (a line is four points) and into their
//!   cone by spots, with the attenuation of the file (usually the inverse square); a lamp shines through its own shade;
//! - windows that lead to the open air: sky and ground as a disc of the window's area, and the sun where its ray passes the
//!   window and meets nothing but glass. They are those of [`dwell_scene::Sky`]; a house without one has an even sky of
//!   2,500 cd/m², ground that throws a fifth of that back, and a low sun without shadows;
//! - what a room throws back, evenly from all around: the equation of the integrating sphere, with the mean reflectance
//!   of the room's walls; rooms share it through doors as far as those are open;
//! - materials that glow, unless their thing is switched off.
//!
//! [`Preset::Full`] is for pictures: the mean of sixteen rays through each pixel, soft shadows of all lamps, windows and the sun by rays
//! to places in them, what nearby surfaces throw back instead of the room's mean, and what polish and metals reflect. Its grain is the
//! same each time. Always by the `cpu` back end.
//!
//! Mirrors (metals of a roughness of at most 0.05) show what they reflect; to depth, ids and flat pictures they are surfaces. Rougher
//! metals are paint of their colour but on full pictures.
//!
//! The picture is exposed for the mean light of the camera's room and tone-mapped. The open air has an exposure of its
//! own, as if photographed apart.

mod back_end;
mod camera;
mod color;
mod cpu;
mod error;
mod frame;
mod gpu;
pub mod laws;
mod light;
mod map;
mod material;
mod semantic;
mod texture;
mod texture_filter;
mod triangle_table;
mod visible_objects;

pub use back_end::{BackEnd, Renderer};
pub use camera::{Camera, Projection};
pub use cpu::{CpuRenderer, RenderJob};
pub use error::RenderError;
pub use frame::{Frame, FrameMut, ImageChannels, Preset, PreviousPoses, View};
pub use gpu::{
    AdapterInfo, AdapterKind, BatchLimits, Gpu, GpuRenderer, PendingBatch, VisibilityPath,
    VisibilityPathSpeeds, adapters,
};
pub use laws::{CameraLaws, Shutter};
pub use map::{Dollhouse, DollhouseConfig, StoreyMap};
pub use semantic::{ClassSet, EntityClasses, semantic_classes};
pub use texture::texture_bytes;
pub use visible_objects::{OrientedBox, VisibleObject, visible_objects};
