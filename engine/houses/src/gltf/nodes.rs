//! The node tree, flattened.

use ::gltf::json::{Index, Root};
use glam::{Affine3A, Mat4, Quat, Vec3};

use crate::damage::Damage;
use crate::report::{At, Report};

/// A node that shows a mesh.
pub(super) struct Instance {
    pub(super) name: String,
    pub(super) mesh: usize,
    pub(super) world_from_mesh: Affine3A,
}

/// All nodes with meshes of the default scene (of all scenes when none is the default), parents first.
pub(super) fn instances(json: &Root, at: &At, report: &mut Report) -> Vec<Instance> {
    let scenes: Vec<_> = match json.scene.and_then(|scene| json.scenes.get(scene.value())) {
        Some(scene) => vec![scene],
        None => json.scenes.iter().collect(),
    };
    let roots = scenes
        .iter()
        .flat_map(|scene| scene.nodes.iter().map(Index::value));
    let mut open: Vec<(usize, Affine3A)> = roots.map(|node| (node, Affine3A::IDENTITY)).collect();
    if json.scenes.is_empty() {
        open.extend((0..json.nodes.len()).map(|node| (node, Affine3A::IDENTITY)));
    }
    open.reverse();
    let mut seen = vec![false; json.nodes.len()];
    let mut found = Vec::new();
    while let Some((index, world_from_parent)) = open.pop() {
        let Some(node) = json.nodes.get(index) else {
            continue;
        };
        // A file may claim a cycle; each node is visited once.
        if std::mem::replace(&mut seen[index], true) {
            continue;
        }
        let parent_from_node = if let Some(numbers) = node.matrix {
            Affine3A::from_mat4(Mat4::from_cols_array(&numbers))
        } else {
            let rotation = node
                .rotation
                .map_or(Quat::IDENTITY, |r| Quat::from_array(r.0).normalize());
            let scale = node.scale.map_or(Vec3::ONE, Vec3::from);
            let translation = node.translation.map_or(Vec3::ZERO, Vec3::from);
            Affine3A::from_scale_rotation_translation(scale, rotation, translation)
        };
        let world_from_mesh = world_from_parent * parent_from_node;
        let node_at = at.field(format_args!("nodes[{index}]"));
        if !world_from_mesh.is_finite() {
            let reason = "it is not finite".to_owned();
            report.warn(node_at, Damage::BadTransform { reason });
            continue;
        }
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
            found.push(Instance {
                name,
                mesh: mesh.value(),
                world_from_mesh,
            });
        }
        if node.skin.is_some() {
            let what = "skins are not read; the mesh stands in its rest pose".to_owned();
            report.warn(node_at, Damage::Simplified { what });
        }
        let children = node.children.iter().flatten().rev();
        open.extend(children.map(|child| (child.value(), world_from_mesh)));
    }
    found
}
