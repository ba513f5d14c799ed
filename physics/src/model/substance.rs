//! Materials of the convex pieces of a part with several materials, from the faces that are seen.
//!
//! A house gives the material of each face of a part, and the convex pieces that collide, but not which belongs to which. A
//! face belongs to the piece that it lies on; a piece has the material of most of the faces on it.

use super::plan::{CollisionPiece, MaterialAssignment};
use super::shapes;
use dwell_scene::{House, MaterialId, PartId};
use glam::Vec3;

/// Most faces that are sampled, the largest first; up to this number four points each, else the middle.
const MOST_FACES: usize = 512;
const FEW_FACES: usize = 128;
/// Difference of distances to two pieces up to which a face belongs to both, m.
const TIE_M: f32 = 1e-4;

/// A sample of a face, with the area that it represents.
struct SurfaceSample {
    point: Vec3,
    area_m2: f64,
    /// Its index among the part's materials.
    slot: usize,
}

/// Gives each convex piece, in part space, the material of the faces on it; pieces without any keep the one they have.
pub(super) fn assign_face_materials(house: &House, part: PartId, pieces: &mut [CollisionPiece]) {
    let materials = &house.parts[part].materials;
    let alike = materials.windows(2).all(|two| two[0] == two[1]);
    if alike || !pieces.iter().any(is_convex) {
        return;
    }
    let bounds: Vec<_> = pieces
        .iter()
        .map(|piece| shapes::bounds(&piece.shape, &piece.pose))
        .collect();
    let mut areas = vec![vec![0.0; materials.len()]; pieces.len()];
    for spot in sample_faces(house, part) {
        let mut distances = vec![f32::INFINITY; pieces.len()];
        let mut least = f32::INFINITY;
        for (k, piece) in pieces.iter().enumerate() {
            let apart = (bounds[k].min - spot.point).max(spot.point - bounds[k].max);
            let at_least = apart.max(Vec3::ZERO).length();
            if is_convex(piece) && at_least <= least + TIE_M {
                distances[k] = piece.shape.distance_to_point(&piece.pose, spot.point, true);
                least = least.min(distances[k]);
            }
        }
        for (area, distance) in areas.iter_mut().zip(distances) {
            if distance <= least + TIE_M
                && let Some(area) = area.get_mut(spot.slot)
            {
                *area += spot.area_m2;
            }
        }
    }
    for (piece, areas) in pieces.iter_mut().zip(&areas) {
        if is_convex(piece)
            && let Some(material) = dominant_material(materials, areas)
        {
            piece.materials = MaterialAssignment::Uniform(Some(material));
        }
    }
}

fn is_convex(piece: &CollisionPiece) -> bool {
    piece.shape.as_trimesh().is_none()
}

/// Returns the material with the largest area, of equal ones the first; `None` where there is no area.
fn dominant_material(materials: &[MaterialId], areas: &[f64]) -> Option<MaterialId> {
    let of = |material: MaterialId| -> f64 {
        let own = materials.iter().zip(areas);
        own.filter(|(other, _)| **other == material)
            .map(|(_, area)| area)
            .sum()
    };
    let mut best: Option<(MaterialId, f64)> = None;
    for material in materials {
        let area = of(*material);
        if area > best.map_or(0.0, |(_, most)| most) {
            best = Some((*material, area));
        }
    }
    best.map(|(material, _)| material)
}

/// Returns samples all over the largest faces of a part, in part space.
fn sample_faces(house: &House, part: PartId) -> Vec<SurfaceSample> {
    let part = &house.parts[part];
    let mesh = &house.meshes[part.mesh];
    let mut faces: Vec<(f64, usize, [Vec3; 3])> = (0..mesh.triangles.len())
        .map(|k| {
            let corners = mesh.corners(k);
            let corners = corners.map(|corner| part.part_from_mesh.transform_point3(corner));
            let [a, b, c] = corners;
            let area_m2 = 0.5 * f64::from((b - a).cross(c - a).length());
            (area_m2, k, corners)
        })
        .filter(|(area_m2, ..)| area_m2.is_finite() && *area_m2 > 0.0)
        .collect();
    faces.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    faces.truncate(MOST_FACES);
    let few = faces.len() <= FEW_FACES;
    let mut spots = Vec::new();
    for (area_m2, k, corners) in faces {
        let slot = usize::from(mesh.slot(k));
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let mut points = vec![middle];
        if few {
            points.extend(corners.map(|corner| 0.5 * (corner + middle)));
        }
        let area_m2 = area_m2 / points.len() as f64;
        spots.extend(points.into_iter().map(|point| SurfaceSample {
            point,
            area_m2,
            slot,
        }));
    }
    spots
}
