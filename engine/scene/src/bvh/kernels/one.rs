//! One ray against everything: static geometry first, then what moves.

use super::super::instances::InstanceSet;
use super::super::ray::Ray;
use super::super::scene::SceneBvh;
use super::Filter;
use super::nearest::{Claim, Nearest, Place};
use super::single::{Hits, Probe, Visit, meet, traverse};
use super::slab::least;
use crate::bounds::Aabb;
use crate::instructions::Kernel;

/// Hands the hits of a ray to `hits`, in no particular order, until one is enough. What comes of it: whether one was.
pub(in super::super) struct OneRay<'a, 'b, H> {
    pub(in super::super) scene: &'a SceneBvh<'b>,
    pub(in super::super) ray: &'a Ray,
    pub(in super::super) filter: &'a Filter,
    pub(in super::super) hits: &'a mut H,
}

impl<H: Hits> Kernel for OneRay<'_, '_, H> {
    type Output = bool;

    #[inline(always)]
    fn run(self) -> bool {
        let (scene, filter) = (self.scene, self.filter);
        let probe = probe(self.ray, &scene.fixed.tree.bounds);
        if meet(scene.fixed, &probe, filter, 0, self.hits) {
            return true;
        }
        let set = scene.moving;
        if set.is_empty() {
            return false;
        }
        let probe = &self::probe(self.ray, &set.tree.bounds);
        let limit = least(self.hits.limit(), probe.far);
        let hits = self.hits;
        let mut moving = Moving {
            set,
            probe,
            filter,
            hits,
        };
        traverse(&set.tree, probe, limit, &mut moving)
    }
}

#[inline(always)]
fn probe(ray: &Ray, bounds: &Aabb) -> Probe {
    let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
    Probe::new(bounds, origin, direction, (ray.near_m, ray.far_m), 1.0)
}

/// What moves.
struct Moving<'a, H> {
    set: &'a InstanceSet,
    probe: &'a Probe,
    filter: &'a Filter,
    hits: &'a mut H,
}

impl<H: Hits> Visit for Moving<'_, H> {
    #[inline(always)]
    fn leaf(&mut self, instance: usize, limit: &mut f32) -> bool {
        let placed = &self.set.placed[instance];
        let (start, end) = self.probe.range_in(&placed.bounds);
        let apart = placed.is_hidden() || start > least(end, *limit);
        if apart || !self.filter.admits(placed.id, placed.mask) {
            return false;
        }
        // The ray in the space of the instance, where it lies in the instance's box.
        let map = &placed.mesh_from_world;
        let [x, y, z] = self.probe.direction;
        let direction = map.vector(x, y, z);
        let (bounds, origin) = (&placed.mesh.tree.bounds, map.point(self.probe.origin));
        let local = Probe::new(bounds, origin, direction, (start, end), map.longest);
        if !local.is_usable() {
            return false;
        }
        let (filter, source) = (self.filter.within(), instance as u32 + 1);
        let enough = meet(&placed.mesh, &local, &filter, source, self.hits);
        *limit = least(self.hits.limit(), *limit);
        enough
    }
}

/// Offers every hit that may matter to `nearest`.
pub(in super::super) struct Offer<'a, C> {
    pub(in super::super) nearest: &'a mut Nearest,
    pub(in super::super) claim: C,
}

impl<C: Fn(Place) -> Claim> Hits for Offer<'_, C> {
    #[inline(always)]
    fn found(&mut self, place: Place, distance: f32) -> bool {
        if distance <= self.nearest.limit {
            self.nearest.offer(distance, place, &self.claim);
        }
        false
    }

    #[inline(always)]
    fn limit(&self) -> f32 {
        self.nearest.limit
    }
}

/// Any hit is enough.
pub(in super::super) struct Any;

impl Hits for Any {
    #[inline(always)]
    fn found(&mut self, _: Place, _: f32) -> bool {
        true
    }

    #[inline(always)]
    fn limit(&self) -> f32 {
        f32::INFINITY
    }
}

/// Calls a function for every hit.
pub(in super::super) struct Every<F>(pub(in super::super) F);

impl<F: FnMut(Place, f32)> Hits for Every<F> {
    #[inline(always)]
    fn found(&mut self, place: Place, distance: f32) -> bool {
        (self.0)(place, distance);
        false
    }

    #[inline(always)]
    fn limit(&self) -> f32 {
        f32::INFINITY
    }
}
