//! Triangulation of directions on the sphere: their convex hull.

use glam::{DVec3, Vec3};

/// Displacement of points off the sphere, so that no four lie in one plane: rings of equal height would.
const JITTER: f64 = 1e-8;
/// Starting points of the search: cells along the edge of a cube's side.
const CELLS: usize = 16;

/// Triangles that cover the sphere, anticlockwise seen from outside.
#[derive(Debug)]
pub(super) struct Triangulation {
    triangles: Vec<HullTriangle>,
    /// A triangle near each cell of a cube around the sphere. Shape (side, cell, cell), flat.
    near: Vec<u32>,
}

#[derive(Debug)]
struct HullTriangle {
    corners: [u32; 3],
    /// Neighbour across the edge opposite to each corner.
    neighbours: [u32; 3],
    /// Vectors whose products with a direction are its weights of the corners, up to a common factor.
    weighers: [Vec3; 3],
}

/// A face of the growing hull.
#[derive(Clone, Copy)]
struct HullFace {
    corners: [u32; 3],
    neighbours: [u32; 3],
    alive: bool,
}

impl Triangulation {
    /// Triangulates unit vectors that are at least 5e-4 apart and have the origin within their hull; `None` for others.
    ///
    /// # Source
    /// The incremental convex hull: M. de Berg et al., *Computational Geometry* (2008), chapter 11. On a sphere it is the Delaunay
    /// triangulation.
    pub(super) fn new(points: &[DVec3]) -> Option<Self> {
        let lifted: Vec<DVec3> = points
            .iter()
            .enumerate()
            .map(|(k, p)| *p * (1.0 + JITTER * hash_jitter(k)))
            .collect();
        let faces = hull(&lifted)?;
        // Only the remaining faces, renumbered.
        let mut number = vec![u32::MAX; faces.len()];
        let mut count = 0;
        for (face, number) in faces.iter().zip(&mut number) {
            if face.alive {
                *number = count;
                count += 1;
            }
        }
        let mut triangles = Vec::with_capacity(count as usize);
        for face in faces.iter().filter(|face| face.alive) {
            let [a, b, c] = face.corners.map(|k| points[k as usize]);
            let volume = a.dot(b.cross(c));
            if volume <= 1e-12 {
                return None;
            }
            let weighers = [b.cross(c), c.cross(a), a.cross(b)];
            triangles.push(HullTriangle {
                corners: face.corners,
                neighbours: face.neighbours.map(|k| number[k as usize]),
                weighers: weighers.map(|w| (w / volume).as_vec3()),
            });
        }
        let mut mesh = Self {
            triangles,
            near: Vec::new(),
        };
        let mut near = Vec::with_capacity(6 * CELLS * CELLS);
        let mut from = 0;
        for side in 0..6 {
            for cell in 0..CELLS * CELLS {
                from = mesh.walk(from, middle(side, cell / CELLS, cell % CELLS)).0;
                near.push(from);
            }
        }
        mesh.near = near;
        Some(mesh)
    }

    /// Returns the number of triangles.
    pub(super) fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Returns the three points around a direction, and their weights, which sum to 1.
    pub(super) fn locate(&self, direction: Vec3) -> ([u32; 3], [f32; 3]) {
        let start = self.near[cell_of(direction)];
        let (found, weights) = self.walk(start, direction);
        let weights = weights.map(|w| w.max(0.0));
        let sum: f32 = weights.iter().sum();
        let corners = self.triangles[found as usize].corners;
        if sum > 0.0 {
            (corners, weights.map(|w| w / sum))
        } else {
            (corners, [1.0, 0.0, 0.0])
        }
    }

    /// Walks from triangle to triangle, across the edge that the direction is furthest beyond.
    fn walk(&self, start: u32, direction: Vec3) -> (u32, [f32; 3]) {
        let weigh = |k: u32| {
            self.triangles[k as usize]
                .weighers
                .map(|w| w.dot(direction))
        };
        let lowest = |weights: &[f32; 3]| {
            let ends = weights[0].min(weights[1]).min(weights[2]);
            let place = weights.iter().position(|w| *w == ends).unwrap_or(0);
            (place, ends)
        };
        let mut at = start;
        for _ in 0..self.triangles.len() {
            let weights = weigh(at);
            let (place, least) = lowest(&weights);
            if least >= -1e-6 {
                return (at, weights);
            }
            at = self.triangles[at as usize].neighbours[place];
        }
        // Rounding can make a walk circle along a sliver: then the best of all is used.
        let all = 0..self.triangles.len() as u32;
        let best = all.max_by(|a, b| lowest(&weigh(*a)).1.total_cmp(&lowest(&weigh(*b)).1));
        let best = best.unwrap_or(0);
        (best, weigh(best))
    }
}

