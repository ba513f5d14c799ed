//! Batches that are too large for an adapter's buffers or calls are cut, and show what they show whole.

use super::agreement::{Pair, gpu};
use super::houses::tests_all;
use crate::common::{Builder, look};
use dwell_render::{
    BatchLimits, Camera, Frame, Gpu, GpuRenderer, ImageChannels, Preset, Projection, RenderJob,
    View, VisibilityPath,
};
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use dwell_scene::{Mesh, Pose, ShoeboxMaterials, State};
use glam::Vec3;

/// A room with forty boxes that move.
fn boxes(path: VisibilityPath) -> Option<Pair> {
    let room = dwell_scene::House::shoebox([6.0, 3.0, 6.0], &ShoeboxMaterials::default()).unwrap();
    let mut builder = Builder::from(&room);
    for k in 0..40 {
        let mesh = Mesh::cuboid(Vec3::ZERO, Vec3::new(0.3, 0.05 * k as f32 + 0.1, 0.2));
        let place = Vec3::new(0.5 * (k % 10) as f32 + 0.5, 0.0, (k / 10) as f32 + 1.0);
        let place = Pose::from_position(place);
        builder.add(
            &format!("box {k}"),
            mesh,
            Builder::plaster(&format!("box {k}")),
            true,
            place,
        );
    }
    Pair::new(builder.build().house, path)
}

const EYE: Vec3 = Vec3::new(5.5, 2.5, 5.5);

fn view(camera: Camera, k: usize) -> View {
    let target = Vec3::new(0.04 * k as f32, 0.3, 1.0);
    View {
        preset: [Preset::Flat, Preset::Lit][k % 2],
        ..look(camera, EYE, target)
    }
}

fn fisheye(f: f32) -> Camera {
    let projection = Projection::Fisheye {
        fx: f,
        fy: f,
        cx: 12.0,
        cy: 12.0,
        k1: 0.01,
        k2: 0.0,
        k3: 0.0,
        k4: 0.0,
        half_angle_deg: 90.0,
    };
    Camera::new(24, 24, projection).unwrap()
}

/// A batch that is too large: its name, its views, the rows that each wants, whether each is of a world of its own, and the
/// limits.
struct Case {
    what: &'static str,
    views: Vec<View>,
    rows: Option<(u32, u32)>,
    are_worlds_apart: bool,
    most: BatchLimits,
}

/// More than the largest table of the room takes (the corners, with those of a person's pieces), and less than what grows.
const BYTES: u64 = 400 << 10;
/// Views of a batch, and worlds.
const VIEWS: usize = 100;

fn cases() -> Vec<Case> {
    let pinhole = |edge: u32| Camera::from_fov(edge, edge, 80.0).unwrap();
    let bytes = BatchLimits {
        buffer_bytes: BYTES,
        ..BatchLimits::NONE
    };
    vec![
        Case {
            what: "images and first hits",
            views: (0..VIEWS).map(|k| view(pinhole(16), k)).collect(),
            rows: None,
            are_worlds_apart: false,
            most: bytes,
        },
        Case {
            what: "rows of worlds",
            views: (0..VIEWS).map(|k| view(pinhole(2), k)).collect(),
            rows: None,
            are_worlds_apart: true,
            most: bytes,
        },
        Case {
            what: "rays of lenses",
            views: (0..VIEWS)
                .map(|k| view(fisheye(8.0 + 0.04 * k as f32), k))
                .collect(),
            rows: Some((11, 12)),
            are_worlds_apart: false,
            most: bytes,
        },
        Case {
            what: "groups of a call",
            views: (0..VIEWS).map(|k| view(pinhole(16), k)).collect(),
            rows: None,
            are_worlds_apart: false,
            most: BatchLimits {
                groups: 12,
                ..BatchLimits::NONE
            },
        },
    ]
}

