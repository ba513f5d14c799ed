//! Doll's house views: a storey from outside and above, without the part over a cut.

use super::section_view::CutawayView;
use super::{StoreyMap, floor_y};
use crate::camera::{Camera, Projection};
use crate::cpu::CpuRenderer;
use crate::error::RenderError;
use crate::frame::View;
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use dwell_scene::{Aabb, House, LevelId, Pose, State, space};
use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// Free space around the storey, as a share of the image's width.
const BORDER: f32 = 0.02;
/// Largest thickness of outer walls, m.
const WALL_M: f32 = 0.4;
/// Distance of the eye, in diagonals of the house: perspective shows, and sizes can still be compared.
const DIAGONALS: f32 = 2.2;
/// Depth below its floor to which a storey extends, m: slabs and steps.
const SLAB_M: f32 = 0.35;
/// Edge of the pixels by which walls are found at the cut, m.
const PLAN_PIXEL_M: f32 = 0.015;

/// The view of a doll's house.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DollhouseConfig {
    /// Pixels across, 1 to 16,384; as many down as are needed.
    pub width: u32,
    /// Heading of the view, to the left of -Z, degrees.
    pub yaw_deg: f32,
    /// Pitch of the view downwards, 20 to 90 degrees.
    pub down_deg: f32,
    /// Height of the cut over the floor, m, 0.3 to 10.
    pub cut_m: f32,
}

impl Default for DollhouseConfig {
    fn default() -> Self {
        Self {
            width: 1000,
            yaw_deg: 25.0,
            down_deg: 52.0,
            cut_m: 1.6,
        }
    }
}

impl DollhouseConfig {
    fn check(&self) -> Result<(), RenderError> {
        for (field, found, low, high, allowed) in [
            (
                "yaw_deg",
                self.yaw_deg,
                -3600.0,
                3600.0,
                "-3600 to 3600 degrees",
            ),
            ("down_deg", self.down_deg, 20.0, 90.0, "20 to 90 degrees"),
            ("cut_m", self.cut_m, 0.3, 10.0, "0.3 to 10 m"),
        ] {
            if !(low..=high).contains(&found) {
                return Err(RenderError::Camera {
                    field,
                    found: found.to_string(),
                    allowed,
                });
            }
        }
        Ok(())
    }
}

/// A storey from outside and above, cut open; storeys of one house are seen from the same place above them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dollhouse {
    /// Camera and pose. [`Self::render`] leaves out the part over the cut.
    pub view: View,
    /// Height of the cut, m.
    pub cut_y: f32,
    floor_y: f32,
    plan: StoreyMap,
}

impl Dollhouse {
    /// The view of a storey.
    ///
    /// # Errors
    /// [`RenderError::Level`] for a storey that the house does not have; [`RenderError::Camera`] for a number out of range.
    pub fn new(
        house: &House,
        level: LevelId,
        config: &DollhouseConfig,
    ) -> Result<Self, RenderError> {
        config.check()?;
        let mut plan = StoreyMap::new(house, level, 1)?;
        let floor_y = floor_y(house, level);
        let cut_y = floor_y + config.cut_m;
        let size = plan.size_m();
        let edge = (size.max_element() / PLAN_PIXEL_M).clamp(64.0, 8192.0);
        plan = StoreyMap::new(house, level, edge as u32)?;
        plan.cut_y = cut_y;
        let bounds = footprint(house, floor_y, cut_y);
        let (yaw_rad, down_rad) = (config.yaw_deg.to_radians(), config.down_deg.to_radians());
        let rotation = space::rotation_from_yaw_pitch(yaw_rad, -down_rad);
        let distance_m = DIAGONALS * bounds.size().length();
        let world_from_camera = Pose::new(
            bounds.center() - rotation * Vec3::NEG_Z * distance_m,
            rotation,
        );
        let camera_from_world = world_from_camera.inverse();
        // The corners in the plane one metre ahead tell what the image must hold.
        let corners = bounds.corners().map(|corner| {
            let p = camera_from_world.transform_point(corner);
            Vec2::new(p.x / -p.z, p.y / p.z)
        });
        let low = corners.into_iter().fold(Vec2::MAX, Vec2::min);
        let high = corners.into_iter().fold(Vec2::MIN, Vec2::max);
        let width = config.width as f32;
        let border = BORDER * width;
        let f = (width - 2.0 * border) / (high.x - low.x);
        let height = ((high.y - low.y) * f + 2.0 * border).ceil().max(1.0);
        let projection = Projection::Pinhole {
            fx: f,
            fy: f,
            cx: border - low.x * f,
            cy: border - low.y * f,
        };
        let camera = Camera::new(config.width, height as u32, projection)?
            .with_range(0.0, 2.0 * distance_m + 10.0)?;
        Ok(Self {
            view: View::new(camera, world_from_camera),
            cut_y,
            floor_y: floor_y - SLAB_M,
            plan,
        })
    }

