//! A wall with rectangular openings.

use dwell_scene::Mesh;
use glam::{Vec2, Vec3};

use super::file::ArchElement;

/// The slots of a wall: the side to the left when walking from the first point to the second, the other side, and all rims.
const SIDES: [u16; 2] = [0, 1];
const RIM: u16 = 2;

/// The closed mesh of a wall, texture coordinates in metres; empty for one without length.
pub(crate) fn wall(element: &ArchElement) -> Mesh {
    let mut mesh = Mesh::default();
    let [from, to] = [0, 1].map(|k| Vec3::from(element.points[k].map(|x| x as f32)));
    let along = (to - from).with_y(0.0);
    let (length, height, half) = (
        along.length(),
        element.height_m as f32,
        element.depth_m as f32 / 2.0,
    );
    let Some(along) = along.try_normalize().filter(|_| length > 1e-4) else {
        return mesh;
    };
    let left = Vec3::Y.cross(along);
    let cuts = |axis: usize, end: f32| {
        let edges = element
            .holes
            .iter()
            .flat_map(|hole| [hole.min[axis] as f32, hole.max[axis] as f32]);
        let mut cuts: Vec<f32> = edges
            .filter(|x| *x > 1e-4 && *x < end - 1e-4)
            .chain([0.0, end])
            .collect();
        cuts.sort_by(f32::total_cmp);
        cuts.dedup_by(|a, b| (*a - *b).abs() < 1e-4);
        cuts
    };
    let (columns, rows) = (cuts(0, length), cuts(1, height));
    let is_solid = |i: usize, k: usize| {
        if i + 1 >= columns.len() || k + 1 >= rows.len() {
            return false;
        }
        let center = [
            f32::midpoint(columns[i], columns[i + 1]),
            f32::midpoint(rows[k], rows[k + 1]),
        ]
        .map(f64::from);
        let inside = |axis: usize, hole: &super::ArchHole| {
            (hole.min[axis]..hole.max[axis]).contains(&center[axis])
        };
        !element
            .holes
            .iter()
            .any(|hole| inside(0, hole) && inside(1, hole))
    };
    let at = |u: f32, v: f32, side: f32| from + along * u + Vec3::Y * v + left * (side * half);
    for i in 0..columns.len() - 1 {
        for k in (0..rows.len() - 1).filter(|k| is_solid(i, *k)) {
            let ([u0, u1], [v0, v1]) = ([columns[i], columns[i + 1]], [rows[k], rows[k + 1]]);
            let flat = [(u0, v0), (u1, v0), (u1, v1), (u0, v1)];
            quad(
                &mut mesh,
                flat.map(|(u, v)| at(u, v, 1.0)),
                left,
                flat.map(|(u, v)| Vec2::new(u, v)),
                SIDES[0],
            );
            quad(
                &mut mesh,
                flat.map(|(u, v)| at(u, v, -1.0)),
                -left,
                flat.map(|(u, v)| Vec2::new(u, v)),
                SIDES[1],
            );
            // Rims where the neighbour is empty: before, after, below, above.
            let neighbours = [
                (
                    i.checked_sub(1).is_some_and(|i| is_solid(i, k)),
                    [(u0, v0), (u0, v1)],
                    -along,
                ),
                (is_solid(i + 1, k), [(u1, v0), (u1, v1)], along),
                (
                    k.checked_sub(1).is_some_and(|k| is_solid(i, k)),
                    [(u0, v0), (u1, v0)],
                    Vec3::NEG_Y,
                ),
                (is_solid(i, k + 1), [(u0, v1), (u1, v1)], Vec3::Y),
            ];
            for (solid, [(ua, va), (ub, vb)], normal) in neighbours {
                if !solid {
                    let corners = [
                        at(ua, va, 1.0),
                        at(ua, va, -1.0),
                        at(ub, vb, -1.0),
                        at(ub, vb, 1.0),
                    ];
                    let run = (ub - ua) + (vb - va);
                    let uvs = [(0.0, 0.0), (2.0 * half, 0.0), (2.0 * half, run), (0.0, run)]
                        .map(Vec2::from);
                    quad(&mut mesh, corners, normal, uvs, RIM);
                }
            }
        }
    }
    mesh
}

/// Appends a quad that faces `normal`, whichever way its corners turn.
pub(super) fn quad(mesh: &mut Mesh, corners: [Vec3; 4], normal: Vec3, uvs: [Vec2; 4], slot: u16) {
    let base = mesh.positions.len() as u32;
    let [a, b, c, _] = corners;
    let order = if (b - a).cross(c - a).dot(normal) >= 0.0 {
        [0, 1, 2, 3]
    } else {
        [0, 3, 2, 1]
    };
    mesh.positions.extend(corners);
    mesh.normals.extend([normal; 4]);
    mesh.uvs.extend(uvs);
    let [a, b, c, d] = order.map(|k: u32| base + k);
    mesh.triangles.extend([[a, b, c], [a, c, d]]);
    mesh.slots.extend([slot, slot]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::suncg::arch::{ArchHole, ElementKind};

    fn element(holes: Vec<ArchHole>) -> ArchElement {
        ArchElement {
            id: "w".into(),
            kind: ElementKind::Wall,
            rooms: vec![],
            height_m: 2.5,
            depth_m: 0.1,
            points: vec![[1.0, 0.0, 2.0], [1.0, 0.0, 6.0]],
            holes,
            materials: vec![],
        }
    }

    #[test]
    fn a_wall_is_closed_and_its_openings_are_open() {
        let mesh = wall(&element(vec![]));
        assert!((mesh.enclosed_volume_m3() - 1.0).abs() < 1e-6);
        let door = ArchHole {
            min: [1.0, 0.0],
            max: [1.9, 2.0],
        };
        let window = ArchHole {
            min: [2.5, 0.9],
            max: [3.5, 2.2],
        };
        let mesh = wall(&element(vec![door, window]));
        mesh.check("wall").unwrap();
        assert!(
            (mesh.enclosed_volume_m3() - (1.0 - 0.18 - 0.13)).abs() < 1e-6,
            "{}",
            mesh.enclosed_volume_m3()
        );
        let bounds = mesh.bounds();
        assert!(
            bounds.min.abs_diff_eq(Vec3::new(0.95, 0.0, 2.0), 1e-6)
                && bounds.max.abs_diff_eq(Vec3::new(1.05, 2.5, 6.0), 1e-6)
        );
        assert!(
            wall(&ArchElement {
                points: vec![[0.0; 3]; 2],
                ..element(vec![])
            })
            .triangles
            .is_empty()
        );
    }
}
