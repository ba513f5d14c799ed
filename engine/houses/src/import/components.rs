//! Connected pieces of a mesh.

use dwell_scene::{Aabb, Mesh};
use glam::Vec3;

/// Connected triangles.
#[derive(Debug, Clone)]
pub(crate) struct ConnectedComponent {
    /// Indices of its triangles, rising.
    pub(crate) triangles: Vec<u32>,
    /// The box around them, mesh space.
    pub(crate) bounds: Aabb,
}

/// The connected pieces of `mesh`, ordered by their first triangle. Vertices at exactly the same place are one.
pub(crate) fn components(mesh: &Mesh) -> Vec<ConnectedComponent> {
    let welded = weld(&mesh.positions);
    let mut parent: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|vertex| find(&mut parent, welded[vertex as usize]));
        let root = a.min(b).min(c);
        for other in [a, b, c] {
            parent[other as usize] = root;
        }
    }
    // Several roots may have been joined after a triangle was seen, so the pieces are read in a second pass.
    let mut piece_of_root = vec![u32::MAX; parent.len()];
    let mut pieces: Vec<ConnectedComponent> = Vec::new();
    for (k, triangle) in mesh.triangles.iter().enumerate() {
        let root = find(&mut parent, welded[triangle[0] as usize]) as usize;
        if piece_of_root[root] == u32::MAX {
            piece_of_root[root] = pieces.len() as u32;
            pieces.push(ConnectedComponent {
                triangles: Vec::new(),
                bounds: Aabb::EMPTY,
            });
        }
        let piece = &mut pieces[piece_of_root[root] as usize];
        piece.triangles.push(k as u32);
        mesh.corners(k)
            .into_iter()
            .for_each(|corner| piece.bounds.add_point(corner));
    }
    pieces
}

fn find(parent: &mut [u32], mut vertex: u32) -> u32 {
    while parent[vertex as usize] != vertex {
        parent[vertex as usize] = parent[parent[vertex as usize] as usize];
        vertex = parent[vertex as usize];
    }
    vertex
}

/// For each vertex the first vertex at the same place.
fn weld(positions: &[Vec3]) -> Vec<u32> {
    // Adding 0 makes -0 and 0 the same place.
    let key = |vertex: u32| {
        (positions[vertex as usize] + Vec3::ZERO)
            .to_array()
            .map(f32::to_bits)
    };
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    order.sort_unstable_by_key(|&vertex| (key(vertex), vertex));
    let mut first = vec![0; positions.len()];
    for pair in order.chunk_by(|&a, &b| key(a) == key(b)) {
        for &vertex in pair {
            first[vertex as usize] = pair[0];
        }
    }
    first
}

/// The part of `mesh` that `triangles` make; slots stay as they are.
pub(crate) fn submesh(mesh: &Mesh, triangles: &[u32]) -> Mesh {
    let mut new_of_old = vec![u32::MAX; mesh.positions.len()];
    let mut part = Mesh::default();
    for &k in triangles {
        let triangle = mesh.triangles[k as usize].map(|old| {
            let new = &mut new_of_old[old as usize];
            if *new == u32::MAX {
                *new = part.positions.len() as u32;
                part.positions.push(mesh.positions[old as usize]);
                part.normals.extend(mesh.normals.get(old as usize));
                part.uvs.extend(mesh.uvs.get(old as usize));
            }
            *new
        });
        part.triangles.push(triangle);
        part.slots.extend(mesh.slots.get(k as usize));
    }
    part
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_boxes_are_two_pieces_and_together_the_mesh() {
        let mut mesh = Mesh::cuboid(Vec3::ZERO, Vec3::ONE);
        mesh.append(&Mesh::cuboid(Vec3::splat(2.0), Vec3::splat(3.0)), 1);
        let pieces = components(&mesh);
        assert_eq!(pieces.len(), 2);
        let second = submesh(&mesh, &pieces[1].triangles);
        assert_eq!(
            second.bounds(),
            Aabb::new(Vec3::splat(2.0), Vec3::splat(3.0))
        );
        assert_eq!(
            (
                second.triangles.len(),
                second.positions.len(),
                second.slots[0]
            ),
            (12, 24, 1)
        );
        second.check("second").unwrap();
    }

    #[test]
    fn pieces_joined_by_a_late_triangle_are_one() {
        let mut mesh = Mesh::cuboid(Vec3::ZERO, Vec3::ONE);
        mesh.append(&Mesh::cuboid(Vec3::splat(2.0), Vec3::splat(3.0)), 0);
        mesh.triangles.push([0, 1, 24]);
        mesh.slots.push(0);
        assert_eq!(components(&mesh).len(), 1);
    }
}
