//! Conversion of the file's assets into our models.

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use dwell_furniture::finishes::Finish;
use dwell_furniture::model::{Model, PartBuilder};
use dwell_furniture::model_cache::cached_model;
use dwell_furniture::shapes::{axis_rotation, block};
use dwell_furniture::style::STYLES;
use dwell_scene::random::RandomKey;
use dwell_scene::{Aabb, Mobility, Pose, RoomId};
use glam::Vec3;
use serde::Deserialize;

use super::file::{ProcThorLight, ProcThorObject};
use super::shell::split_camel_case;
use super::{ProcThorReader, is_valid_position, point, rotation};
use crate::building::assembly::AddedModel;
use crate::import::{CategoryRow, category, category_of};
use crate::warning_kind::{UnmappedKind, WarningKind};

/// Rotation between the file's forward (+Z, our -Z) and the front of our models (+Z).
const HALF_TURN: f32 = std::f32::consts::PI;
/// Stretching beyond which, or below the inverse of which, it is reported.
const ODD_STRETCH: f32 = 3.0;

/// Largest distance of a thing's middle from the box of its room, m: things hang in and on walls.
const OUTSIDE_M: f32 = 0.5;

/// A row of `assets/ai2thor_types.csv`.
#[derive(Deserialize)]
struct TypeRow {
    #[serde(rename = "type")]
    name: String,
    kind: String,
}

/// The kind of the catalogue for a type; `Some("")`: a block of its size.
fn kind_of(type_name: &str) -> Option<&'static str> {
    static TABLE: OnceLock<BTreeMap<String, String>> = OnceLock::new();
    let table = TABLE.get_or_init(|| {
        let text = include_str!("../../../../assets/ai2thor_types.csv");
        csv::Reader::from_reader(text.as_bytes())
            .deserialize::<TypeRow>()
            .map(|row| {
                let row = row.expect("the tables of assets/ are checked by this file's tests");
                (row.name, row.kind)
            })
            .collect()
    });
    table.get(type_name).map(String::as_str)
}

/// The kinds of one house by asset, height and whether they stay.
type AssetKinds = BTreeMap<(String, u32, bool), Option<AddedModel>>;

