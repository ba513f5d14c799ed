//! A sheet of generated houses, each from above without its ceiling and from inside.
//!
//! `cargo run -p dwell-tests --example contact_sheet -- docs/images/generated-houses.jpg seed:0..24`: file, HOUSE strings.

#![expect(clippy::print_stdout, reason = "a program tells by printing")]

use dwell_render::{Camera, CpuRenderer, Frame, ImageChannels, Preset, View};
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use dwell_scene::{House, Pose, Room, State};
use glam::{Quat, Vec3};
use image::{RgbImage, imageops};
use std::error::Error;
use std::f32::consts::FRAC_PI_2;
use std::sync::Arc;

/// Houses in a row.
const COLUMNS: u32 = 6;
/// Of each picture.
const WIDTH_PX: u32 = 256;
const HEIGHT_PX: u32 = 192;
/// Pictures are drawn this much larger and then made smaller.
const FINER: u32 = 2;
/// Height over the floor at which the view from above is cut, m.
const CUT_M: f32 = 2.2;
const EYE_M: f32 = 1.55;

type Found<T> = Result<T, Box<dyn Error>>;

/// A house that can be drawn.
struct Stage {
    house: Arc<House>,
    scene: RayScene,
    state: State,
    renderer: CpuRenderer,
}

impl Stage {
    fn new(house: House) -> Self {
        let house = Arc::new(house);
        Self {
            scene: RayScene::new(house.clone()),
            state: State::new(&house),
            renderer: CpuRenderer::new(&house),
            house,
        }
    }

    fn draw(&self, camera: Camera, pose: Pose) -> Found<Frame> {
        let view = View {
            preset: Preset::Lit,
            ..View::new(camera, pose)
        };
        let mut frame = Frame::new(&camera, ImageChannels::default());
        let mut targets = [frame.as_mut()];
        let threads = Threads::default();
        self.renderer
            .render(&self.scene, &self.state, &[view], &mut targets, threads)?;
        Ok(frame)
    }

    fn picture(&self, camera: Camera, pose: Pose) -> Found<RgbImage> {
        let frame = self.draw(camera, pose)?;
        let image = RgbImage::from_raw(camera.width(), camera.height(), frame.rgb)
            .ok_or("an image of another size")?;
        let filter = imageops::FilterType::Triangle;
        Ok(imageops::resize(&image, WIDTH_PX, HEIGHT_PX, filter))
    }

    /// The ground floor from above.
    fn view_above(&self) -> Found<RgbImage> {
        let level = self.house.levels.iter().next().ok_or("no storey")?;
        let (size, middle) = (level.bounds.size(), level.bounds.center());
        let aspect = WIDTH_PX as f32 / HEIGHT_PX as f32;
        // The longer side lies across the picture.
        let turned = size.z > size.x;
        let (across, along) = if turned {
            (size.z, size.x)
        } else {
            (size.x, size.z)
        };
        let width_m = (across + 0.6).max((along + 0.6) * aspect);
        let camera = Camera::orthographic(
            FINER * WIDTH_PX,
            FINER * HEIGHT_PX,
            width_m,
            width_m / aspect,
        )?;
        let floor = self
            .house
            .rooms
            .iter()
            .next()
            .map_or(0.0, |room| room.floor_y);
        let up = 50.0;
        let camera = camera.with_range(up - CUT_M, up + 1.0)?;
        let turn = if turned {
            Quat::from_rotation_y(FRAC_PI_2)
        } else {
            Quat::IDENTITY
        };
        let down = turn * Quat::from_rotation_x(-FRAC_PI_2);
        self.picture(camera, Pose::new(middle.with_y(floor + up), down))
    }

    /// The room where people spend the day, from the corner with the farthest view.
    fn view_inside(&self) -> Found<RgbImage> {
        let rank = |room: &Room| match room.name.split('_').next() {
            Some("living" | "studio" | "lobby") => 1000.0,
            _ => 0.0,
        } + room.area_m2();
        let room = self
            .house
            .rooms
            .iter()
            .max_by(|a, b| rank(a).total_cmp(&rank(b)));
        let room = room.ok_or("no room")?;
        let bounds = room.bounds;
        let target = bounds.center().with_y(room.floor_y + 0.9);
        let small = Camera::from_fov(48, 36, 85.0)?;
        let mut best: Option<(f32, Pose)> = None;
        for (x, z) in [
            (0.0, 0.0),
            (1.0, 0.0),
            (0.0, 1.0),
            (1.0, 1.0),
            (0.5, 0.0),
            (0.5, 1.0),
        ] {
            let inset = 0.35;
            let corner = bounds.min.lerp(bounds.max, 0.0);
            let size = bounds.size() - 2.0 * inset;
            let eye = Vec3::new(
                corner.x + inset + x * size.x,
                room.floor_y + EYE_M,
                corner.z + inset + z * size.z,
            );
            if !room.contains_xz(glam::Vec2::new(eye.x, eye.z)) {
                continue;
            }
            let to = target - eye;
            let yaw = (-to.x).atan2(-to.z);
            let pitch = to.y.atan2(to.x.hypot(to.z)).max(-0.35);
            let turn = Quat::from_rotation_y(yaw) * Quat::from_rotation_x(pitch);
            let pose = Pose::new(eye, turn);
            let depth = self.draw(small, pose)?.depth;
            let near = depth.iter().filter(|depth| **depth < 0.7).count() as f32;
            let far: f32 = depth.iter().map(|depth| depth.min(6.0)).sum();
            let score = (far - 12.0 * near) / depth.len() as f32;
            if best.is_none_or(|(most, _)| score > most) {
                best = Some((score, pose));
            }
        }
        let (_, pose) = best.ok_or("no corner")?;
        let camera = Camera::from_fov(FINER * WIDTH_PX, FINER * HEIGHT_PX, 85.0)?;
        self.picture(camera, pose)
    }
}

fn main() -> Found<()> {
    let arguments: Vec<String> = std::env::args().collect();
    let file = arguments.get(1).ok_or("the file to write")?;
    let mut houses = Vec::new();
    for house in &arguments[2..] {
        match dwell_houses::seed_range(house)? {
            Some((seeds, fields)) => {
                houses.extend(seeds.map(|seed| format!("seed:{seed}{fields}")));
            }
            None => houses.push(house.to_owned()),
        }
    }
    let count = houses.len() as u32;
    let rows = count.div_ceil(COLUMNS);
    let (wide, high) = (WIDTH_PX + 4, 2 * HEIGHT_PX + 8);
    let mut sheet =
        RgbImage::from_pixel(COLUMNS.min(count) * wide, rows * high, image::Rgb([255; 3]));
    for (k, name) in (0..count).zip(&houses) {
        let (house, report) = dwell_houses::open(name)?;
        println!("{name}: {} objects", house.objects.len());
        for warning in report.warnings() {
            println!("  {warning}");
        }
        let stage = Stage::new(house);
        let (x, y) = (i64::from(k % COLUMNS * wide), i64::from(k / COLUMNS * high));
        imageops::replace(&mut sheet, &stage.view_above()?, x, y);
        imageops::replace(
            &mut sheet,
            &stage.view_inside()?,
            x,
            y + i64::from(HEIGHT_PX),
        );
    }
    sheet.save(file)?;
    Ok(())
}
