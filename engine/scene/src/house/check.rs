//! The one check of a house's tables.

use super::check_rooms;
use super::data::{AgentStart, HouseData, Mobility, Room};
use crate::articulation::{Joint, Mimic};
use crate::collider::Collider;
use crate::error::{SceneError, check_range};
use crate::fixtures::{LightShape, SoundFile};
use crate::ids::{Id, IdVec, JointId, MaterialId, MeshId};
use crate::interrupt;
use crate::space::is_singular;
use glam::Vec3A;
use std::collections::BTreeSet;

/// Largest coordinate of anything, m: beyond it f32 positions are coarser than 4 mm.
pub(super) const LARGEST_COORDINATE_M: f32 = 32_768.0;

pub(super) fn check_id<I: Id, T>(
    at: &str,
    table: &'static str,
    items: &IdVec<I, T>,
    id: I,
) -> Result<(), SceneError> {
    if id.index() < items.len() {
        return Ok(());
    }
    Err(SceneError::Dangling {
        at: at.to_owned(),
        table,
        index: id.index(),
        count: items.len(),
    })
}

fn unique<'a>(table: &str, names: impl Iterator<Item = &'a str>) -> Result<(), SceneError> {
    let mut seen = BTreeSet::new();
    for (k, name) in names.enumerate() {
        let at = format!("{table}[{k}]");
        check_range(
            &at,
            "name",
            !name.is_empty(),
            "empty",
            "a name of at least one character",
        )?;
        if !seen.insert(name) {
            return Err(SceneError::DuplicateName {
                at,
                name: name.to_owned(),
            });
        }
    }
    Ok(())
}

fn slots(
    data: &HouseData,
    at: &str,
    mesh: MeshId,
    materials: &[MaterialId],
) -> Result<(), SceneError> {
    check_id(at, "meshes", &data.meshes, mesh)?;
    for material in materials {
        check_id(at, "materials", &data.materials, *material)?;
    }
    let used = data.meshes[mesh].slot_count();
    check_range(
        at,
        "materials",
        used <= materials.len(),
        materials.len(),
        "one for each slot that the mesh uses",
    )
}

pub(super) fn is_within_coordinate_limit(coordinate_m: f32) -> bool {
    coordinate_m.abs() <= LARGEST_COORDINATE_M
}

/// Checks every index, name and range of `data`.
pub(super) fn check(data: &HouseData) -> Result<(), SceneError> {
    let rooms = data.rooms.len();
    check_range(
        "house",
        "rooms",
        rooms <= Room::MAX_PER_HOUSE,
        rooms,
        "at most 500",
    )?;
    unique("rooms", data.rooms.iter().map(|room| room.name.as_str()))?;
    unique(
        "structure",
        data.structure.iter().map(|piece| piece.name.as_str()),
    )?;
    unique(
        "objects",
        data.objects.iter().map(|object| object.name.as_str()),
    )?;
    unique(
        "materials",
        data.materials.iter().map(|material| material.name.as_str()),
    )?;
    let entities = data.structure.len() + data.objects.len();
    check_range(
        "house",
        "structure and objects",
        entities < 1 << 30,
        entities,
        "fewer than 2^30",
    )?;
    for (id, mesh) in data.meshes.iter_ids() {
        interrupt::unwind_if_cancelled();
        mesh.check(&format!("meshes[{}]", id.0))?;
    }
    for (id, texture) in data.textures.iter_ids() {
        texture.check(&format!("textures[{}]", id.0))?;
    }
    for (id, material) in data.materials.iter_ids() {
        let at = format!("materials[{}] {:?}", id.0, material.name);
        material.check(&at)?;
        if let Some(texture) = material.texture {
            check_id(&at, "textures", &data.textures, texture)?;
        }
    }
    check_rooms::check(data)?;
    for (id, piece) in data.structure.iter_ids() {
        interrupt::unwind_if_cancelled();
        let at = format!("structure[{}] {:?}", id.0, piece.name);
        check_id(&at, "levels", &data.levels, piece.level)?;
        if let Some(room) = piece.room {
            check_id(&at, "rooms", &data.rooms, room)?;
        }
        slots(data, &at, piece.mesh, &piece.materials)?;
        let bounds = data.meshes[piece.mesh].bounds();
        let far = bounds.min.abs().max(bounds.max.abs()).max_element();
        check_range(
            &at,
            "mesh",
            bounds.is_empty() || far <= LARGEST_COORDINATE_M,
            far,
            "coordinates within 32768 m of the origin",
        )?;
    }
    objects(data)?;
    check_rooms::level_and_room_bounds(data)?;
    joints(data)?;
    fixtures(data)?;
    data.sky.map_or(Ok(()), |sky| sky.check())
}