/// The images of a case by a renderer, and into how many submissions its batch was cut.
fn taken(
    pair: &Pair,
    worlds: &[(RayScene, State)],
    case: &Case,
    by: &GpuRenderer,
) -> (Vec<Frame>, usize) {
    let frame = |view: &View| {
        let camera = &view.camera;
        let mut whole = Frame::new(camera, ImageChannels::ALL);
        if let Some((first, end)) = case.rows {
            let pixels = ((end - first) * camera.width()) as usize;
            whole.rgb.truncate(pixels * 3);
            whole.depth.truncate(pixels);
            whole.instance.truncate(pixels);
            whole.semantic.truncate(pixels);
            whole.normals.truncate(pixels * 3);
            whole.albedo.truncate(pixels * 3);
            whole.flow.truncate(pixels * 2);
        }
        whole
    };
    let mut frames: Vec<Frame> = case.views.iter().map(frame).collect();
    let jobs: Vec<RenderJob<'_>> = case
        .views
        .iter()
        .zip(&mut frames)
        .enumerate()
        .map(|(k, (view, frame))| {
            let world = if case.are_worlds_apart { k } else { 0 };
            let (scene, state) = worlds.get(world).unwrap_or(&worlds[0]);
            RenderJob {
                rows: case.rows,
                ..RenderJob::new(scene, state, *view, frame.as_mut())
            }
        })
        .collect();
    let submitted = by.submit(&jobs, Threads::ONE).unwrap();
    drop(jobs);
    let parts = submitted.submission_count();
    let mut into: Vec<_> = frames.iter_mut().map(Frame::as_mut).collect();
    by.collect(submitted, &mut into, Threads::ONE).unwrap();
    drop(into);
    assert_eq!(pair.house.rooms.len(), 1);
    (frames, parts)
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn a_batch_too_large_for_any_buffer_is_cut_and_shows_the_same() {
    let Some(shared) = gpu() else { return };
    for path in VisibilityPath::ALL {
        let Some(pair) = boxes(path) else { return };
        let worlds: Vec<(RayScene, State)> = (0..VIEWS)
            .map(|k| {
                let mut state = pair.state.clone();
                for pose in &mut state.part_pose {
                    pose.position.y += 0.004 * k as f32;
                }
                let mut scene = RayScene::new(pair.house.clone());
                scene.update(&state);
                (scene, state)
            })
            .collect();
        for (k, case) in cases().into_iter().enumerate() {
            // Each renderer compiles its shaders: every case by one path, with `DWELL_TEST_ALL=1` by both.
            if !tests_all() && VisibilityPath::ALL[k % 2] != path {
                continue;
            }
            let small = Gpu::open_adapter(shared.adapter(), case.most).unwrap();
            let small = GpuRenderer::new(small, pair.cpu.clone(), path).unwrap();
            let (whole, one) = taken(&pair, &worlds, &case, &pair.gpu);
            assert_eq!(one, 1);
            // Twice: what earlier batches left is in no one's way.
            for _ in 0..2 {
                let (cut, parts) = taken(&pair, &worlds, &case, &small);
                println!("{}, {}: {parts} parts", case.what, path.name());
                assert!((2..20).contains(&parts), "{}: {parts}", case.what);
                assert!(cut == whole, "{}", case.what);
            }
        }
    }
}

#[test]
fn a_view_too_large_for_a_buffer_is_refused_by_name() {
    let Some(shared) = gpu() else { return };
    let Some(pair) = boxes(VisibilityPath::Compute) else {
        return;
    };
    let most = BatchLimits {
        buffer_bytes: BYTES,
        ..BatchLimits::NONE
    };
    let small = Gpu::open_adapter(shared.adapter(), most).unwrap();
    let small = GpuRenderer::new(small, pair.cpu.clone(), VisibilityPath::Compute).unwrap();
    let view = view(Camera::from_fov(256, 256, 80.0).unwrap(), 0);
    let mut frame = Frame::new(&view.camera, ImageChannels::default());
    let job = RenderJob::new(&pair.scene, &pair.state, view, frame.as_mut());
    let error = small.render_batch(&mut [job], Threads::ONE).unwrap_err();
    let error = error.to_string();
    assert!(
        error.contains("first hits") && error.contains(&BYTES.to_string()),
        "{error}"
    );
}
