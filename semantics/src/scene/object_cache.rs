//! Cache of a scene about an object: each entry is measured at first use.

use super::Term;
use crate::geometry::Extent;
use dwell_scene::{ObjectId, RoomId};
use std::cell::OnceCell;
use std::sync::Arc;

/// A carrier of a thing, with its share of the load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupportShare {
    /// The carrier: an object or a structure piece.
    pub by: Term,
    /// The share of the sole's points that rest on it, 0 to 1.
    pub share: f32,
    /// Smallest height of those points above it, m; at most 0 where they touch it or sink in.
    pub gap_m: f32,
}

/// The measurements of an object.
#[derive(Default)]
pub(crate) struct ObjectCache {
    pub(super) extent: OnceCell<Arc<Extent>>,
    pub(super) room: OnceCell<Option<RoomId>>,
    /// Its carriers, the largest share first.
    pub(crate) supports: OnceCell<Vec<SupportShare>>,
    /// Its containers, ascending.
    pub(crate) around: OnceCell<Vec<ObjectId>>,
    /// Its mount: the term on which it hangs.
    pub(crate) mount: OnceCell<Option<Term>>,
    /// The objects against which it stands, ascending.
    pub(crate) against: OnceCell<Vec<ObjectId>>,
    /// Candidates for its neighbours, ascending.
    pub(crate) near: OnceCell<Vec<ObjectId>>,
    /// Its neighbours, the objects next to it, ascending.
    pub(crate) beside: OnceCell<Vec<ObjectId>>,
}
