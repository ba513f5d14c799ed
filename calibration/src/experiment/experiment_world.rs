//! Small houses in which trajectories and servos are simulated, and the physics worlds over them.

use crate::bundle::file::BoardManifest;
use crate::error::CalibrationError;
use dwell_physics::{PhysicsConfig, PhysicsWorld};
use dwell_scene::material::library;
use dwell_scene::{
    Category, Collider, House, HouseData, IdVec, Joint, JointKind, LawSpec, LevelId, Material,
    Mesh, Mobility, Object, ObjectId, Part, PartId, Pose, Servo, ShoeboxMaterials, State,
};
use glam::{Affine3A, Vec3};
use std::sync::Arc;

/// Half the edge of the box that stands for the servo's load, m.
const ARM_HALF_EDGE_M: f32 = 0.1;
/// Substance of things that touch nothing.
const OBJECT_SUBSTANCE: &str = "rubber";
/// Height at which a thing waits above the board until it is placed, m.
const WAITING_HEIGHT_M: f32 = 2.0;

/// A physics world at its start, to be copied for every simulation.
#[derive(Clone)]
pub(crate) struct ExperimentWorld {
    pub(crate) house: Arc<House>,
    pub(crate) world: PhysicsWorld,
    pub(crate) state: State,
}

/// The simulated object.
pub(crate) struct ExperimentObject {
    pub(crate) name: String,
    pub(crate) mass_kg: f32,
    pub(crate) collider: Collider,
    /// The servo and Coulomb friction of its hinge; `None`: it is free.
    pub(crate) hinge: Option<(Servo, f32)>,
    /// The board above which it waits, the plane y = 0.
    pub(crate) board: Option<Board>,
    /// Its substance.
    pub(crate) substance: String,
}

/// A board that things touch.
pub(crate) struct Board {
    /// Half its edge, m.
    pub(crate) half_edge_m: f32,
    /// Its substance.
    pub(crate) substance: String,
}

impl ExperimentObject {
    /// A ball.
    pub(crate) fn ball(name: &str, mass_kg: f64, radius_m: f64) -> Self {
        Self {
            name: name.to_owned(),
            mass_kg: mass_kg as f32,
            collider: Collider::Ball {
                center: Vec3::ZERO,
                radius: radius_m as f32,
            },
            hinge: None,
            board: None,
            substance: OBJECT_SUBSTANCE.to_owned(),
        }
    }

    /// A box.
    pub(crate) fn cuboid(name: &str, mass_kg: f64, half_extents_m: [f64; 3]) -> Self {
        let half = Vec3::from(half_extents_m.map(|half| half as f32));
        Self {
            collider: Collider::cuboid(-half, half),
            ..Self::ball(name, mass_kg, 0.1)
        }
    }

    /// The same above a board, of the substances that the manifest says.
    pub(crate) fn above_board(self, half_edge_m: f32, board: &BoardManifest) -> Self {
        let [thing, board] = board.substance_pair().map(str::to_owned);
        Self {
            board: Some(Board {
                half_edge_m,
                substance: board,
            }),
            substance: thing,
            ..self
        }
    }

    /// A box on a vertical hinge with this moment of inertia about it.
    pub(crate) fn arm(name: &str, inertia_kg_m2: f64, hinge: (Servo, f32)) -> Self {
        let half = ARM_HALF_EDGE_M;
        Self {
            name: name.to_owned(),
            // A box about its middle: I = m (a² + c²) / 12 with edges a = c.
            mass_kg: (inertia_kg_m2 * 12.0 / f64::from(8.0 * half * half)) as f32,
            collider: Collider::cuboid(Vec3::splat(-half), Vec3::splat(half)),
            hinge: Some(hinge),
            board: None,
            substance: OBJECT_SUBSTANCE.to_owned(),
        }
    }
}

