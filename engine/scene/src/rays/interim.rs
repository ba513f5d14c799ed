//! Traversal until the real kernels land: a median-split tree, one ray at a time.

use crate::bounds::Aabb;
use crate::bvh::{Hit, Ray, RayMask};
use crate::house::Geometry;
use crate::ids::EntityId;
use crate::mesh::Mesh;
use glam::{Affine3A, Vec3};
use std::sync::Arc;

#[derive(Clone, Debug)]
struct Node {
    bounds: Aabb,
    first: u32,
    count: u32,
}

/// A tree over triangles.
#[derive(Debug, Default)]
pub struct Tree {
    nodes: Vec<Node>,
    order: Vec<u32>,
    corners: Vec<[Vec3; 3]>,
    ids: Vec<i32>,
}

impl Tree {
    pub(crate) fn build(mesh: &Mesh, id: impl Fn(usize) -> i32) -> Self {
        let corners: Vec<[Vec3; 3]> = (0..mesh.triangles.len()).map(|k| mesh.corners(k)).collect();
        let mut order: Vec<u32> = (0..corners.len() as u32).collect();
        let ids = (0..corners.len()).map(id).collect();
        let mut nodes = Vec::new();
        if !order.is_empty() {
            let end = order.len();
            split(&corners, &mut order, 0, end, &mut nodes);
        }
        Self {
            nodes,
            order,
            corners,
            ids,
        }
    }

    fn bounds(&self) -> Aabb {
        self.nodes.first().map_or(Aabb::EMPTY, |node| node.bounds)
    }

    fn visit(&self, ray: &Ray, far_m: &mut f32, mut found: impl FnMut(u32, f32, f32, f32) -> bool) {
        let inverse = ray.direction.recip();
        let mut stack = vec![0_usize];
        while let Some(k) = stack.pop() {
            let Some(node) = self.nodes.get(k) else {
                continue;
            };
            let (t0, t1) = (
                (node.bounds.min - ray.origin) * inverse,
                (node.bounds.max - ray.origin) * inverse,
            );
            let near = t0.min(t1).max_element().max(ray.near_m);
            let far = t0.max(t1).min_element() * 1.000_01 + 1e-4;
            if !(near <= far && near <= *far_m + 1e-4) {
                continue;
            }
            if node.count == 0 {
                stack.extend([node.first as usize, k + 1]);
                continue;
            }
            for &triangle in &self.order[node.first as usize..(node.first + node.count) as usize] {
                let [a, b, c] = self.corners[triangle as usize];
                let (e1, e2) = (b - a, c - a);
                let p = ray.direction.cross(e2);
                let determinant = e1.dot(p);
                if determinant.abs() < 1e-20 {
                    continue;
                }
                let s = (ray.origin - a) / determinant;
                let u = s.dot(p);
                let q = s.cross(e1);
                let v = ray.direction.dot(q);
                let t = e2.dot(q);
                let inside = u >= -1e-6 && v >= -1e-6 && u + v <= 1.0 + 1e-6;
                if inside && t >= ray.near_m && t <= ray.far_m && found(triangle, t, u, v) {
                    return;
                }
            }
        }
    }
}

fn split(
    corners: &[[Vec3; 3]],
    order: &mut [u32],
    start: usize,
    end: usize,
    nodes: &mut Vec<Node>,
) {
    let part = &mut order[start..end];
    let bounds = Aabb::from_points(part.iter().flat_map(|k| corners[*k as usize]));
    let place = nodes.len();
    nodes.push(Node {
        bounds,
        first: start as u32,
        count: part.len() as u32,
    });
    if part.len() <= 4 {
        return;
    }
    let axis = bounds.size().max_position();
    let center = |k: u32| corners[k as usize].iter().map(|p| p[axis]).sum::<f32>();
    part.sort_by(|a, b| center(*a).total_cmp(&center(*b)));
    let middle = usize::midpoint(start, end);
    nodes[place].count = 0;
    split(corners, order, start, middle, nodes);
    nodes[place].first = nodes.len() as u32;
    split(corners, order, middle, end, nodes);
}

/// Moving parts.
#[derive(Clone, Debug, Default)]
pub(super) struct Instances {
    items: Vec<(Aabb, Affine3A, Affine3A, Arc<Tree>, i32)>,
}

impl Instances {
    pub(super) fn rebuild(&mut self, geometry: &Geometry, world_from_mesh: &[Affine3A]) {
        self.items.clear();
        for (part, place) in geometry.movable.iter().zip(world_from_mesh) {
            let placed = geometry.placed_part(*part);
            if let Some(tree) = &geometry.mesh_bvh[placed.mesh] {
                let bounds = tree.bounds().transformed(place).grown(1e-3);
                self.items.push((
                    bounds,
                    *place,
                    place.inverse(),
                    tree.clone(),
                    placed.entity.0,
                ));
            }
        }
    }

    fn each(
        &self,
        geometry: &Geometry,
        ray: &Ray,
        hidden: EntityId,
        mut found: impl FnMut(Hit) -> bool,
    ) {
        let mut far_m = ray.far_m;
        let mut stop = false;
        let tree = &geometry.static_bvh;
        tree.visit(ray, &mut far_m, |triangle, distance_m, u, v| {
            let id = tree.ids[triangle as usize];
            stop = id != hidden.0
                && found(Hit {
                    distance_m,
                    u,
                    v,
                    id,
                    instance: None,
                    triangle,
                });
            stop
        });
        for (k, (_, _, mesh_from_world, tree, id)) in self.items.iter().enumerate() {
            if stop || *id == hidden.0 {
                continue;
            }
            let local = Ray {
                origin: mesh_from_world.transform_point3(ray.origin),
                direction: mesh_from_world.transform_vector3(ray.direction),
                ..*ray
            };
            tree.visit(&local, &mut far_m, |triangle, distance_m, u, v| {
                stop = found(Hit {
                    distance_m,
                    u,
                    v,
                    id: *id,
                    instance: Some(k as u32),
                    triangle,
                });
                stop
            });
        }
    }

    pub(super) fn closest(
        &self,
        geometry: &Geometry,
        ray: &Ray,
        _mask: RayMask,
        hidden: EntityId,
    ) -> Option<Hit> {
        let mut hits = Vec::new();
        self.each(geometry, ray, hidden, |hit| {
            hits.push(hit);
            false
        });
        let nearest = hits
            .iter()
            .map(|hit| hit.distance_m)
            .fold(f32::INFINITY, f32::min);
        hits.retain(|hit| hit.distance_m <= nearest + 1e-5 + 1e-6 * nearest);
        hits.into_iter().min_by_key(|hit| (hit.id, hit.triangle))
    }

    pub(super) fn occluded(&self, geometry: &Geometry, ray: &Ray, _mask: RayMask) -> bool {
        let mut blocked = false;
        self.each(geometry, ray, EntityId::VOID, |_| {
            blocked = true;
            true
        });
        blocked
    }
}
