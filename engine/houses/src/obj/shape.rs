//! Conversion of faces of an OBJ file into triangle meshes.

use std::collections::{BTreeMap, BTreeSet};

use dwell_scene::Mesh;
use dwell_scene::interrupt::CancelPoller;
use glam::{Vec2, Vec3, Vec3Swizzles as _};

use super::file::{FaceCorner, FaceGroup, MtlFile, NONE, ObjFile};
use super::triangles::FaceTriangulator;
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// Largest number of material slots of one mesh: slots are 16-bit numbers.
pub(super) const MAX_SLOTS: usize = u16::MAX as usize;

/// Largest number of compared vertices at one position; more are duplicated.
const MAX_CHAIN: usize = 256;

/// The material slots of a model: those of its MTL files in file order, then names that only `usemtl` knows.
///
/// SUNCG's overrides count these positions.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct MaterialSlots {
    /// Name of each slot, and its position in the MTL file.
    pub(crate) entries: Vec<(String, Option<usize>)>,
    /// The first slot of each name.
    places: BTreeMap<String, u16>,
    /// Number of materials beyond [`MAX_SLOTS`], which have no slot.
    pub(super) left_out: usize,
}

impl MaterialSlots {
    /// The slots of `obj` with `mtl`: the first 65,535. What is shown in one of the others is reported, and shown in the first.
    pub(crate) fn from_obj_and_mtl(
        obj: &ObjFile,
        mtl: &MtlFile,
        at: &FileLocation,
        report: &mut LoadReport,
    ) -> Self {
        let mut slots = Self::default();
        for (i, material) in mtl.materials.iter().enumerate() {
            if slots.find(&material.name).is_some() {
                report.warn(
                    at.clone(),
                    WarningKind::DuplicateMaterial {
                        name: material.name.clone(),
                    },
                );
            }
            if i < MAX_SLOTS {
                slots.push(&material.name, Some(i));
            } else {
                slots.left_out += 1;
            }
        }
        let mut unshown = BTreeSet::new();
        for run in &obj.face_groups {
            let name = run.material.as_deref().unwrap_or("");
            if slots.find(name).is_none() {
                if slots.entries.len() >= MAX_SLOTS {
                    if unshown.insert(name) {
                        let first = &slots.entries[0].0;
                        let what = format!(
                            "material {name:?} is beyond the first {MAX_SLOTS}, the most that one file may use; {first:?} is shown"
                        );
                        report.warn(at.clone(), WarningKind::Simplified { what });
                    }
                    continue;
                }
                if run.material.is_some() {
                    report.warn(
                        at.clone(),
                        WarningKind::MissingMaterial {
                            name: name.to_owned(),
                        },
                    );
                }
                slots.push(name, None);
            }
        }
        slots
    }

    fn find(&self, name: &str) -> Option<u16> {
        self.places.get(name).copied()
    }

    fn push(&mut self, name: &str, in_file: Option<usize>) {
        let place = self.entries.len() as u16;
        self.places.entry(name.to_owned()).or_insert(place);
        self.entries.push((name.to_owned(), in_file));
    }

    /// The slot that a stretch of faces shows.
    pub(crate) fn slot_of_group(&self, run: &FaceGroup) -> u16 {
        self.find(run.material.as_deref().unwrap_or(""))
            .unwrap_or(0)
    }
}

/// Runs of an OBJ file as one mesh.
pub(crate) struct ObjGroupSelection<'a> {
    /// The file.
    pub(crate) obj: &'a ObjFile,
    /// The slot of each run that is taken, with the run.
    pub(crate) face_groups: Vec<(u16, &'a FaceGroup)>,
    /// True if corners without texture coordinates get some, in metres on the nearest axis plane, because a texture
    /// lies on them.
    pub(crate) box_mapping: bool,
}

