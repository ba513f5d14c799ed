//! The contacts that a law's target names.

use super::collider_entry::{ColliderMetadata, ContactEntity};
use super::contact_law::ContactSide;
use super::substances::ContactTable;
use crate::error::PhysicsError;
use crate::model::PhysicsModel;
use dwell_scene::material::library;
use dwell_scene::{House, LawValues, ObjectId, StructureId};

/// All objects, pieces of structure and the substance that one name of a contact's target stands for.
#[derive(Clone, Debug, PartialEq)]
struct NamedContactTarget {
    objects: Vec<ObjectId>,
    structure: Vec<StructureId>,
    substance: Option<&'static str>,
}

impl NamedContactTarget {
    fn of(house: &House, name: &str) -> Option<Self> {
        let objects = house.objects.iter_ids();
        let structure = house.structure.iter_ids();
        let named = Self {
            objects: objects
                .filter(|(_, object)| object.name == name)
                .map(|(id, _)| id)
                .collect(),
            structure: structure
                .filter(|(_, piece)| piece.name == name)
                .map(|(id, _)| id)
                .collect(),
            substance: library().get(name).map(|substance| substance.name.as_str()),
        };
        let nothing =
            named.objects.is_empty() && named.structure.is_empty() && named.substance.is_none();
        (!nothing).then_some(named)
    }

    fn is_thing(&self, house: &House, contact_entity: Option<ContactEntity>) -> bool {
        match contact_entity {
            Some(ContactEntity::Part(part)) => self.objects.contains(&house.parts[part].object),
            Some(ContactEntity::Structure(id)) => self.structure.contains(&id),
            _ => false,
        }
    }

    fn matches_side(&self, house: &House, side: &ContactSide<'_>) -> bool {
        self.substance == Some(side.substance) || self.is_thing(house, side.contact_entity)
    }
}

/// The contacts that a law changes. A target is `NAME` (all contacts of the thing) or `NAME~NAME` (those between the two,
/// in either order); a name is that of an object, of a piece of the structure or of a substance of the materials library.
/// No target: all contacts.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ContactScope {
    one: Option<NamedContactTarget>,
    other: Option<NamedContactTarget>,
}

impl ContactScope {
    pub(crate) fn of(values: LawValues<'_>, model: &PhysicsModel) -> Result<Self, PhysicsError> {
        let house = &model.house;
        let Some(target) = &values.spec.target else {
            return Ok(Self {
                one: None,
                other: None,
            });
        };
        let named = |name: &str| {
            NamedContactTarget::of(house, name).ok_or_else(|| {
                let objects = house.objects.iter().map(|object| object.name.as_str());
                let structure = house.structure.iter().map(|piece| piece.name.as_str());
                let kind = "object, structure or substance";
                PhysicsError::no_target(values.info.id, kind, name, objects.chain(structure))
            })
        };
        // An object's own name may contain the separator.
        if let Some(whole) = NamedContactTarget::of(house, target) {
            return Ok(Self {
                one: Some(whole),
                other: None,
            });
        }
        Ok(match target.split_once('~') {
            Some((one, other)) => Self {
                one: Some(named(one)?),
                other: Some(named(other)?),
            },
            None => Self {
                one: Some(named(target)?),
                other: None,
            },
        })
    }

    /// Returns whether rapier must ask the hook about the pairs of a collider.
    pub(crate) fn needs_hook(
        &self,
        house: &House,
        table: &ContactTable,
        entry: &ColliderMetadata,
    ) -> bool {
        let Some(one) = &self.one else {
            return entry.body.is_some();
        };
        let made_of = |class: u16| one.substance == Some(table.substance(class));
        entry.surface.any_material(made_of) || one.is_thing(house, entry.contact_entity)
    }

    /// Returns whether a contact is within the scope, and if so, whether `b` is the surface and not `a`.
    pub(crate) fn match_sides(
        &self,
        house: &House,
        a: &ContactSide<'_>,
        b: &ContactSide<'_>,
    ) -> Option<bool> {
        let is = |named: &Option<NamedContactTarget>, side: &ContactSide<'_>| {
            named
                .as_ref()
                .is_none_or(|named| named.matches_side(house, side))
        };
        let (forth, back) = (
            is(&self.one, a) && is(&self.other, b),
            is(&self.one, b) && is(&self.other, a),
        );
        match (forth, back) {
            (false, false) => None,
            (true, false) => Some(false),
            (false, true) => Some(true),
            // Structure sorts before parts, parts before agents.
            (true, true) => Some(a.contact_entity > b.contact_entity),
        }
    }
}
