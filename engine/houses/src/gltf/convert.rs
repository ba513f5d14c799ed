//! The file's tables into a house.

use std::sync::Arc;

use ::gltf::json::Root;
use ::gltf::json::mesh::{Mode, Primitive, Semantic};
use ::gltf::json::validation::Checked;
use dwell_scene::parallel::Threads;
use dwell_scene::{MaterialId, Mesh};
use glam::{Vec2, Vec3};

use super::accessor::{floats, indices};
use super::buffers::Buffers;
use super::nodes::node_tree;
use super::surface::{images, materials};
use crate::data_root::DataRoot;
use crate::error::HousesError;
use crate::import::{ImportedScene, MaterialTableBuilder, SceneNode, texture_name};
use crate::limits::{MAX_CORNERS_SHOWN, MAX_NODES};
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

pub(super) fn convert(
    json: &Root,
    buffers: &Buffers<'_>,
    root: &DataRoot,
    name: &str,
    trusted: bool,
    threads: Threads,
    report: &mut LoadReport,
) -> Result<ImportedScene, HousesError> {
    let at = FileLocation::file(name);
    if json.nodes.len() > MAX_NODES {
        let (found, allowed) = (json.nodes.len() as u64, MAX_NODES as u64);
        return Err(HousesError::TooLarge {
            at: at.field("nodes"),
            what: "node count",
            found,
            allowed,
        });
    }
    let unread = [
        ("animations", json.animations.len()),
        ("cameras", json.cameras.len()),
    ];
    for (what, count) in unread.into_iter().filter(|(_, count)| *count > 0) {
        report.warn(
            at.field(what),
            WarningKind::Simplified {
                what: format!("{count} {what} are not read"),
            },
        );
    }
    let mut looks = MaterialTableBuilder::default();
    let images = images(json, buffers, root, &at, threads, report);
    let material_ids = materials(json, &images, trusted, &mut looks, &at, report);
    let mut meshes: Vec<Option<(Arc<Mesh>, Vec<MaterialId>)>> = vec![None; json.meshes.len()];
    let (mut read, mut shown) = (VertexBudget::default(), VertexBudget::default());
    let mut things = Vec::new();
    let tree = node_tree(json, trusted, &at, report);
    for instance in tree.instances {
        let Some(mesh) = json.meshes.get(instance.mesh) else {
            continue;
        };
        let (shape, materials) = meshes[instance.mesh].get_or_insert_with(|| {
            let mesh_at = at.field(format_args!("meshes[{}]", instance.mesh));
            merge(
                json,
                buffers,
                &mesh.primitives,
                &material_ids,
                &mut read,
                &mesh_at,
                report,
            )
        });
        if shape.triangles.is_empty() {
            report.warn(
                at.clone(),
                WarningKind::EmptyMesh {
                    path: instance.name,
                },
            );
            continue;
        }
        if let Err(reason) = shown.reserve(shape.positions.len(), 3 * shape.triangles.len()) {
            report.warn(
                at.field("nodes"),
                WarningKind::UnreadableMesh {
                    path: instance.name,
                    reason,
                },
            );
            continue;
        }
        let (mesh, materials) = (shape.clone(), materials.clone());
        things.push(SceneNode {
            name: instance.name,
            mesh,
            world_from_mesh: instance.world_from_mesh,
            materials,
            level: instance.level,
            room: instance.room,
            role: instance.role,
            part_of: instance.part_of,
        });
    }
    Ok(ImportedScene {
        name: texture_name(name),
        source: "gltf",
        nodes: things,
        materials: looks,
        textures: images.textures,
        levels: tree.levels,
        rooms: tree.rooms,
        sky: tree.sky,
        lamps: tree.lamps,
        objects: tree.objects,
    })
}

/// Numbers of vertices and indices so far.
#[derive(Default)]
pub(crate) struct VertexBudget(u64);

impl VertexBudget {
    /// Counts those of a mesh.
    ///
    /// # Errors
    /// A sentence when they are more than what is left of [`MAX_CORNERS_SHOWN`].
    pub(crate) fn reserve(&mut self, vertices: usize, indices: usize) -> Result<(), String> {
        let all = self
            .0
            .saturating_add((vertices as u64).saturating_add(indices as u64));
        if all > MAX_CORNERS_SHOWN {
            return Err(format!(
                "with it there are {all} vertices and indices; {MAX_CORNERS_SHOWN} are read"
            ));
        }
        self.0 = all;
        Ok(())
    }

