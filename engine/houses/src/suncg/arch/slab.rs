//! Floors, ceilings and grounds.

use dwell_scene::Mesh;
use glam::{DVec2, Vec2, Vec3};

use super::file::{ArchElement, ElementKind};
use super::wall::quad;
use crate::import::triangulate;

/// The closed mesh of a slab, texture coordinates in metres: slot 0 is the side that the room sees, slot 1 the other one,
/// slot 2 the rim. Empty for an outline without area.
pub(crate) fn slab(element: &ArchElement) -> Mesh {
    let points: Vec<Vec3> = element
        .points
        .iter()
        .map(|p| Vec3::from(p.map(|x| x as f32)))
        .collect();
    // Seen from above, x to the right and -z up, so that counter-clockwise faces +Y.
    let outline: Vec<DVec2> = points
        .iter()
        .map(|p| DVec2::new(f64::from(p.x), -f64::from(p.z)))
        .collect();
    let triangles = triangulate(&outline);
    let mut mesh = Mesh::default();
    if triangles.is_empty() {
        return mesh;
    }
    let depth = element.depth_m as f32;
    let ceiling = element.kind == ElementKind::Ceiling;
    let (seen, hidden) = if ceiling {
        (Vec3::NEG_Y, Vec3::Y)
    } else {
        (Vec3::Y, Vec3::NEG_Y)
    };
    for (normal, shift, slot) in [(seen, 0.0, 0), (hidden, depth, 1)] {
        let base = mesh.positions.len() as u32;
        mesh.positions
            .extend(points.iter().map(|p| *p - seen * shift));
        mesh.normals.extend(points.iter().map(|_| normal));
        mesh.uvs.extend(points.iter().map(|p| Vec2::new(p.x, -p.z)));
        for triangle in &triangles {
            let [a, b, c] = triangle.map(|k| base + k as u32);
            mesh.triangles
                .push(if normal.y > 0.0 { [a, b, c] } else { [a, c, b] });
            mesh.slots.push(slot);
        }
    }
    let area: f64 = (0..outline.len())
        .map(|k| outline[k].perp_dot(outline[(k + 1) % outline.len()]))
        .sum();
    for k in 0..points.len() {
        let (a, b) = (points[k], points[(k + 1) % points.len()]);
        let outward = (b - a).cross(Vec3::Y) * area.signum() as f32;
        if let Some(normal) = outward.try_normalize() {
            let corners = [a, b, b - seen * depth, a - seen * depth];
            let run = (b - a).length();
            quad(
                &mut mesh,
                corners,
                normal,
                [(0.0, 0.0), (run, 0.0), (run, depth), (0.0, depth)].map(Vec2::from),
                2,
            );
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floors_lie_under_their_points_and_ceilings_above() {
        for kind in [ElementKind::Floor, ElementKind::Ceiling] {
            let mut points = vec![
                [40.0, 1.0, 40.0],
                [44.0, 1.0, 40.0],
                [44.0, 1.0, 43.0],
                [40.0, 1.0, 43.0],
            ];
            for _ in 0..2 {
                let element = ArchElement {
                    id: "f".into(),
                    kind,
                    rooms: vec![],
                    height_m: 0.0,
                    depth_m: 0.05,
                    points: points.clone(),
                    holes: vec![],
                    materials: vec![],
                };
                let mesh = slab(&element);
                mesh.check("slab").unwrap();
                assert!(
                    (mesh.enclosed_volume_m3() - 0.6).abs() < 1e-4,
                    "{kind:?} {}",
                    mesh.enclosed_volume_m3()
                );
                let (low, high) = (mesh.bounds().min.y, mesh.bounds().max.y);
                let expected = if kind == ElementKind::Floor {
                    (0.95, 1.0)
                } else {
                    (1.0, 1.05)
                };
                assert!((low - expected.0).abs() < 1e-6 && (high - expected.1).abs() < 1e-6);
                points.reverse();
            }
        }
    }
}
