//! Copies of objects of one house into the tables of another: meshes and textures are shared, equal materials too.

use std::collections::BTreeMap;
use std::sync::Arc;

use dwell_scene::{
    HouseData, Id, IdVec, JointId, LevelId, Material, MaterialId, MeshId, Object, ObjectId, PartId,
};

use super::sound_file;

/// Appends copies of `objects` to `into` and returns their ids. Storey and room are left to the caller.
pub(super) fn copy_objects(
    into: &mut HouseData,
    from: &HouseData,
    objects: &[ObjectId],
) -> Vec<ObjectId> {
    let mut graft = ObjectCopier {
        into,
        from,
        meshes: BTreeMap::new(),
        materials: BTreeMap::new(),
    };
    objects.iter().map(|id| graft.object(*id)).collect()
}

struct ObjectCopier<'a> {
    into: &'a mut HouseData,
    from: &'a HouseData,
    meshes: BTreeMap<MeshId, MeshId>,
    materials: BTreeMap<MaterialId, MaterialId>,
}

impl ObjectCopier<'_> {
    fn object(&mut self, id: ObjectId) -> ObjectId {
        let source = &self.from.objects[id];
        let new = ObjectId::from_index(self.into.objects.len());
        let first = PartId::from_index(self.into.parts.len());
        let part_of = |part: PartId| PartId(part.0 - source.first_part.0 + first.0);
        for part in source.parts() {
            let mut part = self.from.parts[part].clone();
            part.object = new;
            part.mesh = self.mesh(part.mesh);
            for material in &mut part.materials {
                *material = self.material(*material);
            }
            self.into.parts.push(part);
        }
        self.into.objects.push(Object {
            level: LevelId(0),
            room: None,
            first_part: first,
            ..source.clone()
        });
        let first_joint = self.into.joints.len() as u32;
        let own: Vec<JointId> = self
            .from
            .joints
            .iter_ids()
            .filter(|(_, joint)| joint.object == id)
            .map(|(id, _)| id)
            .collect();
        for joint in &own {
            let mut joint = self.from.joints[*joint].clone();
            joint.object = new;
            joint.child = part_of(joint.child);
            joint.parent = joint.parent.map(part_of);
            joint.mimic = joint.mimic.and_then(|mut mimic| {
                let leader = own.iter().position(|other| *other == mimic.leader)?;
                mimic.leader = JointId(first_joint + leader as u32);
                Some(mimic)
            });
            self.into.joints.push(joint);
        }
        let (from, into) = (self.from, &mut *self.into);
        let lights = from.lights.iter().filter(|light| light.object == id);
        into.lights.extend(lights.cloned().map(|mut light| {
            (light.object, light.part) = (new, part_of(light.part));
            light
        }));
        let emitters = from.emitters.iter().filter(|emitter| emitter.object == id);
        for mut emitter in emitters.cloned() {
            (emitter.object, emitter.part) = (new, part_of(emitter.part));
            if let Some(file) = emitter.sound_file {
                let sound = from.sound_files[file].clone();
                let file = sound_file::add_or_find(&mut into.sound_files, sound);
                emitter.signal.clone_from(&into.sound_files[file].name);
                emitter.sound_file = Some(file);
            }
            into.emitters.push(emitter);
        }
        let spaces = from.receptacles.iter().filter(|space| space.object == id);
        into.receptacles.extend(spaces.cloned().map(|mut space| {
            (space.object, space.part) = (new, part_of(space.part));
            space
        }));
        new
    }

    fn mesh(&mut self, id: MeshId) -> MeshId {
        let (from, into) = (self.from, &mut *self.into);
        *self.meshes.entry(id).or_insert_with(|| {
            let mesh = &from.meshes[id];
            find_or_push(&mut into.meshes, mesh)
        })
    }

    fn material(&mut self, id: MaterialId) -> MaterialId {
        let (from, into) = (self.from, &mut *self.into);
        *self.materials.entry(id).or_insert_with(|| {
            let mut material = from.materials[id].clone();
            material.texture = material
                .texture
                .map(|texture| find_or_push(&mut into.textures, &from.textures[texture]));
            find_or_add_material(&mut into.materials, material)
        })
    }
}

/// The id of something shared; it is there once.
fn find_or_push<I: Id, T>(table: &mut IdVec<I, Arc<T>>, thing: &Arc<T>) -> I {
    let known = table.iter().position(|other| Arc::ptr_eq(other, thing));
    known.map_or_else(|| table.push(thing.clone()), I::from_index)
}

/// The id of a material: of one with the same name and content, else of a new one with a name that was free.
pub(super) fn find_or_add_material(
    materials: &mut IdVec<MaterialId, Material>,
    mut material: Material,
) -> MaterialId {
    let base = material.name.clone();
    // Numbers by which equal names are distinguished already.
    let number_of = |name: &str| -> Option<u64> {
        match name.strip_prefix(&base)? {
            "" => Some(1),
            rest => rest.strip_prefix('_')?.parse().ok(),
        }
    };
    let mut known: BTreeMap<String, MaterialId> = BTreeMap::new();
    for (id, other) in materials.iter_ids() {
        if number_of(&other.name).is_some() {
            known.entry(other.name.clone()).or_insert(id);
        }
    }
    let mut number = 1;
    loop {
        let Some(id) = known.get(&material.name).copied() else {
            return materials.push(material);
        };
        if materials[id] == material {
            return id;
        }
        number += 1;
        material.name = format!("{base}_{number}");
    }
}
