//! A chain in this crate's world.

use crate::chain::{Chain, DENSITY, GRAVITY, ORIGIN, Solver};
use dwell_physics::{JointState, PhysicsConfig, PhysicsWorld};
use dwell_scene::{
    Category, Collider, House, Joint, JointCommand, JointId, JointKind, LevelId, MaterialId, Mesh,
    Mobility, Object, ObjectId, Part, PartId, Pose, RoomId, Servo, ShoeboxMaterials, State,
};
use glam::{Affine3A, DVec3, Vec3};
use std::sync::Arc;

pub(crate) struct Ours {
    chain: Chain,
    house: Arc<House>,
    world: PhysicsWorld,
    state: State,
}

fn house(chain: &Chain) -> Arc<House> {
    let room = House::shoebox([8.0, 8.0, 8.0], &ShoeboxMaterials::default()).expect("it is valid");
    let mut data = room.data().clone();
    let (object, first_part) = (ObjectId(0), PartId(0));
    let (mut at, mut reach) = (ORIGIN, 0.0);
    for (k, bar) in chain.bars.iter().enumerate() {
        let (low, high) = (
            Vec3::new(0.0, -bar.half, -bar.half),
            Vec3::new(bar.length, bar.half, bar.half),
        );
        let mesh = data.meshes.push(Arc::new(Mesh::cuboid(low, high)));
        let part = data.parts.push(Part {
            object,
            name: format!("bar_{k}"),
            fixed: false,
            world_from_part: Pose::from_position(at),
            mesh,
            part_from_mesh: Affine3A::IDENTITY,
            materials: vec![MaterialId(0)],
            colliders: vec![Collider::cuboid(low, high)],
            mass_kg: None,
            density_kg_m3: DENSITY,
            inertial: None,
        });
        let servo = chain.motor.map(|motor| Servo {
            stiffness: motor.stiffness,
            damping: motor.damping,
            max_effort: 1e6,
            velocity_gain: 0.0,
            max_velocity: None,
            gear: 1.0,
            feed_forward: false,
        });
        let before = k.checked_sub(1);
        let place = if k == 0 { at } else { Vec3::X * reach };
        data.joints.push(Joint {
            parent: before.map(|before| PartId(before as u32)),
            parent_from_joint: Pose::from_position(place),
            limits: chain.limits,
            friction: chain.friction,
            servo,
            ..Joint::new(&format!("j{k}"), object, part, JointKind::Hinge, bar.axis)
        });
        (at.x, reach) = (at.x + bar.length, bar.length);
    }
    data.objects.push(Object {
        name: "chain".into(),
        source_id: String::new(),
        model: String::new(),
        category: Category::default(),
        level: LevelId(0),
        room: Some(RoomId(0)),
        mobility: Mobility::Articulated,
        pickable: false,
        switch: None,
        first_part,
        part_count: chain.bars.len() as u32,
    });
    Arc::new(House::new(data).expect("it is valid"))
}

impl Ours {
    pub(crate) fn new(chain: &Chain) -> Self {
        let house = house(chain);
        let mut state = State::new(&house);
        let gravity = "world/gravity_m_s2".parse().expect("it is an address");
        state
            .set_parameter(&house, &gravity, f64::from(GRAVITY))
            .expect("it is in range");
        let config = PhysicsConfig {
            sleeping: false,
            control_rate_hz: chain.control_hz as f32,
            ..PhysicsConfig::default()
        };
        let (mut world, _) =
            PhysicsWorld::new(house.clone(), config, &mut state).expect("it is a valid house");
        let start = chain.start.iter().enumerate();
        let joints: Vec<JointState> = start
            .map(|(k, [position, velocity])| JointState {
                joint: JointId(k as u32),
                position: *position,
                velocity: *velocity,
            })
            .collect();
        world
            .set_joints(&mut state, &joints)
            .expect("it is within limits");
        if chain.motor.is_some() {
            for (k, [position, _]) in chain.start.iter().enumerate() {
                state.joint_command[JointId(k as u32)] = JointCommand::Position(*position);
            }
        }
        Self {
            chain: chain.clone(),
            house,
            world,
            state,
        }
    }
}

impl Solver for Ours {
    fn steps(&mut self, control_steps: usize) {
        let mut events = Vec::new();
        for _ in 0..control_steps {
            self.world
                .step(&mut self.state, &[], &mut events)
                .expect("it is the world's state");
        }
    }

    fn angles(&self) -> Vec<f64> {
        self.state
            .joint_position
            .iter()
            .map(|q| f64::from(*q))
            .collect()
    }

    fn rates(&self) -> Vec<f64> {
        self.state
            .joint_velocity
            .iter()
            .map(|v| f64::from(*v))
            .collect()
    }

    fn energy_j(&self) -> f64 {
        let bars = self.chain.bars.iter().zip(self.house.parts.ids());
        let potential: f64 = bars
            .map(|(bar, part)| {
                let pose = self.state.part_pose[part];
                let turn = pose.rotation.as_dquat();
                let middle = turn * DVec3::X * (0.5 * f64::from(bar.length));
                let height = f64::from(pose.position.y) + middle.y;
                Chain::mass_kg(bar) * f64::from(GRAVITY) * height
            })
            .sum();
        self.world.kinetic_energy_j() + potential
    }

    fn bits(&self) -> Vec<u8> {
        self.world.unpacked_snapshot()
    }

    fn restored(&self) -> Box<dyn Solver> {
        let mut again = Self::new(&self.chain);
        again.state = self.state.clone();
        again
            .world
            .restore(&mut again.state, &self.world.snapshot())
            .expect("it is this world's snapshot");
        Box::new(again)
    }
}
