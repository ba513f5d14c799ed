//! Meshes of the pieces of a person, in units of its height: closed, facing outwards. Limbs hang from their joint along -Y;
//! what is ahead is at -Z.

use super::proportions::{
    ANKLE, FOOT, FOOT_BREADTH, FOREARM, HAND, HIP_BREADTH, SHIN, SHOULDER_BREADTH, THIGH, TRUNK,
    UPPER_ARM,
};
use crate::bvh::{RayMask, TriangleAttributes, TriangleBvh};
use crate::math;
use crate::mesh::Mesh;
use glam::{Quat, Vec2, Vec3};
use std::f32::consts::{PI, TAU};
use std::sync::{Arc, LazyLock};

/// The mesh of a piece, with its tree.
#[derive(Debug)]
pub struct PersonMesh {
    /// In units of the height.
    pub mesh: Mesh,
    /// For rays that see bodies.
    pub tree: Arc<TriangleBvh>,
}

/// The kinds of pieces, in the order of [`person_meshes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PieceKind {
    Head,
    Hair,
    Face,
    Neck,
    Trunk,
    Pelvis,
    UpperArm,
    Forearm,
    LeftPalm,
    RightPalm,
    Fingers,
    PointingFinger,
    Thigh,
    Shin,
    Foot,
}

/// How many there are.
const SHAPES: usize = 15;

/// An ellipse about Y: its height, half its width along X, half its depth along Z, and its middle along Z.
type Ring = [f32; 4];

