//! A model: one kind of thing with its parts, before a house holds it.
//!
//! Model space: metres, +Y up, the front towards +Z. Things that stand have the middle of their foot at the origin; things
//! on a wall have the wall's face at z = 0; things on a ceiling hang down from y = 0.

use super::finishes::Finish;
use super::shapes::SolidMesh;
use dwell_scene::{Aabb, Collider, JointKind, LightShape, Mesh, Mobility, Pose, ReceptacleKind};
use glam::Vec3;
use std::sync::Arc;

/// One kind of thing.
#[derive(Clone, Debug)]
pub struct Model {
    /// The model's name: `"dining_chair"`.
    pub name: &'static str,
    /// A row of `assets/categories.csv`; its name is what instances are called.
    pub category: &'static str,
    /// Mobility of the instances.
    pub mobility: Mobility,
    /// True if a hand can pick it up.
    pub pickable: bool,
    /// Initial state of its switch, true for on; `None` without a switch.
    pub switch: Option<bool>,
    /// The root first.
    pub parts: Vec<ModelPart>,
    /// The joints between parts.
    pub joints: Vec<ModelJoint>,
    /// The lights that shine while it is on.
    pub lights: Vec<ModelLight>,
    /// The sound sources.
    pub sounds: Vec<ModelSound>,
    /// The surfaces and volumes that can hold other things.
    pub spaces: Vec<ModelReceptacle>,
}

/// A rigid part; its space is the model's while all joints are at 0.
#[derive(Clone, Debug)]
pub struct ModelPart {
    /// Name in the model.
    pub name: &'static str,
    /// Visual mesh, in the space of the part.
    pub mesh: Arc<Mesh>,
    /// One for each slot of the mesh.
    pub finishes: Vec<Finish>,
    /// Collision geometry: convex pieces in the space of the part.
    pub colliders: Vec<Collider>,
    /// Mass, kg.
    pub mass_kg: f32,
    /// Mean density of its substance, kg/m³.
    pub density_kg_m3: f32,
}

/// A joint between two parts.
#[derive(Clone, Debug)]
pub struct ModelJoint {
    /// Name in the model.
    pub name: &'static str,
    /// Hinge or slide.
    pub kind: JointKind,
    /// Indices of parts.
    pub parent: usize,
    /// Index of the part that moves.
    pub child: usize,
    /// A point on the axis, m.
    pub position: Vec3,
    /// Unit length; positive positions open.
    pub axis: Vec3,
    /// The position at which it is fully open, rad or m; 0 is closed.
    pub open: f32,
    /// The position at the start.
    pub initial: f32,
    /// True for the model's switch.
    pub toggles_switch: bool,
}

/// A light of a part.
#[derive(Clone, Debug)]
pub struct ModelLight {
    /// Index of the part that carries it.
    pub part: usize,
    /// Place in the space of the part, m.
    pub position: Vec3,
    /// Point, spot or line.
    pub shape: LightShape,
    /// Radiant power, W.
    pub power_w: f32,
}

/// A sound of a part.
#[derive(Clone, Debug)]
pub struct ModelSound {
    /// Index of the part that carries it.
    pub part: usize,
    /// Place in the space of the part, m.
    pub position: Vec3,
    /// A name of the signals that sources play: `"hum"`.
    pub signal: &'static str,
    /// Sound pressure level at 1 m, dB re 20 µPa.
    pub level_db: f32,
}

/// A place that holds things.
#[derive(Clone, Debug)]
pub struct ModelReceptacle {
    /// Index of the part that carries it.
    pub part: usize,
    /// Name in the model.
    pub name: &'static str,
    /// Kind: a surface with things on it or a volume with things in it.
    pub kind: ReceptacleKind,
    /// The room for things, in the space of the part, m.
    pub space: Aabb,
}

impl Model {
    /// A thing that stands loose: it can be pushed.
    pub fn movable(name: &'static str, category: &'static str) -> Self {
        Self::new(name, category, Mobility::Movable)
    }

    /// A small thing that a hand can take.
    pub fn pickable(name: &'static str, category: &'static str) -> Self {
        Self {
            pickable: true,
            ..Self::movable(name, category)
        }
    }

    /// A thing that never moves.
    pub fn fixed(name: &'static str, category: &'static str) -> Self {
        Self::new(name, category, Mobility::Fixed)
    }

    /// A thing that stands firm but has doors or drawers.
    pub fn articulated(name: &'static str, category: &'static str) -> Self {
        Self::new(name, category, Mobility::Articulated)
    }

    fn new(name: &'static str, category: &'static str, mobility: Mobility) -> Self {
        Self {
            name,
            category,
            mobility,
            pickable: false,
            switch: None,
            parts: Vec::new(),
            joints: Vec::new(),
            lights: Vec::new(),
            sounds: Vec::new(),
            spaces: Vec::new(),
        }
    }

