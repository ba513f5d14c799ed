//! Maps: a storey from above, and from outside as a doll's house.

mod dollhouse;
mod section_view;
mod walls;

pub use dollhouse::{Dollhouse, DollhouseConfig};

use crate::camera::Camera;
use crate::cpu::CpuRenderer;
use crate::error::RenderError;
use crate::frame::View;
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use dwell_scene::{Aabb, House, Id, LevelId, Pose, State, space};
use glam::{Vec2, Vec3};
use section_view::CutawayView;
use std::f32::consts::FRAC_PI_2;

/// Distance of the cut below the lowest ceiling of a storey, m.
const BELOW_CEILING_M: f32 = 0.6;
/// Free space around the house, m.
const BORDER_M: f32 = 0.5;
/// A storey from above, cut open below its ceilings, -Z up in the image and +X to the right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoreyMap {
    /// The view to render; [`crate::Preset::Flat`], which is a field to set. Its depth counts from the cut.
    pub view: View,
    /// The upper left corner of the image: (x, z), m.
    pub corner: Vec2,
    /// Pixels a metre, in both directions.
    pub pixels_per_m: f32,
    /// Height of the cut, m.
    pub cut_y: f32,
}

impl StoreyMap {
    /// The map of a storey whose longer edge has `longest_edge` pixels.
    ///
    /// # Errors
    /// [`RenderError::Level`] for a storey that the house does not have; [`RenderError::Camera`] for 0 pixels or more
    /// than 16,384, or a house of more than 100 km.
    pub fn new(house: &House, level: LevelId, longest_edge: u32) -> Result<Self, RenderError> {
        let Some(storey) = house.levels.get(level) else {
            return Err(RenderError::Level {
                found: level.index(),
                count: house.levels.len(),
            });
        };
        let rooms = || house.rooms.iter().filter(|room| room.level == level);
        let footprint = rooms().flat_map(|room| room.footprint.iter().flatten());
        let mut bounds =
            Aabb::from_points(footprint.map(|p| Vec3::new(p.x, storey.bounds.min.y, p.y)));
        if bounds.is_empty() {
            bounds = storey.bounds;
        }
        let bounds = bounds.grown(BORDER_M);
        let ceiling = rooms()
            .map(|room| room.ceiling_y)
            .fold(f32::INFINITY, f32::min);
        let cut_y = if ceiling.is_finite() {
            (ceiling - BELOW_CEILING_M).max(floor_y(house, level) + 0.5)
        } else {
            storey.bounds.max.y + 1.0
        };
        let size = bounds.size();
        let pixels_per_m = longest_edge as f32 / size.x.max(size.z).max(1e-3);
        // Whole pixels: the image spans a little more than asked for.
        let pixels = |length_m: f32| (length_m * pixels_per_m).round().max(1.0) as u32;
        let (width, height) = (pixels(size.x), pixels(size.z));
        let (width_m, height_m) = (width as f32 / pixels_per_m, height as f32 / pixels_per_m);
        let depth_m = (cut_y - storey.bounds.min.y).max(1.0) + 1.0;
        let camera =
            Camera::orthographic(width, height, width_m, height_m)?.with_range(0.0, depth_m)?;
        let center = Vec3::new(bounds.center().x, cut_y, bounds.center().z);
        let world_from_camera = Pose::new(center, space::rotation_from_yaw_pitch(0.0, -FRAC_PI_2));
        let corner = Vec2::new(center.x - width_m * 0.5, center.z - height_m * 0.5);
        Ok(Self {
            view: View::new(camera, world_from_camera),
            corner,
            pixels_per_m,
            cut_y,
        })
    }

    /// Returns the size of the image, (x, z), m.
    pub fn size_m(&self) -> Vec2 {
        let camera = &self.view.camera;
        Vec2::new(camera.width() as f32, camera.height() as f32) / self.pixels_per_m
    }

    /// The map as a picture: flat colours, walls dark where they are cut, paper where nothing of the storey is. Shape (height,
    /// width, 3) of [`Self::view`]'s camera.
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
            floor_y: self.cut_y - self.view.camera.far_m(),
            plan: self,
        };
        cut.render(renderer, scene, state, threads)
    }

    /// Returns the image of a point, pixels from the upper left corner of the image.
    pub fn image_from_world(&self, point: Vec3) -> Vec2 {
        (Vec2::new(point.x, point.z) - self.corner) * self.pixels_per_m
    }
}

/// The lowest floor of a storey, m.
fn floor_y(house: &House, level: LevelId) -> f32 {
    let rooms = house.rooms.iter().filter(|room| room.level == level);
    let lowest = rooms.map(|room| room.floor_y).fold(f32::INFINITY, f32::min);
    if lowest.is_finite() {
        return lowest;
    }
    house
        .levels
        .get(level)
        .map_or(0.0, |storey| storey.bounds.min.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::ShoeboxMaterials;

    #[test]
    fn the_map_and_its_camera_agree() {
        let house = House::shoebox([8.0, 3.0, 4.0], &ShoeboxMaterials::default()).unwrap();
        let map = StoreyMap::new(&house, LevelId(0), 450).unwrap();
        assert_eq!(
            (map.view.camera.width(), map.view.camera.height()),
            (450, 250)
        );
        for point in [
            Vec3::new(0.0, 0.0, 0.0),
            Vec3::new(8.0, 1.0, 4.0),
            Vec3::new(2.5, 0.3, 1.0),
        ] {
            let in_camera = map.view.world_from_camera.inverse().transform_point(point);
            let (image, depth) = map.view.camera.project(in_camera).unwrap();
            assert!(
                (image - map.image_from_world(point)).length() < 1e-2,
                "{image}"
            );
            assert!((depth - (map.cut_y - point.y)).abs() < 1e-4);
        }
        let message = StoreyMap::new(&house, LevelId(3), 450)
            .unwrap_err()
            .to_string();
        assert_eq!(message, "no storey 3; the house has 1");
    }
}
