//! Growth of cost with the number of things: words, a plan's edits and resets, at 100, 1,000 and 10,000 things of twelve kinds
//! of the catalogue, spread over a floor, or in a heap, all at one place.
//!
//! `cargo bench --profile dev -p dwell-benches --bench growth_words -- spread heap 10000`: shapes, or parts of their rows' names, and
//! the largest number; without `--bench` the smallest alone, once. A row that took longer than 20 s is not tried with more things.

#![expect(clippy::unwrap_used, reason = "a bench may stop at the first surprise")]
#![expect(clippy::print_stdout, reason = "a program tells by printing")]

use dwell::{Engines, Env, EnvConfig};
use dwell_houses::authoring::{FileAccess, HousePlan, build, edit, edits_from_json};
use dwell_scene::interrupt;
use dwell_scene::{Aabb, AgentStart, House, HouseData, Id, JointId, ObjectId, PartId, Pose, State};
use dwell_semantics::check::Addressee;
use dwell_semantics::graph::scene_graph;
use dwell_semantics::instruct::{InstructionKind, candidates};
use dwell_semantics::{Semantics, Viewer, describe};
use glam::Vec3;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

const SIZES: [usize; 3] = [100, 1_000, 10_000];
/// A row that took longer is not tried with more things.
const LONGEST_S: f64 = 20.0;
/// Time after which a row is stopped.
const STOP_S: f64 = 150.0;
const KINDS: [&str; 12] = [
    "desk",
    "mug",
    "dining_chair",
    "bowl",
    "book",
    "table_lamp",
    "bookshelf",
    "vase",
    "plate",
    "armchair",
    "plant",
    "laptop",
];
/// A thing has so much floor where things are spread, m.
const APART_M: f32 = 1.5;

/// The arrangement of things.
#[derive(Clone, Copy, PartialEq)]
enum Shape {
    Spread,
    Heap,
}

impl Shape {
    const ALL: [Self; 2] = [Self::Spread, Self::Heap];

    fn name(self) -> &'static str {
        match self {
            Self::Spread => "spread",
            Self::Heap => "heap",
        }
    }

    /// Edge of the floor, m.
    fn edge_m(self, count: usize) -> f32 {
        match self {
            Self::Spread => (count as f32).sqrt().ceil() * APART_M + 2.0,
            Self::Heap => 8.0,
        }
    }

    /// Returns where thing `k` goes.
    fn place(self, k: usize, count: usize) -> Vec3 {
        let across = (count as f32).sqrt().ceil() as usize;
        match self {
            Self::Spread => Vec3::new(
                1.5 + (k % across) as f32 * APART_M,
                0.0,
                1.5 + (k / across) as f32 * APART_M,
            ),
            Self::Heap => Vec3::new(6.0, 0.0, 6.0),
        }
    }
}

/// A floor with walls, and one thing of each kind.
fn floor(edge_m: f32) -> Option<House> {
    let add = |(k, kind): (usize, &&str)| {
        let x = 0.8 + 0.5 * k as f32;
        format!(
            r#"{{"add": {{"what": {{"catalogue": {{"kind": "{kind}", "seed": {k}}}}}, "name": "{kind}", "place": {{"at": [{x}, 0, 1]}}}}}}"#
        )
    };
    let adds: Vec<String> = KINDS.iter().enumerate().map(add).collect();
    let adds = adds.join(",");
    let plan = format!(
        r#"{{"name": "floor", "building": {{"storeys": [{{"rooms": [{{"name": "hall", "outline": [[0, 0], [{edge_m}, 0], [{edge_m}, {edge_m}], [0, {edge_m}]]}}]}}]}}, "edits": [{adds}]}}"#
    );
    let plan: HousePlan = serde_json::from_str(&plan).unwrap();
    match build(&plan, &FileAccess::Anywhere) {
        Ok((house, _)) => Some(house),
        Err(error) => {
            println!("{error}");
            None
        }
    }
}

