//! Growth of a view's cost with the house: generated houses side by side, of about 50 thousand, 500 thousand and
//! 5 million triangles, seen from inside rooms by the `cpu` back end on one thread.
//!
//! `cargo bench --profile dev -p dwell-benches --bench large_houses`; without `--bench` the smallest alone, once.
//! Things that can move share the meshes of their models; walls, floors and what is fixed is in the tree of what never moves.

#![expect(clippy::unwrap_used, reason = "a bench may stop at the first surprise")]
#![expect(clippy::print_stdout, reason = "a program tells by printing")]

use dwell_houses::generate::{HomeKind, HouseSpec, generate};
use dwell_render::{Camera, CpuRenderer, Frame, FrameMut, ImageChannels, Preset, View};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{
    Aabb, House, HouseData, Level, LevelId, MaterialId, MeshId, ObjectId, PartId, Pose, RoomId,
    State, TextureId,
};
use glam::{Vec2, Vec3};
use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};
use std::alloc::System;
use std::sync::Arc;
use std::time::Instant;

const MIB: f64 = 1024.0 * 1024.0;
/// Triangles of the houses.
const SIZES: [usize; 3] = [50_000, 500_000, 5_000_000];
/// Houses that differ; more are copies of them.
const SEEDS: u64 = 12;
/// From one house to the next, m.
const PLOT_M: f32 = 24.0;
/// Views of each.
const VIEWS: usize = 200;
const ROUNDS: usize = 8;

#[global_allocator]
static HEAP: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Returns what is allocated and not freed, MiB.
fn in_use_mib() -> f64 {
    let stats = HEAP.stats();
    (stats.bytes_allocated - stats.bytes_deallocated) as f64 / MIB
}

/// Time that a processor worked for this process, s: what others do on the machine does not count; 0 where the system does
/// not say.
fn processor_s() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // The fields after the name in brackets; ticks of 10 ms in user and in system mode are the 12th and 13th of them.
    let fields = text.rsplit(')').next().unwrap_or_default();
    let ticks = fields.split_whitespace().skip(11).take(2);
    let ticks = ticks.filter_map(|word| word.parse::<f64>().ok());
    ticks.sum::<f64>() / 100.0
}

/// Houses side by side, as one.
struct Town {
    data: HouseData,
    triangles: usize,
    houses: usize,
}

/// Offsets of the tables that all copies of a house share in those of the town.
struct Shared {
    house: House,
    mesh: u32,
    material: u32,
}

impl Town {
    /// About so many triangles, by whole houses.
    fn new(triangles: usize) -> Self {
        let mut data = HouseData {
            name: "town".into(),
            source: "town@1".into(),
            ..HouseData::default()
        };
        data.levels.push(Level {
            name: "0".into(),
            bounds: Aabb::new(Vec3::splat(-1e3), Vec3::splat(1e3)),
        });
        let mut town = Self {
            data,
            triangles: 0,
            houses: 0,
        };
        let spec = HouseSpec {
            home: Some(HomeKind::Apartment),
            storeys: Some(1),
            area_m2: Some(60.0),
            ..HouseSpec::default()
        };
        let mut shared: Vec<Shared> = Vec::new();
        // Rows of a square that is large enough for houses of 20 thousand triangles.
        let across = ((triangles as f32 / 20_000.0).sqrt().ceil() as usize).max(1);
        // About as many: one more house must not go far beyond.
        while town.triangles * 20 < triangles * 19 {
            let kind = town.houses % SEEDS as usize;
            if shared.len() == kind {
                let house = generate(kind as u64, &spec).unwrap().house;
                shared.push(town.share(kind, house));
            }
            let (x, z) = (town.houses % across, town.houses / across);
            town.add(&shared[kind], Vec3::new(x as f32, 0.0, z as f32) * PLOT_M);
        }
        town
    }