    /// Counts those that a primitive names.
    ///
    /// # Errors
    /// That of [`Self::take`].
    fn reserve_primitive(&mut self, json: &Root, primitive: &Primitive) -> Result<(), String> {
        let count = |index: ::gltf::json::Index<_>| {
            let accessor: Option<&::gltf::json::Accessor> = json.accessors.get(index.value());
            let count = accessor.map_or(0, |accessor| accessor.count.0);
            usize::try_from(count).unwrap_or(usize::MAX)
        };
        let positions = primitive.attributes.values().map(|index| count(*index));
        let vertices = positions.max().unwrap_or(0);
        // A strip has nearly as many triangles as indices.
        self.reserve(
            vertices,
            primitive.indices.map_or(vertices, count).saturating_mul(3),
        )
    }
}

/// The primitives of a mesh as one mesh with a slot each.
fn merge(
    json: &Root,
    buffers: &Buffers<'_>,
    primitives: &[Primitive],
    material_ids: &[MaterialId],
    corners: &mut VertexBudget,
    at: &FileLocation,
    report: &mut LoadReport,
) -> (Arc<Mesh>, Vec<MaterialId>) {
    let mut merged = Mesh::default();
    let mut materials: Vec<MaterialId> = Vec::new();
    for (k, primitive) in primitives.iter().enumerate() {
        let at = at.field(format_args!("primitives[{k}]"));
        let part = corners
            .reserve_primitive(json, primitive)
            .and_then(|()| read(json, buffers, primitive, &at, report));
        let mut part = match part {
            Ok(part) => part,
            Err(reason) => {
                report.warn(at.clone(), WarningKind::BadPrimitive { reason });
                continue;
            }
        };
        transform_uvs(json, primitive, &mut part);
        // Slots are 16-bit numbers.
        let material = primitive
            .material
            .and_then(|m| material_ids.get(m.value()))
            .or(material_ids.last());
        let Some(material) = material.filter(|_| materials.len() < usize::from(u16::MAX)) else {
            continue;
        };
        if merged.positions.is_empty() {
            part.slots = vec![materials.len() as u16; part.triangles.len()];
            merged = part;
            materials.push(*material);
            continue;
        }
        // Mixed primitives keep their attributes: flat normals and no place on the image for those that lack them.
        match_attributes(&mut part, &merged);
        if merged.normals.is_empty() && !part.normals.is_empty() {
            merged = with_flat_normals(&merged);
        }
        if !part.uvs.is_empty() {
            merged.uvs.resize(merged.positions.len(), Vec2::ZERO);
        }
        merged.append(&part, materials.len() as u16);
        materials.push(*material);
    }
    (Arc::new(merged), materials)
}

/// Applies the texture transform of the primitive's material (`KHR_texture_transform`) to the texture coordinates.
fn transform_uvs(json: &Root, primitive: &Primitive, part: &mut Mesh) {
    let material = primitive
        .material
        .and_then(|index| json.materials.get(index.value()));
    let info =
        material.and_then(|material| material.pbr_metallic_roughness.base_color_texture.as_ref());
    let extension = info.and_then(|info| info.extensions.as_ref()?.texture_transform.as_ref());
    let Some(transform) = extension else { return };
    let (offset, scale) = (
        Vec2::from(transform.offset.0),
        Vec2::from(transform.scale.0),
    );
    let (s, c) = dwell_scene::math::sin_cos(transform.rotation.0);
    if !(offset.is_finite() && scale.is_finite() && s.is_finite()) {
        return;
    }
    for uv in &mut part.uvs {
        // In the file v counts downwards, here upwards.
        let scaled = Vec2::new(uv.x, 1.0 - uv.y) * scale;
        let turned = Vec2::new(scaled.x * c + scaled.y * s, scaled.y * c - scaled.x * s) + offset;
        *uv = Vec2::new(turned.x, 1.0 - turned.y);
    }
}

/// Gives `part` the attributes that `merged` already has.
fn match_attributes(part: &mut Mesh, merged: &Mesh) {
    if !merged.normals.is_empty() && part.normals.is_empty() {
        *part = with_flat_normals(part);
    }
    if !merged.uvs.is_empty() {
        part.uvs.resize(part.positions.len(), Vec2::ZERO);
    }
}

