//! The node tree, flattened, with `extras.dwell` of our own files.

use std::fmt;

use ::gltf::json::{Index, Node, Root};
use dwell_scene::{Sky, StructureKind};
use glam::{Affine3A, Mat4, Quat, Vec2, Vec3, Vec4};
use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::extras::{Extras, dwell_extras};
use super::lights::{self, LampExtras};
use crate::import::{
    AnnotatedLight, AnnotatedObject, AnnotatedPart, ImportedLamp, NamedRoom, NodeRole,
};
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// A node that shows a mesh.
pub(super) struct MeshNode {
    pub(super) name: String,
    pub(super) mesh: usize,
    pub(super) world_from_mesh: Affine3A,
    /// The storey and the room that its node stands in, as positions in [`NodeTree`].
    pub(super) level: Option<usize>,
    pub(super) room: Option<usize>,
    pub(super) role: NodeRole,
    /// The object and its part, as positions in [`NodeTree::objects`], whose look this is.
    pub(super) part_of: Option<(usize, usize)>,
}

/// The content of all nodes.
#[derive(Default)]
pub(super) struct NodeTree {
    pub(super) instances: Vec<MeshNode>,
    /// Names of storeys that have rooms.
    pub(super) levels: Vec<String>,
    pub(super) rooms: Vec<NamedRoom>,
    pub(super) sky: Option<Sky>,
    pub(super) lamps: Vec<ImportedLamp>,
    /// Objects with more than shapes and names in the file.
    pub(super) objects: Vec<AnnotatedObject>,
}

/// A node's `extras.dwell`, as far as it is read; `docs/formats/glb.md` has all of it.
#[derive(Default, Deserialize)]
struct DwellNodeExtras {
    #[serde(default)]
    room: Option<String>,
    #[serde(default)]
    kinds: Vec<String>,
    #[serde(default)]
    floor_y: f32,
    #[serde(default)]
    ceiling_y: f32,
    #[serde(default)]
    footprint: Vec<[Vec2; 3]>,
    #[serde(default)]
    structure: Option<StructureKind>,
    #[serde(default)]
    object: Option<String>,
    #[serde(default)]
    part: Option<String>,
    #[serde(default)]
    light: Option<AnnotatedLight>,
    #[serde(default)]
    sky: Option<Sky>,
    #[serde(default)]
    power_w: Option<f32>,
    #[serde(default)]
    on: Option<bool>,
    #[serde(default)]
    light_of: Option<String>,
}

/// A node in the traversal.
struct PendingNode {
    node: usize,
    /// The place in the file that names it.
    named: NodeReferenceSource,
    world_from_parent: Affine3A,
    /// The name of the topmost node above, which is a storey's in our files.
    top: Option<usize>,
    room: Option<usize>,
    /// True for a part of an object.
    of_object: bool,
    /// The object, as a position in [`NodeTree::objects`], when it is complete.
    object: Option<usize>,
}

/// The place in the file that names a node.
#[derive(Clone, Copy)]
enum NodeReferenceSource {
    /// A scene's list, by scene and position.
    Scene(usize, usize),
    /// The table of nodes itself: there are no scenes.
    Table(usize),
    /// A node's children, by node and position.
    Child(usize, usize),
}

impl fmt::Display for NodeReferenceSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene(scene, k) => write!(f, "scenes[{scene}].nodes[{k}]"),
            Self::Table(node) => write!(f, "nodes[{node}]"),
            Self::Child(node, k) => write!(f, "nodes[{node}].children[{k}]"),
        }
    }
}

