//! The bodies that a law's target names.

use crate::error::PhysicsError;
use crate::model::{BodyDefinition, PhysicsModel};
use dwell_scene::LawValues;
use dwell_scene::law::is_part_named;

/// Returns the bodies that a spec acts on, free or jointed: those of the object that it names, the one of the part that it
/// names as `OBJECT/PART`, or all; in order.
pub(super) fn moving_bodies<'a>(
    values: LawValues<'_>,
    model: &'a PhysicsModel,
) -> Result<Vec<(u32, &'a BodyDefinition)>, PhysicsError> {
    let house = &model.house;
    let object = |plan: &BodyDefinition| house.objects[plan.object].name.as_str();
    let named = |plan: &BodyDefinition, name: &str| {
        let mut parts = plan.parts.iter();
        object(plan) == name || parts.any(|(part, _)| is_part_named(house, *part, name))
    };
    let target = values.spec.target.as_deref();
    let bodies = model.bodies.iter().enumerate();
    let found: Vec<(u32, &BodyDefinition)> = bodies
        .filter(|(_, plan)| target.is_none_or(|name| named(plan, name)))
        .map(|(index, plan)| (index as u32, plan))
        .collect();
    match target {
        Some(name) if found.is_empty() => {
            if let Some(id) = house.object_named(name) {
                return Err(PhysicsError::LawUnfit {
                    law: values.info.id,
                    what: format!("{:?}", house.objects[id].name),
                    why: "no part of it moves".to_owned(),
                });
            }
            let kind = "object that moves (or OBJECT/PART of one)";
            Err(PhysicsError::no_target(
                values.info.id,
                kind,
                name,
                model.bodies.iter().map(object),
            ))
        }
        _ => Ok(found),
    }
}
