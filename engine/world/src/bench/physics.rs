//! Physics steps a second: of one world as it falls to rest, without sleep, asleep, and of many worlds together.

use super::unwinding::DropOnThread;
use super::{BenchOptions, BenchProgress, median};
use crate::error::WorldError;
use dwell_physics::{PhysicsConfig, PhysicsModel, PhysicsWorld};
use dwell_scene::interrupt;
use dwell_scene::material::library;
use dwell_scene::parallel::Threads;
use dwell_scene::{
    Category, Collider, House, HouseData, IdVec, LevelId, Material, Mesh, Mobility, Object,
    ObjectId, Part, PartId, Pose, State,
};
use glam::{Affine3A, Vec3};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::sync::Arc;
use std::time::Instant;

/// Simulated time after which everything should be at rest, s.
const SETTLED_S: f32 = 5.0;
/// Below this height a thing has fallen out of the house, m under its lowest floor.
const FALLEN_M: f32 = 1.0;
/// Physics steps in a control step.
const STEPS_PER_CONTROL: usize = 5;

/// Boxes that take the place of a house's objects.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BenchBoxes {
    /// Those that stand.
    pub fixed: Vec<BoxBody>,
    /// Those that move.
    pub dynamic: Vec<BoxBody>,
    /// Of those that move, kg/m³.
    pub density_kg_m3: f32,
    /// Physics steps per second; a whole multiple of 5.
    pub physics_rate_hz: f32,
}

/// An upright box.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoxBody {
    /// m.
    pub center: [f32; 3],
    /// Half of each edge, m.
    pub half_extents: [f32; 3],
}

