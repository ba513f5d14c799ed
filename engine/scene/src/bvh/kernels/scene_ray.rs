//! Single rays against a scene: static geometry first, then moving instances.

use super::super::instances::InstanceSet;
use super::super::ray::Ray;
use super::super::scene::SceneBvh;
use super::HitFilter;
use super::closest_hit::{ClosestHit, HitTriangle, TieBreak};
use super::slab::min_f32;
use super::tree_ray::{HitVisitor, PreparedRay, RayLeafVisitor, intersect_tree, traverse};
use crate::bounds::Aabb;
use crate::simd_dispatch::SimdKernel;

/// Passes the hits of a ray to `hits`, in no particular order, until it needs no more. The output: whether it stopped.
pub(in super::super) struct SceneRayQuery<'a, 'b, H> {
    pub(in super::super) scene: &'a SceneBvh<'b>,
    pub(in super::super) ray: &'a Ray,
    pub(in super::super) filter: &'a HitFilter,
    pub(in super::super) hits: &'a mut H,
}

impl<H: HitVisitor> SimdKernel for SceneRayQuery<'_, '_, H> {
    type Output = bool;

    #[inline(always)]
    fn run(self) -> bool {
        let (scene, filter) = (self.scene, self.filter);
        let probe = probe(self.ray, &scene.fixed.tree.bounds);
        if intersect_tree(scene.fixed, &probe, filter, 0, self.hits) {
            return true;
        }
        let set = scene.moving;
        if set.is_empty() {
            return false;
        }
        let probe = &self::probe(self.ray, &set.tree.bounds);
        let limit = min_f32(self.hits.limit(), probe.far);
        let hits = self.hits;
        let mut moving = LeafInstanceIntersector {
            set,
            probe,
            filter,
            hits,
        };
        traverse(&set.tree, probe, limit, &mut moving)
    }
}

#[inline(always)]
fn probe(ray: &Ray, bounds: &Aabb) -> PreparedRay {
    let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
    PreparedRay::new(bounds, origin, direction, (ray.near_m, ray.far_m), 1.0)
}

/// The moving instances.
struct LeafInstanceIntersector<'a, H> {
    set: &'a InstanceSet,
    probe: &'a PreparedRay,
    filter: &'a HitFilter,
    hits: &'a mut H,
}

impl<H: HitVisitor> RayLeafVisitor for LeafInstanceIntersector<'_, H> {
    #[inline(always)]
    fn visit_leaf(&mut self, instance: usize, limit: &mut f32) -> bool {
        let placed = &self.set.placed[instance];
        let (start, end) = self.probe.range_in_box(&placed.bounds);
        let apart = placed.is_hidden() || start > min_f32(end, *limit);
        if apart || !self.filter.accepts(placed.id, placed.mask) {
            return false;
        }
        // The ray in the space of the instance, where it lies in the instance's box.
        let map = &placed.mesh_from_world;
        let [x, y, z] = self.probe.direction;
        let direction = map.transform_vector(x, y, z);
        let (bounds, origin) = (
            &placed.mesh.tree.bounds,
            map.transform_point(self.probe.origin),
        );
        let local = PreparedRay::new(bounds, origin, direction, (start, end), map.max_component);
        if !local.is_usable() {
            return false;
        }
        let (filter, source) = (self.filter.for_instance_triangles(), instance as u32 + 1);
        let enough = intersect_tree(&placed.mesh, &local, &filter, source, self.hits);
        *limit = min_f32(self.hits.limit(), *limit);
        enough
    }
}

/// Offers every hit that may matter to `nearest`.
pub(in super::super) struct ClosestHitVisitor<'a, C> {
    pub(in super::super) nearest: &'a mut ClosestHit,
    pub(in super::super) tie_break: C,
}

impl<C: Fn(HitTriangle) -> TieBreak> HitVisitor for ClosestHitVisitor<'_, C> {
    #[inline(always)]
    fn visit_hit(&mut self, place: HitTriangle, distance: f32) -> bool {
        if distance <= self.nearest.limit {
            self.nearest.consider(distance, place, &self.tie_break);
        }
        false
    }

    #[inline(always)]
    fn limit(&self) -> f32 {
        self.nearest.limit
    }
}

/// Stops at the first hit.
pub(in super::super) struct AnyHitVisitor;

impl HitVisitor for AnyHitVisitor {
    #[inline(always)]
    fn visit_hit(&mut self, _: HitTriangle, _: f32) -> bool {
        true
    }

    #[inline(always)]
    fn limit(&self) -> f32 {
        f32::INFINITY
    }
}

/// Calls a function for every hit.
pub(in super::super) struct AllHitsVisitor<F>(pub(in super::super) F);

impl<F: FnMut(HitTriangle, f32)> HitVisitor for AllHitsVisitor<F> {
    #[inline(always)]
    fn visit_hit(&mut self, place: HitTriangle, distance: f32) -> bool {
        (self.0)(place, distance);
        false
    }

    #[inline(always)]
    fn limit(&self) -> f32 {
        f32::INFINITY
    }
}
