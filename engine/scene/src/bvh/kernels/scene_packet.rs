//! Ray packets against a scene: static geometry first, then moving instances.

use super::super::instances::{InstanceSet, PreparedInstance};
use super::super::packet::RayPacket;
use super::super::scene::SceneBvh;
use super::HitFilter;
use super::closest_hit::{HitTriangle, TieBreak, coincidence_max_distance};
use super::prepared_packet::PreparedPacket;
use super::slab::min_f32;
use super::tree_packet::{
    ClosestLeafVisitor, OccludedLeafVisitor, PacketClosestHits, PacketLeafVisitor, traverse,
};

/// Offers all hits of a packet that may matter to its results.
#[inline(always)]
pub(super) fn closest<const N: usize>(
    scene: &SceneBvh<'_>,
    rays: &RayPacket<N>,
    filter: &HitFilter,
    answers: &mut PacketClosestHits<N>,
) {
    let (origin, far) = (rays.origin.to_array(), rays.effective_far());
    let claim = |k: usize, place: HitTriangle| {
        scene.tie_break(origin, rays.ray(k).direction.to_array(), place)
    };
    let bvh = scene.fixed;
    let mut fan = PreparedPacket::new(
        &bvh.tree.bounds,
        origin,
        &rays.direction,
        (&rays.near_m, &far),
        1.0,
    );
    traverse(
        &bvh.tree,
        &mut fan,
        &mut ClosestLeafVisitor {
            bvh,
            source: 0,
            filter: *filter,
            hits: answers,
            tie_break: claim,
        },
    );
    if !scene.moving.is_empty() {
        fan.prepare_for_tree(&scene.moving.tree.bounds);
        let mut moving = ClosestInstanceVisitor {
            set: scene.moving,
            filter,
            answers,
            claim,
        };
        traverse(&scene.moving.tree, &mut fan, &mut moving);
    }
}

/// Returns the rays of a packet that hit anything, as bits.
#[inline(always)]
pub(super) fn occluded<const N: usize>(
    scene: &SceneBvh<'_>,
    rays: &RayPacket<N>,
    filter: &HitFilter,
) -> u64 {
    let (origin, far) = (rays.origin.to_array(), rays.effective_far());
    let bvh = scene.fixed;
    let mut fan = PreparedPacket::new(
        &bvh.tree.bounds,
        origin,
        &rays.direction,
        (&rays.near_m, &far),
        1.0,
    );
    traverse(
        &bvh.tree,
        &mut fan,
        &mut OccludedLeafVisitor {
            bvh,
            filter: *filter,
        },
    );
    if !scene.moving.is_empty() {
        fan.prepare_for_tree(&scene.moving.tree.bounds);
        traverse(
            &scene.moving.tree,
            &mut fan,
            &mut OccludedInstanceVisitor {
                set: scene.moving,
                filter,
            },
        );
    }
    (0..N)
        .map(|k| u64::from(far[k] >= 0.0 && fan.limit[k] == f32::NEG_INFINITY) << k)
        .sum()
}

/// Returns the rays of a packet in the space of an instance, within its box; `None` when none can hit it.
#[inline(always)]
fn packet_in_instance<const N: usize>(
    placed: &PreparedInstance,
    fan: &PreparedPacket<N>,
    filter: &HitFilter,
) -> Option<PreparedPacket<N>> {
    if placed.is_hidden() || !filter.accepts(placed.id, placed.mask) {
        return None;
    }
    let (start, mut end) = fan.range_in_box(&placed.bounds);
    let map = &placed.mesh_from_world;
    let origin = map.transform_point(fan.origin);
    let mut direction = [[0.0; N]; 3];
    let [x, y, z] = &fan.direction;
    for k in 0..N {
        let local = map.transform_vector(x[k], y[k], z[k]);
        [direction[0][k], direction[1][k], direction[2][k]] = local;
        let finite = (local[0].is_finite() & local[1].is_finite()) & local[2].is_finite();
        end[k] = if finite { end[k] } else { f32::NEG_INFINITY };
    }
    let local = PreparedPacket::new(
        &placed.mesh.tree.bounds,
        origin,
        &direction,
        (&start, &end),
        map.max_component,
    );
    let finite = origin[0].is_finite() && origin[1].is_finite() && origin[2].is_finite();
    (finite && !local.is_done()).then_some(local)
}

/// [`ClosestLeafVisitor`] over the instances of a set.
struct ClosestInstanceVisitor<'a, const N: usize, C> {
    set: &'a InstanceSet,
    filter: &'a HitFilter,
    answers: &'a mut PacketClosestHits<N>,
    claim: C,
}

impl<const N: usize, C: Fn(usize, HitTriangle) -> TieBreak + Copy> PacketLeafVisitor<N>
    for ClosestInstanceVisitor<'_, N, C>
{
    #[inline(always)]
    fn visit_leaf(&mut self, fan: &mut PreparedPacket<N>, instance: usize) -> bool {
        let placed = &self.set.placed[instance];
        if let Some(mut local) = packet_in_instance(placed, fan, self.filter) {
            let (bvh, source) = (&*placed.mesh, instance as u32 + 1);
            let (answers, claim) = (&mut *self.answers, self.claim);
            let mut visit = ClosestLeafVisitor {
                bvh,
                source,
                filter: self.filter.for_instance_triangles(),
                hits: answers,
                tie_break: claim,
            };
            traverse(&bvh.tree, &mut local, &mut visit);
            for k in 0..N {
                fan.limit[k] = min_f32(
                    coincidence_max_distance(self.answers.distance[k]),
                    fan.limit[k],
                );
            }
            fan.update_limit_bounds();
        }
        false
    }
}

/// [`OccludedLeafVisitor`] over the instances of a set.
struct OccludedInstanceVisitor<'a> {
    set: &'a InstanceSet,
    filter: &'a HitFilter,
}

impl<const N: usize> PacketLeafVisitor<N> for OccludedInstanceVisitor<'_> {
    #[inline(always)]
    fn visit_leaf(&mut self, fan: &mut PreparedPacket<N>, instance: usize) -> bool {
        let placed = &self.set.placed[instance];
        if let Some(mut local) = packet_in_instance(placed, fan, self.filter) {
            let before = local.limit;
            traverse(
                &placed.mesh.tree,
                &mut local,
                &mut OccludedLeafVisitor {
                    bvh: &placed.mesh,
                    filter: self.filter.for_instance_triangles(),
                },
            );
            for k in 0..N {
                let blocked = (before[k] >= 0.0) & (local.limit[k] == f32::NEG_INFINITY);
                fan.limit[k] = if blocked {
                    f32::NEG_INFINITY
                } else {
                    fan.limit[k]
                };
            }
            fan.update_limit_bounds();
        }
        fan.is_done()
    }
}
