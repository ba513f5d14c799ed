//! Coincident surfaces: faces of one thing in one plane that overlap, of which neither is before the other.

use dwell_scene::{House, Mesh, ObjectId, Pose};
use glam::{DVec3, Vec2, Vec3};
use std::collections::BTreeMap;

/// Faces closer together coincide, m.
const APART_M: f32 = 1e-4;
/// Smaller overlaps are not seen, m².
const LEAST_M2: f32 = 1e-6;
/// Distance before a face from which it is looked at, m.
const EYE_M: f32 = 5e-4;
/// Places of an image closer together look the same, in repeats of the image.
const UV_APART: f32 = 0.01;
/// Faces whose normals differ less are parallel.
const PARALLEL: f32 = 1e-3;
/// A direction along which normals that differ have different components.
const GENERIC: Vec3 = Vec3::new(0.528, 0.637, 0.562);

/// A triangle of a thing.
#[derive(Clone, Debug)]
pub struct Facet {
    corners: [Vec3; 3],
    normal: Vec3,
    material: usize,
    /// Of its corners; `None` for a plain colour.
    uvs: Option<[Vec2; 3]>,
}

impl Facet {
    /// The texture coordinates at a place of it; zero for a plain colour.
    fn uv(&self, place: Vec3) -> Vec2 {
        let Some(uvs) = self.uvs else {
            return Vec2::ZERO;
        };
        let [a, b, c] = self.corners;
        let weight = |from: Vec3, to: Vec3| (to - from).cross(place - from).dot(self.normal);
        let weights = [weight(b, c), weight(c, a), weight(a, b)];
        let whole: f32 = weights.iter().sum();
        let sum: Vec2 = uvs
            .iter()
            .zip(weights)
            .map(|(uv, weight)| *uv * weight)
            .sum();
        sum / whole
    }
}

/// Two materials whose faces coincide where they can be seen.
#[derive(Clone, Copy, Debug)]
pub struct CoincidentFaces {
    /// The materials, as the facets number them.
    pub materials: [usize; 2],
    /// Area that is shared by faces of both, m².
    pub area_m2: f32,
    /// A place of it.
    pub place: Vec3,
    /// Where the faces look, unit length.
    pub normal: Vec3,
}

/// The triangles of a mesh that stands at `pose`; `material` gives the number of the material of a slot, and whether it has an
/// image.
pub fn facets(mesh: &Mesh, pose: &Pose, material: impl Fn(usize) -> (usize, bool)) -> Vec<Facet> {
    let triangles = (0..mesh.triangles.len()).filter_map(|triangle| {
        let corners = mesh.corners(triangle).map(|p| pose.transform_point(p));
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).try_normalize()?;
        let (material, has_image) = material(usize::from(mesh.slot(triangle)));
        let uv = |vertex: u32| mesh.uvs[vertex as usize];
        Some(Facet {
            corners,
            normal,
            material,
            uvs: has_image.then(|| mesh.triangles[triangle].map(uv)),
        })
    });
    triangles.collect()
}

/// The triangles of an object at the start, with the indices of its materials in the house.
pub fn object_facets(house: &House, object: ObjectId) -> Vec<Facet> {
    let parts = house.objects[object].parts();
    let facets = parts.flat_map(|part| {
        let part = &house.parts[part];
        let material = |slot: usize| {
            let material = part.materials[slot];
            let has_image = house.materials[material].texture.is_some();
            (material.0 as usize, has_image)
        };
        facets(&house.meshes[part.mesh], &part.world_from_part, material)
    });
    facets.collect()
}