impl ExperimentWorld {
    /// A closed box of `size_m` around the origin with one thing in it. Near the origin single precision is finest: the
    /// rounding of larger coordinates would exceed the effects that are looked for.
    pub(crate) fn new(
        size_m: f32,
        thing: &ExperimentObject,
        config: PhysicsConfig,
    ) -> Result<Self, CalibrationError> {
        let fault =
            |error: &dyn std::fmt::Display| CalibrationError::simulation(&thing.name, error);
        let box_house =
            House::shoebox([size_m; 3], &ShoeboxMaterials::default()).map_err(|e| fault(&e))?;
        let mut data = HouseData::clone(&box_house);
        let middle = Vec3::splat(0.5 * size_m);
        for mesh in &mut data.meshes {
            let mut moved = Mesh::clone(mesh);
            for position in &mut moved.positions {
                *position -= middle;
            }
            *mesh = Arc::new(moved);
        }
        // Nothing here needs rooms.
        data.rooms = IdVec::new();
        for piece in &mut data.structure {
            piece.room = None;
        }
        add_object(&mut data, thing);
        if let Some(board) = &thing.board {
            put_board(&mut data, board);
        }
        let house = Arc::new(House::new(data).map_err(|e| fault(&e))?);
        let mut state = State::new(&house);
        let (world, report) =
            PhysicsWorld::new(house.clone(), config, &mut state).map_err(|e| fault(&e))?;
        if !report.frozen.is_empty() || !report.moved.is_empty() {
            return Err(fault(&"it does not fit where it should start"));
        }
        Ok(Self {
            house,
            world,
            state,
        })
    }

    /// Installs laws and overrides into a copy.
    pub(crate) fn with_laws_and_overrides(
        &self,
        laws: Vec<LawSpec>,
        overrides: &[(&str, f64)],
    ) -> Result<Self, CalibrationError> {
        let fault = |error: &dyn std::fmt::Display| {
            CalibrationError::simulation("laws and parameters", error)
        };
        let mut stage = self.clone();
        stage.state.laws = laws;
        for (address, value) in overrides {
            let address = address.parse().map_err(|e| fault(&e))?;
            stage
                .state
                .set_parameter(&stage.house, &address, *value)
                .map_err(|e| fault(&e))?;
        }
        stage
            .world
            .apply_parameters(&mut stage.state)
            .map_err(|e| fault(&e))?;
        Ok(stage)
    }

    /// Adopts changes of the state.
    pub(crate) fn adopt_state(&mut self) -> Result<(), CalibrationError> {
        let adopted = self.world.adopt_state(&mut self.state);
        adopted.map_err(|error| CalibrationError::simulation("a start", error))
    }

    /// One step.
    pub(crate) fn step(&mut self) -> Result<(), CalibrationError> {
        let mut events = Vec::new();
        let stepped = self.world.step(&mut self.state, &[], &mut events);
        stepped.map_err(|error| CalibrationError::simulation("a step", error))
    }
}

fn add_object(data: &mut HouseData, thing: &ExperimentObject) {
    let material = data.materials.push(Material::from_substance(
        "thing",
        library().get_or_default(&thing.substance),
    ));
    let mesh = data.meshes.push(Arc::new(octahedron()));
    let (object, part) = (
        ObjectId(data.objects.len() as u32),
        PartId(data.parts.len() as u32),
    );
    data.objects.push(Object {
        name: thing.name.clone(),
        source_id: String::new(),
        model: String::new(),
        category: Category::default(),
        level: LevelId(0),
        room: None,
        mobility: if thing.hinge.is_some() {
            Mobility::Articulated
        } else {
            Mobility::Movable
        },
        pickable: false,
        switch: None,
        first_part: part,
        part_count: 1,
    });
    data.parts.push(Part {
        object,
        name: "part".into(),
        fixed: false,
        world_from_part: if thing.board.is_some() {
            Pose::from_position(Vec3::new(0.0, WAITING_HEIGHT_M, 0.0))
        } else {
            Pose::IDENTITY
        },
        mesh,
        part_from_mesh: Affine3A::from_scale(Vec3::splat(ARM_HALF_EDGE_M)),
        materials: vec![material],
        colliders: vec![thing.collider.clone()],
        mass_kg: Some(thing.mass_kg),
        density_kg_m3: 1000.0,
        inertial: None,
    });
    if let Some((servo, friction)) = thing.hinge {
        data.joints.push(Joint {
            limits: Some([-3.0, 3.0]),
            friction,
            servo: Some(servo),
            ..Joint::new(&thing.name, object, part, JointKind::Hinge, Vec3::Y)
        });
    }
}

