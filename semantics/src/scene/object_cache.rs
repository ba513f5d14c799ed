//! What a scene remembers of an object: measured at first use by those who know how.

use super::Term;
use crate::geometry::Extent;
use dwell_scene::{ObjectId, RoomId};
use std::cell::OnceCell;

/// Something that carries a thing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceSupport {
    /// What carries: an object or a structure piece.
    pub by: Term,
    /// The share of the sole's points that rest on it, 0 to 1.
    pub share: f32,
    /// How far those points are above it where they are nearest, m; at most 0 where they touch it or sink in.
    pub gap_m: f32,
}

/// What was measured of an object.
#[derive(Default)]
pub(crate) struct ObjectCache {
    pub(super) extent: OnceCell<Extent>,
    pub(super) room: OnceCell<Option<RoomId>>,
    /// What it rests on, the largest share first.
    pub(crate) supports: OnceCell<Vec<SurfaceSupport>>,
    /// What it is in, rising.
    pub(crate) around: OnceCell<Vec<ObjectId>>,
    /// What may be next to it, rising.
    pub(crate) near: OnceCell<Vec<ObjectId>>,
    /// What is next to it, rising.
    pub(crate) beside: OnceCell<Vec<ObjectId>>,
}