/// The same mesh with every triangle on its own, so that each has its own normal.
fn with_flat_normals(mesh: &Mesh) -> Mesh {
    let mut flat = Mesh::default();
    for (k, triangle) in mesh.triangles.iter().enumerate() {
        let [a, b, c] = mesh.corners(k);
        let normal = (b - a).cross(c - a).normalize_or(Vec3::Y);
        let base = flat.positions.len() as u32;
        flat.positions.extend([a, b, c]);
        flat.normals.extend([normal; 3]);
        flat.uvs.extend(
            triangle
                .iter()
                .filter_map(|vertex| mesh.uvs.get(*vertex as usize)),
        );
        flat.triangles.push([base, base + 1, base + 2]);
        flat.slots.push(mesh.slot(k));
    }
    flat
}

fn read(
    json: &Root,
    buffers: &Buffers<'_>,
    primitive: &Primitive,
    at: &FileLocation,
    report: &mut LoadReport,
) -> Result<Mesh, String> {
    let attribute = |wanted: &Semantic| {
        let mut found = primitive.attributes.iter();
        found.find_map(|(semantic, index)| {
            matches!(semantic, Checked::Valid(s) if s == wanted).then_some(*index)
        })
    };
    let positions: Vec<[f32; 3]> = floats(
        json,
        buffers,
        attribute(&Semantic::Positions).ok_or("no positions")?,
    )?;
    let vertices = positions.len();
    let mut nan = 0;
    let mut finite = |value: f32| {
        nan += u64::from(!value.is_finite());
        if value.is_finite() { value } else { 0.0 }
    };
    let mut mesh = Mesh {
        positions: positions
            .into_iter()
            .map(|p| Vec3::from(p.map(&mut finite)))
            .collect(),
        ..Mesh::default()
    };
    report.warn_times(at.clone(), WarningKind::NanVertices, nan);
    if let Some(index) = attribute(&Semantic::Normals) {
        let normals: Vec<[f32; 3]> = floats(json, buffers, index)?;
        mesh.normals = normals
            .into_iter()
            .map(|n| Vec3::from(n).try_normalize().unwrap_or(Vec3::Y))
            .collect();
    }
    if let Some(index) = attribute(&Semantic::TexCoords(0)) {
        let uvs: Vec<[f32; 2]> = floats(json, buffers, index)?;
        // glTF counts v downwards from the image's upper edge.
        let up = |[u, v]: [f32; 2]| {
            if u.is_finite() && v.is_finite() {
                Vec2::new(u, 1.0 - v)
            } else {
                Vec2::ZERO
            }
        };
        mesh.uvs = uvs.into_iter().map(up).collect();
    }
    if !(mesh.normals.is_empty() || mesh.normals.len() == vertices)
        || !(mesh.uvs.is_empty() || mesh.uvs.len() == vertices)
    {
        return Err("attributes of different lengths".to_owned());
    }
    let order = match primitive.indices {
        Some(index) => indices(json, buffers, index)?,
        None => (0..vertices as u32).collect(),
    };
    if let Some(index) = order.iter().find(|index| **index as usize >= vertices) {
        return Err(format!("index {index} with {vertices} vertices"));
    }
    mesh.triangles = match primitive.mode {
        Checked::Valid(Mode::Triangles) => {
            order.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect()
        }
        Checked::Valid(Mode::TriangleStrip) => {
            // Every other triangle of a strip turns the other way.
            let turned = |(k, t): (usize, &[u32])| {
                if k % 2 == 0 {
                    [t[0], t[1], t[2]]
                } else {
                    [t[1], t[0], t[2]]
                }
            };
            order.windows(3).enumerate().map(turned).collect()
        }
        Checked::Valid(Mode::TriangleFan) => order
            .get(1..)
            .unwrap_or_default()
            .windows(2)
            .map(|t| [order[0], t[0], t[1]])
            .collect(),
        _ => return Err("points and lines have no surface".to_owned()),
    };
    let flat = |t: &&[u32; 3]| {
        let [a, b, c] = t.map(|vertex| mesh.positions[vertex as usize]);
        (b - a).cross(c - a) == Vec3::ZERO
    };
    let degenerate = mesh.triangles.iter().filter(flat).count() as u64;
    report.warn_times(at.clone(), WarningKind::DegenerateTriangles, degenerate);
    Ok(mesh)
}