/// The surface through ellipses from below; the first and the last are closed by their middles.
fn tube(rings: &[Ring], around: u16) -> Mesh {
    let mut mesh = Mesh::default();
    let count = u32::from(around);
    for [y, wide, deep, z] in rings {
        for step in 0..around {
            let (sine, cosine) = math::sin_cos(TAU * f32::from(step) / f32::from(around));
            let point = Vec3::new(wide * cosine, *y, z - deep * sine);
            mesh.positions.push(point);
        }
    }
    let rows = rings.len() as u32;
    for row in 1..rows {
        for step in 0..count {
            let next = (step + 1) % count;
            let corner = |row: u32, step: u32| row * count + step;
            let (a, b) = (corner(row - 1, step), corner(row - 1, next));
            let (c, d) = (corner(row, step), corner(row, next));
            mesh.triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    let ends = [(0, false), (rows - 1, true)];
    for (row, is_upper) in ends {
        let [y, _, _, z] = rings[row as usize];
        let middle = mesh.positions.len() as u32;
        mesh.positions.push(Vec3::new(0.0, y, z));
        for step in 0..count {
            let (a, b) = (row * count + step, row * count + (step + 1) % count);
            let triangle = if is_upper {
                [a, b, middle]
            } else {
                [b, a, middle]
            };
            mesh.triangles.push(triangle);
        }
    }
    with_normals(mesh)
}

/// Sets normals to the means of those of the triangles around, by area.
fn with_normals(mut mesh: Mesh) -> Mesh {
    mesh.normals = vec![Vec3::ZERO; mesh.positions.len()];
    for triangle in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(triangle);
        let normal = (b - a).cross(c - a);
        for corner in mesh.triangles[triangle] {
            mesh.normals[corner as usize] += normal;
        }
    }
    for normal in &mut mesh.normals {
        *normal = normal.normalize_or(Vec3::Y);
    }
    mesh
}

/// An ellipsoid of half axes `half` about `middle`, turned by `turn` before.
fn ellipsoid(half: Vec3, middle: Vec3, (rows, around): (u16, u16)) -> Mesh {
    dome(half, middle, PI, 0.0, (rows, around))
}

/// The part of an ellipsoid within `reach_rad` of its upper pole, which leans back by `tilt_rad`.
fn dome(
    half: Vec3,
    middle: Vec3,
    reach_rad: f32,
    tilt_rad: f32,
    (rows, around): (u16, u16),
) -> Mesh {
    // Poles are almost points: triangles there keep an area.
    let rings: Vec<Ring> = (0..=rows)
        .map(|row| {
            let part = f32::from(rows - row) / f32::from(rows);
            let (sine, cosine) = math::sin_cos(reach_rad * part.clamp(0.02, 0.98));
            [cosine, sine, sine, 0.0]
        })
        .collect();
    let turn = super::leg::rotation_x(tilt_rad);
    let mut mesh = tube(&rings, around);
    for point in &mut mesh.positions {
        *point = middle + (turn * *point) * half;
    }
    with_normals(mesh)
}

/// A limb from its joint down, with round ends: `(part of the length, radius)`.
fn limb(length: f32, radii: &[Vec2], around: u16) -> Mesh {
    let (first, last) = (radii[0], radii[radii.len() - 1]);
    let mut rings: Vec<Ring> = Vec::new();
    let round = |radius: f32, angle: f32| {
        let (sine, cosine) = math::sin_cos(angle);
        (radius * cosine, radius * sine)
    };
    for angle in [1.35, 0.75] {
        let (radius, below) = round(last.y, angle);
        rings.push([-length - below, radius, radius, 0.0]);
    }
    for at in radii.iter().rev() {
        rings.push([-length * at.x, at.y, at.y, 0.0]);
    }
    for angle in [0.75, 1.35] {
        let (radius, above) = round(first.y, angle);
        rings.push([above, radius, radius, 0.0]);
    }
    tube(&rings, around)
}

fn joined(meshes: &[Mesh]) -> Mesh {
    let mut all = Mesh::default();
    for mesh in meshes {
        all.append(mesh, 0);
    }
    all
}

/// The head about the joint on which it turns.
fn head() -> Mesh {
    let skull = ellipsoid(
        Vec3::new(0.045, 0.065, 0.056),
        Vec3::new(0.0, 0.03, 0.004),
        (8, 12),
    );
    let jaw = ellipsoid(
        Vec3::new(0.033, 0.03, 0.036),
        Vec3::new(0.0, -0.006, -0.016),
        (4, 8),
    );
    let nose = ellipsoid(
        Vec3::new(0.0075, 0.013, 0.012),
        Vec3::new(0.0, 0.018, -0.054),
        (4, 6),
    );
    let ear = |x: f32| {
        let half = Vec3::new(0.006, 0.016, 0.01);
        ellipsoid(half, Vec3::new(x, 0.026, 0.008), (3, 5))
    };
    joined(&[skull, jaw, nose, ear(-0.045), ear(0.045)])
}

fn hair() -> Mesh {
    let cap = dome(
        Vec3::new(0.049, 0.068, 0.061),
        Vec3::new(0.0, 0.032, 0.008),
        1.75,
        0.62,
        (5, 12),
    );
    let brow = |x: f32| {
        let half = Vec3::new(0.011, 0.0022, 0.003);
        ellipsoid(half, Vec3::new(x, 0.046, -0.0475), (3, 4))
    };
    joined(&[cap, brow(-0.018), brow(0.018)])
}

/// Eyes and mouth.
fn face() -> Mesh {
    let eye = |x: f32| {
        let half = Vec3::new(0.0075, 0.0048, 0.005);
        ellipsoid(half, Vec3::new(x, 0.031, -0.0465), (4, 6))
    };
    let mouth = ellipsoid(
        Vec3::new(0.014, 0.0028, 0.004),
        Vec3::new(0.0, -0.008, -0.0485),
        (3, 5),
    );
    joined(&[eye(-0.018), eye(0.018), mouth])
}

/// From below the waist to the neck, about the point between the hips.
fn trunk() -> Mesh {
    let (half, top) = (0.5 * SHOULDER_BREADTH, TRUNK);
    let rings = [
        [0.028, 0.086, 0.056, 0.0],
        [0.08, 0.080, 0.053, -0.002],
        [0.15, 0.088, 0.060, -0.006],
        [0.21, 0.098, 0.066, -0.008],
        [0.25, 0.107, 0.062, -0.004],
        [top - 0.004, half - 0.012, 0.050, 0.0],
        [top + 0.018, half - 0.024, 0.040, 0.002],
        [top + 0.031, 0.062, 0.033, 0.004],
        [top + 0.039, 0.034, 0.028, 0.005],
    ];
    tube(&rings, 14)
}

fn pelvis() -> Mesh {
    let half = 0.5 * HIP_BREADTH;
    let rings = [
        [-0.046, 0.03, 0.03, 0.0],
        [-0.036, 0.07, 0.052, 0.0],
        [-0.01, half - 0.002, 0.066, 0.003],
        [0.02, half - 0.003, 0.064, 0.003],
        [0.045, 0.088, 0.058, 0.0],
        [0.052, 0.08, 0.052, 0.0],
    ];
    tube(&rings, 12)
}

/// The palm with its thumb, which is ahead of a hanging hand and close to the body's middle.
fn palm(inwards: f32) -> Mesh {
    let rings = [
        [-0.058, 0.006, 0.019, 0.0],
        [-0.054, 0.0085, 0.0225, 0.0],
        [-0.03, 0.0095, 0.023, 0.0],
        [-0.008, 0.010, 0.016, 0.0],
        [0.004, 0.009, 0.012, 0.0],
    ];
    let mut thumb = limb(0.034, &[Vec2::new(0.0, 0.0068), Vec2::new(1.0, 0.0052)], 8);
    let lean = super::leg::rotation_x(0.62);
    for point in &mut thumb.positions {
        *point = lean * *point + Vec3::new(inwards * 0.004, -0.018, -0.017);
    }
    joined(&[tube(&rings, 8), with_normals(thumb)])
}

/// Four fingers, a little bent.
fn fingers() -> Mesh {
    let finger = |k: u8| {
        let z = (f32::from(k) - 1.5) * 0.0112;
        let length = HAND - 0.056 - 0.005 - 0.004 * (f32::from(k) - 1.0).abs();
        let radii = [Vec2::new(0.0, 0.0056), Vec2::new(1.0, 0.0046)];
        let mut mesh = limb(length, &radii, 4);
        for point in &mut mesh.positions {
            *point += Vec3::new(0.0, -0.056, z);
        }
        mesh
    };
    joined(&[0, 1, 2, 3].map(finger))
}

/// The index finger stretched, the others in a fist.
fn pointing_finger() -> Mesh {
    let radii = [Vec2::new(0.0, 0.006), Vec2::new(1.0, 0.0048)];
    let mut index = limb(HAND - 0.05 - 0.0048, &radii, 6);
    for point in &mut index.positions {
        *point += Vec3::new(0.0, -0.05, -0.0168);
    }
    // The tip is the end of the hand's line.
    let lean = Quat::from_rotation_arc(
        Vec3::new(0.0, -0.058, 0.0).normalize(),
        Vec3::new(0.0, -0.058, 0.0168).normalize(),
    );
    let base = Vec3::new(0.0, -0.05, -0.0168);
    for point in &mut index.positions {
        *point = base + lean * (*point - base);
    }
    let fist = ellipsoid(
        Vec3::new(0.014, 0.014, 0.019),
        Vec3::new(0.0, -0.062, 0.005),
        (4, 7),
    );
    joined(&[with_normals(index), fist])
}

/// The shoe about the ankle.
fn foot() -> Mesh {
    let half = 0.5 * FOOT_BREADTH;
    let heel = 0.25 * FOOT;
    // Along the foot from the heel: the height of its back, half its breadth.
    let rows: [[f32; 3]; 8] = [
        [0.0, 0.020, 0.4],
        [0.08, 0.040, 0.75],
        [0.25, 0.052, 0.85],
        [0.40, 0.044, 0.85],
        [0.60, 0.030, 0.95],
        [0.80, 0.022, 1.0],
        [0.94, 0.017, 0.8],
        [1.0, 0.010, 0.35],
    ];
    let rings: Vec<Ring> = rows
        .iter()
        .map(|[along, high, wide]| [along * FOOT, wide * half, 0.5 * high, 0.5 * high])
        .collect();
    let mut mesh = tube(&rings, 8);
    // From along Y to along -Z; soles are flat.
    for point in &mut mesh.positions {
        *point = Vec3::new(point.x, point.z - ANKLE, heel - point.y);
    }
    with_normals(mesh)
}

fn shape(kind: PieceKind) -> Mesh {
    let at = Vec2::new;
    match kind {
        PieceKind::Head => head(),
        PieceKind::Hair => hair(),
        PieceKind::Face => face(),
        PieceKind::Neck => limb(0.07, &[at(0.0, 0.028), at(1.0, 0.032)], 8),
        PieceKind::Trunk => trunk(),
        PieceKind::Pelvis => pelvis(),
        PieceKind::UpperArm => limb(
            UPPER_ARM,
            &[at(0.0, 0.026), at(0.5, 0.0255), at(1.0, 0.021)],
            8,
        ),
        PieceKind::Forearm => limb(
            FOREARM,
            &[at(0.0, 0.019), at(0.3, 0.0205), at(1.0, 0.0125)],
            8,
        ),
        PieceKind::LeftPalm => palm(1.0),
        PieceKind::RightPalm => palm(-1.0),
        PieceKind::Fingers => fingers(),
        PieceKind::PointingFinger => pointing_finger(),
        PieceKind::Thigh => limb(THIGH, &[at(0.0, 0.046), at(0.4, 0.044), at(1.0, 0.031)], 8),
        PieceKind::Shin => limb(SHIN, &[at(0.0, 0.030), at(0.3, 0.032), at(1.0, 0.0215)], 8),
        PieceKind::Foot => foot(),
    }
}

static MESHES: LazyLock<[PersonMesh; SHAPES]> = LazyLock::new(|| {
    [
        PieceKind::Head,
        PieceKind::Hair,
        PieceKind::Face,
        PieceKind::Neck,
        PieceKind::Trunk,
        PieceKind::Pelvis,
        PieceKind::UpperArm,
        PieceKind::Forearm,
        PieceKind::LeftPalm,
        PieceKind::RightPalm,
        PieceKind::Fingers,
        PieceKind::PointingFinger,
        PieceKind::Thigh,
        PieceKind::Shin,
        PieceKind::Foot,
    ]
    .map(|kind| {
        let mesh = shape(kind);
        let tag = |_| TriangleAttributes {
            id: 0,
            mask: RayMask::BODY,
        };
        let tree = TriangleBvh::build_tagged(&mesh.positions, &mesh.triangles, tag);
        PersonMesh {
            mesh,
            tree: Arc::new(tree),
        }
    })
});

/// The mesh of a kind of piece.
pub(super) fn mesh_of(kind: PieceKind) -> &'static PersonMesh {
    &MESHES[kind as usize]
}

/// The meshes of all pieces, in the order of [`super::person_pieces`]; pieces of one kind share theirs.
pub fn person_meshes() -> [&'static PersonMesh; super::PERSON_PIECES] {
    super::pieces::PIECES.map(|piece| mesh_of(piece.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// Every edge is shared by two triangles that run along it in opposite directions, and the volume is positive.
    #[test]
    fn meshes_are_closed_and_face_outwards() {
        for (kind, PersonMesh { mesh, .. }) in MESHES.iter().enumerate() {
            mesh.check("piece").unwrap();
            let mut edges: BTreeMap<(u32, u32), i32> = BTreeMap::new();
            for [a, b, c] in &mesh.triangles {
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    let way = if from < to { 1 } else { -1 };
                    *edges.entry((*from.min(to), *from.max(to))).or_default() += way;
                }
            }
            assert!(edges.values().all(|sum| *sum == 0), "{kind} has a hole");
            assert!(mesh.enclosed_volume_m3() > 0.0, "{kind} faces inwards");
        }
    }

    #[test]
    fn a_person_is_cheap() {
        let count: usize = person_meshes()
            .iter()
            .map(|piece| piece.mesh.triangles.len())
            .sum();
        assert!((1000..4000).contains(&count), "{count}");
    }
}