fn objects(data: &HouseData) -> Result<(), SceneError> {
    let mut next_part = 0;
    for (id, object) in data.objects.iter_ids() {
        let at = format!("objects[{}] {:?}", id.0, object.name);
        check_id(&at, "levels", &data.levels, object.level)?;
        if let Some(room) = object.room {
            check_id(&at, "rooms", &data.rooms, room)?;
        }
        let follows = object.first_part.0 == next_part && object.part_count > 0;
        check_range(
            &at,
            "first_part",
            follows,
            object.first_part.0,
            "parts in the order of the objects, at least one each",
        )?;
        let left = data.parts.len() - next_part as usize;
        check_range(
            &at,
            "part_count",
            object.part_count as usize <= left,
            object.part_count,
            "parts that exist",
        )?;
        next_part += object.part_count;
        for part in object.parts() {
            interrupt::unwind_if_cancelled();
            let part = &data.parts[part];
            let at = format!("{at} part {:?}", part.name);
            check_range(
                &at,
                "object",
                part.object == id,
                part.object.0,
                "the object that lists it",
            )?;
            check_range(
                &at,
                "fixed",
                part.fixed || object.mobility != Mobility::Fixed,
                part.fixed,
                "true in a fixed object",
            )?;
            check_range(
                &at,
                "world_from_part",
                part.world_from_part.is_valid(),
                "not rigid",
                "finite with a unit quaternion",
            )?;
            let far = part.world_from_part.position.abs().max_element();
            check_range(
                &at,
                "world_from_part",
                far <= LARGEST_COORDINATE_M,
                far,
                "within 32768 m of the origin",
            )?;
            check_range(
                &at,
                "part_from_mesh",
                part.part_from_mesh.is_finite(),
                "not finite",
                "finite numbers",
            )?;
            check_range(
                &at,
                "part_from_mesh",
                !is_singular(&part.part_from_mesh.matrix3),
                "a transform that flattens space",
                "one that keeps a volume",
            )?;
            if part.mesh.index() < data.meshes.len() {
                let bounds = data.meshes[part.mesh].bounds();
                let reach = Vec3A::from(bounds.min.abs().max(bounds.max.abs()));
                let map = &part.part_from_mesh;
                let far = map.matrix3.abs() * reach + map.translation.abs();
                let far = far.max_element();
                check_range(
                    &at,
                    "mesh",
                    bounds.is_empty() || far <= LARGEST_COORDINATE_M,
                    far,
                    "coordinates within 32768 m of the part's origin",
                )?;
            }
            check_range(
                &at,
                "density_kg_m3",
                (0.01..=30_000.0).contains(&part.density_kg_m3),
                part.density_kg_m3,
                "0.01 to 30000",
            )?;
            if let Some(mass) = part.mass_kg {
                check_range(
                    &at,
                    "mass_kg",
                    (1e-6..=1e6).contains(&mass),
                    mass,
                    "1e-6 to 1e6",
                )?;
            }
            if let Some(inertial) = &part.inertial {
                let (ok, found) = (inertial.is_valid(), format!("{:?}", inertial.moments));
                let allowed =
                    "finite, principal moments above 0 with none above the sum of the other two";
                check_range(
                    &at,
                    "inertial",
                    ok && part.mass_kg.is_some(),
                    found,
                    allowed,
                )?;
            }
            for (k, collider) in part.colliders.iter().enumerate() {
                let at = format!("{at} colliders[{k}]");
                collider.check(&at, LARGEST_COORDINATE_M)?;
            }
            let exact = part.colliders.contains(&Collider::ExactMesh);
            check_range(
                &at,
                "colliders",
                part.fixed || !exact,
                "exact_mesh",
                "convex pieces on parts that move",
            )?;
            slots(data, &at, part.mesh, &part.materials)?;
        }
    }
    check_range(
        "parts",
        "count",
        next_part as usize == data.parts.len(),
        data.parts.len(),
        "as many as the objects list",
    )
}

