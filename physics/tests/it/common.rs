//! Houses composed by hand, and a world over them.

use dwell_physics::{AgentControl, ContactEvent, PhysicsConfig, PhysicsWorld, StartReport};
use dwell_scene::material::library;
use dwell_scene::navigation::{NavConfig, NavGrid};
use dwell_scene::rays::RayScene;
use dwell_scene::{
    Aabb, AgentBody, AgentId, AgentState, Category, Collider, House, HouseData, Id, Joint, JointId,
    JointKind, LevelId, Material, MaterialId, Mesh, Mobility, Object, ObjectId, Part, PartId, Pose,
    Receptacle, ReceptacleKind, RoomId, ShoeboxMaterials, State,
};
use glam::{Affine3A, Quat, Vec3};
use std::sync::Arc;

/// A room with things in it.
pub(crate) struct Build {
    pub(crate) data: HouseData,
}

/// A part to be added.
#[derive(Clone)]
pub(crate) struct Piece {
    pub(crate) collider: Collider,
    pub(crate) substance: &'static str,
    pub(crate) place: Pose,
    pub(crate) density: f32,
    pub(crate) fixed: bool,
}

impl Piece {
    pub(crate) fn cuboid(half: Vec3, at: Vec3) -> Self {
        Self {
            collider: Collider::cuboid(-half, half),
            substance: "wood",
            place: Pose::from_position(at),
            density: 500.0,
            fixed: false,
        }
    }

    pub(crate) fn ball(radius: f32, at: Vec3) -> Self {
        Self {
            collider: Collider::Ball {
                center: Vec3::ZERO,
                radius,
            },
            ..Self::cuboid(Vec3::splat(radius), at)
        }
    }

    pub(crate) fn of(mut self, substance: &'static str) -> Self {
        self.substance = substance;
        self
    }

    pub(crate) fn turned(mut self, rotation: Quat) -> Self {
        self.place.rotation = rotation;
        self
    }

    pub(crate) fn density(mut self, density: f32) -> Self {
        self.density = density;
        self
    }
}

impl Build {
    /// A closed room from the origin, with a parquet floor and plaster walls.
    pub(crate) fn room(size: [f32; 3]) -> Self {
        Self::room_of(size, "parquet")
    }

    pub(crate) fn room_of(size: [f32; 3], floor: &str) -> Self {
        let of = |name: &str, substance: &str| {
            Material::from_substance(name, library().get_or_default(substance))
        };
        let materials = ShoeboxMaterials {
            floor: of("floor", floor),
            ..ShoeboxMaterials::uniform(&of("wall", "plaster"))
        };
        Self {
            data: House::shoebox(size, &materials).unwrap().data().clone(),
        }
    }

    pub(crate) fn material(&mut self, substance: &str) -> MaterialId {
        let name = format!("of_{substance}");
        if let Some((id, _)) = self.data.materials.iter_ids().find(|(_, m)| m.name == name) {
            return id;
        }
        let substance = library()
            .get(substance)
            .expect("a substance of the library");
        self.data
            .materials
            .push(Material::from_substance(name, substance))
    }

    /// Adds an object with one part for each piece.
    pub(crate) fn object(&mut self, name: &str, mobility: Mobility, pieces: &[Piece]) -> ObjectId {
        let id = ObjectId::from_index(self.data.objects.len());
        let first_part = PartId::from_index(self.data.parts.len());
        for (k, piece) in pieces.iter().enumerate() {
            let material = self.material(piece.substance);
            let bounds = piece.collider.bounds().expect("a convex piece");
            let mesh = self
                .data
                .meshes
                .push(Arc::new(Mesh::cuboid(bounds.min, bounds.max)));
            self.data.parts.push(Part {
                object: id,
                name: format!("part_{k}"),
                fixed: piece.fixed || mobility == Mobility::Fixed,
                world_from_part: piece.place,
                mesh,
                part_from_mesh: Affine3A::IDENTITY,
                materials: vec![material],
                colliders: vec![piece.collider.clone()],
                mass_kg: None,
                density_kg_m3: piece.density,
                inertial: None,
            });
        }
        self.data.objects.push(Object {
            name: name.to_owned(),
            source_id: name.to_owned(),
            model: name.to_owned(),
            category: Category {
                fine: name
                    .trim_end_matches(|c: char| c == '_' || c.is_ascii_digit())
                    .to_owned(),
                ..Category::default()
            },
            level: LevelId(0),
            room: Some(RoomId(0)),
            mobility,
            pickable: mobility == Mobility::Movable,
            switch: None,
            first_part,
            part_count: pieces.len() as u32,
        })
    }

    pub(crate) fn movable(&mut self, name: &str, piece: Piece) -> ObjectId {
        self.object(name, Mobility::Movable, &[piece])
    }

