//! Convex pieces of a mesh, for bodies that move.

use dwell_scene::{Aabb, Collider, Mesh};
use glam::{Affine3A, Vec3};

use super::components::{ConnectedComponent, components};

/// Largest number of convex pieces of one body.
const MAX_PIECES: usize = 24;
/// Half of the least thickness of a piece, m: contact solvers lose thinner ones.
const MIN_HALF_M: f32 = 0.0025;

/// The vertices of a mesh's connected pieces, of which each gets a convex hull.
#[derive(Debug)]
pub(crate) struct HullPointSets {
    /// Vertices of each piece, mesh space; the largest first.
    points: Vec<Vec<Vec3>>,
}

/// Convex pieces that cover `mesh`: one hull for each of its [`HullPointSets`].
pub(crate) fn convex_pieces(mesh: &Mesh, part_from_mesh: &Affine3A) -> Vec<Collider> {
    HullPointSets::from_mesh(mesh).hulls(part_from_mesh)
}

impl HullPointSets {
    /// The connected pieces of `mesh`, at most 24; the smallest ones are joined to the piece whose box grows least.
    ///
    /// Models of furniture are built from boards and legs that do not touch, so this keeps the room under a table free.
    pub(crate) fn from_mesh(mesh: &Mesh) -> Self {
        let points = largest_components(mesh).into_iter().map(|piece| {
            let triangles = piece.triangles.iter();
            let mut vertices: Vec<u32> = triangles
                .flat_map(|&k| mesh.triangles[k as usize])
                .collect();
            vertices.sort_unstable();
            vertices.dedup();
            let place = |vertex: u32| mesh.positions[vertex as usize];
            vertices.into_iter().map(place).collect()
        });
        Self {
            points: points.collect(),
        }
    }

    /// A hull around each piece that no box already covers.
    pub(crate) fn hulls(&self, part_from_mesh: &Affine3A) -> Vec<Collider> {
        let mut colliders: Vec<Collider> = Vec::new();
        for piece in &self.points {
            let moved = piece
                .iter()
                .map(|point| part_from_mesh.transform_point3(*point));
            let points: Vec<Vec3> = moved.collect();
            let bounds = Aabb::from_points(points.iter().copied());
            // A piece inside another one adds nothing.
            let inside = |c: &Collider| {
                c.bounds().is_some_and(|b| {
                    matches!(c, Collider::Cuboid { .. })
                        && b.contains(bounds.min)
                        && b.contains(bounds.max)
                })
            };
            if !bounds.is_empty() && !colliders.iter().any(inside) {
                colliders.push(hull(&points, &bounds));
            }
        }
        colliders
    }
}

fn largest_components(mesh: &Mesh) -> Vec<ConnectedComponent> {
    let mut pieces = components(mesh);
    pieces.sort_by(|a, b| diagonal(&b.bounds).total_cmp(&diagonal(&a.bounds)));
    let small = pieces.split_off(pieces.len().min(MAX_PIECES));
    for piece in small {
        let growth = |seed: &Aabb| seed.union(&piece.bounds).volume() - seed.volume();
        let nearest = pieces
            .iter_mut()
            .min_by(|a, b| growth(&a.bounds).total_cmp(&growth(&b.bounds)));
        if let Some(seed) = nearest {
            seed.bounds = seed.bounds.union(&piece.bounds);
            seed.triangles.extend(piece.triangles);
        }
    }
    pieces
}

fn diagonal(bounds: &Aabb) -> f32 {
    bounds.size().length_squared()
}

/// The hull of `points`, held as its farthest points along 50 directions; a box where they span no volume.
fn hull(points: &[Vec3], bounds: &Aabb) -> Collider {
    let mut farthest: Vec<Vec3> = Vec::new();
    for direction in directions() {
        let best = points
            .iter()
            .copied()
            .max_by(|a, b| a.dot(direction).total_cmp(&b.dot(direction)));
        farthest.extend(best.filter(|point| !farthest.contains(point)));
    }
    if bounds.size().min_element() > 2.0 * MIN_HALF_M && spans_volume(&farthest) {
        return Collider::Hull { points: farthest };
    }
    let half = (bounds.size() * 0.5).max(Vec3::splat(MIN_HALF_M));
    Collider::cuboid(bounds.center() - half, bounds.center() + half)
}

