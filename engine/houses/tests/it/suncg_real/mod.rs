//! Facts 1 to 18 and 21 to 24 of the format's reference page, on the real sample house. Skips, with a line, where the
//! data is absent.

#![allow(
    clippy::unwrap_used,
    reason = "tests stop at the first surprise and compare exact numbers"
)]

use crate::common;

mod content;
mod geometry;

use dwell_houses::obj;
use dwell_houses::suncg::ParsedSuncgFiles;
use dwell_houses::suncg::file::SuncgNode;
use glam::{DMat4, DVec3};

pub(crate) fn nodes(files: &ParsedSuncgFiles) -> &[SuncgNode] {
    &files.house.levels[0].nodes
}

pub(crate) fn model_of(node: &SuncgNode) -> &str {
    node.model_id.as_deref().unwrap()
}

pub(crate) fn objects(files: &ParsedSuncgFiles) -> impl Iterator<Item = (usize, &SuncgNode)> {
    nodes(files)
        .iter()
        .enumerate()
        .filter(|(_, node)| node.kind.as_deref() == Some("Object"))
}

pub(crate) fn matrix(node: &SuncgNode) -> DMat4 {
    DMat4::from_cols_array(node.transform.as_deref().unwrap().try_into().unwrap())
}

pub(crate) fn object_mesh<'a>(files: &'a ParsedSuncgFiles, model: &str) -> &'a obj::file::ObjFile {
    &files.meshes[&format!("object/{model}/{model}.obj")].obj
}

pub(crate) fn room_mesh(files: &ParsedSuncgFiles, room: usize, part: char) -> &obj::file::ObjFile {
    &files.meshes[&format!("room/{}/fr_0rm_{room}{part}.obj", files.scene_id)].obj
}

pub(crate) fn bounds(points: impl Iterator<Item = DVec3>) -> (DVec3, DVec3) {
    points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| {
        (low.min(p), high.max(p))
    })
}

pub(crate) fn positions(mesh: &obj::file::ObjFile) -> impl Iterator<Item = DVec3> + '_ {
    mesh.positions.iter().map(|p| DVec3::from(p.map(f64::from)))
}

pub(crate) fn stated(node: &SuncgNode) -> (DVec3, DVec3) {
    let corner = |c: &Option<Vec<f64>>| DVec3::from_slice(c.as_deref().unwrap());
    let bbox = node.bbox.as_ref().unwrap();
    (corner(&bbox.min), corner(&bbox.max))
}

pub(crate) fn difference(a: (DVec3, DVec3), b: (DVec3, DVec3)) -> f64 {
    (a.0 - b.0).abs().max((a.1 - b.1).abs()).max_element()
}