/// So many things.
fn house(shape: Shape, count: usize) -> Option<House> {
    let base = floor(shape.edge_m(count))?;
    let mut data = base.data().clone();
    data.agent_starts = vec![AgentStart {
        position: Vec3::new(1.0, 0.0, 2.5),
        yaw_rad: 0.0,
    }];
    for k in base.objects.len()..count {
        copy(&mut data, &base, k, shape.place(k, count));
    }
    for level in &mut data.levels {
        level.bounds = Aabb::new(Vec3::splat(-1e3), Vec3::splat(1e3));
    }
    Some(House::new(data).unwrap())
}

/// One more of the kinds of `base`, with its foot at `place`.
fn copy(data: &mut HouseData, base: &House, k: usize, place: Vec3) {
    let id = ObjectId::from_index(k % base.objects.len());
    let bounds = base.object_bounds(&State::new(base), id);
    let by = place - bounds.center().with_y(bounds.min.y);
    let new = ObjectId::from_index(data.objects.len());
    let first = PartId::from_index(data.parts.len());
    let mut object = base.objects[id].clone();
    let part_of = |part: PartId| PartId(part.0 - object.first_part.0 + first.0);
    for part in object.parts() {
        let mut part = base.parts[part].clone();
        part.object = new;
        part.world_from_part = Pose::new(by, glam::Quat::IDENTITY) * part.world_from_part;
        data.parts.push(part);
    }
    let joints: Vec<JointId> = base.joints_of(id).collect();
    for joint in &joints {
        let mut joint = base.joints[*joint].clone();
        joint.object = new;
        joint.child = part_of(joint.child);
        joint.mimic = None;
        match joint.parent {
            Some(parent) => joint.parent = Some(part_of(parent)),
            None => {
                joint.parent_from_joint =
                    Pose::new(by, glam::Quat::IDENTITY) * joint.parent_from_joint;
            }
        }
        data.joints.push(joint);
    }
    for space in base.receptacles.iter().filter(|space| space.object == id) {
        let mut space = space.clone();
        (space.object, space.part) = (new, part_of(space.part));
        data.receptacles.push(space);
    }
    object.name = format!("{} {k}", object.name);
    object.source_id.clone_from(&object.name);
    object.first_part = first;
    data.objects.push(object);
}

/// A plan's edits: so many desks.
fn adds(shape: Shape, count: usize) -> String {
    let add = |k: usize| {
        let (at, seed) = (shape.place(k, count), k % 4);
        format!(
            r#"{{"add": {{"what": {{"catalogue": {{"kind": "desk", "seed": {seed}}}}}, "place": {{"at": [{}, 0, {}]}}}}}}"#,
            at.x, at.z
        )
    };
    let all: Vec<String> = (0..count).map(add).collect();
    format!("[{}]", all.join(","))
}

static LATE: AtomicBool = AtomicBool::new(false);

/// Seconds that `work` took; `None` when it was stopped.
fn timed<R>(work: impl FnOnce() -> R) -> (f64, Option<R>) {
    LATE.store(false, Ordering::Relaxed);
    let done = Arc::new(AtomicBool::new(false));
    let watch = done.clone();
    let begun = Instant::now();
    let watcher = std::thread::spawn(move || {
        while !watch.load(Ordering::Relaxed) {
            if begun.elapsed().as_secs_f64() > STOP_S {
                LATE.store(true, Ordering::Relaxed);
            }
            std::thread::sleep(Duration::from_millis(5));
        }
    });
    let result = interrupt::interruptible(|| LATE.load(Ordering::Relaxed), work).ok();
    let seconds = begun.elapsed().as_secs_f64();
    done.store(true, Ordering::Relaxed);
    watcher.join().unwrap();
    (seconds, result)
}

struct Rows {
    wanted: Vec<String>,
    /// Rows that took too long with fewer things.
    slow: Vec<String>,
}

