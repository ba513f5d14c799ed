//! A packet of rays against everything: static geometry first, then what moves.

use super::super::instances::{InstanceSet, Placed};
use super::super::packet::RayPacket;
use super::super::scene::SceneBvh;
use super::Filter;
use super::fan::Fan;
use super::nearest::{Claim, Place, horizon};
use super::packet::{Answers, Closest, Occluded, Visit, traverse};
use super::slab::least;

/// Offers all hits of a packet that may matter to its answers.
#[inline(always)]
pub(super) fn closest<const N: usize>(
    scene: &SceneBvh<'_>,
    rays: &RayPacket<N>,
    filter: &Filter,
    answers: &mut Answers<N>,
) {
    let (origin, far) = (rays.origin.to_array(), rays.usable_far());
    let claim =
        |k: usize, place: Place| scene.claim(origin, rays.ray(k).direction.to_array(), place);
    let bvh = scene.fixed;
    let mut fan = Fan::new(
        &bvh.tree.bounds,
        origin,
        &rays.direction,
        (&rays.near_m, &far),
        1.0,
    );
    traverse(
        &bvh.tree,
        &mut fan,
        &mut Closest {
            bvh,
            source: 0,
            filter: *filter,
            answers,
            claim,
        },
    );
    if !scene.moving.is_empty() {
        fan.aim(&scene.moving.tree.bounds);
        let mut moving = ClosestMoving {
            set: scene.moving,
            filter,
            answers,
            claim,
        };
        traverse(&scene.moving.tree, &mut fan, &mut moving);
    }
}

/// Which rays of a packet meet anything, as bits.
#[inline(always)]
pub(super) fn occluded<const N: usize>(
    scene: &SceneBvh<'_>,
    rays: &RayPacket<N>,
    filter: &Filter,
) -> u64 {
    let (origin, far) = (rays.origin.to_array(), rays.usable_far());
    let bvh = scene.fixed;
    let mut fan = Fan::new(
        &bvh.tree.bounds,
        origin,
        &rays.direction,
        (&rays.near_m, &far),
        1.0,
    );
    traverse(
        &bvh.tree,
        &mut fan,
        &mut Occluded {
            bvh,
            filter: *filter,
        },
    );
    if !scene.moving.is_empty() {
        fan.aim(&scene.moving.tree.bounds);
        traverse(
            &scene.moving.tree,
            &mut fan,
            &mut OccludedMoving {
                set: scene.moving,
                filter,
            },
        );
    }
    (0..N)
        .map(|k| u64::from(far[k] >= 0.0 && fan.limit[k] == f32::NEG_INFINITY) << k)
        .sum()
}

/// Rays of a packet in the space of an instance, where they lie in its box; nothing when none can meet it.
#[inline(always)]
fn enter<const N: usize>(placed: &Placed, fan: &Fan<N>, filter: &Filter) -> Option<Fan<N>> {
    if placed.is_hidden() || !filter.admits(placed.id, placed.mask) {
        return None;
    }
    let (start, mut end) = fan.range_in(&placed.bounds);
    let map = &placed.mesh_from_world;
    let origin = map.point(fan.origin);
    let mut direction = [[0.0; N]; 3];
    let [x, y, z] = &fan.direction;
    for k in 0..N {
        let local = map.vector(x[k], y[k], z[k]);
        [direction[0][k], direction[1][k], direction[2][k]] = local;
        let finite = (local[0].is_finite() & local[1].is_finite()) & local[2].is_finite();
        end[k] = if finite { end[k] } else { f32::NEG_INFINITY };
    }
    let local = Fan::new(
        &placed.mesh.tree.bounds,
        origin,
        &direction,
        (&start, &end),
        map.longest,
    );
    let finite = origin[0].is_finite() && origin[1].is_finite() && origin[2].is_finite();
    (finite && !local.is_done()).then_some(local)
}

/// [`Closest`] over the instances of a set.
struct ClosestMoving<'a, const N: usize, C> {
    set: &'a InstanceSet,
    filter: &'a Filter,
    answers: &'a mut Answers<N>,
    claim: C,
}

impl<const N: usize, C: Fn(usize, Place) -> Claim + Copy> Visit<N> for ClosestMoving<'_, N, C> {
    #[inline(always)]
    fn leaf(&mut self, fan: &mut Fan<N>, instance: usize) -> bool {
        let placed = &self.set.placed[instance];
        if let Some(mut local) = enter(placed, fan, self.filter) {
            let (bvh, source) = (&*placed.mesh, instance as u32 + 1);
            let (answers, claim) = (&mut *self.answers, self.claim);
            let mut visit = Closest {
                bvh,
                source,
                filter: self.filter.within(),
                answers,
                claim,
            };
            traverse(&bvh.tree, &mut local, &mut visit);
            for k in 0..N {
                fan.limit[k] = least(horizon(self.answers.distance[k]), fan.limit[k]);
            }
            fan.limits_changed();
        }
        false
    }
}

/// [`Occluded`] over the instances of a set.
struct OccludedMoving<'a> {
    set: &'a InstanceSet,
    filter: &'a Filter,
}

impl<const N: usize> Visit<N> for OccludedMoving<'_> {
    #[inline(always)]
    fn leaf(&mut self, fan: &mut Fan<N>, instance: usize) -> bool {
        let placed = &self.set.placed[instance];
        if let Some(mut local) = enter(placed, fan, self.filter) {
            let before = local.limit;
            traverse(
                &placed.mesh.tree,
                &mut local,
                &mut Occluded {
                    bvh: &placed.mesh,
                    filter: self.filter.within(),
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
            fan.limits_changed();
        }
        fan.is_done()
    }
}