/// All nodes of the default scene (of all scenes when none is the default), parents first. `trusted`: whether what `extras` say
/// of objects counts.
pub(super) fn node_tree(
    json: &Root,
    trusted: bool,
    at: &FileLocation,
    report: &mut LoadReport,
) -> NodeTree {
    let own = json.scene.map(|scene| scene.value());
    let scenes: Vec<_> = match own.and_then(|k| Some((k, json.scenes.get(k)?))) {
        Some(scene) => vec![scene],
        None => json.scenes.iter().enumerate().collect(),
    };
    let roots = scenes.iter().flat_map(|(s, scene)| {
        let nodes = scene.nodes.iter().map(Index::value).enumerate();
        nodes.map(|(k, node)| (node, NodeReferenceSource::Scene(*s, k)))
    });
    let root = |(node, named): (usize, NodeReferenceSource)| PendingNode {
        node,
        named,
        world_from_parent: Affine3A::IDENTITY,
        top: None,
        room: None,
        of_object: false,
        object: None,
    };
    let mut open: Vec<PendingNode> = roots.map(root).collect();
    if json.scenes.is_empty() {
        open.extend(
            (0..json.nodes.len()).map(|node| root((node, NodeReferenceSource::Table(node)))),
        );
    }
    open.reverse();
    let mut seen = vec![false; json.nodes.len()];
    let mut found = NodeTree::default();
    // Storeys by their nodes, in the order of their first rooms.
    let mut tops: Vec<usize> = Vec::new();
    while let Some(PendingNode {
        node: index,
        named,
        world_from_parent,
        top,
        room,
        of_object,
        object,
    }) = open.pop()
    {
        let Some(node) = json.nodes.get(index) else {
            continue;
        };
        // A file may claim a cycle; each node is visited once.
        if std::mem::replace(&mut seen[index], true) {
            let damage = WarningKind::BadIndex {
                found: index.to_string(),
                reason: "a node that was reached already".to_owned(),
            };
            report.warn(at.field(named), damage);
            continue;
        }
        let node_at = at.field(format_args!("nodes[{index}]"));
        let world_from_mesh = world_from_parent * parent_from_node(node, &node_at, report);
        if !world_from_mesh.is_finite() {
            let reason = "it is not finite".to_owned();
            report.warn(node_at, WarningKind::BadTransform { reason });
            continue;
        }
        let known = read_node_extras(node, &node_at, report);
        let said = LampExtras {
            power_w: known.power_w,
            on: known.on,
            light_of: known.light_of.clone(),
            sky: known.sky.is_some(),
        };
        if let (Some(object), Some(light)) = (object, known.light.clone()) {
            found.objects[object].lights.push(light);
        } else {
            let lamp = lights::light(json, node, world_from_mesh, said, &node_at, report);
            found.lamps.extend(lamp);
        }
        found.sky = found.sky.or(known.sky);
        let own = room_from_extras(
            known.room.as_deref(),
            &known,
            world_from_mesh,
            &node_at,
            report,
        );
        let top = top.unwrap_or(index);
        let of_object = of_object || known.object.is_some();
        let begun = (trusted && known.object.is_some())
            .then(|| read_annotations::<AnnotatedObject>(node, &node_at, report))
            .flatten();
        let object = begun.map_or(object, |mut own| {
            (own.level, own.room) = (Some(top), room);
            found.objects.push(own);
            Some(found.objects.len() - 1)
        });
        let part = (object.is_some() && known.part.is_some())
            .then(|| read_annotations::<AnnotatedPart>(node, &node_at, report))
            .flatten();
        let part_of = object.zip(part).map(|(object, mut part)| {
            part.world_from_node = world_from_mesh;
            part.is_visible = node.mesh.is_some();
            let parts = &mut found.objects[object].parts;
            parts.push(part);
            (object, parts.len() - 1)
        });
        let room = own.map_or(room, |mut own| {
            own.level = tops
                .iter()
                .position(|other| *other == top)
                .unwrap_or_else(|| {
                    tops.push(top);
                    let name = json.nodes.get(top).and_then(|node| node.name.as_deref());
                    let name = name.map_or_else(|| top.to_string(), ToOwned::to_owned);
                    let plain = name.strip_prefix("level_").unwrap_or(&name).to_owned();
                    found.levels.push(plain);
                    tops.len() - 1
                });
            found.rooms.push(own);
            Some(found.rooms.len() - 1)
        });
        if let Some(mesh) = node.mesh {
            let of_mesh = || {
                json.meshes
                    .get(mesh.value())
                    .and_then(|mesh| mesh.name.clone())
            };
            let name = node
                .name
                .clone()
                .or_else(of_mesh)
                .filter(|name| !name.is_empty());
            let name = name.unwrap_or_else(|| format!("node_{index}"));
            found.instances.push(MeshNode {
                name,
                mesh: mesh.value(),
                world_from_mesh,
                level: Some(top),
                room,
                role: match known.structure {
                    Some(kind) => NodeRole::Building(kind),
                    None if of_object => NodeRole::Object,
                    None => NodeRole::Unspecified,
                },
                part_of,
            });
        }
        if node.skin.is_some() {
            let what = "skins are not read; the mesh stands in its rest pose".to_owned();
            report.warn(node_at, WarningKind::Simplified { what });
        }
        let children = node.children.as_deref().unwrap_or_default();
        open.extend(
            children
                .iter()
                .enumerate()
                .rev()
                .map(|(k, child)| PendingNode {
                    node: child.value(),
                    named: NodeReferenceSource::Child(index, k),
                    world_from_parent: world_from_mesh,
                    top: Some(top),
                    room,
                    of_object,
                    object,
                }),
        );
    }
    for object in &mut found.objects {
        object.level = tops.iter().position(|top| Some(*top) == object.level);
    }
    for instance in &mut found.instances {
        instance.level = tops.iter().position(|top| Some(*top) == instance.level);
    }
    found
}