    pub(crate) fn fixed(&mut self, name: &str, piece: Piece) -> ObjectId {
        self.object(name, Mobility::Fixed, &[piece])
    }

    /// A hinge or slide that moves an object's last part; `world_from_joint` is where its frame is.
    pub(crate) fn joint(
        &mut self,
        object: ObjectId,
        kind: JointKind,
        axis: Vec3,
        at: Vec3,
        limits: [f32; 2],
    ) -> JointId {
        let id = self.data.objects[object].parts().next_back().unwrap();
        let child_from_joint =
            self.data.parts[id].world_from_part.inverse() * Pose::from_position(at);
        self.data.joints.push(Joint {
            parent_from_joint: Pose::from_position(at),
            child_from_joint,
            limits: Some(limits),
            closed: 0.0_f32.clamp(limits[0], limits[1]),
            open: limits[1],
            initial: 0.0_f32.clamp(limits[0], limits[1]),
            ..Joint::new("hinge", object, id, kind, axis)
        })
    }

    /// A wall across the room at `z` with a doorway from x = 2 to x = 3 and a door in it, hinged at x = 2.
    pub(crate) fn wall_with_door(&mut self, z: f32, width: f32) -> (ObjectId, JointId) {
        let wall = |from: f32, to: f32, low: f32| {
            Piece::cuboid(
                Vec3::new((to - from) * 0.5, (3.0 - low) * 0.5, 0.05),
                Vec3::new((to + from) * 0.5, (3.0 + low) * 0.5, z),
            )
            .of("plaster")
        };
        self.fixed("wall_a", wall(0.0, 2.0, 0.0));
        self.fixed("wall_b", wall(3.0, width, 0.0));
        self.fixed("lintel", wall(2.0, 3.0, 2.1));
        let leaf = Piece::cuboid(Vec3::new(0.49, 1.04, 0.02), Vec3::new(2.5, 1.05, z))
            .of("wood_door")
            .density(400.0);
        let door = self.object("door_1", Mobility::Articulated, &[leaf]);
        let joint = self.joint(
            door,
            JointKind::Hinge,
            Vec3::Y,
            Vec3::new(2.01, 0.0, z),
            [0.0, 1.6],
        );
        self.data.joints[joint].friction = 0.5;
        self.data.joints[joint].damping = 0.5;
        (door, joint)
    }

    /// A chest with one drawer that slides towards +Z, 0.5 m wide, 0.24 m high, 0.4 m deep, its foot's middle at `at`.
    /// The drawer is marked as holding things inside.
    pub(crate) fn chest(&mut self, at: Vec3) -> (ObjectId, JointId) {
        let board = |half: Vec3, middle: Vec3| {
            let mut piece = Piece::cuboid(half, at + middle);
            piece.fixed = true;
            piece
        };
        let sides = [
            board(Vec3::new(0.01, 0.12, 0.2), Vec3::new(-0.24, 0.12, 0.0)),
            board(Vec3::new(0.01, 0.12, 0.2), Vec3::new(0.24, 0.12, 0.0)),
            board(Vec3::new(0.25, 0.01, 0.2), Vec3::new(0.0, 0.01, 0.0)),
            board(Vec3::new(0.25, 0.01, 0.2), Vec3::new(0.0, 0.23, 0.0)),
            board(Vec3::new(0.25, 0.12, 0.01), Vec3::new(0.0, 0.12, -0.19)),
        ];
        let mut pieces: Vec<Piece> = sides.into();
        let half = Vec3::new(0.22, 0.09, 0.18);
        pieces.push(Piece::cuboid(half, at + Vec3::new(0.0, 0.12, 0.01)));
        let chest = self.object("chest_of_drawers", Mobility::Articulated, &pieces);
        let leaf = self.data.objects[chest].parts().next_back().unwrap();
        let wall = |low: [f32; 3], high: [f32; 3]| Collider::cuboid(low.into(), high.into());
        self.data.parts[leaf].colliders = vec![
            wall([-0.22, -0.09, -0.18], [0.22, -0.08, 0.18]),
            wall([-0.22, -0.08, -0.18], [-0.21, 0.05, 0.18]),
            wall([0.21, -0.08, -0.18], [0.22, 0.05, 0.18]),
            wall([-0.21, -0.08, -0.18], [0.21, 0.05, -0.17]),
            wall([-0.22, -0.09, 0.17], [0.22, 0.09, 0.18]),
        ];
        let origin = self.data.parts[leaf].world_from_part.position;
        let joint = self.joint(chest, JointKind::Slide, Vec3::Z, origin, [0.0, 0.34]);
        self.data.joints[joint].friction = 1.0;
        self.data.joints[joint].damping = 8.0;
        self.data.receptacles.push(Receptacle {
            object: chest,
            part: leaf,
            name: "drawer".to_owned(),
            holding: ReceptacleKind::In,
            space_in_part: Aabb::new(Vec3::new(-0.21, -0.08, -0.17), Vec3::new(0.21, 0.09, 0.17)),
        });
        (chest, joint)
    }