    /// The same model with a switch.
    #[must_use]
    pub fn with_switch_state(mut self, on: bool) -> Self {
        self.switch = Some(on);
        self
    }

    /// The same model with one more part.
    #[must_use]
    pub fn part(mut self, part: PartBuilder) -> Self {
        self.parts.push(part.finish());
        self
    }

    /// The same model; its newest part turns about `axis` through `position`, from closed at 0 to `open_rad`.
    #[must_use]
    pub fn hinged(self, name: &'static str, position: [f32; 3], axis: Vec3, open_rad: f32) -> Self {
        self.joint(name, JointKind::Hinge, position, axis, open_rad)
    }

    /// The same model; its newest part slides along `axis` by up to `open_m`.
    #[must_use]
    pub fn sliding(self, name: &'static str, axis: Vec3, open_m: f32) -> Self {
        self.joint(name, JointKind::Slide, [0.0; 3], axis, open_m)
    }

    fn joint(
        mut self,
        name: &'static str,
        kind: JointKind,
        position: [f32; 3],
        axis: Vec3,
        open: f32,
    ) -> Self {
        let child = self.parts.len() - 1;
        let position = Vec3::from(position);
        self.joints.push(ModelJoint {
            name,
            kind,
            parent: 0,
            child,
            position,
            axis,
            open,
            initial: 0.0,
            toggles_switch: false,
        });
        self
    }

    /// The same model, off; its newest joint is its switch.
    #[must_use]
    pub fn with_switch(mut self) -> Self {
        if let Some(joint) = self.joints.last_mut() {
            joint.toggles_switch = true;
        }
        self.with_switch_state(false)
    }

    /// The same model, its first joint open by `fraction` (0 to 1) at the start.
    #[must_use]
    pub fn with_initial_opening(mut self, fraction: f32) -> Self {
        if let Some(joint) = self.joints.first_mut() {
            joint.initial = joint.open * fraction;
        }
        self
    }

    /// The same model; its newest part shines in all directions.
    #[must_use]
    pub fn with_light(self, position: [f32; 3], power_w: f32) -> Self {
        self.with_light_shape(position, LightShape::Point, power_w)
    }

    /// The same model; its newest part has a light.
    #[must_use]
    pub fn with_light_shape(mut self, position: [f32; 3], shape: LightShape, power_w: f32) -> Self {
        let part = self.parts.len() - 1;
        self.lights.push(ModelLight {
            part,
            position: position.into(),
            shape,
            power_w,
        });
        self
    }

    /// The same model; its newest part sounds.
    #[must_use]
    pub fn with_sound(mut self, position: [f32; 3], signal: &'static str, level_db: f32) -> Self {
        let part = self.parts.len() - 1;
        self.sounds.push(ModelSound {
            part,
            position: position.into(),
            signal,
            level_db,
        });
        self
    }

    /// The same model; things can stand on its newest part, in the free space between two corners.
    #[must_use]
    pub fn with_support_surface(self, name: &'static str, min: [f32; 3], max: [f32; 3]) -> Self {
        self.with_receptacle(name, ReceptacleKind::On, min, max)
    }

    /// The same model; things can lie inside its newest part, in the free space between two corners.
    #[must_use]
    pub fn with_container_space(self, name: &'static str, min: [f32; 3], max: [f32; 3]) -> Self {
        self.with_receptacle(name, ReceptacleKind::In, min, max)
    }

    fn with_receptacle(
        mut self,
        name: &'static str,
        holding: ReceptacleKind,
        min: [f32; 3],
        max: [f32; 3],
    ) -> Self {
        let part = self.parts.len() - 1;
        self.spaces.push(ModelReceptacle {
            part,
            name,
            kind: holding,
            space: Aabb::new(min.into(), max.into()),
        });
        self
    }

    /// The same model with the parts, joints and sounds of another one mounted on its root at `pose`; that one's root is
    /// called `name` here, and its switch is the whole's.
    #[must_use]
    pub fn with_mounted(mut self, other: Self, name: &'static str, pose: &Pose) -> Self {
        let first = self.parts.len();
        for mut part in other.parts {
            let solid = SolidMesh {
                mesh: Mesh::clone(&part.mesh),
                colliders: part.colliders,
            };
            let SolidMesh { mesh, colliders } = solid.transformed(pose);
            part.mesh = Arc::new(mesh);
            part.colliders = colliders;
            self.parts.push(part);
        }
        if let Some(root) = self.parts.get_mut(first) {
            root.name = name;
        }
        if !other.joints.is_empty() && self.mobility == Mobility::Fixed {
            self.mobility = Mobility::Articulated;
        }
        self.joints
            .extend(other.joints.into_iter().map(|joint| ModelJoint {
                parent: joint.parent + first,
                child: joint.child + first,
                position: pose.transform_point(joint.position),
                axis: pose.transform_vector(joint.axis),
                ..joint
            }));
        self.sounds
            .extend(other.sounds.into_iter().map(|sound| ModelSound {
                part: sound.part + first,
                position: pose.transform_point(sound.position),
                ..sound
            }));
        self.switch = self.switch.or(other.switch);
        self
    }