/// Cuts polygons into triangles, merges corners into vertices, replaces numbers that are not finite.
pub(crate) fn build_mesh(
    shape: &ObjGroupSelection<'_>,
    at: &FileLocation,
    report: &mut LoadReport,
) -> Mesh {
    let obj = shape.obj;
    let faces = || {
        shape
            .face_groups
            .iter()
            .flat_map(|(slot, run)| run.faces.clone().map(move |face| (*slot, face)))
    };
    let corners = || faces().flat_map(|(_, face)| obj.face(face));
    let normals = corners().any(|corner| corner.normal != NONE);
    let uvs = shape.box_mapping || corners().any(|corner| corner.texcoord != NONE);
    let triangle_count = faces().map(|(_, face)| obj.face(face).len() - 2).sum();
    let mut builder = ObjMeshBuilder {
        obj,
        mesh: Mesh::default(),
        heads: NewestVertices::with_capacity(obj.positions.len(), triangle_count),
        chain: Vec::new(),
        normals,
        uvs,
        box_mapping: shape.box_mapping,
    };
    builder.mesh.triangles.reserve(triangle_count);
    let mut degenerate = 0;
    let (mut points, mut ring) = (Vec::new(), Vec::new());
    let mut cutter = FaceTriangulator::default();
    let mut poll = CancelPoller::new(100_000);
    for (slot, face) in faces() {
        let face = obj.face(face);
        poll.count_many(face.len());
        points.clear();
        points.extend(face.iter().map(|corner| position(obj, *corner)));
        let flat = face_normal(&points);
        ring.clear();
        ring.extend(face.iter().map(|corner| builder.vertex(*corner, flat)));
        for triangle in cutter.triangulate_face(&points, flat) {
            builder.mesh.triangles.push(triangle.map(|k| ring[k]));
            builder.mesh.slots.push(slot);
            let [a, b, c] = builder.mesh.corners(builder.mesh.triangles.len() - 1);
            degenerate += u64::from((b - a).cross(c - a) == Vec3::ZERO);
        }
    }
    report.warn_times(at.clone(), WarningKind::DegenerateTriangles, degenerate);
    report.warn_times(at.clone(), WarningKind::UnfilledFaces, cutter.unfilled);
    builder.mesh
}

fn position(obj: &ObjFile, corner: FaceCorner) -> Vec3 {
    // The first importers set numbers that are not finite to 0, and houses depend on it.
    Vec3::from(obj.positions[corner.position as usize].map(|x| if x.is_finite() { x } else { 0.0 }))
}

/// The unit normal of a polygon (Newell's method); up for one without area.
fn face_normal(points: &[Vec3]) -> Vec3 {
    let mut sum = Vec3::ZERO;
    for (k, p) in points.iter().enumerate() {
        let q = points[(k + 1) % points.len()];
        sum += (*p - q).yzx() * (*p + q).zxy();
    }
    sum.try_normalize().unwrap_or(Vec3::Y)
}

/// The newest vertex of each position. A file may hold a few faces each of very many things and ten million positions.
enum NewestVertices {
    Dense(Vec<u32>),
    Sparse(BTreeMap<u32, u32>),
}

impl NewestVertices {
    fn with_capacity(positions: usize, triangles: usize) -> Self {
        if positions / 64 > triangles {
            return Self::Sparse(BTreeMap::new());
        }
        Self::Dense(vec![NONE; positions])
    }

    fn get(&self, position: u32) -> u32 {
        match self {
            Self::Dense(heads) => heads[position as usize],
            Self::Sparse(heads) => heads.get(&position).copied().unwrap_or(NONE),
        }
    }

    fn set(&mut self, position: u32, vertex: u32) {
        match self {
            Self::Dense(heads) => heads[position as usize] = vertex,
            Self::Sparse(heads) => {
                heads.insert(position, vertex);
            }
        }
    }
}

struct ObjMeshBuilder<'a> {
    obj: &'a ObjFile,
    mesh: Mesh,
    /// For each position of the file the newest vertex made of it.
    heads: NewestVertices,
    /// For each vertex its corner and the next vertex at the same position.
    chain: Vec<(FaceCorner, u32)>,
    normals: bool,
    uvs: bool,
    box_mapping: bool,
}

impl ObjMeshBuilder<'_> {
    /// The vertex of a corner; the same corner of another face is the same vertex unless it needs this face's normal.
    fn vertex(&mut self, corner: FaceCorner, flat: Vec3) -> u32 {
        let own = (self.normals && corner.normal == NONE)
            || (self.box_mapping && corner.texcoord == NONE);
        let head = self.heads.get(corner.position);
        let mut vertex = if own { NONE } else { head };
        for _ in 0..MAX_CHAIN {
            if vertex == NONE {
                break;
            }
            let (known, next) = self.chain[vertex as usize];
            if known == corner {
                return vertex;
            }
            vertex = next;
        }
        let vertex = self.mesh.positions.len() as u32;
        let point = position(self.obj, corner);
        self.mesh.positions.push(point);
        if self.normals {
            let stored = self
                .obj
                .normals
                .get(corner.normal as usize)
                .map(|n| Vec3::from(*n));
            self.mesh
                .normals
                .push(stored.and_then(Vec3::try_normalize).unwrap_or(flat));
        }
        if self.uvs {
            let stored = self
                .obj
                .texcoords
                .get(corner.texcoord as usize)
                .map(|uv| Vec2::from(*uv));
            let made = || {
                if self.box_mapping {
                    box_uv(point, flat)
                } else {
                    Vec2::ZERO
                }
            };
            self.mesh.uvs.push(stored.unwrap_or_else(made));
        }
        // A vertex with a normal of its own is never shared: it stays out of the chain.
        self.chain.push((corner, if own { NONE } else { head }));
        if !own {
            self.heads.set(corner.position, vertex);
        }
        vertex
    }
}