    /// The camera of the map on which walls at the cut are found; [`Self::render`] draws them as a picture of its size.
    pub fn plan_camera(&self) -> &Camera {
        &self.plan.view.camera
    }

    /// The picture, walls dark where they are cut, paper where nothing is. Shape (height, width, 3) of [`Self::view`]'s camera.
    ///
    /// # Errors
    /// [`RenderError::OtherHouse`] for a scene over another house than the renderer's.
    pub fn render(
        &self,
        renderer: &CpuRenderer,
        scene: &RayScene,
        state: &State,
        threads: Threads,
    ) -> Result<Vec<u8>, RenderError> {
        let cut = CutawayView {
            view: self.view,
            level_y: self.cut_y,
            floor_y: self.floor_y,
            plan: &self.plan,
        };
        cut.render(renderer, scene, state, threads)
    }
}

/// Around all rooms of a house as seen from above, between two heights.
fn footprint(house: &House, low_y: f32, high_y: f32) -> Aabb {
    let corners = house
        .rooms
        .iter()
        .flat_map(|room| room.footprint.iter().flatten());
    let mut bounds = Aabb::from_points(corners.map(|p| Vec3::new(p.x, low_y, p.y)));
    if bounds.is_empty() {
        let levels = house.levels.iter();
        bounds = levels.fold(Aabb::EMPTY, |all, level| all.union(&level.bounds));
    }
    let wall = Vec3::new(WALL_M, 0.0, WALL_M);
    Aabb::new(
        bounds.min.with_y(low_y) - wall,
        bounds.max.with_y(high_y) + wall,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::ShoeboxMaterials;
    use std::sync::Arc;

    fn pictured(config: &DollhouseConfig) -> (Dollhouse, Vec<u8>) {
        let house = House::shoebox([8.0, 3.0, 4.0], &ShoeboxMaterials::default()).unwrap();
        let house = Arc::new(house);
        let (scene, state) = (RayScene::new(house.clone()), State::new(&house));
        let doll = Dollhouse::new(&house, LevelId(0), config).unwrap();
        let renderer = CpuRenderer::new(&house);
        let rgb = doll
            .render(&renderer, &scene, &state, Threads::ONE)
            .unwrap();
        (doll, rgb)
    }

    /// From outside one looks over the cut walls onto the floor; the ceiling is not in the way.
    #[test]
    fn one_sees_the_floor_of_a_closed_room_from_outside() {
        let (doll, rgb) = pictured(&DollhouseConfig {
            width: 300,
            ..DollhouseConfig::default()
        });
        let camera = &doll.view.camera;
        assert_eq!(rgb.len(), camera.pixels() * 3);
        let from_world = doll.view.world_from_camera.inverse();
        let color = |point: Vec3| {
            let (image, _) = camera.project(from_world.transform_point(point)).unwrap();
            let k = image.y as usize * camera.width() as usize + image.x as usize;
            [rgb[k * 3], rgb[k * 3 + 1], rgb[k * 3 + 2]]
        };
        // Two places of the floor, which a ceiling would hide, are as bright as each other.
        let floor = color(Vec3::new(4.0, 0.0, 1.5));
        assert_eq!(floor, color(Vec3::new(6.0, 0.0, 1.5)));
        assert!(floor != [250, 249, 246] && floor != walls_srgb());
        // Walls are dark at the cut and nowhere else.
        assert_eq!(color(Vec3::new(0.0, doll.cut_y, 2.0)), walls_srgb());
        assert_eq!(color(Vec3::new(4.0, doll.cut_y, 0.0)), walls_srgb());
        assert_eq!(&rgb[..3], [250, 249, 246], "nothing is outside");
        let dark = rgb
            .chunks_exact(3)
            .filter(|rgb| *rgb == walls_srgb())
            .count();
        assert!(dark * 10 < camera.pixels(), "{dark}");
    }

    fn walls_srgb() -> [u8; 3] {
        crate::map::walls::SRGB
    }

    #[test]
    fn numbers_out_of_range_are_named() {
        let house = House::shoebox([8.0, 3.0, 4.0], &ShoeboxMaterials::default()).unwrap();
        let level = DollhouseConfig {
            down_deg: 5.0,
            ..DollhouseConfig::default()
        };
        let message = Dollhouse::new(&house, LevelId(0), &level)
            .unwrap_err()
            .to_string();
        assert_eq!(
            message,
            "camera: down_deg is 5; allowed is 20 to 90 degrees"
        );
    }
}