    /// The same model with `paint` on every surface whose finish is called `name`; masses stay.
    #[must_use]
    pub fn with_finish_replaced(mut self, name: &str, paint: &Finish) -> Self {
        let finishes = self.parts.iter_mut().flat_map(|part| &mut part.finishes);
        for finish in finishes.filter(|finish| finish.name == name) {
            finish.clone_from(paint);
        }
        self
    }

    /// The box around it with all joints closed, model space.
    pub fn bounds(&self) -> Aabb {
        self.parts.iter().fold(Aabb::EMPTY, |bounds, part| {
            bounds.union(&part.mesh.bounds())
        })
    }

    /// Returns where a part stands at the start.
    pub fn model_from_part(&self, part: usize) -> Pose {
        let Some(joint) = self.joints.iter().find(|joint| joint.child == part) else {
            return Pose::IDENTITY;
        };
        let to_axis = Pose::from_position(joint.position);
        let motion = match joint.kind {
            JointKind::Hinge => Pose::new(
                Vec3::ZERO,
                super::shapes::axis_rotation(joint.axis, joint.initial),
            ),
            JointKind::Slide => Pose::from_position(joint.axis * joint.initial),
        };
        self.model_from_part(joint.parent) * to_axis * motion * to_axis.inverse()
    }
}

/// A part under construction.
#[derive(Debug)]
pub struct PartBuilder {
    name: &'static str,
    mesh: Mesh,
    finishes: Vec<Finish>,
    colliders: Vec<Collider>,
    collider_volume_m3: f32,
    mass_kg: f32,
}

impl PartBuilder {
    /// A part without a shape.
    pub fn new(name: &'static str) -> Self {
        Self {
            name,
            mesh: Mesh::default(),
            finishes: Vec::new(),
            colliders: Vec::new(),
            collider_volume_m3: 0.0,
            mass_kg: 0.0,
        }
    }

    /// The same part with one more shape, solid of its finish's substance.
    #[must_use]
    pub fn with(self, finish: &Finish, solid: SolidMesh) -> Self {
        self.with_fill_fraction(finish, solid, 1.0)
    }

    /// The same part with one more shape of which `fill` (0 to 1) is substance and the rest air.
    #[must_use]
    pub fn with_fill_fraction(mut self, finish: &Finish, mut solid: SolidMesh, fill: f32) -> Self {
        let slot = self
            .finishes
            .iter()
            .position(|known| known == finish)
            .unwrap_or_else(|| {
                self.finishes.push(finish.clone());
                self.finishes.len() - 1
            });
        let volume = solid.mesh.enclosed_volume_m3() as f32;
        self.mass_kg += volume * finish.substance().density_kg_m3 * fill;
        self.collider_volume_m3 += solid.collider_volume_m3();
        if finish.tile_m > 0.0 {
            for uv in &mut solid.mesh.uvs {
                *uv /= finish.tile_m;
            }
        }
        self.mesh.append(&solid.mesh, slot as u16);
        self.colliders.append(&mut solid.colliders);
        self
    }

    /// The same part with one more bar or plate: metal ones are tubes and sheets.
    #[must_use]
    pub fn with_hollow(self, finish: &Finish, solid: SolidMesh) -> Self {
        self.with_fill_fraction(finish, solid, finish.hollow_fill_fraction())
    }

    /// The same part with each of `solids`, bars or plates: metal ones are tubes and sheets.
    #[must_use]
    pub fn with_all_hollow(
        self,
        finish: &Finish,
        solids: impl IntoIterator<Item = SolidMesh>,
    ) -> Self {
        solids
            .into_iter()
            .fold(self, |part, solid| part.with_hollow(finish, solid))
    }

    /// The same part with one more stuffed shape under a cover.
    #[must_use]
    pub fn with_padding(self, cover: &Finish, solid: SolidMesh) -> Self {
        self.with_fill_fraction(cover, solid, cover.padded_fill_fraction())
    }

    /// The same part with each of `solids`.
    #[must_use]
    pub fn with_all(self, finish: &Finish, solids: impl IntoIterator<Item = SolidMesh>) -> Self {
        solids
            .into_iter()
            .fold(self, |part, solid| part.with(finish, solid))
    }

    fn finish(mut self) -> ModelPart {
        // Models stay for as long as the process.
        self.mesh.shrink_to_fit();
        self.colliders.shrink_to_fit();
        let mass_kg = self.mass_kg.max(1e-3);
        let density_kg_m3 = (mass_kg / self.collider_volume_m3.max(1e-6)).clamp(1.0, 20_000.0);
        ModelPart {
            name: self.name,
            mesh: Arc::new(self.mesh),
            finishes: self.finishes,
            colliders: self.colliders,
            mass_kg,
            density_kg_m3,
        }
    }
}
