//! Occluders: large flat convex pieces of walls without gaps.

use super::cull::PLANE_SLACK_M;
use dwell_scene::Aabb;
use dwell_scene::bvh::flat::{BLOCK_ROWS, PackedRow};
use glam::{DVec3, Vec3, Vec4, Vec4Swizzles};
use std::collections::BTreeMap;

/// Smallest piece that may grow together with others, m².
const LEAST_PIECE_M2: f32 = 0.02;
/// Smallest piece that is used, m².
const LEAST_M2: f32 = 0.4;
/// Most corners of a piece.
const MOST_CORNERS: usize = 8;
/// Largest distance of a piece's corners from its plane, m.
const FLAT_M: f32 = 1e-5;

/// A flat convex piece of something that never moves.
#[derive(Clone, Debug)]
pub(super) struct Occluder {
    /// Corners in order around it.
    corners: Vec<Vec3>,
    /// Normal, unit length.
    normal: Vec3,
    area_m2: f32,
    pub(super) id: i32,
    pub(super) bounds: Aabb,
}

/// The volume that an occluder hides from one place: all that lies inside of its planes.
#[derive(Clone, Copy, Debug)]
pub(super) struct OcclusionVolume {
    planes: [Vec4; MOST_CORNERS + 1],
    count: usize,
}

impl OcclusionVolume {
    /// Returns whether a box lies in the shadow as a whole.
    pub(super) fn hides(&self, bounds: &Aabb) -> bool {
        let (center, half) = (bounds.center(), bounds.size() * 0.5);
        self.planes[..self.count].iter().all(|plane| {
            plane.xyz().dot(center) + plane.w - plane.xyz().abs().dot(half) > PLANE_SLACK_M
        })
    }
}

impl Occluder {
    /// Twice the area, along the normal.
    fn area_vector(corners: &[Vec3]) -> DVec3 {
        let first = corners[0].as_dvec3();
        let edges = corners.windows(2);
        edges.fold(DVec3::ZERO, |sum, pair| {
            sum + (pair[0].as_dvec3() - first).cross(pair[1].as_dvec3() - first)
        })
    }

    /// A flat convex piece; `None` for corners that make none.
    fn new(corners: Vec<Vec3>, id: i32) -> Option<Self> {
        let twice = Self::area_vector(&corners);
        let normal = twice.try_normalize()?.as_vec3();
        let count = corners.len();
        let at = |k: usize| corners[k % count];
        let fits = (0..count).all(|k| {
            let (before, here, after) = (at(k), at(k + 1), at(k + 2));
            let turn = (here - before).cross(after - here).dot(normal);
            // Straight on is convex, too.
            let straight = 1e-6 * (here - before).length() * (after - here).length();
            turn >= -straight && (here - at(0)).dot(normal).abs() <= FLAT_M
        });
        fits.then(|| Self {
            area_m2: (twice.length() * 0.5) as f32,
            normal,
            id,
            bounds: Aabb::from_points(corners.iter().copied()),
            corners,
        })
    }

    /// The approximate solid angle that it subtends at a point, sr.
    pub(super) fn solid_angle_sr(&self, eye: Vec3) -> f32 {
        let way = self.bounds.center() - eye;
        let squared = way.length_squared().max(0.01);
        self.area_m2 * (self.normal.dot(way).abs() / squared.sqrt()) / squared
    }

    /// Returns the volume that it hides from a point; `None` where parts of it may be nearer than `near_m`, where they are not seen.
    pub(super) fn occlusion_volume(&self, eye: Vec3, near_m: f32) -> Option<OcclusionVolume> {
        let height = self.normal.dot(self.corners[0] - eye);
        if height.abs() < near_m.max(0.01) {
            return None;
        }
        let mut shadow = OcclusionVolume {
            planes: [Vec4::ZERO; MOST_CORNERS + 1],
            count: self.corners.len() + 1,
        };
        // Away from the eye, behind the piece.
        let side = height.signum();
        let away = self.normal * side;
        shadow.planes[0] = away.extend(-away.dot(self.corners[0]));
        for (k, corner) in self.corners.iter().enumerate() {
            let next = self.corners[(k + 1) % self.corners.len()];
            let normal = ((*corner - eye).cross(next - eye) * side).try_normalize()?;
            shadow.planes[k + 1] = normal.extend(-normal.dot(eye));
        }
        Some(shadow)
    }

    /// Joins two pieces, where they share an edge and the result is flat and convex.
    fn joined(&self, other: &Self) -> Option<Self> {
        let (a, b) = (&self.corners, &other.corners);
        if self.id != other.id || a.len() + b.len() - 2 > MOST_CORNERS {
            return None;
        }
        let turned: Vec<Vec3> = if self.normal.dot(other.normal) > 0.0 {
            b.clone()
        } else {
            b.iter().rev().copied().collect()
        };
        // The edge from a[k] to a[k + 1] runs the other way around the other piece.
        let next = |corners: &[Vec3], k: usize| corners[(k + 1) % corners.len()];
        let (k, j) = (0..a.len()).find_map(|k| {
            let same = |j: &usize| turned[*j] == next(a, k) && next(&turned, *j) == a[k];
            (0..turned.len()).find(same).map(|j| (k, j))
        })?;
        let mut corners: Vec<Vec3> = (1..=a.len()).map(|step| a[(k + step) % a.len()]).collect();
        let rest = 2..turned.len();
        corners.extend(rest.map(|step| turned[(j + step) % turned.len()]));
        Self::new(corners, self.id)
    }
}

