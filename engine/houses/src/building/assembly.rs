//! Assembly of models into the tables of a house.

use crate::import::{UniqueNames, category};
use dwell_furniture::finishes::Finish;
use dwell_furniture::model::Model;
use dwell_furniture::textures::{TexturePattern, textures};
use dwell_scene::{
    Aabb, Category, HouseData, Id, Joint, JointKind, Level, LevelId, Light, MaterialId, Mesh,
    MeshId, Object, ObjectId, Part, PartId, Pose, Receptacle, RoomId, SoundEmitter, Structure,
    StructureKind, TextureId,
};
use glam::Affine3A;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Colour of lamps, linear: about 3,000 K.
const WARM_WHITE: [f32; 3] = [1.0, 0.86, 0.68];
/// Lamps fade with the square of the distance.
const ATTENUATION: [f32; 3] = [0.0, 0.0, 1.0];
/// Coulomb friction of hinges, N·m, and of slides, N.
const FRICTION: f32 = 0.3;
/// Viscous damping of hinges, N·m·s/rad.
const HINGE_DAMPING: f32 = 0.4;
/// Viscous damping of slides, N·s/m.
const SLIDE_DAMPING: f32 = 8.0;

/// A model that is part of the house.
#[derive(Clone, Debug)]
pub(crate) struct AddedModel {
    pub(crate) model: Arc<Model>,
    meshes: Vec<MeshId>,
    materials: Vec<Vec<MaterialId>>,
}

/// A house under construction.
#[derive(Debug, Default)]
pub(crate) struct HouseAssembly {
    pub(crate) data: HouseData,
    /// The storey that is being built.
    pub(crate) level: LevelId,
    patterns: Vec<TexturePattern>,
    finishes: Vec<(Finish, MaterialId)>,
    /// Models by address, which they keep alive.
    kinds: BTreeMap<usize, AddedModel>,
    material_names: UniqueNames,
    object_names: UniqueNames,
}

impl HouseAssembly {
    /// An empty house without a storey; `source` names its maker and its version.
    pub(crate) fn new(name: &str, source: &str) -> Self {
        let mut assembly = Self::default();
        name.clone_into(&mut assembly.data.name);
        source.clone_into(&mut assembly.data.source);
        assembly
    }

    /// Adds a storey above the others; later pieces stand on it.
    pub(crate) fn add_storey(&mut self) {
        let name = self.data.levels.len().to_string();
        let bounds = Aabb::EMPTY;
        self.level = self.data.levels.push(Level { name, bounds });
    }

    /// The material of a finish; equal finishes are one material.
    pub(crate) fn add_material(&mut self, finish: &Finish) -> MaterialId {
        if let Some((_, id)) = self.finishes.iter().find(|(known, _)| known == finish) {
            return *id;
        }
        let texture = finish.pattern.map(|pattern| {
            let known = self
                .patterns
                .iter()
                .position(|p| *p == pattern)
                .unwrap_or_else(|| {
                    self.patterns.push(pattern);
                    self.patterns.len() - 1
                });
            TextureId::from_index(known)
        });
        let name = self.material_names.unique(finish.name);
        let id = self.data.materials.push(finish.material(name, texture));
        self.finishes.push((finish.clone(), id));
        id
    }

    /// Adds a model; a shared model is one kind.
    pub(crate) fn add_model(&mut self, model: impl Into<Arc<Model>>) -> AddedModel {
        let model = model.into();
        let address = Arc::as_ptr(&model) as usize;
        if let Some(known) = self.kinds.get(&address) {
            return known.clone();
        }
        let meshes = model
            .parts
            .iter()
            .map(|part| self.data.meshes.push(part.mesh.clone()))
            .collect();
        let materials = model
            .parts
            .iter()
            .map(|part| {
                part.finishes
                    .iter()
                    .map(|finish| self.add_material(finish))
                    .collect()
            })
            .collect();
        let kind = AddedModel {
            model,
            meshes,
            materials,
        };
        self.kinds.insert(address, kind.clone());
        kind
    }

    /// A piece of the building, its mesh in world space.
    pub(crate) fn add_structure(
        &mut self,
        name: &str,
        kind: StructureKind,
        room: Option<RoomId>,
        mut mesh: Mesh,
        finishes: &[Finish],
    ) {
        mesh.shrink_to_fit();
        let materials = finishes
            .iter()
            .map(|finish| self.add_material(finish))
            .collect();
        let mesh = self.data.meshes.push(Arc::new(mesh));
        self.data.structure.push(Structure {
            name: name.to_owned(),
            kind,
            room,
            level: self.level,
            mesh,
            materials,
        });
    }