/// Returns a number from -1 to 1 that is uncorrelated with those of `k`'s neighbours.
fn hash_jitter(k: usize) -> f64 {
    let bits = xxhash_rust::xxh3::xxh3_64(&(k as u64).to_le_bytes());
    (bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// Returns six times the volume of a tetrahedron; positive where `d` is beyond the side from which a, b, c are anticlockwise.
fn orient3d(points: &[DVec3], [a, b, c]: [u32; 3], d: u32) -> f64 {
    let [a, b, c, d] = [a, b, c, d].map(|k| points[k as usize]);
    (b - a).cross(c - a).dot(d - a)
}

/// Returns four points that span a volume.
fn first_four(points: &[DVec3]) -> Option<[u32; 4]> {
    let furthest = |measure: &dyn Fn(DVec3) -> f64| {
        let all = 0..points.len() as u32;
        all.max_by(|a, b| measure(points[*a as usize]).total_cmp(&measure(points[*b as usize])))
    };
    let a = *points.first()?;
    let second = furthest(&|p| p.distance(a))?;
    let b = points[second as usize];
    let third = furthest(&|p| (b - a).cross(p - a).length())?;
    let c = points[third as usize];
    let normal = (b - a).cross(c - a);
    let fourth = furthest(&|p| normal.dot(p - a).abs())?;
    (normal.dot(points[fourth as usize] - a).abs() > 1e-6).then_some([0, second, third, fourth])
}

/// Returns the hull's faces, with removed ones between.
fn hull(points: &[DVec3]) -> Option<Vec<HullFace>> {
    let [a, b, c, d] = first_four(points)?;
    // Turned so that d lies behind a, b, c.
    let (b, c) = if orient3d(points, [a, b, c], d) > 0.0 {
        (c, b)
    } else {
        (b, c)
    };
    let face = |corners, neighbours| HullFace {
        corners,
        neighbours,
        alive: true,
    };
    let mut faces = vec![
        face([a, b, c], [2, 3, 1]),
        face([a, d, b], [2, 0, 3]),
        face([b, d, c], [3, 0, 1]),
        face([c, d, a], [1, 0, 2]),
    ];
    let mut free: Vec<u32> = Vec::new();
    let mut visible = Vec::new();
    // The new face whose rim edge starts at a point. Shape (point,).
    let mut begins = vec![u32::MAX; points.len()];
    for point in 0..points.len() as u32 {
        if [a, b, c, d].contains(&point) {
            continue;
        }
        visible.clear();
        let alive = (0_u32..).zip(&faces).filter(|(_, face)| face.alive);
        visible.extend(
            alive
                .filter(|(_, face)| orient3d(points, face.corners, point) > 0.0)
                .map(|(k, _)| k),
        );
        for k in &visible {
            faces[*k as usize].alive = false;
        }
        // The rim of the visible faces, edge by edge: from u to v, with the face behind it.
        let mut rim = Vec::new();
        for k in &visible {
            let HullFace {
                corners,
                neighbours,
                ..
            } = faces[*k as usize];
            for side in 0..3 {
                let behind = neighbours[side];
                if faces[behind as usize].alive {
                    rim.push((corners[(side + 1) % 3], corners[(side + 2) % 3], behind));
                }
            }
        }
        free.extend_from_slice(&visible);
        let mut made = Vec::with_capacity(rim.len());
        for (u, v, behind) in &rim {
            let new = face([*u, *v, point], [u32::MAX, u32::MAX, *behind]);
            let k = if let Some(k) = free.pop() {
                faces[k as usize] = new;
                k
            } else {
                faces.push(new);
                faces.len() as u32 - 1
            };
            begins[*u as usize] = k;
            made.push((k, *u, *v, *behind));
        }
        for (k, u, v, behind) in &made {
            // Across the edge from v to the point lies the face whose rim begins at v.
            let next = begins[*v as usize];
            faces[*k as usize].neighbours[0] = next;
            faces[next as usize].neighbours[1] = *k;
            let other = &mut faces[*behind as usize];
            for side in 0..3 {
                if other.corners[(side + 1) % 3] == *v && other.corners[(side + 2) % 3] == *u {
                    other.neighbours[side] = *k;
                }
            }
        }
    }
    Some(faces)
}

/// Returns the cell of the cube that a direction points into.
fn cell_of(direction: Vec3) -> usize {
    let size = direction.abs();
    let (side, long, u, v) = if size.x >= size.y && size.x >= size.z {
        (0, direction.x, direction.y, direction.z)
    } else if size.y >= size.z {
        (1, direction.y, direction.z, direction.x)
    } else {
        (2, direction.z, direction.x, direction.y)
    };
    let place = |x: f32| {
        let part = 0.5 * (x / long.abs().max(1e-12) + 1.0);
        ((part * CELLS as f32) as usize).min(CELLS - 1)
    };
    let side = 2 * side + usize::from(long < 0.0);
    (side * CELLS + place(u)) * CELLS + place(v)
}

/// Returns the direction to the middle of a cell, unit length.
fn middle(side: usize, u: usize, v: usize) -> Vec3 {
    let place = |k: usize| 2.0 * (k as f32 + 0.5) / CELLS as f32 - 1.0;
    let (u, v, long) = (
        place(u),
        place(v),
        if side.is_multiple_of(2) { 1.0 } else { -1.0 },
    );
    let towards = match side / 2 {
        0 => Vec3::new(long, u, v),
        1 => Vec3::new(v, long, u),
        _ => Vec3::new(u, v, long),
    };
    towards / towards.length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::RandomKey;

    /// Rings of equal height, as most measurements have them, and a pole.
    fn rings() -> Vec<DVec3> {
        let mut points = vec![DVec3::Y];
        for height_deg in (-80..=80).step_by(10) {
            let (y, r) = libm::sincos(f64::from(height_deg).to_radians());
            let count = (36.0 * r).round().max(3.0) as usize;
            for k in 0..count {
                let (s, c) = libm::sincos(std::f64::consts::TAU * k as f64 / count as f64);
                points.push(DVec3::new(r * s, y, r * c));
            }
        }
        points.push(DVec3::NEG_Y);
        points
    }

    fn scattered(count: usize) -> Vec<DVec3> {
        let mut stream = RandomKey::root(5).stream();
        (0..count)
            .map(|_| {
                let d = stream.direction().as_dvec3();
                d / d.length()
            })
            .collect()
    }

    /// Euler: 2 n - 4 triangles over n points, each neighbour's neighbour is itself, and no point lies within the circle of a
    /// triangle.
    #[test]
    fn triangles_cover_the_sphere_and_are_delaunays() {
        for points in [rings(), scattered(300), scattered(4), scattered(5)] {
            let Some(mesh) = Triangulation::new(&points) else {
                assert!(points.len() < 6);
                continue;
            };
            assert_eq!(mesh.len(), 2 * points.len() - 4);
            for (k, triangle) in (0_u32..).zip(&mesh.triangles) {
                for side in 0..3 {
                    let other = &mesh.triangles[triangle.neighbours[side] as usize];
                    assert!(other.neighbours.contains(&k));
                    assert!(!other.corners.contains(&triangle.corners[side]));
                }
                for point in 0..points.len() as u32 {
                    assert!(orient3d(&points, triangle.corners, point) < 1e-7);
                }
            }
        }
    }

    #[test]
    fn every_direction_is_among_its_three_points() {
        for points in [rings(), scattered(300)] {
            let mesh = Triangulation::new(&points).unwrap();
            let mut stream = RandomKey::root(6).stream();
            for _ in 0..5000 {
                let direction = stream.direction();
                let (corners, weights) = mesh.locate(direction);
                let sum: DVec3 = corners
                    .iter()
                    .zip(weights)
                    .map(|(k, w)| points[*k as usize] * f64::from(w))
                    .sum();
                assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-5);
                let found = (sum / sum.length()).as_vec3();
                assert!(found.distance(direction) < 1e-4, "{direction} {found}");
            }
            for (k, point) in (0_u32..).zip(&points) {
                let (corners, weights) = mesh.locate(point.as_vec3());
                let own = corners
                    .iter()
                    .zip(weights)
                    .find(|(corner, _)| **corner == k);
                assert!(own.is_some_and(|(_, weight)| weight > 0.999), "{point}");
            }
        }
    }

    #[test]
    fn half_a_sphere_is_refused() {
        let upper: Vec<DVec3> = scattered(50).into_iter().filter(|p| p.y > 0.1).collect();
        assert!(Triangulation::new(&upper).is_none());
        assert!(Triangulation::new(&upper[..2]).is_none());
    }
}
