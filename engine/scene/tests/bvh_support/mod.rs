//! Random scenes, and an oracle in double precision that shares no code with the engine.

use dwell_scene::bvh::{Hit, Instance, InstanceSet, Ray, RayMask, TriangleAttributes, TriangleBvh};
use dwell_scene::random::RandomKey;
use glam::{Affine3A, DVec3, Quat, Vec3};
use std::sync::Arc;

/// Triangles with ids.
#[derive(Clone, Debug)]
pub(crate) struct Soup {
    pub(crate) corners: Vec<[Vec3; 3]>,
    pub(crate) ids: Vec<i32>,
    center: Vec3,
}

fn tag(id: i32) -> TriangleAttributes {
    // Odd ids are for ears only.
    let mask = if id % 2 == 0 {
        RayMask::ALL
    } else {
        RayMask::EAR
    };
    TriangleAttributes { id, mask }
}

fn tree(corners: &[[Vec3; 3]], tag: impl Fn(usize) -> TriangleAttributes) -> TriangleBvh {
    let positions: Vec<Vec3> = corners.iter().flatten().copied().collect();
    let triangles: Vec<[u32; 3]> = (0..corners.len() as u32)
        .map(|k| [3 * k, 3 * k + 1, 3 * k + 2])
        .collect();
    TriangleBvh::build_tagged(&positions, &triangles, tag)
}

impl Soup {
    /// Triangles of all sizes in a box of 4 m.
    pub(crate) fn random(key: RandomKey, count: usize, center: Vec3) -> Self {
        let mut stream = key.child("soup").stream();
        let corners = (0..count).map(|_| {
            let at = center + stream.direction() * stream.range(0.0, 2.0);
            let size = 0.01 * 100.0_f32.powf(stream.uniform_f32());
            [(); 3].map(|()| at + stream.direction() * size)
        });
        let corners: Vec<_> = corners.collect();
        let ids = (0..count).map(|_| 1 + stream.below(12) as i32).collect();
        Self {
            corners,
            ids,
            center,
        }
    }

    /// Triangles in a few planes, some of them tilted: many coincide.
    pub(crate) fn flat(key: RandomKey, count: usize, center: Vec3) -> Self {
        let mut stream = key.child("flat").stream();
        let corners = (0..count).map(|_| {
            let turn = Quat::from_rotation_z(0.3 * stream.below(3) as f32);
            let height = 0.7 * stream.below(3) as f32 - 0.7;
            [(); 3].map(|()| {
                let (x, z) = (stream.range(-2.0, 2.0), stream.range(-2.0, 2.0));
                center + turn * Vec3::new(x, height, z)
            })
        });
        let corners: Vec<_> = corners.collect();
        let ids = (0..count).map(|_| 1 + stream.below(40) as i32).collect();
        Self {
            corners,
            ids,
            center,
        }
    }

    pub(crate) fn tree(&self) -> TriangleBvh {
        tree(&self.corners, |k| TriangleAttributes::new(self.ids[k]))
    }

    /// Returns the transforms of the instances of [`Self::split`].
    pub(crate) fn poses(key: RandomKey, count: usize) -> Vec<Affine3A> {
        let mut stream = key.stream();
        let pose = |_| {
            let turn = Quat::from_axis_angle(stream.direction(), stream.range(0.0, 3.0));
            let mirror = if stream.below(2) == 0 { 1.0 } else { -1.0 };
            let scale = Vec3::new(mirror, 1.0, 1.0) * stream.range(0.5, 1.5);
            Affine3A::from_scale_rotation_translation(scale, turn, stream.direction())
        };
        (0..count).map(pose).collect()
    }

    fn parts(&self) -> [Vec<usize>; 8] {
        // Triangles 0, 8, 16 ... stay; the others make seven meshes.
        std::array::from_fn(|part| (part..self.corners.len()).step_by(8).collect())
    }

    /// An eighth of the triangles as static geometry, the others as instances with ids 20 to 26.
    pub(crate) fn split(&self, key: RandomKey) -> (TriangleBvh, InstanceSet) {
        let parts = self.parts();
        let pick = |part: &[usize]| part.iter().map(|k| self.corners[*k]).collect::<Vec<_>>();
        let fixed = tree(&pick(&parts[0]), |k| tag(self.ids[parts[0][k]]));
        let poses = Self::poses(key, 7);
        let instances = parts[1..]
            .iter()
            .zip(&poses)
            .enumerate()
            .map(|(k, (part, pose))| {
                let local: Vec<_> = pick(part)
                    .iter()
                    .map(|t| t.map(|v| v - self.center))
                    .collect();
                let TriangleAttributes { id, mask } = tag(20 + k as i32);
                let world_from_mesh = Affine3A::from_translation(self.center) * *pose;
                Instance {
                    mesh: Arc::new(tree(&local, |_| TriangleAttributes::new(0))),
                    world_from_mesh,
                    id,
                    mask,
                }
            });
        (fixed, InstanceSet::new(instances))
    }