/// The house with boxes instead of objects.
fn with_box_objects(house: &House, boxes: &BenchBoxes) -> Result<House, WorldError> {
    let mut data = HouseData::clone(house);
    data.objects = IdVec::new();
    data.parts = IdVec::new();
    data.joints = IdVec::new();
    data.lights.clear();
    data.emitters.clear();
    data.receptacles.clear();
    let material = data.materials.push(Material {
        name: "bench box".into(),
        ..Material::from_substance("bench box", library().get_or_default("oak"))
    });
    let all = boxes.fixed.iter().map(|one| (one, true));
    for (one, fixed) in all.chain(boxes.dynamic.iter().map(|one| (one, false))) {
        let half = Vec3::from_array(one.half_extents);
        let mesh = data.meshes.push(Arc::new(Mesh::cuboid(-half, half)));
        let (object, part) = (
            ObjectId(data.objects.len() as u32),
            PartId(data.parts.len() as u32),
        );
        data.objects.push(Object {
            name: format!("box_{}", object.0),
            source_id: String::new(),
            model: "box".into(),
            category: Category::default(),
            level: LevelId(0),
            room: None,
            mobility: if fixed {
                Mobility::Fixed
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
            name: "box".into(),
            fixed,
            world_from_part: Pose::from_position(Vec3::from_array(one.center)),
            mesh,
            part_from_mesh: Affine3A::IDENTITY,
            materials: vec![material],
            colliders: vec![Collider::cuboid(-half, half)],
            mass_kg: None,
            density_kg_m3: boxes.density_kg_m3,
            inertial: None,
        });
    }
    Ok(House::new(data)?)
}

/// A world at its start.
#[derive(Clone)]
struct BenchWorld {
    world: PhysicsWorld,
    state: State,
}

impl BenchWorld {
    fn new(
        house: &Arc<House>,
        model: &Arc<PhysicsModel>,
        config: &PhysicsConfig,
    ) -> Result<(Self, dwell_physics::StartReport), WorldError> {
        let mut state = State::new(house);
        let (world, report) = PhysicsWorld::with_model(model.clone(), config, &mut state)?;
        Ok((Self { world, state }, report))
    }

    /// Runs physics steps; the rate, 1/s.
    fn run(&mut self, physics_steps: usize) -> Result<f64, WorldError> {
        let mut events = Vec::new();
        let start = Instant::now();
        for _ in 0..physics_steps.div_ceil(STEPS_PER_CONTROL) {
            interrupt::unwind_if_cancelled();
            self.world.step(&mut self.state, &[], &mut events)?;
            events.clear();
        }
        Ok(physics_steps as f64 / start.elapsed().as_secs_f64())
    }
}

/// Steps per second of `options.steps` physics steps from the start (`physics_steps_per_s`), the same with sleeping off,
/// all asleep, and of `options.worlds` worlds together; and whether the things came to rest.
pub(super) fn run(
    house: &str,
    options: &BenchOptions,
    progress: &mut BenchProgress<'_>,
) -> Result<Value, WorldError> {
    progress.set_part_count(5);
    progress.begin_part("coming to rest")?;
    let (mut opened, _) = dwell_houses::open(house)?;
    let mut config = PhysicsConfig::default();
    if let Some(boxes) = &options.boxes {
        opened = with_box_objects(&opened, boxes)?;
        config.physics_rate_hz = boxes.physics_rate_hz;
        // As the scripts, which put a box on others until it is free, without a ceiling over it.
        config.max_start_shift_m = 1.0;
    }
    let most_hz = 1000.0 * STEPS_PER_CONTROL as f32;
    if !(STEPS_PER_CONTROL as f32..=most_hz).contains(&config.physics_rate_hz) {
        return Err(WorldError::Config {
            field: "boxes.physics_rate_hz",
            found: config.physics_rate_hz.to_string(),
            allowed: format!("{STEPS_PER_CONTROL} to {most_hz} Hz"),
        });
    }
    config.control_rate_hz = config.physics_rate_hz / STEPS_PER_CONTROL as f32;
    let house = Arc::new(opened);
    let model = Arc::new(PhysicsModel::new(house.clone()));
    let (start, report) = BenchWorld::new(&house, &model, &config)?;
    let restless = PhysicsConfig {
        sleeping: false,
        ..config.clone()
    };
    let (awake, _) = BenchWorld::new(&house, &model, &restless)?;
    let mut settled = start.clone();
    settled.run((SETTLED_S * config.physics_rate_hz) as usize)?;
    let energy_j = settled.world.kinetic_energy_j();
    let lowest = house
        .levels
        .iter()
        .map(|level| level.bounds.min.y)
        .fold(f32::INFINITY, f32::min);
    let fallen = (settled.state.part_pose.iter())
        .filter(|pose| pose.position.y < lowest - FALLEN_M)
        .count();
    settled.run(10 * config.physics_rate_hz as usize)?;
    let threads = Threads::try_resolve(options.threads)?;
    progress.begin_part("worlds together")?;
    let together = parallel_speedup(&start, options, threads)?;
    let mut rate = |what: &str, start: &BenchWorld| -> Result<f64, WorldError> {
        progress.begin_part(what)?;
        let mut rates = Vec::new();
        for _ in 0..options.repeats {
            rates.push(start.clone().run(options.steps)?);
        }
        rates.sort_by(f64::total_cmp);
        Ok(median(&rates))
    };
    Ok(json!({
        "physics_steps_per_s": rate("one world", &start)?,
        "physics_steps_per_s_sleeping_off": rate("sleeping off", &awake)?,
        "physics_steps_per_s_all_asleep": rate("all asleep", &settled)?,
        "worlds": options.worlds,
        "threads": threads.count(),
        "speed_up_of_worlds_together": together,
        "physics_steps": options.steps,
        "dt_s": 1.0 / config.physics_rate_hz,
        "bodies": report.bodies,
        "moved_at_start": report.moved.len(),
        "frozen_at_start": report.frozen.len(),
        "fallen": fallen,
        "kinetic_energy_after_5_s_j": energy_j,
    }))
}

/// Throughput of many worlds on `threads` threads over that of one world on one thread, of the median of interleaved pairs.
fn parallel_speedup(
    start: &BenchWorld,
    options: &BenchOptions,
    threads: Threads,
) -> Result<f64, WorldError> {
    let mut ratios = Vec::new();
    for _ in 0..options.repeats.min(5) {
        let alone = start.clone().run(options.steps)?;
        let mut worlds = DropOnThread(Vec::with_capacity(options.worlds));
        for _ in 0..options.worlds {
            interrupt::unwind_if_cancelled();
            worlds.push((start.clone(), Ok(0.0)));
        }
        let begun = Instant::now();
        threads.for_each(&mut worlds, |_, (world, rate)| {
            *rate = world.run(options.steps);
        });
        let seconds = begun.elapsed().as_secs_f64();
        for (_, rate) in worlds.drain(..) {
            rate?;
        }
        ratios.push((options.worlds * options.steps) as f64 / seconds / alone);
    }
    ratios.sort_by(f64::total_cmp);
    Ok(median(&ratios))
}
