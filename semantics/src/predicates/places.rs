//! The places of all things at once.

use super::mount::mount_of;
use crate::scene::SemanticScene;
use dwell_scene::ObjectId;
use dwell_scene::parallel::Threads;

/// Smallest number of things that are worth measuring on several threads.
const LEAST_TO_SHARE: usize = 32;

impl SemanticScene<'_> {
    /// Measures what carries, holds and mounts each object, on all threads: for whoever goes on to ask for most of them.
    pub(crate) fn measure_places(&self) {
        let all = self.house().objects.ids();
        let unknown: Vec<ObjectId> = all
            .filter(|object| self.cache(*object).mount.get().is_none())
            .collect();
        let threads = Threads::resolve(None);
        if threads.count() == 1 || unknown.len() < LEAST_TO_SHARE {
            return;
        }
        let shares: Vec<&[ObjectId]> = unknown
            .chunks(unknown.len().div_ceil(2 * threads.count()))
            .collect();
        let (semantics, state) = (self.semantics, self.state);
        let measured = threads.map(shares.len(), |k| {
            let own = semantics.scene(state);
            let places = shares[k].iter().map(|object| {
                let supports = own.supporting_surfaces(*object).to_vec();
                let around = own.containers(*object).to_vec();
                (*object, supports, around, mount_of(&own, *object))
            });
            places.collect::<Vec<_>>()
        });
        for (object, supports, around, mount) in measured.into_iter().flatten() {
            let own = self.cache(object);
            // What is known already is the same.
            let _ = own.supports.set(supports);
            let _ = own.around.set(around);
            let _ = own.mount.set(mount);
        }
    }
}