    /// Returns what [`Self::split`] makes, as plain triangles.
    pub(crate) fn baked(&self, key: RandomKey) -> Self {
        let poses = Self::poses(key, 7);
        let mut baked = Self {
            corners: Vec::new(),
            ids: Vec::new(),
            center: self.center,
        };
        for (part, triangles) in self.parts().iter().enumerate() {
            for &k in triangles {
                let place = |v: Vec3| match part {
                    0 => v,
                    _ => self.center + poses[part - 1].transform_point3(v - self.center),
                };
                baked.corners.push(self.corners[k].map(place));
                baked.ids.push(if part == 0 {
                    self.ids[k]
                } else {
                    19 + part as i32
                });
            }
        }
        baked
    }

    /// Fans of 64 rays: narrow, wide, and all around.
    pub(crate) fn fans(&self, key: RandomKey) -> Vec<Ray> {
        let mut stream = key.stream();
        let mut rays = Vec::new();
        for spread in [0.02, 0.3, 10.0] {
            let origin = self.center + stream.direction() * stream.range(0.0, 5.0);
            let ahead = self.center + stream.direction() - origin;
            for _ in 0..64 {
                let near_m = if stream.below(4) == 0 {
                    stream.range(0.0, 3.0)
                } else {
                    0.0
                };
                let far_m = if stream.below(4) == 0 {
                    stream.range(0.0, 6.0)
                } else {
                    f32::INFINITY
                };
                rays.push(
                    Ray::new(origin, ahead + stream.direction() * spread).with_range(near_m, far_m),
                );
            }
        }
        rays
    }
}

/// The same triangles in another order, each with other first corners.
pub(crate) fn permuted(soup: &Soup, key: RandomKey) -> Soup {
    let mut stream = key.stream();
    let mut order: Vec<usize> = (0..soup.ids.len()).collect();
    stream.shuffle(&mut order);
    Soup {
        corners: order.iter().map(|k| soup.corners[*k]).collect(),
        ids: order.iter().map(|k| soup.ids[*k]).collect(),
        center: soup.center,
    }
}

/// Rays from outside, from inside, along axes, and from surfaces.
pub(crate) fn rays_at(key: RandomKey, count: usize, soup: &Soup) -> Vec<Ray> {
    let mut stream = key.stream();
    let ray = |k| {
        let origin = soup.center + stream.direction() * stream.range(0.0, 6.0);
        let target = soup.center + stream.direction() * stream.range(0.0, 2.0);
        let axes = [
            Vec3::X,
            Vec3::NEG_X,
            Vec3::Y,
            Vec3::NEG_Y,
            Vec3::Z,
            Vec3::NEG_Z,
        ];
        match k % 4 {
            0 => Ray::new(target - axes[k / 4 % 6] * 5.0, axes[k / 4 % 6]),
            1 if !soup.corners.is_empty() => {
                let [a, b, c] = soup.corners[stream.below(soup.corners.len())];
                Ray::new((a + b + c) / 3.0, stream.direction()).with_range(1e-3, f32::INFINITY)
            }
            _ => Ray::new(origin, target - origin),
        }
    };
    (0..count).map(ray).collect()
}

/// Distances by Cramer's rule in double precision.
pub(crate) struct Oracle {
    corners: Vec<[DVec3; 3]>,
    ids: Vec<i32>,
}

impl Oracle {
    pub(crate) fn new(soup: &Soup) -> Self {
        Self {
            corners: soup.corners.iter().map(|t| t.map(Vec3::as_dvec3)).collect(),
            ids: soup.ids.clone(),
        }
    }

    /// Returns all hits with a margin of `slack` beyond the edges (inside them when negative): distance, id, and the error
    /// of the distance for errors of the coordinates.
    fn hits(&self, ray: &Ray, slack: f64) -> Vec<(f64, i32, f64)> {
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let mut hits = Vec::new();
        for ([a, b, c], id) in self.corners.iter().zip(&self.ids) {
            let normal = (b - a).cross(c - a);
            let slope = normal.dot(direction);
            let distance = normal.dot(a - origin) / slope;
            let point = origin + direction * distance;
            // Distances from the edges, positive inside.
            let edge = |p: &DVec3, q: &DVec3| normal.cross(q - p).normalize().dot(point - p);
            let inside = edge(a, b).min(edge(b, c)).min(edge(c, a));
            let cosine = (slope / normal.length()).abs();
            if inside > -slack / cosine.max(1e-9) && cosine > 1e-9 {
                hits.push((distance, *id, 1.0 / cosine));
            }
        }
        hits
    }

