//! Objects from the catalogue, from files, from houses, and boxes.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use dwell_furniture::catalogue::entries;
use dwell_furniture::model::Model;
use dwell_furniture::model_cache::cached_model;
use dwell_furniture::style::{STYLES, Style, StyleSplit};
use dwell_scene::material::library;
use dwell_scene::random::RandomKey;
use dwell_scene::{
    Category, Collider, House, HouseData, Id, Material, MaterialId, Mesh, Mobility, Object,
    ObjectId, Part, PartId, Pose, RoomId,
};
use glam::{Affine3A, Vec3};

use super::apply::EditSession;
use super::copy_objects::copy_objects;
use super::edit_errors::{MAX_SUGGESTIONS, check_range, invalid_field, prefix_field, unknown_name};
use super::edits::{AddObject, ObjectAttributes, ObjectSource, Placement, UpAxis};
use super::{describe, fixtures, mesh_file, place, surfaces};
use crate::building::assembly::HouseAssembly;
use crate::error::HousesError;
use crate::formats::{FORMATS, open_by};
use crate::import::{CategoryRow, category, convex_pieces};
use dwell_scene::name_suggestions::nearest_names;

/// Longest edge and volume of things that a hand can take, m and m³.
const HANDY: (f32, f32) = (0.6, 0.05);
/// Mean density of an unknown thing, over the box around it, kg/m³.
const USUAL_DENSITY_KG_M3: f32 = 300.0;

/// Adds an object; returns its id.
///
/// # Errors
/// [`HousesError::Spec`] for what does not exist or cannot be; what readers of files say.
pub(super) fn add(
    session: &mut EditSession<'_>,
    wanted: &AddObject,
) -> Result<ObjectId, HousesError> {
    if let Some(name) = &wanted.name {
        session.check_name_is_free("name", name)?;
    }
    if wanted.place.at.is_none() && wanted.place.on.is_none() {
        return Err(invalid_field("place", "no place", "`at`, `on`, or both"));
    }
    let id = match &wanted.source {
        ObjectSource::Catalogue { kind, style, seed } => {
            let model =
                model(kind, style.as_deref(), *seed).map_err(prefix_field("what.catalogue"))?;
            add_model_instance(&mut session.data, model)
        }
        ObjectSource::File { path, scale, up } => {
            from_file(session, path, *scale, *up, &wanted.attributes)
                .map_err(prefix_field("what.file"))?
        }
        ObjectSource::Copy { house, object } => {
            copy(session, house.as_deref(), object).map_err(prefix_field("what.copy"))?
        }
        ObjectSource::Box { size_m } => from_box(&mut session.data, *size_m, &wanted.attributes)
            .map_err(prefix_field("what.box"))?,
    };
    describe::set_attributes(&mut session.data, id, &wanted.attributes)
        .map_err(prefix_field("traits"))?;
    if let Some(look) = &wanted.style {
        surfaces::paint_object(&mut session.data, id, None, look).map_err(prefix_field("look"))?;
    }
    place_new_object(session, id, wanted.name.as_deref(), &wanted.place)?;
    if let Some(sound) = &wanted.sound {
        fixtures::attach_sound(session, id, sound).map_err(prefix_field("sound"))?;
    }
    Ok(id)
}

/// Names a new object and puts it into its place.
pub(super) fn place_new_object(
    session: &mut EditSession<'_>,
    id: ObjectId,
    name: Option<&str>,
    placing: &Placement,
) -> Result<(), HousesError> {
    let object = &mut session.data.objects[id];
    // Not yet counted with the others.
    let base = object.category.coarse.clone();
    object.name = String::new();
    let name = name.map_or_else(
        || session.object_index.next_numbered_name(&base),
        str::to_owned,
    );
    let object = &mut session.data.objects[id];
    object.source_id.clone_from(&name);
    object.name = name;
    let change = place::placement_transform(session, id, placing)?;
    place::transform_objects(session, &[id].into(), &change);
    place::update_room_and_level(&mut session.data, id);
    Ok(())
}

/// The style of a name; one for training, drawn by the seed, without a name.
pub(super) fn style(name: Option<&str>, seed: u64) -> Result<&'static Style, HousesError> {
    let train: Vec<&Style> = STYLES
        .iter()
        .filter(|style| style.split == StyleSplit::Train)
        .collect();
    let Some(name) = name else {
        let drawn = RandomKey::root(seed)
            .child("style")
            .stream()
            .below(train.len());
        return Ok(train[drawn]);
    };
    let found = STYLES.iter().find(|style| style.name == name);
    found.ok_or_else(|| {
        unknown_name(
            "style",
            name,
            "styles",
            STYLES.iter().map(|style| style.name),
        )
    })
}

/// The kinds of the catalogue with their categories, by the alphabet.
pub fn kinds() -> BTreeMap<&'static str, &'static str> {
    let entries = entries().iter();
    entries.map(|entry| (entry.kind, entry.category)).collect()
}

/// Returns the error for an unknown kind, which offers the kinds of that category (for a cup: mugs), then those of similar spelling.
fn unknown_kind(kind: &str) -> HousesError {
    let kinds = kinds();
    let is_one = kinds.iter().filter(|(_, category)| **category == kind);
    let mut near: Vec<&str> = is_one.map(|(kind, _)| *kind).collect();
    near.extend(nearest_names(kind, kinds.keys().copied(), MAX_SUGGESTIONS));
    let mut seen = BTreeSet::new();
    near.retain(|kind| seen.insert(*kind));
    near.truncate(MAX_SUGGESTIONS);
    let offer = near.join(", ");
    let count = kinds.len();
    let possible = format!("one of {count} kinds of the catalogue; the nearest are {offer}");
    invalid_field("kind", format_args!("{kind:?}"), possible)
}