    /// Takes over what copies of a house share.
    fn share(&mut self, kind: usize, house: House) -> Shared {
        let data = &mut self.data;
        let texture = data.textures.len() as u32;
        let (mesh, material) = (data.meshes.len() as u32, data.materials.len() as u32);
        data.textures = data
            .textures
            .iter()
            .chain(&house.textures)
            .cloned()
            .collect();
        data.meshes = data.meshes.iter().chain(&house.meshes).cloned().collect();
        for found in &house.materials {
            let mut own = found.clone();
            own.name = format!("{kind} {}", own.name);
            own.texture = own.texture.map(|id| TextureId(id.0 + texture));
            data.materials.push(own);
        }
        data.sky = data.sky.or(house.sky);
        Shared {
            house,
            mesh,
            material,
        }
    }

    /// Adds a copy of a house.
    fn add(&mut self, shared: &Shared, offset: Vec3) {
        let (house, data, copy) = (&shared.house, &mut self.data, self.houses);
        let named = |name: &str| format!("{copy} {name}");
        let materials = |all: &[MaterialId]| {
            all.iter()
                .map(|id| MaterialId(id.0 + shared.material))
                .collect::<Vec<_>>()
        };
        let (room, object, part) = (
            data.rooms.len() as u32,
            data.objects.len() as u32,
            data.parts.len() as u32,
        );
        let moved = |bounds: Aabb| Aabb::new(bounds.min + offset, bounds.max + offset);
        let on_floor = Vec2::new(offset.x, offset.z);
        for found in &house.rooms {
            let mut own = found.clone();
            own.name = named(&own.name);
            own.level = LevelId(0);
            own.bounds = moved(own.bounds);
            for corner in own.footprint.iter_mut().flatten() {
                *corner += on_floor;
            }
            data.rooms.push(own);
        }
        for found in &house.structure {
            // Walls are in world space.
            let mut mesh = (*house.meshes[found.mesh]).clone();
            mesh.positions.iter_mut().for_each(|p| *p += offset);
            self.triangles += mesh.triangles.len();
            let mut own = found.clone();
            own.name = named(&own.name);
            own.room = own.room.map(|id| RoomId(id.0 + room));
            own.level = LevelId(0);
            own.mesh = data.meshes.push(Arc::new(mesh));
            own.materials = materials(&own.materials);
            data.structure.push(own);
        }
        for found in &house.objects {
            let mut own = found.clone();
            own.name = named(&own.name);
            own.level = LevelId(0);
            own.room = own.room.map(|id| RoomId(id.0 + room));
            own.first_part = PartId(own.first_part.0 + part);
            data.objects.push(own);
        }
        for found in &house.parts {
            let mut own = found.clone();
            self.triangles += house.meshes[own.mesh].triangles.len();
            own.object = ObjectId(own.object.0 + object);
            own.world_from_part.position += offset;
            own.mesh = MeshId(own.mesh.0 + shared.mesh);
            own.materials = materials(&own.materials);
            // Nothing touches anything here.
            own.colliders = Vec::new();
            data.parts.push(own);
        }
        for found in &house.lights {
            let mut own = found.clone();
            own.object = ObjectId(own.object.0 + object);
            own.part = PartId(own.part.0 + part);
            data.lights.push(own);
        }
        self.houses += 1;
    }
}

/// A town ready to be looked at.
struct World {
    triangles: usize,
    scene: RayScene,
    state: State,
    renderer: CpuRenderer,
    views: Vec<View>,
    frames: Vec<Frame>,
}