    /// Panics when `found` is not an answer that rounding could explain.
    pub(crate) fn check(&self, ray: &Ray, found: Option<Hit>) {
        let reach = self
            .corners
            .iter()
            .flatten()
            .map(|v| v.distance(ray.origin.as_dvec3()))
            .fold(1.0, f64::max);
        let rounding = 1e-6 * reach + 2e-7 * f64::from(ray.origin.abs().max_element());
        let within = |d: f64, slack: f64| {
            d >= f64::from(ray.near_m) + slack && d <= f64::from(ray.far_m) - slack
        };
        let sure = self.hits(ray, -rounding);
        let nearest_sure = sure
            .iter()
            .filter(|hit| within(hit.0, rounding * hit.2))
            .map(|hit| hit.0 + 2.0 * rounding * hit.2)
            .fold(f64::INFINITY, f64::min);
        let Some(hit) = found else {
            assert!(
                nearest_sure == f64::INFINITY,
                "{ray:?} missed a surface at {nearest_sure}"
            );
            return;
        };
        let distance = f64::from(hit.distance_m);
        assert!(
            distance <= nearest_sure,
            "{ray:?} found {hit:?} behind one at {nearest_sure}"
        );
        let possible = self.hits(ray, rounding);
        let explained = possible.iter().any(|(d, id, slope)| {
            *id == hit.id && (d - distance).abs() <= (2.0 * rounding + 4e-5) * slope
        });
        assert!(explained, "{ray:?} found {hit:?}, which is not there");
    }
}

/// A rectangle on the ground from `corner` on, cut into `cuts` by `cuts` uneven fields.
pub(crate) fn ground(corner: Vec3, size: [f32; 2], cuts: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    let part = |k: u32| (k as f32 / cuts as f32).powf(1.3);
    for z in 0..=cuts {
        for x in 0..=cuts {
            positions.push(corner + Vec3::new(size[0] * part(x), 0.0, size[1] * part(z)));
        }
    }
    for z in 0..cuts {
        for x in 0..cuts {
            let at = |x: u32, z: u32| z * (cuts + 1) + x;
            triangles.push([at(x, z), at(x, z + 1), at(x + 1, z)]);
            triangles.push([at(x + 1, z), at(x, z + 1), at(x + 1, z + 1)]);
        }
    }
    (positions, triangles)
}

/// A closed box of 2 by 2 by 2 m around `center`, each side in `cuts` by `cuts` fields with shaken corners.
pub(crate) fn room(center: Vec3, cuts: u32, key: RandomKey) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut stream = key.child("room").stream();
    let mut positions: Vec<Vec3> = Vec::new();
    let mut places: std::collections::BTreeMap<[u32; 3], u32> = std::collections::BTreeMap::new();
    let mut triangles = Vec::new();
    let mut vertex = |grid: [u32; 3]| {
        *places.entry(grid).or_insert_with(|| {
            let plain = Vec3::from_array(grid.map(|g| 2.0 * g as f32 / cuts as f32 - 1.0));
            let shaken = plain * (1.0 + 0.1 * stream.uniform_f32());
            positions.push(center + shaken);
            positions.len() as u32 - 1
        })
    };
    for axis in 0..3 {
        for side in [0, cuts] {
            for u in 0..cuts {
                for v in 0..cuts {
                    let at = |u: u32, v: u32| {
                        let mut grid = [side; 3];
                        grid[(axis + 1) % 3] = u;
                        grid[(axis + 2) % 3] = v;
                        grid
                    };
                    let [a, b, c, d] =
                        [at(u, v), at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)].map(&mut vertex);
                    triangles.extend([[a, b, c], [a, c, d]]);
                }
            }
        }
    }
    (positions, triangles)
}

/// Two meshes in one tree, with an id each.
pub(crate) fn joined(
    first: &(Vec<Vec3>, Vec<[u32; 3]>),
    second: &(Vec<Vec3>, Vec<[u32; 3]>),
    ids: [i32; 2],
) -> TriangleBvh {
    let base = first.0.len() as u32;
    let positions: Vec<Vec3> = first.0.iter().chain(&second.0).copied().collect();
    let later = second.1.iter().map(|t| t.map(|k| k + base));
    let triangles: Vec<[u32; 3]> = first.1.iter().copied().chain(later).collect();
    let count = first.1.len();
    TriangleBvh::build_tagged(&positions, &triangles, |k| {
        TriangleAttributes::new(ids[usize::from(k >= count)])
    })
}