    pub(crate) fn house(self) -> Arc<House> {
        Arc::new(House::new(self.data).unwrap())
    }

    pub(crate) fn run(self) -> Run {
        self.run_with(PhysicsConfig::default())
    }

    pub(crate) fn run_with(self, config: PhysicsConfig) -> Run {
        Run::over(self.house(), config)
    }
}

/// A world with its state.
#[derive(Clone)]
pub(crate) struct Run {
    pub(crate) house: Arc<House>,
    pub(crate) world: PhysicsWorld,
    pub(crate) state: State,
    pub(crate) report: StartReport,
    pub(crate) rays: RayScene,
    pub(crate) events: Vec<ContactEvent>,
}

impl Run {
    pub(crate) fn over(house: Arc<House>, config: PhysicsConfig) -> Self {
        let state = State::new(&house);
        Self::from_state(house, config, state)
    }

    pub(crate) fn from_state(house: Arc<House>, config: PhysicsConfig, mut state: State) -> Self {
        let (world, report) = PhysicsWorld::new(house.clone(), config, &mut state).unwrap();
        let mut rays = RayScene::new(house.clone());
        rays.update(&state);
        Self {
            house,
            world,
            state,
            report,
            rays,
            events: Vec::new(),
        }
    }

    pub(crate) fn agent(&mut self, at: Vec3, yaw: f32) -> AgentId {
        self.agent_with(AgentBody::default(), at, yaw)
    }

    pub(crate) fn agent_with(&mut self, body: AgentBody, at: Vec3, yaw: f32) -> AgentId {
        self.world
            .add_agent(&mut self.state, AgentState::new(body, at, yaw))
            .unwrap()
    }

    /// Returns positions where an agent can stand and walk about, the nearest to `point` first.
    pub(crate) fn places_by(&self, point: Vec3) -> Vec<Vec3> {
        let grid = NavGrid::build(&self.house, &self.state, &NavConfig::default()).unwrap();
        let largest = grid.walkable().filter(|cell| grid.island(*cell) == Some(0));
        let mut places: Vec<Vec3> = largest.map(|cell| grid.position(cell)).collect();
        places.sort_by(|a, b| a.distance(point).total_cmp(&b.distance(point)));
        places
    }

    pub(crate) fn steps(&mut self, count: usize) {
        self.walk(count, &[]);
    }

    pub(crate) fn walk(&mut self, count: usize, controls: &[AgentControl]) {
        for _ in 0..count {
            self.world
                .step(&mut self.state, controls, &mut self.events)
                .unwrap();
        }
        self.rays.update(&self.state);
    }

    pub(crate) fn act(
        &mut self,
        agent: AgentId,
        action: impl dwell_physics::HandAction,
    ) -> dwell_physics::ActionOutcome {
        let outcome = self.world.act(&mut self.state, &self.rays, agent, &action);
        self.rays.update(&self.state);
        outcome
    }

    /// Waits for the end of an operation that takes time.
    pub(crate) fn told(&mut self, steps: usize) -> Option<dwell_physics::ActionOutcome> {
        (0..steps).find_map(|_| {
            self.walk(1, &[]);
            self.world
                .delayed_outcomes()
                .first()
                .map(|notice| notice.outcome.clone())
        })
    }

    pub(crate) fn rotation(&self, object: ObjectId) -> Quat {
        self.state.part_pose[self.root(object)].rotation
    }

    pub(crate) fn root(&self, object: ObjectId) -> PartId {
        self.house.objects[object].first_part
    }

    pub(crate) fn position(&self, object: ObjectId) -> Vec3 {
        self.state.part_pose[self.root(object)].position
    }

    pub(crate) fn velocity(&self, object: ObjectId) -> Vec3 {
        self.state.part_velocity[self.root(object)].linear
    }

    /// Gives an object a velocity.
    pub(crate) fn throw(&mut self, object: ObjectId, velocity: Vec3) {
        let root = self.root(object);
        self.state.part_velocity[root].linear = velocity;
        self.world.adopt_state(&mut self.state).unwrap();
    }

    /// State and physics as one number.
    pub(crate) fn hash(&self) -> (u64, Vec<u8>) {
        (self.state.hash(), self.world.unpacked_snapshot())
    }
}

pub(crate) fn forward(speed: f32) -> AgentControl {
    AgentControl {
        forward_m_s: speed,
        ..AgentControl::default()
    }
}

pub(crate) fn gravity() -> f32 {
    dwell_scene::units::STANDARD_GRAVITY_M_S2
}

/// The pair's values, straight from the library.
pub(crate) fn pair(a: &str, b: &str) -> (f32, f32) {
    let pair = library().pair_contact(a, b);
    (pair.friction, pair.restitution)
}
