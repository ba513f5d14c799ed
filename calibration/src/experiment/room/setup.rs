//! A room as the engine simulates it.

use crate::bundle::ROOM_SURFACES;
use crate::bundle::file::{RoomManifest, SurfaceManifest};
use crate::error::CalibrationError;
use dwell_acoustics::{AcousticConfig, AcousticScene};
use dwell_scene::material::library;
use dwell_scene::rays::RayScene;
use dwell_scene::{Bands, House, Material, ShoeboxMaterials};
use glam::Vec3;
use std::sync::Arc;

/// The sides on which a box begins, by axis, in [`ROOM_SURFACES`].
const FIRST_SIDES: [usize; 3] = [2, 0, 4];
/// The sides on which it ends.
const LAST_SIDES: [usize; 3] = [3, 1, 5];

/// A house with what sound needs of it.
#[derive(Clone)]
pub(super) struct RoomSetup {
    pub(super) house: Arc<House>,
    pub(super) scene: AcousticScene,
    pub(super) rays: RayScene,
    /// Places of the bundle become places of the house by this.
    pub(super) shift: Vec3,
}

impl RoomSetup {
    /// A house with the origin of the bundle.
    pub(super) fn new(
        house: Arc<House>,
        shift: Vec3,
        config: AcousticConfig,
    ) -> Result<Self, CalibrationError> {
        let scene = AcousticScene::new(house.clone(), config)
            .map_err(|error| CalibrationError::simulation("the room", error))?;
        Ok(Self {
            rays: RayScene::new(house.clone()),
            house,
            scene,
            shift,
        })
    }

    /// The box of a manifest, with each side so much further out, m.
    pub(super) fn of_box(
        room: &RoomManifest,
        offsets_m: &[f64; 6],
        config: AcousticConfig,
    ) -> Result<Self, CalibrationError> {
        let size_m: [f64; 3] = std::array::from_fn(|axis| {
            room.size_m[axis] + offsets_m[FIRST_SIDES[axis]] + offsets_m[LAST_SIDES[axis]]
        });
        let shift = FIRST_SIDES.map(|side| offsets_m[side] as f32);
        let side = |name: &str| material(name, room.surfaces.get(name));
        let [floor, ceiling, west, east, north, south] = ROOM_SURFACES.map(side);
        let materials = ShoeboxMaterials {
            floor,
            ceiling,
            west,
            east,
            north,
            south,
        };
        let house = House::shoebox(size_m.map(|edge| edge as f32), &materials)
            .map_err(|error| CalibrationError::simulation("the room", error))?;
        Self::new(Arc::new(house), Vec3::from_array(shift), config)
    }

    /// The side of the box that each plane is, by its position in [`ROOM_SURFACES`].
    pub(super) fn sides_of_planes(&self) -> Vec<Option<usize>> {
        let sides = self.scene.planes().iter().map(|plane| {
            let axis = (0..3).find(|axis| plane.normal[*axis].abs() > 0.99)?;
            let place = plane.normal[axis] * plane.offset_m;
            let first = place.abs() < 1e-3;
            Some(if first {
                FIRST_SIDES[axis]
            } else {
                LAST_SIDES[axis]
            })
        });
        sides.collect()
    }
}

fn material(name: &str, surface: Option<&SurfaceManifest>) -> Material {
    let known = surface.cloned().unwrap_or_default();
    let mut material = Material::from_substance(
        name,
        library().get_or_default(known.substance.as_deref().unwrap_or("plaster")),
    );
    if let Some(absorption) = known.absorption {
        material.absorption = Bands {
            centres_hz: absorption.centres_hz.iter().map(|f| *f as f32).collect(),
            values: absorption.values.iter().map(|v| *v as f32).collect(),
        };
    }
    if let Some(scattering) = known.scattering {
        material.scattering = Bands::constant(scattering as f32);
    }
    material
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_acoustics::SoundSourcePose;
    use std::collections::BTreeMap;

    /// An echo off each side of a box comes from the side's mirror image, where the side stands and where it is moved.
    #[test]
    fn first_echoes_come_from_the_images_of_moved_sides() {
        let surfaces: BTreeMap<String, SurfaceManifest> = ROOM_SURFACES
            .map(|side| (side.to_owned(), SurfaceManifest::default()))
            .into();
        let size_m = [5.0, 2.6, 4.0];
        let room = RoomManifest {
            size_m,
            surfaces,
            position_sd_m: None,
        };
        let config = AcousticConfig {
            rays: 0,
            image_order: 1,
            ..AcousticConfig::full()
        };
        let (source, receiver) = (Vec3::new(1.0, 1.1, 1.4), Vec3::new(3.7, 1.6, 2.9));
        for (moved, offset_m) in [(0, 0.0), (2, 0.5), (3, 0.7), (0, -0.2), (5, 0.4)] {
            let mut offsets_m = [0.0; 6];
            offsets_m[moved] = offset_m;
            let stage = RoomSetup::of_box(&room, &offsets_m, config).unwrap();
            let paths = stage
                .scene
                .early_paths(
                    &stage.rays,
                    &SoundSourcePose::omni(source + stage.shift),
                    receiver + stage.shift,
                )
                .unwrap();
            let sides = stage.sides_of_planes();
            for side in 0..6 {
                let found = paths
                    .iter()
                    .map(|one| &one.path)
                    .find(|path| path.order() == 1 && sides[path.planes[0] as usize] == Some(side))
                    .unwrap();
                let axis = [1, 1, 0, 0, 2, 2][side];
                let place = if FIRST_SIDES.contains(&side) {
                    -offsets_m[side]
                } else {
                    size_m[axis] + offsets_m[side]
                };
                let mut image = source.as_dvec3();
                image[axis] = 2.0 * place - image[axis];
                let length_m = image.distance(receiver.as_dvec3());
                assert!((found.length_m - length_m).abs() < 1e-5, "{moved} {side}");
            }
        }
    }
}