/// Returns the annotations of an object or part in a node; unreadable ones are reported and ignored.
fn read_annotations<T: DeserializeOwned>(
    node: &Node,
    at: &FileLocation,
    report: &mut LoadReport,
) -> Option<T> {
    let text = node.extras.as_ref()?.get();
    let read: Result<Extras<T>, _> = serde_json::from_str(text);
    read.map(|extras| extras.dwell)
        .map_err(|error| {
            let what = format!(
                "what extras.dwell says of an object is not read: {}",
                crate::plain_parse_error(&error)
            );
            report.warn(at.field("extras"), WarningKind::Simplified { what });
        })
        .ok()
}

/// Returns a node's annotations; `None` where `extras` are not ours.
fn read_node_extras(node: &Node, at: &FileLocation, report: &mut LoadReport) -> DwellNodeExtras {
    dwell_extras(node.extras.as_ref().map(|extras| extras.get()), at, report)
}

/// The room that a node is; its numbers count in the world, so that a node that is moved is none.
fn room_from_extras(
    name: Option<&str>,
    known: &DwellNodeExtras,
    world_from_node: Affine3A,
    at: &FileLocation,
    report: &mut LoadReport,
) -> Option<NamedRoom> {
    let name = name?;
    let points = || known.footprint.iter().flatten();
    let finite = points().all(|p| p.is_finite())
        && (known.floor_y..1e4).contains(&known.ceiling_y)
        && known.floor_y > -1e4;
    if world_from_node != Affine3A::IDENTITY || !finite {
        let what = "a room that is moved, or without floor and ceiling, is not read".to_owned();
        report.warn(at.field("extras.dwell"), WarningKind::Simplified { what });
        return None;
    }
    Some(NamedRoom {
        name: name.to_owned(),
        level: 0,
        kinds: known.kinds.clone(),
        footprint: known.footprint.clone(),
        floor_y: known.floor_y,
        ceiling_y: known.ceiling_y,
    })
}

/// The largest difference of a rotation's length from 1, and of a matrix's last row from 0, 0, 0, 1, that is rounding.
const ROUNDING: f32 = 1e-3;

/// The transform that a node states; what the format does not allow is reported.
///
/// # Source
/// Khronos Group, glTF 2.0 specification (2021), section 3.5.3: a node has a matrix or translation, rotation and scale; a matrix can be
/// decomposed into these, and rotations have unit length.
fn parent_from_node(node: &Node, at: &FileLocation, report: &mut LoadReport) -> Affine3A {
    let mut simplified = |what: String| report.warn(at.clone(), WarningKind::Simplified { what });
    let is_stated = node.translation.is_some() || node.rotation.is_some() || node.scale.is_some();
    if let Some(numbers) = node.matrix {
        if is_stated {
            let what = "its matrix counts, the translation, rotation or scale beside it does not";
            simplified(what.to_owned());
        }
        let matrix = Mat4::from_cols_array(&numbers);
        let last = matrix.row(3);
        if (last - Vec4::W).abs().max_element() > ROUNDING {
            let last = last.to_array();
            simplified(format!(
                "the last row of its matrix is {last:?}, and counts as [0, 0, 0, 1]"
            ));
        }
        return Affine3A::from_mat4(matrix);
    }
    let mut rotation = node.rotation.map_or(Vec4::W, |own| Vec4::from(own.0));
    let length = rotation.as_dvec4().length();
    if (length - 1.0).abs() > f64::from(ROUNDING) && length > 0.0 {
        simplified(format!(
            "its rotation has the length {length:.4e}, and counts as one of length 1"
        ));
        // The square of a long one is infinite.
        rotation /= rotation.abs().max_element();
    }
    let rotation = Quat::from_vec4(rotation).normalize();
    let scale = node.scale.map_or(Vec3::ONE, Vec3::from);
    let translation = node.translation.map_or(Vec3::ZERO, Vec3::from);
    Affine3A::from_scale_rotation_translation(scale, rotation, translation)
}
