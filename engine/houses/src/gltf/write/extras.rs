//! Meanings of nodes: `extras.dwell`, in our names and SI units.

use dwell_scene::{HouseData, Id, Joint, Object, ObjectId, Part, PartId, Room, Structure};
use serde_json::{Value, json};

/// A room: its kinds, heights and floor. The floor is triangles of `[x, z]`.
pub(super) fn room(room: &Room) -> Value {
    json!({"dwell": {
        "room": room.name,
        "kinds": room.kinds,
        "floor_y": room.floor_y,
        "ceiling_y": room.ceiling_y,
        "footprint": room.footprint,
    }})
}

/// A piece of the building.
pub(super) fn structure(piece: &Structure) -> Value {
    json!({"dwell": {"structure": piece.kind}})
}

/// An object: category, mobility, joints, receptacles, and sounds.
pub(super) fn object(house: &HouseData, id: ObjectId, object: &Object) -> Value {
    let part_name = |id: PartId| house.parts[id].name.as_str();
    let joints: Vec<Value> = house
        .joints
        .iter()
        .filter(|joint| joint.object == id)
        .map(|joint| self::joint(house, joint, part_name))
        .collect();
    let places: Vec<Value> = house
        .receptacles
        .iter()
        .filter(|place| place.object == id)
        .map(|place| {
            json!({
                "name": place.name, "part": part_name(place.part), "holding": place.holding,
                "space_in_part": place.space_in_part,
            })
        })
        .collect();
    let sounds: Vec<Value> = house
        .emitters
        .iter()
        .filter(|emitter| emitter.object == id && emitter.sound_file.is_none())
        .map(|emitter| {
            json!({
                "signal": emitter.signal, "part": part_name(emitter.part), "position": emitter.position,
                "level_db": emitter.level_db,
                "loops": emitter.loops, "start_s": emitter.start_s,
            })
        })
        .collect();
    let mut known = json!({
        "object": object.name,
        "index": id.index(),
        "model": object.model,
        "category": object.category,
        "mobility": object.mobility,
        "pickable": object.pickable,
        "switch": object.switch,
    });
    for (name, rows) in [
        ("joints", joints),
        ("receptacles", places),
        ("sounds", sounds),
    ] {
        if !rows.is_empty() {
            known[name] = Value::Array(rows);
        }
    }
    json!({"dwell": known})
}

/// A part: mass and collision pieces. Those are in part space, which the node's matrix may scale.
pub(super) fn part(part: &Part) -> Value {
    json!({"dwell": {
        "part": part.name,
        "fixed": part.fixed,
        "mass_kg": part.mass_kg,
        "density_kg_m3": part.density_kg_m3,
        "inertial": part.inertial,
        "world_from_part": part.world_from_part,
        "part_from_mesh": part.part_from_mesh,
        "colliders": part.colliders,
    }})
}

/// A joint: its axis through its frame on the parent, its range and its place at the start, rad or m; its motor, and by name
/// the joint that it follows.
fn joint<'a>(house: &HouseData, joint: &Joint, part_name: impl Fn(PartId) -> &'a str) -> Value {
    let mimic = joint.mimic.map(|mimic| {
        json!({
            "leader": house.joints[mimic.leader].name,
            "multiplier": mimic.multiplier,
            "offset": mimic.offset,
        })
    });
    json!({
        "name": joint.name,
        "kind": joint.kind,
        "parent": joint.parent.map(&part_name),
        "child": part_name(joint.child),
        "axis": joint.axis,
        "parent_from_joint": joint.parent_from_joint,
        "child_from_joint": joint.child_from_joint,
        "limits": joint.limits,
        "closed": joint.closed,
        "open": joint.open,
        "initial": joint.initial,
        "friction": joint.friction,
        "damping": joint.damping,
        "armature": joint.armature,
        "servo": joint.servo,
        "mimic": mimic,
        "switches": joint.toggles_switch,
    })
}