    /// Puts an instance into a room, its first joint open by `openness` (0 to 1).
    pub(crate) fn add_instance(
        &mut self,
        kind: &AddedModel,
        world_from_model: Pose,
        room: RoomId,
        openness: f32,
    ) {
        let model = if openness > 0.0 {
            Arc::new(Model::clone(&kind.model).with_initial_opening(openness))
        } else {
            kind.model.clone()
        };
        let data = &mut self.data;
        let (object, first_part) = (
            ObjectId::from_index(data.objects.len()),
            PartId::from_index(data.parts.len()),
        );
        let name = self.object_names.numbered(model.category);
        let nyu40 =
            category([model.category]).map_or_else(String::new, |row| row.nyu40_name.clone());
        let joined = |part: usize| model.joints.iter().any(|joint| joint.child == part);
        for (k, part) in model.parts.iter().enumerate() {
            data.parts.push(Part {
                object,
                name: part.name.to_owned(),
                fixed: model.mobility != dwell_scene::Mobility::Movable && !joined(k),
                world_from_part: world_from_model * model.model_from_part(k),
                mesh: kind.meshes[k],
                part_from_mesh: Affine3A::IDENTITY,
                materials: kind.materials[k].clone(),
                colliders: part.colliders.clone(),
                mass_kg: Some(part.mass_kg),
                density_kg_m3: part.density_kg_m3,
                inertial: None,
            });
        }
        data.objects.push(Object {
            source_id: name.clone(),
            name,
            model: model.name.to_owned(),
            category: Category {
                fine: model.name.to_owned(),
                coarse: model.category.to_owned(),
                nyu40,
            },
            level: self.level,
            room: Some(room),
            mobility: model.mobility,
            pickable: model.pickable,
            switch: model.switch,
            first_part,
            part_count: model.parts.len() as u32,
        });
        let part_id = |k: usize| PartId(first_part.0 + k as u32);
        self.add_joints_lights_and_sounds(&model, object, part_id);
    }

    fn add_joints_lights_and_sounds(
        &mut self,
        model: &Model,
        object: ObjectId,
        part_id: impl Fn(usize) -> PartId,
    ) {
        let data = &mut self.data;
        for joint in &model.joints {
            let frame = Pose::from_position(joint.position);
            let hinge = joint.kind == JointKind::Hinge;
            data.joints.push(Joint {
                parent: Some(part_id(joint.parent)),
                parent_from_joint: frame,
                child_from_joint: frame,
                limits: Some([0.0, joint.open]),
                open: joint.open,
                initial: joint.initial,
                toggles_switch: joint.toggles_switch,
                friction: FRICTION,
                damping: if hinge { HINGE_DAMPING } else { SLIDE_DAMPING },
                ..Joint::new(
                    joint.name,
                    object,
                    part_id(joint.child),
                    joint.kind,
                    joint.axis,
                )
            });
        }
        data.lights.extend(model.lights.iter().map(|light| Light {
            object,
            part: part_id(light.part),
            position: light.position,
            shape: light.shape,
            color: WARM_WHITE,
            power_w: light.power_w,
            attenuation: ATTENUATION,
        }));
        data.emitters.extend(model.sounds.iter().map(|sound| {
            SoundEmitter::looping(
                object,
                part_id(sound.part),
                sound.position,
                sound.signal,
                sound.level_db,
            )
        }));
        data.receptacles
            .extend(model.spaces.iter().map(|space| Receptacle {
                object,
                part: part_id(space.part),
                name: space.name.to_owned(),
                holding: space.kind,
                space_in_part: space.space,
            }));
    }

    /// The finished tables: textures and bounds taken.
    pub(crate) fn finish(mut self) -> HouseData {
        for texture in textures(&self.patterns) {
            self.data.textures.push(texture);
        }
        let mut bounds = vec![Aabb::EMPTY; self.data.levels.len()];
        for piece in &self.data.structure {
            let all = &mut bounds[piece.level.index()];
            *all = all.union(&self.data.meshes[piece.mesh].bounds());
        }
        for part in &self.data.parts {
            let place = part.world_from_part.to_affine();
            let all = &mut bounds[self.data.objects[part.object].level.index()];
            *all = all.union(&self.data.meshes[part.mesh].bounds().transformed(&place));
        }
        for (level, bounds) in self.data.levels.iter_mut().zip(bounds) {
            level.bounds = bounds;
        }
        self.data
    }
}
