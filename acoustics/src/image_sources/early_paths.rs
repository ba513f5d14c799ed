//! Where early sound goes: the corners of its paths.

use super::sequences::mirror;
use crate::echogram::PropagationPath;
use crate::error::AcousticsError;
use crate::receiver::SoundSourcePose;
use crate::scene::AcousticScene;
use dwell_scene::rays::RayScene;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// An early path with the points it passes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EarlyPath {
    /// The source, its reflections or bends in order, the receiver, m. Shape (2 to 6,).
    pub points: Vec<Vec3>,
    /// What arrives over it.
    pub path: PropagationPath,
}

impl AcousticScene {
    /// All early paths from `source` to `receiver`, by length: what [`Self::echogram`] calls its paths, with their corners.
    ///
    /// # Errors
    /// As [`Self::echogram`].
    pub fn early_paths(
        &self,
        rays: &RayScene,
        source: &SoundSourcePose,
        receiver: Vec3,
    ) -> Result<Vec<EarlyPath>, AcousticsError> {
        self.check(rays, source, &[receiver])?;
        let paths = super::find(self, rays, source, receiver).into_iter();
        Ok(paths
            .map(|path| EarlyPath {
                points: self.corners(&path, source.position(), receiver),
                path,
            })
            .collect())
    }

    fn corners(&self, path: &PropagationPath, source: Vec3, receiver: Vec3) -> Vec<Vec3> {
        if !path.bends.is_empty() {
            let bends = path.bends.iter().copied();
            return std::iter::once(source)
                .chain(bends)
                .chain([receiver])
                .collect();
        }
        let mut images = Vec::new();
        let found = mirror(self.planes(), source.as_dvec3(), &path.planes, &mut images);
        let mut points = vec![receiver];
        let mut target = receiver.as_dvec3();
        if found {
            for (plane, image) in path.planes.iter().zip(&images).rev() {
                let plane = &self.planes()[*plane as usize];
                let (here, there) = (plane.distance_m(target), plane.distance_m(*image));
                target += (image - target) * (here / (here - there));
                points.push(target.as_vec3());
            }
        }
        points.push(source);
        points.reverse();
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::AcousticConfig;
    use dwell_scene::{House, ShoeboxMaterials};
    use std::sync::Arc;

    /// In a box each first reflection lies on a wall, obeys the law of reflection, and the legs sum up to the path's length.
    #[test]
    fn corners_lie_on_walls_and_legs_sum_up_to_the_length() {
        let size = Vec3::new(6.0, 3.0, 5.0);
        let house = House::shoebox(size.to_array(), &ShoeboxMaterials::default()).unwrap();
        let house = Arc::new(house);
        let rays = RayScene::new(house.clone());
        let scene = AcousticScene::new(house, AcousticConfig::default()).unwrap();
        let (source, receiver) = (Vec3::new(1.0, 1.2, 1.5), Vec3::new(4.5, 1.6, 3.0));
        let paths = scene
            .early_paths(&rays, &SoundSourcePose::at(source), receiver)
            .unwrap();
        let first = paths.iter().filter(|one| one.path.order() == 1).count();
        assert_eq!(first, 6, "one over each side of the box");
        for EarlyPath { points, path } in &paths {
            assert_eq!(points.len(), path.order() + 2);
            assert_eq!((points[0], points[points.len() - 1]), (source, receiver));
            let legs = points.windows(2).map(|leg| leg[0].distance(leg[1]));
            assert!((f64::from(legs.sum::<f32>()) - path.length_m).abs() < 1e-4);
            for corner in points.windows(3) {
                let [before, at, after] = [corner[0], corner[1], corner[2]];
                let on = |k: usize| at[k].abs() < 1e-4 || (at[k] - size[k]).abs() < 1e-4;
                let axis = (0..3).find(|k| on(*k)).unwrap();
                let (inward, outward) = ((at - before).normalize(), (after - at).normalize());
                for k in 0..3 {
                    let expected = if k == axis { -inward[k] } else { inward[k] };
                    assert!((outward[k] - expected).abs() < 1e-3);
                }
            }
        }
    }
}