/// The board: a slab below the plane y = 0, one convex piece without inner edges.
fn put_board(data: &mut HouseData, board: &Board) {
    let material = data.materials.push(Material::from_substance(
        "board",
        library().get_or_default(&board.substance),
    ));
    let mesh = data.meshes.push(Arc::new(octahedron()));
    let (object, part) = (
        ObjectId(data.objects.len() as u32),
        PartId(data.parts.len() as u32),
    );
    data.objects.push(Object {
        name: "board".into(),
        source_id: String::new(),
        model: String::new(),
        category: Category::default(),
        level: LevelId(0),
        room: None,
        mobility: Mobility::Fixed,
        pickable: false,
        switch: None,
        first_part: part,
        part_count: 1,
    });
    let (half, thickness) = (board.half_edge_m, 0.5);
    data.parts.push(Part {
        object,
        name: "part".into(),
        fixed: true,
        world_from_part: Pose::IDENTITY,
        mesh,
        part_from_mesh: Affine3A::from_scale(Vec3::splat(ARM_HALF_EDGE_M)),
        materials: vec![material],
        colliders: vec![Collider::cuboid(
            Vec3::new(-half, -thickness, -half),
            Vec3::new(half, 0.0, half),
        )],
        mass_kg: None,
        density_kg_m3: 1000.0,
        inertial: None,
    });
}

/// A mesh, as every part must have one.
fn octahedron() -> Mesh {
    let axes = [
        Vec3::X,
        Vec3::Y,
        Vec3::Z,
        Vec3::NEG_X,
        Vec3::NEG_Y,
        Vec3::NEG_Z,
    ];
    let faces = [
        [0, 1, 2],
        [1, 3, 2],
        [3, 4, 2],
        [4, 0, 2],
        [1, 0, 5],
        [3, 1, 5],
        [4, 3, 5],
        [0, 4, 5],
    ];
    Mesh {
        positions: axes.to_vec(),
        normals: axes.to_vec(),
        uvs: Vec::new(),
        triangles: faces.to_vec(),
        slots: Vec::new(),
    }
}

/// A quantity with its rate of change at equal steps, read between them by cubic Hermite interpolation.
pub(crate) fn hermite_interpolation(track: &[(f64, f64)], step_s: f64, t_s: f64) -> f64 {
    let last = track.len() - 1;
    let place = (t_s / step_s).clamp(0.0, last as f64);
    let k = (place.floor() as usize).min(last.saturating_sub(1));
    if last == 0 {
        return track[0].0;
    }
    let (s, h) = (place - k as f64, step_s);
    let ((p0, v0), (p1, v1)) = (track[k], track[k + 1]);
    let (s2, s3) = (s * s, s * s * s);
    (2.0 * s3 - 3.0 * s2 + 1.0) * p0
        + (s3 - 2.0 * s2 + s) * h * v0
        + (3.0 * s2 - 2.0 * s3) * p1
        + (s3 - s2) * h * v1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_read_exactly_between_steps() {
        let track: Vec<(f64, f64)> = (0..5)
            .map(|k| f64::from(k) * 0.1)
            .map(|t| (t * t, 2.0 * t))
            .collect();
        for t in [0.0, 0.05, 0.1234, 0.4] {
            assert!((hermite_interpolation(&track, 0.1, t) - t * t).abs() < 1e-12);
        }
        assert!(
            (hermite_interpolation(&track, 0.1, -1.0)).abs() < 1e-12
                && (hermite_interpolation(&track, 0.1, 9.0) - 0.16).abs() < 1e-12
        );
    }
}
