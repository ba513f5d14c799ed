//! Things that a stated goal names: by class, by ids, or by where they are.

use crate::episode::category_of_class;
use crate::episode_spec::StatedGoal;
use crate::error::WorldError;
use crate::world::World;
use dwell_render::{ClassSet, EntityClasses};
use dwell_scene::{Entity, EntityId, ObjectId};
use dwell_semantics::category::categories;
use glam::Vec3;
use std::collections::BTreeSet;

/// Largest distance of a stated point from the box of a thing that is there, m.
const BESIDE_M: f32 = 0.5;

/// The things of a class, and of those that count as it, of which one counts, rising, and the number of the class.
///
/// # Errors
/// [`WorldError::Config`] and [`WorldError::Unknown`] for a class that there is not, here or at all, for a thing that does not exist or
/// is of another class, and for a point where none of the class is.
pub(super) fn resolve_stated_objects(
    world: &World,
    asked: &StatedGoal,
) -> Result<(Vec<ObjectId>, i32), WorldError> {
    let house = world.house();
    let classes = EntityClasses::new(house, ClassSet::Coarse);
    let class_of = |object: ObjectId| classes.of(house.entity_of_object(object).0);
    let stated = asked.class.as_deref().map(class_number).transpose()?;
    let also: Vec<i32> = asked
        .also
        .iter()
        .map(|name| class_number(name))
        .collect::<Result<_, _>>()?;
    if !asked.objects.is_empty() {
        if !asked.positions.is_empty() {
            return Err(fault(
                "episode.goal",
                "one with objects and positions".to_owned(),
                "one of the two".to_owned(),
            ));
        }
        let class_of = |object: ObjectId| {
            let own = class_of(object);
            stated.filter(|_| also.contains(&own)).unwrap_or(own)
        };
        return things_by_id(world, asked, stated, class_of);
    }
    let Some(class) = stated else {
        return Err(fault(
            "episode.goal",
            "one without class and objects".to_owned(),
            "one of ObjectNav with a class, or with objects".to_owned(),
        ));
    };
    let all: Vec<ObjectId> = house
        .objects
        .ids()
        .filter(|object| {
            let own = class_of(*object);
            own == class || also.contains(&own)
        })
        .collect();
    if all.is_empty() {
        let there: BTreeSet<&str> = house
            .objects
            .ids()
            .filter_map(|object| Some(category_of_class(class_of(object))?.name))
            .collect();
        let there: Vec<&str> = there.into_iter().collect();
        return Err(fault(
            "episode.goal.class",
            format!("{:?}", asked.class.as_deref().unwrap_or_default()),
            format!("a class that the house has: {}", there.join(", ")),
        ));
    }
    if asked.positions.is_empty() {
        return Ok((all, class));
    }
    let mut found = BTreeSet::new();
    for place in &asked.positions {
        let point = Vec3::from_array(*place);
        let distance = |object: ObjectId| {
            let bounds = house.object_bounds(world.state(), object);
            point.clamp(bounds.min, bounds.max).distance(point)
        };
        let mut nearest: Option<(f32, ObjectId)> = None;
        for object in &all {
            let away_m = distance(*object);
            if nearest.is_none_or(|(least, _)| away_m < least) {
                nearest = Some((away_m, *object));
            }
        }
        match nearest {
            Some((away_m, object)) if away_m <= BESIDE_M => {
                found.insert(object);
            }
            other => {
                let away_m = other.map_or(f32::INFINITY, |(away_m, _)| away_m);
                let class = asked.class.as_deref().unwrap_or_default();
                return Err(fault(
                    "episode.goal.positions",
                    format!("{place:?}"),
                    format!(
                        "points within {BESIDE_M} m of a thing of the class {class:?}: the nearest is {away_m:.2} m away"
                    ),
                ));
            }
        }
    }
    Ok((found.into_iter().collect(), class))
}

fn things_by_id(
    world: &World,
    asked: &StatedGoal,
    stated: Option<i32>,
    class_of: impl Fn(ObjectId) -> i32,
) -> Result<(Vec<ObjectId>, i32), WorldError> {
    const FIELD: &str = "episode.goal.objects";
    let house = world.house();
    let (mut things, mut class) = (BTreeSet::new(), stated);
    for id in &asked.objects {
        let entity = i32::try_from(*id).ok().map(EntityId);
        let Some(Entity::Object(object)) = entity.and_then(|id| house.entity(id)) else {
            let ends = [house.objects.ids().next(), house.objects.ids().last()];
            let [first, last] = ends.map(|own| own.map_or(0, |own| house.entity_of_object(own).0));
            let allowed = format!("ids of the house's things, {first} to {last}");
            return Err(fault(FIELD, id.to_string(), allowed));
        };
        let own = class_of(object);
        if *class.get_or_insert(own) != own {
            let name = |class: i32| category_of_class(class).map_or("no class", |row| row.name);
            let allowed = format!("things of one class, {}", name(class.unwrap_or_default()));
            return Err(fault(FIELD, format!("{id}, of {}", name(own)), allowed));
        }
        things.insert(object);
    }
    Ok((things.into_iter().collect(), class.unwrap_or_default()))
}

/// The number of a class, by a name or an alias of the table.
fn class_number(name: &str) -> Result<i32, WorldError> {
    let rows = categories().rows();
    let row = categories().get(name);
    let place = row.and_then(|row| rows.iter().position(|other| other.name == row.name));
    place.map(|place| place as i32 + 1).ok_or_else(|| {
        let known = rows.iter().map(|row| row.name.to_owned()).collect();
        WorldError::Unknown {
            kind: "class",
            name: name.to_owned(),
            known,
        }
    })
}

fn fault(field: &'static str, found: String, allowed: String) -> WorldError {
    WorldError::Config {
        field,
        found,
        allowed,
    }
}
