//! Resolution of names in addresses.

use super::Address;
use crate::error::SceneError;
use crate::house::House;
use crate::ids::{Entity, EntityId, JointId, MaterialId, ObjectId, PartId};
use crate::material::library;
use crate::name_suggestions::nearest_names;

/// Number of names that an error lists, the nearest first.
const NEAR: usize = 6;

/// Finds an object by its entity id or by name.
pub(super) fn find_object(
    house: &House,
    address: &Address,
    word: &str,
) -> Result<ObjectId, SceneError> {
    let by_id = word
        .parse()
        .ok()
        .and_then(|id| match house.entity(EntityId(id)) {
            Some(Entity::Object(object)) => Some(object),
            _ => None,
        });
    by_id.or_else(|| house.object_named(word)).ok_or_else(|| {
        let first = house.structure.len() + 1;
        let last = house.structure.len() + house.objects.len();
        address.invalid(format!(
            "no object {word:?}; objects have the ids {first} to {last}, or names"
        ))
    })
}

/// What is told of a name that no substance of the library has.
pub(super) fn no_substance(name: &str) -> String {
    let known = || library().iter().map(|substance| substance.name.as_str());
    format!(
        "no substance {name:?} in the library; of its {} the nearest are {:?}",
        known().count(),
        nearest_names(name, known(), NEAR)
    )
}

pub(super) fn find_material(
    house: &House,
    address: &Address,
    word: &str,
) -> Result<MaterialId, SceneError> {
    let found = house
        .materials
        .iter_ids()
        .find(|(_, material)| material.name == word);
    found.map(|(id, _)| id).ok_or_else(|| {
        let known: Vec<_> = house
            .materials
            .iter()
            .take(12)
            .map(|material| &material.name)
            .collect();
        address.invalid(format!(
            "no material {word:?}; there are {} such as {known:?}",
            house.materials.len()
        ))
    })
}

pub(super) fn find_joint(
    house: &House,
    address: &Address,
    word: &str,
) -> Result<JointId, SceneError> {
    let index = word
        .parse::<u32>()
        .ok()
        .map(JointId)
        .filter(|id| house.joints.get(*id).is_some());
    index.ok_or_else(|| {
        address.invalid(format!(
            "no joint {word:?}; there are {}, counted from 0, or by OBJECT/NAME",
            house.joints.len()
        ))
    })
}

/// Finds a joint by the names of its object and its own.
pub(super) fn find_joint_of(
    house: &House,
    address: &Address,
    object: &str,
    name: &str,
) -> Result<JointId, SceneError> {
    let object = find_object(house, address, object)?;
    let mut joints = house.joints_of(object);
    joints
        .find(|id| house.joints[*id].name == name)
        .ok_or_else(|| {
            let known: Vec<_> = house
                .joints_of(object)
                .map(|id| &house.joints[id].name)
                .collect();
            address.invalid(format!("no joint {name:?}; the object has {known:?}"))
        })
}

/// Finds a part by its number.
pub(super) fn find_part(
    house: &House,
    address: &Address,
    word: &str,
) -> Result<PartId, SceneError> {
    let index = word.parse::<u32>().ok().map(PartId);
    index
        .filter(|id| house.parts.get(*id).is_some())
        .ok_or_else(|| {
            address.invalid(format!(
                "no part {word:?}; there are {}, counted from 0, or by OBJECT/NAME",
                house.parts.len()
            ))
        })
}

/// Finds a part by the names of its object and its own.
pub(super) fn find_part_of(
    house: &House,
    address: &Address,
    object: &str,
    name: &str,
) -> Result<PartId, SceneError> {
    let object = &house.objects[find_object(house, address, object)?];
    let mut parts = object.parts();
    parts
        .find(|id| house.parts[*id].name == name)
        .ok_or_else(|| {
            let known: Vec<_> = object.parts().map(|id| &house.parts[id].name).collect();
            address.invalid(format!("no part {name:?}; the object has {known:?}"))
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_substance_that_there_is_not_is_answered_with_the_nearest() {
        let told = no_substance("woood");
        let said = "no substance \"woood\" in the library; of its ";
        assert!(told.starts_with(said) && told.contains("\"wood"), "{told}");
    }
}