/// A model of the catalogue.
pub(super) fn model(
    kind: &str,
    style_name: Option<&str>,
    seed: u64,
) -> Result<Arc<Model>, HousesError> {
    let style = style(style_name, seed)?;
    let made = cached_model(
        kind,
        style,
        RandomKey::root(seed).child("authored").child(kind),
    );
    let made = made.ok_or_else(|| unknown_kind(kind))?;
    Ok(made.model.clone())
}

/// An instance of a model, at the origin.
pub(super) fn add_model_instance(data: &mut HouseData, model: Arc<Model>) -> ObjectId {
    let mut assembly = HouseAssembly::new("", "");
    assembly.add_storey();
    let kind = assembly.add_model(model);
    assembly.add_instance(&kind, Pose::IDENTITY, RoomId(0), 0.0);
    let single = assembly.finish();
    first(&copy_objects(data, &single, &[ObjectId(0)]))
}

fn first(ids: &[ObjectId]) -> ObjectId {
    ids.first().copied().expect("one object was grafted")
}

fn copy(
    session: &mut EditSession<'_>,
    house: Option<&str>,
    name: &str,
) -> Result<ObjectId, HousesError> {
    let source: Arc<House> = match house {
        None => {
            let id = session.object("object", name)?;
            let mut own = HouseData::default();
            let alone = copy_objects(&mut own, &session.data, &[id]);
            return Ok(first(&copy_objects(&mut session.data, &own, &alone)));
        }
        Some(house) => {
            let house = session.files.resolve_house("house", house)?;
            if let Some(known) = session.houses.get(&house) {
                known.clone()
            } else {
                let (opened, _) = open_by(FORMATS, &house, session.threads)?;
                let opened = Arc::new(opened);
                session.houses.insert(house, opened.clone());
                opened
            }
        }
    };
    let id = source.object_named(name).ok_or_else(|| {
        let names = source.objects.iter().map(|object| object.name.as_str());
        unknown_name("object", name, "objects", names)
    })?;
    Ok(first(&copy_objects(&mut session.data, &source, &[id])))
}

fn from_file(
    session: &mut EditSession<'_>,
    path: &str,
    scale: f32,
    up: UpAxis,
    traits: &ObjectAttributes,
) -> Result<ObjectId, HousesError> {
    let loaded = mesh_file::load(session, path, scale, up)?;
    let stem = path.rsplit(['/', '\\']).next().unwrap_or(path);
    let stem = stem.rsplit_once('.').map_or(stem, |(stem, _)| stem);
    let colliders = convex_pieces(
        &loaded.data.meshes[dwell_scene::MeshId(0)],
        &Affine3A::IDENTITY,
    );
    let single = single_rigid_object(
        loaded.data.clone(),
        loaded.materials.clone(),
        colliders,
        stem,
        traits,
    );
    Ok(first(&copy_objects(
        &mut session.data,
        &single,
        &[ObjectId(0)],
    )))
}

fn from_box(
    data: &mut HouseData,
    size_m: [f32; 3],
    traits: &ObjectAttributes,
) -> Result<ObjectId, HousesError> {
    for edge in size_m {
        check_range("size_m", edge, [0.001, 100.0], "m an edge")?;
    }
    let half = 0.5 * Vec3::from(size_m);
    let mut own = HouseData::default();
    own.meshes.push(Arc::new(Mesh::cuboid(-half, half)));
    let wood = library().get_or_default("wood");
    let material = own
        .materials
        .push(Material::from_substance("box_wood", wood));
    let colliders = vec![Collider::cuboid(-half, half)];
    let single = single_rigid_object(own, vec![material], colliders, "box", traits);
    Ok(first(&copy_objects(data, &single, &[ObjectId(0)])))
}

/// The first mesh of `data` as a loose rigid thing; its mass is that of its category over the box around it.
fn single_rigid_object(
    mut data: HouseData,
    materials: Vec<MaterialId>,
    colliders: Vec<Collider>,
    model: &str,
    traits: &ObjectAttributes,
) -> HouseData {
    let mesh = dwell_scene::MeshId(0);
    let bounds = data.meshes[mesh].bounds();
    let row = traits.category.as_deref().and_then(|name| category([name]));
    let density = row.map_or(USUAL_DENSITY_KG_M3, CategoryRow::box_density_kg_m3);
    let mass_kg = (bounds.volume() * density).clamp(0.001, 5_000.0);
    let object = ObjectId::from_index(data.objects.len());
    let first_part = PartId::from_index(data.parts.len());
    data.parts.push(Part {
        object,
        name: "body".to_owned(),
        fixed: false,
        world_from_part: Pose::IDENTITY,
        mesh,
        part_from_mesh: Affine3A::IDENTITY,
        materials,
        colliders,
        mass_kg: Some(mass_kg),
        density_kg_m3: density.clamp(0.1, 30_000.0),
        inertial: None,
    });
    let (longest, volume) = (bounds.size().max_element(), bounds.volume());
    data.objects.push(Object {
        name: model.to_owned(),
        source_id: model.to_owned(),
        model: model.to_owned(),
        category: Category::default(),
        level: dwell_scene::LevelId(0),
        room: None,
        mobility: Mobility::Movable,
        pickable: longest <= HANDY.0 && volume <= HANDY.1,
        switch: row.is_some_and(CategoryRow::is_switchable).then_some(false),
        first_part,
        part_count: 1,
    });
    data
}
