//! Lamps of files that know lights by their positions alone: each is attached to the object that it most likely belongs to.

use dwell_scene::{Aabb, HouseData, Id, Light, LightShape, Mobility, ObjectId, interrupt};
use glam::Vec3;

/// Largest distance at which a moving thing counts as a lamp's own, m.
const OWN_M: f32 = 0.5;

/// A light of a file, in the world.
pub(crate) struct ImportedLamp {
    /// m.
    pub(crate) position: Vec3,
    /// Axis of a spot's cone, unit length, and half of its opening angle, rad.
    pub(crate) cone: Option<(Vec3, f32)>,
    /// Linear light, each 0 to 1.
    pub(crate) color: [f32; 3],
    pub(crate) power_w: f32,
    /// The object that it belongs to by the file, or whose parts it belongs to.
    pub(crate) object_name: Option<String>,
    /// True if it is on at the start.
    pub(crate) on: bool,
}

/// Returns whether `name` is that of an object or of one of its parts: `fridge_1.door` is of `fridge_1`.
fn names_object_or_part(name: &str, thing: &str) -> bool {
    let rest = name.strip_prefix(thing);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// Attaches lamps to the objects that the file names, else to the nearest, which get a switch: to a moving one only if it is right there.
/// `bounds`: the box of each object. Without an object there are no lamps.
pub(super) fn attach_lamps(lamps: Vec<ImportedLamp>, data: &mut HouseData, bounds: &[Aabb]) {
    for lamp in lamps {
        interrupt::unwind_if_cancelled();
        let apart_m = |k: usize| {
            let own = &bounds[k];
            let apart = (lamp.position.clamp(own.min, own.max) - lamp.position).length();
            let moves = data.objects[ObjectId::from_index(k)].mobility == Mobility::Movable;
            let far = moves && apart > OWN_M;
            let named = |wanted: &String| {
                names_object_or_part(&data.objects[ObjectId::from_index(k)].source_id, wanted)
            };
            let other = !lamp.object_name.as_ref().is_some_and(named);
            ((other, far), apart)
        };
        let nearest = (0..bounds.len()).min_by(|a, b| {
            let (a, b) = (apart_m(*a), apart_m(*b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
        let Some(object) = nearest.map(ObjectId::from_index) else {
            return;
        };
        let carrier = &mut data.objects[object];
        let before = data.lights.iter().any(|light| light.object == object);
        carrier.switch = Some(lamp.on || (before && carrier.switch == Some(true)));
        let part = carrier.first_part;
        let part_from_world = data.parts[part].world_from_part.inverse();
        data.lights.push(Light {
            object,
            part,
            position: part_from_world.transform_point(lamp.position),
            shape: lamp
                .cone
                .map_or(LightShape::Point, |(direction, cutoff_rad)| {
                    LightShape::Spot {
                        direction: part_from_world.transform_vector(direction),
                        cutoff_rad,
                        dropoff_rate: 0.0,
                    }
                }),
            color: lamp.color,
            power_w: lamp.power_w,
            attenuation: [0.0, 0.0, 1.0],
        });
    }
}