fn joints(data: &HouseData) -> Result<(), SceneError> {
    let mut moved = BTreeSet::new();
    for (id, joint) in data.joints.iter_ids() {
        interrupt::unwind_if_cancelled();
        let at = format!("joints[{}] {:?}", id.0, joint.name);
        check_id(&at, "objects", &data.objects, joint.object)?;
        check_id(&at, "parts", &data.parts, joint.child)?;
        check_range(
            &at,
            "child",
            data.parts[joint.child].object == joint.object,
            joint.child.0,
            "a part of its object",
        )?;
        check_range(
            &at,
            "child",
            !data.parts[joint.child].fixed,
            "a fixed part",
            "a part that moves",
        )?;
        check_range(
            &at,
            "child",
            moved.insert(joint.child),
            joint.child.0,
            "a part that no other joint moves",
        )?;
        if let Some(parent) = joint.parent {
            check_id(&at, "parts", &data.parts, parent)?;
            check_range(
                &at,
                "parent",
                parent < joint.child,
                parent.0,
                "a part that stands before the child",
            )?;
        }
        check_range(
            &at,
            "axis",
            (joint.axis.length() - 1.0).abs() < 1e-3,
            joint.axis,
            "a unit vector",
        )?;
        let poses = joint.parent_from_joint.is_valid() && joint.child_from_joint.is_valid();
        check_range(
            &at,
            "parent_from_joint, child_from_joint",
            poses,
            "not rigid",
            "finite with unit quaternions",
        )?;
        let [low, high] = joint.limits.unwrap_or([f32::MIN, f32::MAX]);
        check_range(
            &at,
            "limits",
            low.is_finite() && high.is_finite() && low <= high,
            format!("{low} to {high}"),
            "low <= high",
        )?;
        for (field, value) in [
            ("closed", joint.closed),
            ("open", joint.open),
            ("initial", joint.initial),
        ] {
            check_range(
                &at,
                field,
                (low - 1e-6..=high + 1e-6).contains(&value),
                value,
                "a position within the limits",
            )?;
        }
        check_range(
            &at,
            "friction",
            (0.0..=1e6).contains(&joint.friction),
            joint.friction,
            "0 to 1e6",
        )?;
        check_range(
            &at,
            "damping",
            (0.0..=1e6).contains(&joint.damping),
            joint.damping,
            "0 to 1e6",
        )?;
        check_range(
            &at,
            "armature",
            (0.0..=1e6).contains(&joint.armature),
            joint.armature,
            "0 to 1e6",
        )?;
        let switches = joint.is_openable() && data.objects[joint.object].switch.is_some();
        check_range(
            &at,
            "switches",
            !joint.toggles_switch || switches,
            joint.toggles_switch,
            "true for what opens by hand on an object with a switch",
        )?;
        motor(data, &at, id, joint)?;
    }
    Ok(())
}

/// Checks a joint's servo and what it follows.
fn motor(data: &HouseData, at: &str, id: JointId, joint: &Joint) -> Result<(), SceneError> {
    if let Some(servo) = &joint.servo {
        for (field, value) in [
            ("servo.stiffness", servo.stiffness),
            ("servo.damping", servo.damping),
            ("servo.velocity_gain", servo.velocity_gain),
            ("servo.max_effort", servo.max_effort),
        ] {
            check_range(at, field, (0.0..=1e9).contains(&value), value, "0 to 1e9")?;
        }
        let gear = servo.gear;
        check_range(
            at,
            "servo.gear",
            (1e-6..=1e6).contains(&gear),
            gear,
            "1e-6 to 1e6",
        )?;
        if let Some(velocity) = servo.max_velocity {
            let ok = (0.0..=1e6).contains(&velocity);
            check_range(at, "servo.max_velocity", ok, velocity, "0 to 1e6")?;
        }
    }
    if let Some(mimic) = &joint.mimic {
        check_id(at, "joints", &data.joints, mimic.leader)?;
        let leads = mimic.leader < id && data.joints[mimic.leader].mimic.is_none();
        let (found, allowed) = (
            mimic.leader.0,
            "a joint that stands before and follows none",
        );
        check_range(at, "mimic.leader", leads, found, allowed)?;
        let Mimic {
            multiplier, offset, ..
        } = *mimic;
        let ok = (-1e3..=1e3).contains(&multiplier);
        check_range(at, "mimic.multiplier", ok, multiplier, "-1000 to 1000")?;
        let ok = (-1e4..=1e4).contains(&offset);
        check_range(at, "mimic.offset", ok, offset, "-10000 to 10000")?;
    }
    Ok(())
}