/// The pairs of materials of which faces coincide, looking the same way, outside of all solids of the thing.
///
/// Where faces of closed solids look against each other, each lies within the other's solid.
pub fn coincidences(facets: &[Facet]) -> Vec<CoincidentFaces> {
    let mut order: Vec<(f32, &Facet)> = facets
        .iter()
        .map(|facet| (facet.normal.dot(GENERIC), facet))
        .collect();
    order.sort_by(|p, q| p.0.total_cmp(&q.0));
    let mut found: BTreeMap<[usize; 2], CoincidentFaces> = BTreeMap::new();
    for (k, (along, p)) in order.iter().enumerate() {
        let parallel = order[k + 1..]
            .iter()
            .take_while(|(other, _)| other - along < PARALLEL);
        for (_, q) in parallel {
            let Some(shared) = overlap(p, q) else {
                continue;
            };
            let Some(place) = visible_place(facets, &shared, p.normal) else {
                continue;
            };
            let materials = [p.material.min(q.material), p.material.max(q.material)];
            let one = found.entry(materials).or_insert(CoincidentFaces {
                materials,
                area_m2: 0.0,
                place,
                normal: p.normal,
            });
            one.area_m2 += area_m2(&shared);
        }
    }
    found.into_values().collect()
}

/// The outline of what two faces share that look different; `None` when that is too little.
fn overlap(p: &Facet, q: &Facet) -> Option<Vec<Vec3>> {
    let is_near = |point: &Vec3| p.normal.dot(*point - p.corners[0]).abs() < 20.0 * APART_M;
    if (p.material == q.material && p.uvs.is_none())
        || p.normal.distance(q.normal) > PARALLEL
        || !q.corners.iter().any(is_near)
    {
        return None;
    }
    let mut outline = q.corners.to_vec();
    for k in 0..3 {
        let (a, b) = (p.corners[k], p.corners[(k + 1) % 3]);
        let inwards = p.normal.cross(b - a);
        outline = clip(&outline, |point| inwards.dot(point - a));
        if outline.len() < 3 {
            return None;
        }
    }
    let middle = center(&outline);
    let gap_m = p.normal.dot(middle - p.corners[0]).abs();
    let differs = p.material != q.material || p.uv(middle).distance(q.uv(middle)) > UV_APART;
    (gap_m < APART_M && area_m2(&outline) > LEAST_M2 && differs).then_some(outline)
}

/// The part of a convex outline where `side` is not negative.
fn clip(outline: &[Vec3], side: impl Fn(Vec3) -> f32) -> Vec<Vec3> {
    let mut kept = Vec::with_capacity(outline.len() + 1);
    for k in 0..outline.len() {
        let (a, b) = (outline[k], outline[(k + 1) % outline.len()]);
        let (from, to) = (side(a), side(b));
        if from >= 0.0 {
            kept.push(a);
        }
        if (from < 0.0) != (to < 0.0) {
            kept.push(a + (b - a) * (from / (from - to)));
        }
    }
    kept
}

fn center(outline: &[Vec3]) -> Vec3 {
    outline.iter().sum::<Vec3>() / outline.len() as f32
}

/// The area of a plane outline, m².
fn area_m2(outline: &[Vec3]) -> f32 {
    let first = outline[0];
    let twice: Vec3 = outline
        .windows(2)
        .map(|edge| (edge[0] - first).cross(edge[1] - first))
        .sum();
    twice.length() * 0.5
}

/// A place of `outline` before which no solid lies.
fn visible_place(facets: &[Facet], outline: &[Vec3], normal: Vec3) -> Option<Vec3> {
    let middle = center(outline);
    let towards = outline.iter().map(|corner| middle.lerp(*corner, 0.7));
    std::iter::once(middle)
        .chain(towards)
        .find(|place| winding_number(facets, *place + normal * EYE_M).abs() < 0.5)
}

/// The winding number of the thing's surface about a point: 0 outside, the number of solids that hold it inside.
///
/// The solid angle of a triangle: Van Oosterom and Strackee, IEEE Transactions on Biomedical Engineering 30 (1983), equation 8.
fn winding_number(facets: &[Facet], point: Vec3) -> f64 {
    let angle = |facet: &Facet| {
        let [a, b, c] = facet.corners.map(|corner| (corner - point).as_dvec3());
        let lengths = DVec3::new(a.length(), b.length(), c.length());
        let across = a.dot(b.cross(c));
        let along = lengths.x * lengths.y * lengths.z
            + a.dot(b) * lengths.z
            + b.dot(c) * lengths.x
            + c.dot(a) * lengths.y;
        2.0 * across.atan2(along)
    };
    facets.iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}
