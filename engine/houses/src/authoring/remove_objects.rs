//! Removal of objects from the tables of a house, with everything that only they used.

use std::collections::BTreeSet;

use dwell_scene::{
    HouseData, Id, IdVec, JointId, MaterialId, MeshId, ObjectId, PartId, SoundFileId, TextureId,
};

/// New ids of a table from which entries are removed: `None` for those.
struct IndexRemap(Vec<Option<u32>>);

impl IndexRemap {
    fn of(count: usize, stays: impl Fn(usize) -> bool) -> Self {
        let mut next = 0;
        let number = |k| {
            stays(k).then(|| {
                next += 1;
                next - 1
            })
        };
        Self((0..count).map(number).collect())
    }

    fn stays(&self, index: usize) -> bool {
        self.0.get(index).copied().flatten().is_some()
    }

    /// The new id; removed entries have none, and nothing that stays refers to them.
    fn renumbered<I: Id>(&self, id: I) -> I {
        let new = self.0.get(id.index()).copied().flatten();
        I::from_index(new.unwrap_or_default() as usize)
    }

    fn kept<I: Id, T: Clone>(&self, table: &IdVec<I, T>) -> IdVec<I, T> {
        let kept = table.iter().enumerate().filter(|(k, _)| self.stays(*k));
        kept.map(|(_, item)| item.clone()).collect()
    }
}

/// Removes objects. Those behind them move up; meshes, materials and textures that only they used are removed too.
pub(super) fn remove(data: &mut HouseData, removed: &BTreeSet<ObjectId>) {
    let before = UsedAssets::collect(data, |object| removed.contains(&object), false);
    let objects = IndexRemap::of(data.objects.len(), |k| {
        !removed.contains(&ObjectId::from_index(k))
    });
    let parts = IndexRemap::of(data.parts.len(), |k| {
        objects.stays(data.parts[PartId::from_index(k)].object.index())
    });
    let joints = IndexRemap::of(data.joints.len(), |k| {
        objects.stays(data.joints[JointId::from_index(k)].object.index())
    });
    data.objects = objects.kept(&data.objects);
    data.parts = parts.kept(&data.parts);
    data.joints = joints.kept(&data.joints);
    for object in &mut data.objects {
        object.first_part = parts.renumbered(object.first_part);
    }
    for part in &mut data.parts {
        part.object = objects.renumbered(part.object);
    }
    for joint in &mut data.joints {
        joint.object = objects.renumbered(joint.object);
        joint.child = parts.renumbered(joint.child);
        joint.parent = joint.parent.map(|part| parts.renumbered(part));
        if let Some(mimic) = &mut joint.mimic {
            mimic.leader = joints.renumbered(mimic.leader);
        }
    }
    macro_rules! keep {
        ($table:ident) => {
            data.$table
                .retain(|item| objects.stays(item.object.index()));
            for item in &mut data.$table {
                (item.object, item.part) =
                    (objects.renumbered(item.object), parts.renumbered(item.part));
            }
        };
    }
    let sounded = sound_files(data);
    keep!(lights);
    keep!(emitters);
    keep!(receptacles);
    drop_sounds(data, &sounded);
    drop_unused(data, &before);
}

/// The sound files that emitters name.
fn sound_files(data: &HouseData) -> BTreeSet<SoundFileId> {
    let emitters = data.emitters.iter();
    emitters.filter_map(|emitter| emitter.sound_file).collect()
}

/// Removes the sound files that were named before (`once`) and are not any more.
fn drop_sounds(data: &mut HouseData, once: &BTreeSet<SoundFileId>) {
    let now = sound_files(data);
    let kept = IndexRemap::of(data.sound_files.len(), |k| {
        let id = SoundFileId::from_index(k);
        !once.contains(&id) || now.contains(&id)
    });
    data.sound_files = kept.kept(&data.sound_files);
    for emitter in &mut data.emitters {
        emitter.sound_file = emitter.sound_file.map(|id| kept.renumbered(id));
    }
}