/// The 26 directions to the faces, edges and corners of a cube, and 24 between them.
fn directions() -> impl Iterator<Item = Vec3> {
    let steps = (0..125).map(|k: i32| {
        Vec3::new(
            (k % 5 - 2) as f32,
            (k / 5 % 5 - 2) as f32,
            (k / 25 - 2) as f32,
        )
    });
    // Of the points of a 5 x 5 x 5 grid: those with all coordinates in -1..1, and those of the kind (2, 1, 1).
    steps.filter(|d| {
        let a = d.abs();
        let twos = [a.x, a.y, a.z].iter().filter(|x| **x > 1.5).count();
        d.length_squared() > 0.5
            && (twos == 0 || (twos == 1 && (a.element_sum() - 4.0).abs() < 0.5))
    })
}

/// Returns whether four of the points make a tetrahedron of at least 1e-9 m³ (a cube of 1 mm).
fn spans_volume(points: &[Vec3]) -> bool {
    let Some(&origin) = points.first() else {
        return false;
    };
    let far = |value: &dyn Fn(Vec3) -> f32| {
        points
            .iter()
            .copied()
            .max_by(|a, b| value(*a).total_cmp(&value(*b)))
    };
    let Some(a) = far(&|p| (p - origin).length_squared()) else {
        return false;
    };
    let Some(b) = far(&|p| (p - origin).cross(a - origin).length_squared()) else {
        return false;
    };
    let normal = (a - origin).cross(b - origin);
    far(&|p| (p - origin).dot(normal).abs())
        .is_some_and(|c| (c - origin).dot(normal).abs() / 6.0 > 1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Mesh {
        let mut mesh = Mesh::cuboid(Vec3::new(-0.5, 0.7, -0.4), Vec3::new(0.5, 0.75, 0.4));
        for (x, z) in [(-0.45, -0.35), (0.45, -0.35), (0.45, 0.35), (-0.45, 0.35)] {
            mesh.append(
                &Mesh::cuboid(
                    Vec3::new(x - 0.02, 0.0, z - 0.02),
                    Vec3::new(x + 0.02, 0.7, z + 0.02),
                ),
                0,
            );
        }
        mesh
    }

    #[test]
    fn the_room_under_a_table_stays_free() {
        let pieces = convex_pieces(&table(), &Affine3A::IDENTITY);
        assert_eq!(pieces.len(), 5);
        let under = Vec3::new(0.0, 0.3, 0.0);
        assert!(
            pieces
                .iter()
                .all(|piece| !piece.bounds().unwrap().contains(under))
        );
    }

    #[test]
    fn pieces_cover_the_mesh_after_scaling_and_mirroring() {
        let map = Affine3A::from_scale(Vec3::new(-2.0, 1.0, 0.5));
        let bounds = convex_pieces(&table(), &map)
            .iter()
            .fold(Aabb::EMPTY, |b, piece| b.union(&piece.bounds().unwrap()));
        assert_eq!(bounds, table().bounds().transformed(&map));
    }

    #[test]
    fn a_sheet_becomes_a_thin_box_and_many_pieces_are_merged() {
        let sheet = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Z],
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        };
        let pieces = convex_pieces(&sheet, &Affine3A::IDENTITY);
        assert!(
            matches!(pieces[..], [Collider::Cuboid { half_extents, .. }] if half_extents.y == MIN_HALF_M)
        );
        let mut leaves = Mesh::default();
        for k in 0..500 {
            let corner = Vec3::new((k % 10) as f32, (k / 10 % 10) as f32, (k / 100) as f32);
            leaves.append(&Mesh::cuboid(corner, corner + 0.5), 0);
        }
        assert_eq!(
            convex_pieces(&leaves, &Affine3A::IDENTITY).len(),
            MAX_PIECES
        );
    }
}
