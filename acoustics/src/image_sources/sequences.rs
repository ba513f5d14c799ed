//! Candidate sequences of mirrors.

use crate::planes::{NO_PLANE, Plane};
use crate::propagation_scene::PropagationScene;
use crate::ray_margin::ray_offset_m;
use crate::sphere_sequences::fibonacci_direction;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::rays::RayScene;
use glam::{DVec3, Vec3};
use std::collections::BTreeSet;

/// Most sequences of one order that are tried exhaustively.
const EXHAUSTIVE_LIMIT: usize = 20_000;

/// Distance below which a source on a mirror has no image in it, m.
const ON_PLANE_M: f64 = 1e-6;

/// Calls `visit(planes, images)` once for each sequence: the mirrors from the source on, and the image behind each.
///
/// Candidates are all sequences of the largest planes, as long as an order has not too many of them, and those of rays from
/// the receiver.
pub(super) fn for_each_plane_sequence(
    data: &PropagationScene,
    rays: &RayScene,
    source: Vec3,
    receiver: Vec3,
    mut visit: impl FnMut(&[u32], &[DVec3]),
) {
    let config = data.config();
    let largest = data.plane_table().largest_static_planes();
    let tried = &largest[..largest.len().min(config.image_planes)];
    let mut exhaustive = 0;
    let mut count = 1;
    while exhaustive < config.image_order && count * tried.len() <= EXHAUSTIVE_LIMIT {
        count *= tried.len();
        exhaustive += 1;
    }
    let source = source.as_dvec3();
    if exhaustive > 0 && !tried.is_empty() {
        let mut walk = SequenceSearch {
            planes: data.planes(),
            tried,
            order: exhaustive,
            sequence: Vec::new(),
            images: vec![source],
        };
        walk.descend(&mut visit);
    }
    let mut images = Vec::new();
    for sequence in ray_traced_sequences(data, rays, receiver) {
        let known = sequence.len() <= exhaustive && sequence.iter().all(|p| tried.contains(p));
        if !known && compute_images(data.planes(), source, &sequence, &mut images) {
            visit(&sequence, &images);
        }
    }
}

/// Computes the images of `source` behind each mirror in turn; false where one lies on its mirror.
pub(super) fn compute_images(
    planes: &[Plane],
    source: DVec3,
    sequence: &[u32],
    images: &mut Vec<DVec3>,
) -> bool {
    images.clear();
    let mut image = source;
    for id in sequence {
        let Some(plane) = planes.get(*id as usize) else {
            return false;
        };
        if plane.distance_m(image).abs() < ON_PLANE_M {
            return false;
        }
        image = plane.mirror(image);
        images.push(image);
    }
    true
}

struct SequenceSearch<'a> {
    planes: &'a [Plane],
    tried: &'a [u32],
    order: usize,
    sequence: Vec<u32>,
    /// The source, then its images.
    images: Vec<DVec3>,
}

impl SequenceSearch<'_> {
    fn descend(&mut self, visit: &mut impl FnMut(&[u32], &[DVec3])) {
        let Some(&image) = self.images.last() else {
            return;
        };
        for id in self.tried {
            let plane = &self.planes[*id as usize];
            if self.sequence.last() == Some(id) || plane.distance_m(image).abs() < ON_PLANE_M {
                continue;
            }
            self.sequence.push(*id);
            self.images.push(plane.mirror(image));
            visit(&self.sequence, &self.images[1..]);
            if self.sequence.len() < self.order {
                self.descend(visit);
            }
            self.sequence.pop();
            self.images.pop();
        }
    }
}

/// Returns the sequences, from the source on, of specular rays from the receiver.
fn ray_traced_sequences(
    data: &PropagationScene,
    rays: &RayScene,
    receiver: Vec3,
) -> BTreeSet<Vec<u32>> {
    let config = data.config();
    let mut found = BTreeSet::new();
    for k in 0..config.discovery_rays {
        let mut ray = Ray::new(receiver, fibonacci_direction(k, config.discovery_rays));
        let mut backwards: Vec<u32> = Vec::with_capacity(config.image_order);
        for _ in 0..config.image_order {
            let Some(hit) = rays.closest(&ray, RayMask::EAR) else {
                break;
            };
            let id = data.plane_table().plane_of_hit(data.house(), &hit);
            if id == NO_PLANE || backwards.last() == Some(&id) {
                break;
            }
            backwards.push(id);
            found.insert(backwards.iter().rev().copied().collect());
            let normal = data.planes()[id as usize].normal.as_vec3();
            let point = ray.point_at(hit.distance_m);
            let direction = ray.direction - 2.0 * ray.direction.dot(normal) * normal;
            ray = Ray::new(point, direction).with_range(ray_offset_m(point), f32::INFINITY);
        }
    }
    found
}