/// An edge by the bits of its ends, the smaller end first.
type EdgeKey = [[u32; 3]; 2];

fn edge(a: Vec3, b: Vec3) -> EdgeKey {
    // Zeros have two signs.
    let bits = |p: Vec3| (p + 0.0).to_array().map(f32::to_bits);
    let (a, b) = (bits(a), bits(b));
    if a <= b { [a, b] } else { [b, a] }
}

/// The walls and other large flat pieces of geometry in rows of blocks, joined where they share whole edges.
pub(super) fn occluders(blocks: &[PackedRow]) -> Vec<Occluder> {
    let mut pieces: Vec<Option<Occluder>> = Vec::new();
    for rows in blocks.chunks_exact(BLOCK_ROWS) {
        for lane in (0..4).filter(|lane| rows[13][*lane] != u32::MAX) {
            let corner = |k: usize| {
                let coordinate = |axis: usize| f32::from_bits(rows[3 * k + axis][lane]);
                Vec3::new(coordinate(0), coordinate(1), coordinate(2))
            };
            let corners = vec![corner(0), corner(1), corner(2)];
            let piece = Occluder::new(corners, rows[12][lane] as i32);
            pieces.extend(
                piece
                    .filter(|piece| piece.area_m2 > LEAST_PIECE_M2)
                    .map(Some),
            );
        }
    }
    // The piece at each edge that waits for a neighbour.
    let mut waiting: BTreeMap<EdgeKey, usize> = BTreeMap::new();
    let mut open: Vec<usize> = (0..pieces.len()).collect();
    while let Some(k) = open.pop() {
        let Some(piece) = pieces[k].clone() else {
            continue;
        };
        let count = piece.corners.len();
        for step in 0..count {
            let edge = edge(piece.corners[step], piece.corners[(step + 1) % count]);
            let other = waiting.insert(edge, k).filter(|other| *other != k);
            let Some(other) = other else { continue };
            let joined = pieces[other].as_ref().and_then(|other| piece.joined(other));
            if let Some(joined) = joined {
                (pieces[k], pieces[other]) = (None, None);
                open.push(pieces.len());
                pieces.push(Some(joined));
                break;
            }
        }
    }
    let large = |piece: &Occluder| piece.area_m2 >= LEAST_M2;
    pieces.into_iter().flatten().filter(large).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(triangles: &[[Vec3; 3]]) -> Vec<PackedRow> {
        let positions: Vec<Vec3> = triangles.as_flattened().to_vec();
        let count = triangles.len() as u32;
        let indices: Vec<[u32; 3]> = (0..count).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let tree = dwell_scene::bvh::TriangleBvh::build(&positions, &indices);
        let mut blocks = Vec::new();
        tree.flatten(dwell_scene::bvh::RayMask::EYE, &mut Vec::new(), &mut blocks);
        blocks
    }

    /// A wall of 3 by 2 m across Z at 1, of two triangles.
    fn wall() -> [[Vec3; 3]; 2] {
        let at = |x: f32, y: f32| Vec3::new(x, y, 1.0);
        [
            [at(0.0, 0.0), at(3.0, 0.0), at(3.0, 2.0)],
            [at(0.0, 0.0), at(0.0, 2.0), at(3.0, 2.0)],
        ]
    }

    #[test]
    fn two_triangles_make_a_wall_that_hides_what_is_behind() {
        let found = occluders(&rows(&wall()));
        let [wall] = &found[..] else {
            panic!("{} pieces", found.len())
        };
        assert!((wall.area_m2 - 6.0).abs() < 1e-5 && wall.corners.len() == 4);
        let shadow = wall
            .occlusion_volume(Vec3::new(1.5, 1.0, 3.0), 0.1)
            .unwrap();
        let around = |x: f32, y: f32, z: f32, half: f32| {
            let middle = Vec3::new(x, y, z);
            Aabb::new(middle - half, middle + half)
        };
        // Across the diagonal, behind the middle.
        assert!(shadow.hides(&around(1.5, 1.0, 0.0, 0.3)));
        // Before it, through it, beside its shadow, and half beside.
        for seen in [
            around(1.5, 1.0, 2.0, 0.3),
            around(1.5, 1.0, 1.0, 0.3),
            around(6.0, 1.0, 0.0, 0.3),
            around(3.7, 1.0, 0.0, 0.3),
        ] {
            assert!(!shadow.hides(&seen), "{seen:?}");
        }
        // Too near to be seen as a whole.
        assert!(
            wall.occlusion_volume(Vec3::new(1.5, 1.0, 1.05), 0.1)
                .is_none()
        );
    }

    #[test]
    fn pieces_with_a_gap_or_a_bend_stay_apart() {
        let [a, b] = wall();
        let moved = b.map(|p| p + Vec3::Y * 1e-4);
        assert_eq!(occluders(&rows(&[a, moved])).len(), 2);
        let [x, y, z] = b;
        let bent = [x, y + Vec3::Z * 0.1, z];
        assert_eq!(occluders(&rows(&[a, bent])).len(), 2);
    }
}
