//! A cache of extents across states, for things that are not in their initial pose: most things that were moved lie still.

use crate::geometry::Extent;
use dwell_scene::{House, Id, ObjectId, Pose, State};
use std::sync::{Arc, Mutex, PoisonError};

/// Number of latest poses that are kept of each thing.
const KEPT: usize = 4;

/// The latest poses of a thing's parts, each with its extent.
type Known = Vec<(Box<[Pose]>, Arc<Extent>)>;

/// A cache of the extents of moved things in their latest poses.
#[derive(Debug)]
pub(crate) struct ExtentCache {
    /// Shape (object,).
    known: Vec<Mutex<Known>>,
}

impl ExtentCache {
    pub(crate) fn new(house: &House) -> Self {
        let objects = house.objects.iter();
        Self {
            known: objects.map(|_| Mutex::default()).collect(),
        }
    }

    /// Returns the extent of an object in a state, as [`Extent::measure`] does.
    pub(crate) fn get(&self, house: &House, state: &State, object: ObjectId) -> Arc<Extent> {
        let parts = || house.objects[object].parts();
        let stands = |poses: &[Pose]| {
            let mut pairs = poses.iter().zip(parts());
            pairs.all(|(pose, part)| *pose == state.part_pose[part])
        };
        let lock = || {
            let known = &self.known[object.index()];
            known.lock().unwrap_or_else(PoisonError::into_inner)
        };
        if let Some((_, extent)) = lock().iter().rev().find(|(poses, _)| stands(poses)) {
            return extent.clone();
        }
        // Without the lock: others go on meanwhile.
        let extent = Arc::new(Extent::measure(house, state, object));
        let poses = parts().map(|part| state.part_pose[part]).collect();
        let mut known = lock();
        if known.len() >= KEPT {
            known.remove(0);
        }
        known.push((poses, extent.clone()));
        extent
    }
}