/// Removes entries that were used before (`once`) and are not any more.
fn drop_unused(data: &mut HouseData, once: &UsedAssets) {
    let now = UsedAssets::collect(data, |_| true, true);
    let unused = |once: &BTreeSet<u32>, now: &BTreeSet<u32>, k: usize| {
        once.contains(&(k as u32)) && !now.contains(&(k as u32))
    };
    let meshes = IndexRemap::of(data.meshes.len(), |k| !unused(&once.meshes, &now.meshes, k));
    let materials = IndexRemap::of(data.materials.len(), |k| {
        !unused(&once.materials, &now.materials, k)
    });
    let mut shown = BTreeSet::new();
    let mut dropped = BTreeSet::new();
    for (id, material) in data.materials.iter_ids() {
        let set = if materials.stays(id.index()) {
            &mut shown
        } else {
            &mut dropped
        };
        set.extend(material.texture.map(|texture| texture.0));
    }
    let textures = IndexRemap::of(data.textures.len(), |k| !unused(&dropped, &shown, k));
    data.meshes = meshes.kept(&data.meshes);
    data.materials = materials.kept(&data.materials);
    data.textures = textures.kept(&data.textures);
    for material in &mut data.materials {
        material.texture = material
            .texture
            .map(|id: TextureId| textures.renumbered(id));
    }
    for piece in &mut data.structure {
        piece.mesh = meshes.renumbered(piece.mesh);
        piece
            .materials
            .iter_mut()
            .for_each(|id| *id = materials.renumbered(*id));
    }
    for part in &mut data.parts {
        part.mesh = meshes.renumbered(part.mesh);
        part.materials
            .iter_mut()
            .for_each(|id| *id = materials.renumbered(*id));
    }
}

/// Drops those of some materials, and their images, that nothing shows any more.
pub(super) fn remove_unused_materials(data: &mut HouseData, materials: &[MaterialId]) {
    let mut unused: BTreeSet<MaterialId> = materials.iter().copied().collect();
    let pieces = data.structure.iter().map(|piece| &piece.materials);
    let parts = data.parts.iter().map(|part| &part.materials);
    for id in pieces.chain(parts).flatten() {
        if unused.remove(id) && unused.is_empty() {
            return;
        }
    }
    // Those of a thing that was just added are the last: numbers of others stay, which keeps adding thousands of things cheap.
    let first = data.materials.len() - unused.len();
    let are_last = unused.iter().all(|id| id.index() >= first);
    let are_plain = unused
        .iter()
        .all(|id| data.materials[*id].texture.is_none());
    if are_last && are_plain {
        data.materials.truncate(first);
        return;
    }
    let once = UsedAssets {
        meshes: BTreeSet::new(),
        materials: materials.iter().map(|id| id.0).collect(),
    };
    drop_unused(data, &once);
}

/// Drops a mesh when nothing has it any more.
pub(super) fn remove_unused_mesh(data: &mut HouseData, mesh: MeshId) {
    let once = UsedAssets {
        meshes: [mesh.0].into(),
        materials: BTreeSet::new(),
    };
    drop_unused(data, &once);
}

/// Meshes and materials that are used.
struct UsedAssets {
    meshes: BTreeSet<u32>,
    materials: BTreeSet<u32>,
}

impl UsedAssets {
    fn collect(data: &HouseData, object: impl Fn(ObjectId) -> bool, structure: bool) -> Self {
        let parts = data.parts.iter().filter(|part| object(part.object));
        let parts = parts.map(|part| (part.mesh, &part.materials));
        let pieces = data.structure.iter().filter(|_| structure);
        let pieces = pieces.map(|piece| (piece.mesh, &piece.materials));
        let (mut meshes, mut materials) = (BTreeSet::new(), BTreeSet::new());
        for (mesh, own) in parts.chain(pieces) {
            meshes.insert(mesh.0);
            materials.extend(own.iter().map(|id| id.0));
        }
        Self { meshes, materials }
    }
}
