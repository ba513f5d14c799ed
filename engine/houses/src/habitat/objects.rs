//! Rigid objects.

use dwell_scene::{
    Aabb, Category, Collider, HouseData, LevelId, Mobility, Object, ObjectId, Part, PartId, RoomId,
    space,
};
use glam::{Affine3A, Vec2, Vec3};

use super::HabitatReader;
use super::assets::AssetCache;
use super::dataset::{ResolvedTemplate, TemplateKind};
use super::file::{ObjectInstance, Template};
use super::place;
use crate::import::{CategoryRow, HullPointSets, category, category_of};
use crate::report::FileLocation;
use crate::warning_kind::{UnmappedKind, WarningKind};

/// Largest distance of a thing from its room's range of heights, m.
const ROOM_M: f32 = 0.3;

impl HabitatReader<'_> {
    /// Adds the object that `instance` places.
    pub(super) fn object(&mut self, instance: &ObjectInstance, at: &FileLocation) {
        let name = &instance.template_name;
        let Some(found) = self.template(TemplateKind::Object, name, at) else {
            return;
        };
        let Some(template) = self.parse::<Template>(&found) else {
            return;
        };
        let (pose, scale, frame) = match place::placement(instance, &template) {
            Ok(placement) => placement,
            Err(reason) => {
                return self
                    .report
                    .warn(at.clone(), WarningKind::BadTransform { reason });
            }
        };
        let Some(path) = AssetCache::path(&found, &template.render_asset, self.report) else {
            return;
        };
        let (root, threads) = (&self.dataset.root, self.threads);
        let Some(asset) =
            self.assets
                .merged_asset(root, &path, &mut self.data, threads, self.report)
        else {
            return;
        };
        let object_from_asset = Affine3A::from_scale(scale) * frame;
        // Habitat moves an object's origin to its centre of mass; a translation may count from there or from the asset's origin.
        let origin = if self.is_translated_by_com(instance) {
            let middle = asset.bounds.transformed(&object_from_asset).center();
            template
                .com
                .map_or(middle, |com| Vec3::from_array(com) * scale)
        } else {
            Vec3::ZERO
        };
        let part_from_mesh = Affine3A::from_translation(-origin) * object_from_asset;
        let world_from_mesh = pose.to_affine() * part_from_mesh;
        let Some((world_from_part, part_from_mesh)) = space::split_affine(&world_from_mesh) else {
            let reason = "it flattens space or is not finite".to_owned();
            return self
                .report
                .warn(at.clone(), WarningKind::BadTransform { reason });
        };
        let bounds = asset.bounds.transformed(&world_from_mesh);
        let row = self.category(name, template.semantic_id, &found);
        let moves = instance
            .motion_type
            .as_deref()
            .is_some_and(|kind| kind.eq_ignore_ascii_case("DYNAMIC"));
        let colliders = if moves {
            let shape = self.collision_shape(&found, &template, &path);
            let shape = shape.unwrap_or_else(|| {
                self.assets
                    .collision_shape_of_merged(&path, &asset, &self.data)
            });
            shape.hulls(&part_from_mesh)
        } else {
            vec![Collider::ExactMesh]
        };
        let density_kg_m3 = row
            .map_or(300.0, CategoryRow::box_density_kg_m3)
            .clamp(0.1, 30_000.0);
        let own_box = asset.bounds.transformed(&part_from_mesh);
        let grown = if instance.apply_scale_to_mass {
            scale.to_array().iter().product::<f32>().abs()
        } else {
            1.0
        };
        let stated = template.mass.filter(|mass| *mass > 0.0 && mass.is_finite());
        if let (Some(mass), None) = (template.mass, stated) {
            let damage = WarningKind::BadField {
                found: mass.to_string(),
                expected: "a mass above 0 kg".to_owned(),
            };
            self.report.warn(found.at.field("mass"), damage);
        }
        let mass_kg = stated.map_or(own_box.volume() * density_kg_m3, |mass| mass * grown);
        let (room, level) = containing_room_and_level(&self.data, &bounds);
        let first_part = PartId(self.data.parts.len() as u32);
        let object = ObjectId(self.data.objects.len() as u32);
        self.data.parts.push(Part {
            object,
            name: "body".to_owned(),
            fixed: !moves,
            world_from_part,
            mesh: asset.mesh,
            part_from_mesh,
            materials: asset.materials,
            colliders,
            mass_kg: moves.then(|| mass_kg.clamp(0.001, 5_000.0)),
            inertial: None,
            density_kg_m3,
        });
        let handy = own_box.size().max_element() <= 0.6 && own_box.volume() <= 0.05;
        let word = name.rsplit('/').next().unwrap_or(name);
        let base = row.map_or(word, |row| row.name.as_str());
        let name = self.names.numbered(base);
        self.data.objects.push(Object {
            name,
            source_id: instance.template_name.clone(),
            model: word.to_owned(),
            category: coarse_category(row),
            level,
            room,
            mobility: if moves {
                Mobility::Movable
            } else {
                Mobility::Fixed
            },
            pickable: moves && handy,
            switch: row.is_some_and(CategoryRow::is_switchable).then_some(false),
            first_part,
            part_count: 1,
        });
    }

    /// The collision asset's mesh in the render asset's pose, where a template has one of its own.
    fn collision_shape(
        &mut self,
        found: &ResolvedTemplate,
        template: &Template,
        render: &str,
    ) -> Option<std::sync::Arc<HullPointSets>> {
        if template.collision_asset.is_empty() {
            return None;
        }
        let path = AssetCache::path(found, &template.collision_asset, self.report)?;
        if path == render {
            return None;
        }
        let (root, threads) = (&self.dataset.root, self.threads);
        self.assets
            .collision_shape(root, &path, threads, self.report)
    }

    /// Returns whether the translation of an instance is that of its centre of mass.
    pub(super) fn is_translated_by_com(&self, instance: &ObjectInstance) -> bool {
        let own = instance.translation_origin.as_deref();
        own.or(self.origin.as_deref())
            .is_some_and(|word| word.eq_ignore_ascii_case("COM"))
    }

    /// The category of a template: by its semantic id, else by its name.
    pub(super) fn category(
        &mut self,
        name: &str,
        semantic_id: Option<i64>,
        found: &ResolvedTemplate,
    ) -> Option<&'static CategoryRow> {
        let word = name.rsplit('/').next().unwrap_or(name);
        let class = semantic_id.and_then(|id| self.lexicon.get(&id));
        let by_class = class.and_then(|class| {
            let plain = class.to_ascii_lowercase().replace([' ', '-', '/'], "_");
            category([plain.as_str()]).or_else(|| category_of(class))
        });
        let row = by_class.or_else(|| category_of(word));
        if row.is_none() {
            let (what, name) = (
                UnmappedKind::Category,
                class.map_or(word, |class| class).to_owned(),
            );
            self.report
                .warn(found.at.clone(), WarningKind::Unmapped { what, name });
        }
        row
    }
}

pub(super) fn coarse_category(row: Option<&CategoryRow>) -> Category {
    row.map_or_else(Category::default, |row| Category {
        fine: row.name.clone(),
        coarse: row.name.clone(),
        nyu40: row.nyu40_name.clone(),
    })
}

/// The room and the storey of a box.
pub(super) fn containing_room_and_level(
    data: &HouseData,
    bounds: &Aabb,
) -> (Option<RoomId>, LevelId) {
    let middle = bounds.center();
    let room = data.rooms.iter_ids().find(|(_, room)| {
        room.contains_xz(Vec2::new(middle.x, middle.z))
            && middle.y > room.floor_y - ROOM_M
            && middle.y < room.ceiling_y + ROOM_M
    });
    if let Some((id, room)) = room {
        return (Some(id), room.level);
    }
    let below = data
        .levels
        .iter()
        .rposition(|level| level.bounds.min.y <= middle.y);
    (None, LevelId(below.unwrap_or(0) as u32))
}