impl World {
    /// Builds it, and tells what that takes.
    fn new(triangles: usize) -> Self {
        let town = Town::new(triangles);
        let (count, houses) = (town.triangles, town.houses);
        let house = Arc::new(House::new(town.data).unwrap());
        let before = (Instant::now(), in_use_mib());
        let fixed = house.geometry().static_triangles.len();
        let movable = house.geometry().movable.len();
        let trees = (before.0.elapsed().as_secs_f64(), in_use_mib());
        let renderer = CpuRenderer::new(&house);
        let tables = (before.0.elapsed().as_secs_f64(), in_use_mib());
        let (scene, state) = (RayScene::new(house.clone()), State::new(&house));
        println!(
            "{count} triangles in {houses} houses of {} rooms: {fixed} never move, the rest are {movable} parts\n  \
             trees {:.2} s, {:.0} MiB; textures and tables of triangles {:.2} s, {:.0} MiB; a world {:.1} ms, {:.2} MiB",
            house.rooms.len(),
            trees.0,
            trees.1 - before.1,
            tables.0 - trees.0,
            tables.1 - trees.1,
            (before.0.elapsed().as_secs_f64() - tables.0) * 1e3,
            in_use_mib() - tables.1
        );
        let camera = Camera::from_fov(128, 128, 90.0).unwrap();
        let views: Vec<View> = (0..VIEWS)
            .map(|k| {
                let mut stream = RandomKey::root(3).child(k as u64).stream();
                // Rooms of all houses alike; somewhere on their floors, at the height of a head.
                let room = &house.rooms[RoomId((k * house.rooms.len() / VIEWS) as u32)];
                let [a, b, c] = room.footprint[stream.below(room.footprint.len())];
                let (s, t) = (stream.range(0.2, 0.4), stream.range(0.2, 0.4));
                let at = a + (b - a) * s + (c - a) * t;
                let eye = Vec3::new(at.x, room.floor_y + 1.4, at.y);
                let yaw = stream.range(0.0, std::f32::consts::TAU);
                View::new(camera, Pose::from_position_yaw(eye, yaw))
            })
            .collect();
        let frame = |view: &View| Frame::new(&view.camera, ImageChannels::default());
        Self {
            triangles: count,
            scene,
            state,
            renderer,
            frames: views.iter().map(frame).collect(),
            views,
        }
    }

    /// Renders all views, so many in a call; returns seconds of a processor.
    fn render(&mut self, preset: Preset, at_once: usize) -> f64 {
        let views = self.views.iter().map(|view| View { preset, ..*view });
        let views: Vec<View> = views.collect();
        let mut targets: Vec<FrameMut<'_>> = self.frames.iter_mut().map(Frame::as_mut).collect();
        let before = processor_s();
        for (views, frames) in views.chunks(at_once).zip(targets.chunks_mut(at_once)) {
            let (scene, state) = (&self.scene, &self.state);
            self.renderer
                .render(scene, state, views, frames, Threads::ONE)
                .unwrap();
        }
        processor_s() - before
    }
}

fn main() {
    let is_bench = std::env::args().any(|argument| argument == "--bench");
    let (sizes, rounds) = if is_bench {
        (&SIZES[..], ROUNDS)
    } else {
        (&SIZES[..1], 1)
    };
    let mut worlds: Vec<World> = sizes.iter().map(|size| World::new(*size)).collect();
    // The light of a world is made once a call.
    for (preset, at_once) in [
        (Preset::Flat, VIEWS),
        (Preset::Lit, VIEWS),
        (Preset::Lit, 1),
    ] {
        // In turns, so that what else the machine does meets all alike.
        let mut seconds = vec![0.0; worlds.len()];
        for world in &mut worlds {
            world.render(preset, at_once);
        }
        for _ in 0..rounds {
            for (world, sum) in worlds.iter_mut().zip(&mut seconds) {
                *sum += world.render(preset, at_once);
            }
        }
        for (world, sum) in worlds.iter().zip(&seconds) {
            println!(
                "{}, {at_once} in a call: {} triangles, {:.0} views a second and core, {:.2} of the smallest house's",
                preset.name(),
                world.triangles,
                (VIEWS * rounds) as f64 / sum.max(0.01),
                seconds[0] / sum.max(0.01)
            );
        }
    }
}
