//! The faces of a floor that one walks on.

use dwell_scene::Mesh;
use glam::{Vec2, Vec3};

use crate::warning_kind::WarningKind;

/// Cosine from which on a face looks up, or down.
const LEVEL: f32 = 0.7;
/// Cosine from which on a face leans no more than a floor does that settled or was measured: 5 degrees.
const LEANING: f32 = 0.996;
/// Largest step between faces of one floor, m.
const STEP_M: f32 = 0.02;
/// Share of the area of the largest floor from which on a higher one is no sill or skirting.
const SHARE: f32 = 0.1;

/// A floor seen from above.
#[derive(Debug, PartialEq)]
pub(crate) struct FloorFaces {
    /// Triangles of (x, z), m. Shape (face,).
    pub(crate) footprint: Vec<[Vec2; 3]>,
    /// Height of its highest corner, m.
    pub(crate) floor_y: f32,
}

/// A triangle that looks up, with its position among all.
struct Face {
    place: usize,
    corners: [Vec3; 3],
    low: f32,
    high: f32,
}

/// Faces of one floor.
struct FloorLayer {
    faces: Vec<Face>,
    area_m2: f32,
    low: f32,
}

/// The highest floor of `meshes`: faces that lean by at most 5 degrees, each at most 2 cm below others. Lips, walls and undersides
/// are none of it, and sills of less than a tenth of the largest floor do not count. Where no face of a mesh looks up, those that look
/// down are meant: its faces are turned around. `None` without such a face.
pub(crate) fn floor_faces<'a>(meshes: impl Iterator<Item = &'a Mesh>) -> Option<FloorFaces> {
    let mut faces = Vec::new();
    for mesh in meshes {
        let up = upwardness(mesh);
        let sign = if up.iter().any(|y| *y > LEVEL) {
            1.0
        } else {
            -1.0
        };
        for (k, y) in up.into_iter().enumerate() {
            let corners = mesh.corners(k);
            let heights = corners.map(|p| p.y);
            let low = heights.into_iter().fold(f32::INFINITY, f32::min);
            let high = heights.into_iter().fold(f32::NEG_INFINITY, f32::max);
            if y * sign > LEANING || (y * sign > LEVEL && high - low < STEP_M) {
                faces.push(Face {
                    place: faces.len(),
                    corners,
                    low,
                    high,
                });
            }
        }
    }
    faces.sort_by(|a, b| b.high.total_cmp(&a.high));
    let mut storeys: Vec<FloorLayer> = Vec::new();
    for face in faces {
        let [a, b, c] = face.corners;
        let area_m2 = (b - a).cross(c - a).length() * 0.5;
        match storeys.last_mut() {
            Some(storey) if face.high > storey.low - STEP_M => {
                storey.low = storey.low.min(face.low);
                storey.area_m2 += area_m2;
                storey.faces.push(face);
            }
            _ => storeys.push(FloorLayer {
                area_m2,
                low: face.low,
                faces: vec![face],
            }),
        }
    }
    let areas = storeys.iter().map(|storey| storey.area_m2);
    let least_m2 = areas.fold(0.0, f32::max) * SHARE;
    let mut storey = storeys.into_iter().find(|s| s.area_m2 >= least_m2)?;
    let floor_y = storey.faces.first()?.high;
    storey.faces.sort_by_key(|face| face.place);
    let flat = |p: Vec3| Vec2::new(p.x, p.z);
    let footprint = storey.faces.iter().map(|face| face.corners.map(flat));
    Some(FloorFaces {
        footprint: footprint.collect(),
        floor_y,
    })
}

/// The entry of a report on a floor of which no room can be made.
pub(crate) fn no_level_floor_warning() -> WarningKind {
    WarningKind::Simplified {
        what: "this floor has no face that is level within 5 degrees; no room is made over it"
            .to_owned(),
    }
}

/// How far each triangle looks up: 1 straight up, -1 down. Shape (triangle,).
fn upwardness(mesh: &Mesh) -> Vec<f32> {
    let up = |k: usize| {
        let [a, b, c] = mesh.corners(k);
        (b - a).cross(c - a).normalize_or_zero().y
    };
    (0..mesh.triangles.len()).map(up).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quad([a, b, c, d]: [[f32; 3]; 4]) -> Mesh {
        Mesh {
            positions: [a, b, c, d].map(Vec3::from).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Mesh::default()
        }
    }

    /// 4 by 3 m at a height, facing up; `lean` lifts two of its corners.
    fn floor(y: f32, lean: f32) -> Mesh {
        quad([
            [0.0, y + lean, 3.0],
            [4.0, y + lean, 3.0],
            [4.0, y, 0.0],
            [0.0, y, 0.0],
        ])
    }

    fn found(meshes: &[Mesh]) -> Option<(f32, f32)> {
        let found = floor_faces(meshes.iter())?;
        let area = |[a, b, c]: [Vec2; 3]| (b - a).perp_dot(c - a).abs() * 0.5;
        Some((
            found.footprint.into_iter().map(area).sum::<f32>(),
            found.floor_y,
        ))
    }

    #[test]
    fn a_floor_with_a_lip_a_lean_or_turned_faces_is_found() {
        let lip = quad([
            [0.0, 0.0, 0.0],
            [4.0, 0.0, 0.0],
            [4.0, 0.03, 0.0],
            [0.0, 0.03, 0.0],
        ]);
        let mut turned = floor(1.0, 0.0);
        turned.triangles.iter_mut().for_each(|t| t.swap(0, 1));
        assert_eq!(found(&[floor(0.0, 0.0), lip.clone()]), Some((12.0, 0.0)));
        assert_eq!(found(&[floor(0.0, 0.05)]), Some((12.0, 0.05)));
        assert_eq!(found(&[turned]), Some((12.0, 1.0)));
        assert_eq!(found(&[lip, floor(0.0, 2.0)]), None);
        assert_eq!(found(&[]), None);
    }

    #[test]
    fn the_highest_floor_counts_and_sills_do_not() {
        assert_eq!(
            found(&[floor(0.0, 0.0), floor(3.0, 0.0)]),
            Some((12.0, 3.0))
        );
        let mut sill = floor(0.1, 0.0);
        sill.positions.iter_mut().for_each(|p| p.x *= 0.05);
        assert_eq!(found(&[sill, floor(0.0, 0.0)]), Some((12.0, 0.0)));
        let cuboid = Mesh::cuboid(Vec3::new(0.0, -0.1, 0.0), Vec3::new(4.0, 0.0, 3.0));
        assert_eq!(found(&[cuboid]), Some((12.0, 0.0)));
    }
}