fn fixtures(data: &HouseData) -> Result<(), SceneError> {
    let owners = data.lights.iter().map(|x| ("lights", x.object, x.part));
    let owners = owners.chain(data.emitters.iter().map(|x| ("emitters", x.object, x.part)));
    for (table, object, part) in owners.chain(
        data.receptacles
            .iter()
            .map(|x| ("receptacles", x.object, x.part)),
    ) {
        check_id(table, "objects", &data.objects, object)?;
        check_id(table, "parts", &data.parts, part)?;
        check_range(
            table,
            "part",
            data.parts[part].object == object,
            part.0,
            "a part of its object",
        )?;
    }
    for light in &data.lights {
        let shape = match light.shape {
            LightShape::Point => [0.0; 3],
            LightShape::Line { end } => end.to_array(),
            LightShape::Spot {
                direction,
                cutoff_rad,
                dropoff_rate,
            } => {
                let numbers = direction.to_array().into_iter();
                let mut numbers = numbers.chain([cutoff_rad, dropoff_rate]);
                let all = numbers.all(f32::is_finite);
                [if all { 0.0 } else { f32::NAN }; 3]
            }
        };
        let numbers = shape.into_iter().chain(light.position.to_array());
        let far = numbers
            .into_iter()
            .find(|x| !is_within_coordinate_limit(*x));
        check_range(
            "lights",
            "position, shape",
            far.is_none(),
            far.unwrap_or_default(),
            "finite numbers, and places within 32768 m of the origin",
        )?;
        check_range(
            "lights",
            "power_w",
            (0.0..=1e5).contains(&light.power_w),
            light.power_w,
            "0 to 100000",
        )?;
        let finite = light
            .attenuation
            .iter()
            .chain(&light.color)
            .all(|x| x.is_finite() && *x >= 0.0);
        check_range(
            "lights",
            "attenuation, color",
            finite,
            "negative or not finite",
            "numbers of at least 0",
        )?;
    }
    for emitter in &data.emitters {
        check_range(
            "emitters",
            "level_db",
            (-20.0..=140.0).contains(&emitter.level_db),
            emitter.level_db,
            "-20 to 140",
        )?;
        if let Some(file) = emitter.sound_file {
            check_id("emitters", "sound_files", &data.sound_files, file)?;
        }
        check_range(
            "emitters",
            "start_s",
            (0.0..=86_400.0).contains(&emitter.start_s),
            emitter.start_s,
            "0 to 86400",
        )?;
    }
    receptacles(data)?;
    sounds_and_starts(data)
}

/// The free spaces of receptacles: things are laid into them.
fn receptacles(data: &HouseData) -> Result<(), SceneError> {
    for (k, receptacle) in data.receptacles.iter().enumerate() {
        let at = format!("receptacles[{k}] {:?}", receptacle.name);
        check_rooms::bounds(&at, "space_in_part", &receptacle.space_in_part)?;
    }
    Ok(())
}

fn sounds_and_starts(data: &HouseData) -> Result<(), SceneError> {
    unique(
        "sound_files",
        data.sound_files.iter().map(|sound| sound.name.as_str()),
    )?;
    for (id, sound) in data.sound_files.iter_ids() {
        check_range(
            &format!("sound_files[{}] {:?}", id.0, sound.name),
            "bytes",
            (1..=SoundFile::MAX_BYTES).contains(&(sound.bytes.len() as u64)),
            sound.bytes.len(),
            "1 to 67108864",
        )?;
    }
    check_range(
        "agent_starts",
        "count",
        data.agent_starts.len() <= AgentStart::MAX_PER_HOUSE,
        data.agent_starts.len(),
        "at most 64",
    )?;
    for (k, start) in data.agent_starts.iter().enumerate() {
        let at = format!("agent_starts[{k}]");
        let mut numbers = start.position.to_array().into_iter();
        let far = numbers.find(|x| !is_within_coordinate_limit(*x));
        check_range(
            &at,
            "position",
            far.is_none(),
            far.unwrap_or_default(),
            "within 32768 m of the origin",
        )?;
        check_range(
            &at,
            "yaw_rad",
            start.yaw_rad.abs() <= 1000.0,
            start.yaw_rad,
            "-1000 to 1000",
        )?;
    }
    Ok(())
}
