//! Models ready to be placed: each is built once in a process and shared by all houses.

use super::catalogue::{CatalogueEntry, entries_of};
use super::model::Model;
use super::style::Style;
use dwell_scene::random::RandomKey;
use dwell_scene::{Aabb, Collider, JointKind, Pose};
use glam::Vec3;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Height above which a door leaf counts as high as a person, m.
const HIGH_M: f32 = 1.4;
/// Positions of a joint at which its part is looked at.
const STATIONS: usize = 6;
/// Long pieces are cut into shorter ones before they turn, so that the boxes around them stay tight, m.
const CUT_M: f32 = 0.15;

/// A model with the boxes around its collision pieces.
#[derive(Debug)]
pub struct CachedModel {
    /// The name that furnishing rules use.
    pub kind: &'static str,
    /// The model, shared by all houses of the process.
    pub model: Arc<Model>,
    /// Around each collision piece at the start, model space.
    pub boxes: Vec<Aabb>,
    /// Boxes swept by its doors and drawers, model space.
    pub swept_boxes: Vec<Aabb>,
    /// Boxes of the leaves, wide open, of its doors that are as high as a person, model space.
    pub open_leaves: Vec<Aabb>,
    /// Around everything that is felt, model space.
    pub collider_bounds: Aabb,
    /// The motif of a picture.
    pub picture_id: Option<&'static str>,
}

impl CachedModel {
    /// A model that is not in the catalogue.
    pub fn new(kind: &'static str, model: impl Into<Arc<Model>>) -> Self {
        let model = model.into();
        let (mut boxes, mut swept_boxes, mut open_leaves) = (Vec::new(), Vec::new(), Vec::new());
        for (k, part) in model.parts.iter().enumerate() {
            let pose = model.model_from_part(k);
            boxes.extend(collider_boxes(&part.colliders, &pose));
        }
        for joint in &model.joints {
            let colliders = &model.parts[joint.child].colliders;
            let parent = model.model_from_part(joint.parent);
            let to_axis = Pose::from_position(joint.position);
            let mut swept = Aabb::EMPTY;
            for station in 0..=STATIONS {
                let at = joint.open * station as f32 / STATIONS as f32;
                let motion = match joint.kind {
                    JointKind::Hinge => {
                        Pose::new(Vec3::ZERO, super::shapes::axis_rotation(joint.axis, at))
                    }
                    JointKind::Slide => Pose::from_position(joint.axis * at),
                };
                let pose = parent * to_axis * motion * to_axis.inverse();
                if joint.kind == JointKind::Slide {
                    let all = collider_boxes(colliders, &pose);
                    swept = all.iter().fold(swept, |all, one| all.union(one));
                } else {
                    if station == STATIONS {
                        let open = collider_boxes(colliders, &pose).into_iter();
                        open_leaves.extend(open.filter(|leaf| leaf.max.y > HIGH_M));
                    }
                    let cut = colliders.iter().flat_map(slice_bounds);
                    swept_boxes.extend(cut.map(|piece| piece.transformed(&pose.to_affine())));
                }
            }
            if !swept.is_empty() {
                swept_boxes.push(swept);
            }
        }
        // Thousands of these stay for as long as the process.
        boxes.shrink_to_fit();
        swept_boxes.shrink_to_fit();
        let collider_bounds = boxes.iter().fold(Aabb::EMPTY, |all, one| all.union(one));
        let mut finishes = model.parts.iter().flat_map(|part| &part.finishes);
        let image = finishes.find(|finish| finish.name == "framed_image");
        let picture_id = image.and_then(|image| Some(image.pattern?.generator));
        Self {
            kind,
            model,
            boxes,
            swept_boxes,
            open_leaves,
            collider_bounds,
            picture_id,
        }
    }
}

fn collider_boxes(colliders: &[Collider], pose: &Pose) -> Vec<Aabb> {
    let bounds = |collider: &Collider| match collider {
        Collider::Cuboid {
            part_from_box,
            half_extents,
        } => {
            let place = (*pose * *part_from_box).to_affine();
            Some(Aabb::new(-*half_extents, *half_extents).transformed(&place))
        }
        Collider::Hull { points } => Some(Aabb::from_points(
            points.iter().map(|point| pose.transform_point(*point)),
        )),
        other => other.bounds().map(|b| b.transformed(&pose.to_affine())),
    };
    colliders.iter().filter_map(bounds).collect()
}

/// The box around a collider, cut across its longer level edge.
fn slice_bounds(collider: &Collider) -> Vec<Aabb> {
    let Some(bounds) = collider.bounds() else {
        return Vec::new();
    };
    let size = bounds.size();
    let axis = if size.x > size.z { Vec3::X } else { Vec3::Z };
    let long = size.dot(axis);
    let count = (long / CUT_M).ceil().max(1.0);
    let piece = |k: usize| {
        let from = axis * (long * k as f32 / count);
        let to = axis * (long * (count - k as f32 - 1.0) / count);
        Aabb {
            min: bounds.min + from,
            max: bounds.max - to,
        }
    };
    (0..count as usize).map(piece).collect()
}

/// Returns what is made to measure: equal settings are built once in a process and shared by all houses. `settings` names the thing and
/// says all that `build` depends on.
pub fn cached_custom_model(settings: String, build: impl FnOnce() -> Model) -> Arc<Model> {
    static SHELF: Mutex<BTreeMap<String, Arc<Model>>> = Mutex::new(BTreeMap::new());
    let lock = || SHELF.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = lock().get(&settings) {
        return known.clone();
    }
    let made = Arc::new(build());
    lock().entry(settings).or_insert(made).clone()
}

/// One of the entries of a kind that suit a style, in one of its variants; `None` when there is no such kind.
pub fn cached_model(kind: &str, style: &Style, key: RandomKey) -> Option<Arc<CachedModel>> {
    let mut draw = key.stream();
    let entry = *draw.choose(&entries_of(kind, style))?;
    let variant = draw.bits() % entry.variants;
    Some(variant_of(entry, style, variant))
}

/// A variant of an entry.
fn variant_of(entry: &'static CatalogueEntry, style: &Style, variant: u64) -> Arc<CachedModel> {
    type Shelf = BTreeMap<(&'static str, u64, &'static str, u64), Arc<CachedModel>>;
    static SHELF: Mutex<Shelf> = Mutex::new(BTreeMap::new());
    let lock = || SHELF.lock().unwrap_or_else(PoisonError::into_inner);
    let place = (entry.kind, entry.seed, style.name, variant);
    if let Some(known) = lock().get(&place) {
        return known.clone();
    }
    let key = RandomKey::root(0)
        .child("furniture")
        .child(entry.kind)
        .child(entry.seed)
        .child(style.name)
        .child(variant);
    let made = Arc::new(CachedModel::new(entry.kind, (entry.build)(style, key)));
    lock().entry(place).or_insert(made).clone()
}