impl ProcThorReader<'_> {
    /// Adds all objects, those in and on others too.
    pub(super) fn objects(&mut self, objects: &[ProcThorObject]) {
        let mut kinds = AssetKinds::new();
        let mut unsized_count = 0;
        let mut open: Vec<(&ProcThorObject, String, bool)> = objects
            .iter()
            .enumerate()
            .rev()
            .map(|(k, object)| (object, format!("objects[{k}]"), false))
            .collect();
        while let Some((object, at, inside)) = open.pop() {
            self.object(object, &at, inside, &mut kinds, &mut unsized_count);
            let children = object.children.iter().enumerate().rev();
            open.extend(children.map(|(k, child)| (child, format!("{at}.children[{k}]"), true)));
        }
        if unsized_count > 0 {
            let what = format!(
                "{unsized_count} things have the usual size of their kind: \
                 no asset-database.json says how large their assets are"
            );
            self.warn("objects", WarningKind::Simplified { what });
        }
    }

    fn object(
        &mut self,
        object: &ProcThorObject,
        at: &str,
        inside: bool,
        kinds: &mut AssetKinds,
        unsized_count: &mut usize,
    ) {
        let known = self.sizes.get(&object.asset_id);
        let size = known.map(|(_, size)| size);
        let named = object.id.split('|').next().unwrap_or_default();
        let type_name = known.map_or(named, |(kind, _)| kind).to_owned();
        let Some(position) = object.position else {
            let consequence = "the object is left out".to_owned();
            let damage = WarningKind::MissingField { consequence };
            return self.warn(&format!("{at}.position"), damage);
        };
        let (middle, turned) = (point(position), rotation(object.rotation));
        if !is_valid_position(middle) || !turned.is_finite() {
            let reason = format!(
                "it is no place in a house: position (m) and rotation (degrees) need x, y and z, at most 10000 m from the origin; \
                 found {:?}",
                middle.to_array()
            );
            return self.warn(at, WarningKind::BadTransform { reason });
        }
        let Some(room) = self.containing_or_nearest_room(middle).map(|room| room.id) else {
            return;
        };
        // The height of a thing on the floor is twice that of its middle.
        let upright = turned.mul_vec3(Vec3::Y).y > 0.99;
        let stands = 2.0 * (middle.y - self.floor_y);
        let height = (size.is_none() && !inside && upright && stands > 0.0).then_some(stands);
        let key = (
            if object.asset_id.is_empty() {
                type_name.clone()
            } else {
                object.asset_id.clone()
            },
            height.map_or(0, f32::to_bits),
            object.kinematic,
        );
        if !kinds.contains_key(&key) {
            let model = self.model(&type_name, &key.0, size, height, object.kinematic, at);
            let kind = model.map(|model| self.assembly.add_model(model));
            kinds.insert(key.clone(), kind);
        }
        let Some(Some(kind)) = kinds.get(&key) else {
            return;
        };
        *unsized_count += usize::from(size.is_none());
        let center = kind.model.bounds().center();
        let facing = turned * axis_rotation(Vec3::Y, HALF_TURN);
        let pose = Pose::new(middle, facing) * Pose::from_position(-center);
        self.assembly.add_instance(kind, pose, room, 0.0);
        self.rename_last_object(&object.id, &object.asset_id, at);
        self.unassign_room_if_outside(room, middle, at);
    }

    /// Takes the room from the object placed last where its middle lies outside of it, beyond walls, floor and ceiling.
    fn unassign_room_if_outside(&mut self, room: RoomId, middle: Vec3, at: &str) {
        let data = &mut self.assembly.data;
        let around = data.rooms[room].bounds;
        let margin = Vec3::splat(OUTSIDE_M);
        if Aabb::new(around.min - margin, around.max + margin).contains(middle) {
            return;
        }
        if let Some(object) = data.objects.as_mut_slice().last_mut() {
            object.room = None;
        }
        self.warn(at, WarningKind::OutsideRooms);
    }

    /// The model of an asset; `None` for an unknown one.
    fn model(
        &mut self,
        type_name: &str,
        asset: &str,
        size: Option<Vec3>,
        height: Option<f32>,
        stays: bool,
        at: &str,
    ) -> Option<Model> {
        let style = STYLES.first()?;
        let kind = kind_of(type_name);
        if kind.is_none() {
            let (what, name) = (UnmappedKind::Category, type_name.to_owned());
            self.warn(at, WarningKind::Unmapped { what, name });
        }
        let key = RandomKey::root(0).child("procthor").child(asset);
        let ours = kind
            .filter(|kind| !kind.is_empty())
            .and_then(|kind| cached_model(kind, style, key));
        let mut model = match (ours, size) {
            (Some(ours), _) => Model::clone(&ours.model),
            (None, Some(size)) => plain_block(type_name, size),
            (None, None) => return None,
        };
        let now = model.bounds().size();
        let mounted = category([model.category]).is_some_and(CategoryRow::is_mounted);
        let by = match (size, height) {
            (Some(size), _) => size / now,
            (None, Some(height)) if !mounted => Vec3::new(1.0, height / now.y, 1.0),
            _ => Vec3::ONE,
        };
        if !by.is_finite() || by.max_element() > ODD_STRETCH || by.min_element() < 1.0 / ODD_STRETCH
        {
            // Without a table a middle may be that of a thing on a shelf.
            if size.is_none() {
                return Some(with_fixed_base(model, stays));
            }
            let what = format!("{type_name} is our {} stretched by {by:.2}", model.name);
            self.warn(at, WarningKind::Simplified { what });
        }
        if by != Vec3::ONE {
            model = model.stretched(by);
        }
        Some(with_fixed_base(model, stays))
    }

    /// A ceiling lamp below the ceiling wherever the file has a point of light.
    pub(super) fn lamps(&mut self, lights: &[ProcThorLight]) {
        let Some(style) = STYLES.first() else { return };
        let Some(lamp) = cached_model("ceiling_lamp", style, RandomKey::root(0).child("procthor"))
        else {
            return;
        };
        let kind = self.assembly.add_model(Arc::clone(&lamp.model));
        let top = lamp.model.bounds().max.y;
        for (k, light) in lights.iter().enumerate() {
            if light.kind != "point" {
                continue;
            }
            let at = point(light.position);
            if !is_valid_position(at) {
                let field = format!("proceduralParameters.lights[{k}]");
                let reason = "its position (m) needs x, y and z".to_owned();
                self.warn(&field, WarningKind::BadTransform { reason });
                continue;
            }
            if let Some(room) = self.containing_or_nearest_room(at) {
                let (id, up) = (room.id, room.ceiling_y - top);
                let pose = Pose::from_position(at.with_y(up));
                self.assembly.add_instance(&kind, pose, id, 0.0);
            }
        }
    }
}

/// A model that is fixed, if `stays`; its doors and drawers still move.
fn with_fixed_base(mut model: Model, stays: bool) -> Model {
    if stays && model.mobility == Mobility::Movable {
        model.mobility = if model.joints.is_empty() {
            Mobility::Fixed
        } else {
            Mobility::Articulated
        };
        model.pickable = false;
    }
    model
}

/// A block for an asset of which only size and name are known.
fn plain_block(type_name: &str, size: Vec3) -> Model {
    let wood = Finish::plain("unknown", "wood", [170, 150, 124]);
    let half = size * 0.5;
    let shape = block([-half.x, 0.0, -half.z], [half.x, size.y, half.z]);
    let row = category_of(&split_camel_case(type_name));
    let category = row.map_or("object", |row| row.name.as_str());
    let model = if size.max_element() < 0.4 {
        Model::pickable("block", category)
    } else {
        Model::movable("block", category)
    };
    // Most of a thing's box is air.
    model.part(PartBuilder::new("body").with_fill_fraction(&wood, shape, 0.3))
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_furniture::catalogue::entries;

    #[test]
    fn every_type_has_a_kind_of_the_catalogue_or_is_a_block() {
        let text = include_str!("../../../../assets/ai2thor_types.csv");
        let rows = csv::Reader::from_reader(text.as_bytes())
            .deserialize::<TypeRow>()
            .collect::<Result<Vec<_>, _>>()
            .unwrap();
        assert!(rows.len() > 100);
        for row in rows {
            let known = entries().iter().any(|entry| entry.kind == row.kind);
            assert!(row.kind.is_empty() || known, "{}: {}", row.name, row.kind);
            let style = &STYLES[0];
            assert!(
                row.kind.is_empty() || cached_model(&row.kind, style, RandomKey::root(1)).is_some(),
                "{}: {} does not suit {}",
                row.name,
                row.kind,
                style.name
            );
        }
    }
}