impl Rows {
    fn row<R>(
        &mut self,
        shape: Shape,
        count: usize,
        name: &str,
        work: impl FnOnce() -> R,
    ) -> Option<R> {
        let full = format!("{} {name}", shape.name());
        let wanted =
            self.wanted.is_empty() || self.wanted.iter().any(|w| full.contains(w.as_str()));
        if !wanted || self.slow.contains(&full) {
            return None;
        }
        let (seconds, result) = timed(work);
        let end = if result.is_some() { "" } else { ", stopped" };
        println!("{full:>30} {count:>6} {seconds:>9.3} s{end}");
        if seconds > LONGEST_S {
            self.slow.push(full);
        }
        result
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let is_bench = arguments.iter().any(|argument| argument == "--bench");
    let most = arguments.iter().find_map(|argument| argument.parse().ok());
    let most = most.unwrap_or(if is_bench { SIZES[2] } else { SIZES[0] });
    let words = arguments
        .into_iter()
        .filter(|a| a.parse::<usize>().is_err() && !a.starts_with("--"));
    let mut rows = Rows {
        wanted: words.collect(),
        slow: Vec::new(),
    };
    for shape in Shape::ALL {
        for count in SIZES.into_iter().filter(|count| *count <= most) {
            measure(&mut rows, shape, count);
        }
    }
}

fn measure(rows: &mut Rows, shape: Shape, count: usize) {
    let Some(house) = house(shape, count) else {
        return;
    };
    let house = Arc::new(house);
    words(rows, shape, &house);
    resets(rows, shape, &house);
    plans(rows, shape, &house);
}

/// Measures the cost of sentences about things.
fn words(rows: &mut Rows, shape: Shape, house: &Arc<House>) {
    let count = house.objects.len();
    let semantics = Semantics::new(house);
    let state = State::new(house);
    rows.row(shape, count, "facts", || Semantics::new(house));
    rows.row(shape, count, "house", || {
        describe::describe_house(&semantics.scene(&state), describe::TextOptions::default())
    });
    rows.row(shape, count, "object", || {
        describe::captions(&semantics.scene(&state), describe::TextOptions::default())
    });
    rows.row(shape, count, "graph", || {
        scene_graph(&semantics.scene(&state), None)
    });
    let viewer = Viewer {
        world_from_camera: Pose::from_position_yaw(Vec3::new(1.0, 1.5, 2.0), -2.4),
    };
    rows.row(shape, count, "graph of a view", || {
        scene_graph(&semantics.scene(&state), Some(&viewer))
    });
    rows.row(shape, count, "view", || {
        let listener = Addressee {
            viewer: Some(viewer),
            agent: None,
        };
        describe::describe_view(
            &semantics.scene(&state),
            listener,
            describe::TextOptions::default(),
        )
    });
    rows.row(shape, count, "instructions", || {
        let scene = semantics.scene(&state);
        InstructionKind::ALL.map(|kind| candidates(&scene, kind).len())
    });
}

/// A world without sensors, and the first episode in it, with the grid to walk on.
fn resets(rows: &mut Rows, shape: Shape, house: &Arc<House>) {
    let count = house.objects.len();
    for task in ["Free", "InstructionFollowing"] {
        let mut config = EnvConfig {
            task: task.to_owned(),
            sensors: Some(Vec::new()),
            ..EnvConfig::default()
        };
        config.world.settle_s = Some(0.0);
        let made = rows.row(shape, count, &format!("world, reset {task}"), || {
            let engines = Engines::new(house.clone());
            engines.semantics();
            Env::new(engines, &config)
        });
        if let Some(Ok(mut env)) = made {
            rows.row(shape, count, &format!("reset {task}"), || env.reset(1));
        }
    }
}

/// As many edits as there are things.
fn plans(rows: &mut Rows, shape: Shape, house: &House) {
    let count = house.objects.len();
    let Some(base) = floor(shape.edge_m(count)) else {
        return;
    };
    let of_all = |edit: &dyn Fn(&str) -> String| {
        let all: Vec<String> = house.objects.iter().map(|o| edit(&o.name)).collect();
        format!("[{}]", all.join(","))
    };
    let moved = |name: &str| format!(r#"{{"move": {{"object": "{name}", "by": [0.01, 0, 0]}}}}"#);
    let removed = |name: &str| format!(r#"{{"remove": {{"object": "{name}"}}}}"#);
    for (name, house, edits) in [
        ("plan adds", &base, adds(shape, count)),
        ("plan moves", house, of_all(&moved)),
        ("plan removes", house, of_all(&removed)),
    ] {
        let edits = edits_from_json(&edits).unwrap();
        rows.row(shape, count, name, || {
            let done = edit(house, &edits, &FileAccess::Anywhere);
            if let Err(error) = &done {
                println!("{error}");
            }
            done.ok()
        });
    }
}