/// Texture coordinates in metres on the axis plane that the face is nearest to, v upwards on sides.
fn box_uv(point: Vec3, normal: Vec3) -> Vec2 {
    let a = normal.abs();
    if a.y >= a.x && a.y >= a.z {
        Vec2::new(point.x, -point.z)
    } else if a.x >= a.z {
        Vec2::new(point.z, point.y)
    } else {
        Vec2::new(point.x, point.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::obj::file::MtlMaterial;
    use crate::obj::{read_mtl, read_obj};
    use std::fmt::Write as _;

    fn mesh(text: &str, box_mapping: bool) -> (Mesh, LoadReport) {
        let mut report = LoadReport::new();
        let at = FileLocation::file("a.obj");
        let obj = read_obj(text.as_bytes(), "a.obj", &mut report);
        let slots =
            MaterialSlots::from_obj_and_mtl(&obj, &MtlFile::default(), &at, &mut LoadReport::new());
        let runs = obj
            .face_groups
            .iter()
            .map(|run| (slots.slot_of_group(run), run))
            .collect();
        let mesh = build_mesh(
            &ObjGroupSelection {
                obj: &obj,
                face_groups: runs,
                box_mapping,
            },
            &at,
            &mut report,
        );
        mesh.check("a.obj").unwrap();
        (mesh, report)
    }

    #[test]
    fn a_quad_is_fanned_from_its_first_corner_and_shares_vertices() {
        let (mesh, _) = mesh("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", false);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(
            (mesh.positions.len(), mesh.normals.len(), mesh.uvs.len()),
            (4, 0, 0)
        );
    }

    #[test]
    fn a_concave_face_covers_its_own_area_from_any_first_corner() {
        // An L of 4 by 4 m with arms of 1 m: 7 m², in a plane that leans.
        let outline = [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 1.0],
            [1.0, 1.0],
            [1.0, 4.0],
            [0.0, 4.0],
        ];
        let lean = glam::Quat::from_rotation_x(0.7) * glam::Quat::from_rotation_z(2.0);
        for first in 0..outline.len() {
            for reversed in [false, true] {
                let mut corners = outline;
                corners.rotate_left(first);
                if reversed {
                    corners.reverse();
                }
                let mut text = String::new();
                for [x, y] in corners {
                    let p = lean * Vec3::new(x, y, 0.0);
                    writeln!(text, "v {} {} {}", p.x, p.y, p.z).unwrap();
                }
                let (mesh, report) = mesh(&format!("{text}f 1 2 3 4 5 6\n"), false);
                let normal = lean * if reversed { Vec3::NEG_Z } else { Vec3::Z };
                let areas = (0..mesh.triangles.len()).map(|k| {
                    let [a, b, c] = mesh.corners(k);
                    let cross = (b - a).cross(c - a);
                    assert!(cross.dot(normal) > 0.0, "{first} {reversed}: turned around");
                    cross.length() / 2.0
                });
                assert!((areas.sum::<f32>() - 7.0).abs() < 1e-4, "{first}");
                assert_eq!(mesh.triangles.len(), 4);
                assert!(report.warnings().is_empty(), "{report}");
            }
        }
    }

    #[test]
    fn a_face_that_crosses_itself_or_has_too_many_corners_is_reported() {
        let bow = "v 0 0 0\nv 3 3 0\nv 3 0 0\nv 0 2 0\n";
        let (mesh_of_bow, report) = mesh(&format!("{bow}f 1 2 3 4\n"), false);
        assert_eq!(mesh_of_bow.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(report.count(|d| *d == WarningKind::UnfilledFaces), 1);
        let (mut comb, mut face) = (String::new(), "f".to_owned());
        for k in 0..5000 {
            writeln!(comb, "v {k} {} 0", if k % 2 == 0 { 0 } else { 9 }).unwrap();
            write!(face, " {}", k + 1).unwrap();
        }
        let (_, report) = mesh(
            &format!("{comb}v 5000 -1 0\nv 0 -1 0\n{face} 5001 5002\n"),
            false,
        );
        assert_eq!(report.count(|d| *d == WarningKind::UnfilledFaces), 1);
    }

    #[test]
    fn corners_with_and_without_texture_coordinates_mix() {
        let (mesh, _) = mesh(
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.5 0.5\nvn 0 0 2\nf 1//1 2//1 3//1\nf 1/1/1 2/1/1 3//1\nf 1 3 2\n",
            false,
        );
        assert_eq!(
            mesh.positions.len(),
            8,
            "3 shared, 2 with coordinates, 3 with the face's own normal"
        );
        assert_eq!((mesh.normals[0], mesh.normals[7]), (Vec3::Z, Vec3::NEG_Z));
        assert_eq!((mesh.uvs[0], mesh.uvs[3]), (Vec2::ZERO, Vec2::splat(0.5)));
    }

    #[test]
    fn missing_texture_coordinates_are_made_where_a_texture_lies() {
        let (mesh, _) = mesh("v 1 2 3\nv 2 2 3\nv 1 2 4\nf 1 3 2\n", true);
        assert_eq!(
            mesh.uvs,
            [
                Vec2::new(1.0, -3.0),
                Vec2::new(1.0, -4.0),
                Vec2::new(2.0, -3.0)
            ]
        );
    }

    #[test]
    fn nan_becomes_zero_and_flat_triangles_are_counted() {
        let (mesh, report) = mesh(
            "v 0 nan 0\nv 1 0 0\nv 2 0 0\nvn 0 0 nan\nf 1//1 2//1 3//1\n",
            false,
        );
        assert_eq!((mesh.positions[0], mesh.normals[0]), (Vec3::ZERO, Vec3::Y));
        assert_eq!(report.count(|d| *d == WarningKind::DegenerateTriangles), 1);
    }

    #[test]
    fn what_is_shown_beyond_the_last_slot_is_reported() {
        let text = b"v 0 0 0\nusemtl a65534\nf 1 1 1\nusemtl a65536\nf 1 1 1\nusemtl x\nf 1 1 1\n";
        let obj = read_obj(text, "a.obj", &mut LoadReport::new());
        let materials = (0..MAX_SLOTS + 2).map(|k| MtlMaterial {
            name: format!("a{k}"),
            ..MtlMaterial::default()
        });
        let mtl = MtlFile {
            materials: materials.collect(),
        };
        let at = FileLocation::file("a.obj");
        let mut report = LoadReport::new();
        let slots = MaterialSlots::from_obj_and_mtl(&obj, &mtl, &at, &mut report);
        assert_eq!((slots.entries.len(), slots.left_out), (MAX_SLOTS, 2));
        let shown = obj.face_groups.iter().map(|run| slots.slot_of_group(run));
        assert_eq!(shown.collect::<Vec<u16>>(), [65_534, 0, 0]);
        let told = report.to_string();
        for name in ["\"a65536\" is beyond the first 65535", "\"x\" is beyond"] {
            assert!(told.contains(name), "{told}");
        }
        assert_eq!(report.len(), 2, "{report}");
    }

    #[test]
    fn slots_follow_the_material_file_not_the_use() {
        let obj = read_obj(
            b"v 0 0 0\nusemtl b\nf 1 1 1\nusemtl x\nf 1 1 1\n",
            "a.obj",
            &mut LoadReport::new(),
        );
        let mtl = read_mtl(b"newmtl a\nnewmtl b\n", "a.mtl", &mut LoadReport::new());
        let mut report = LoadReport::new();
        let slots =
            MaterialSlots::from_obj_and_mtl(&obj, &mtl, &FileLocation::file("a.obj"), &mut report);
        assert_eq!(
            slots.entries,
            [
                ("a".into(), Some(0)),
                ("b".into(), Some(1)),
                ("x".into(), None)
            ]
        );
        assert_eq!(
            (
                slots.slot_of_group(&obj.face_groups[0]),
                slots.slot_of_group(&obj.face_groups[1])
            ),
            (1, 2)
        );
        assert_eq!(report.len(), 1);
    }
}
