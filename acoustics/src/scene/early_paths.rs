//! Early paths with their corners.

use super::AcousticScene;
use crate::echogram::PropagationPath;
use crate::error::AcousticsError;
use crate::image_sources;
use crate::receiver::SoundSourcePose;
use dwell_scene::rays::RayScene;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// An early path with its corners.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EarlyPath {
    /// The source, its reflections or bends in order, the receiver, m. Shape (2 to 6,).
    pub points: Vec<Vec3>,
    /// The propagation path.
    pub path: PropagationPath,
}

impl AcousticScene {
    /// Returns all early paths from `source` to `receiver`, by length: the paths of [`Self::echogram`], with their corners.
    ///
    /// # Errors
    /// As [`Self::echogram`].
    pub fn early_paths(
        &self,
        rays: &RayScene,
        source: &SoundSourcePose,
        receiver: Vec3,
    ) -> Result<Vec<EarlyPath>, AcousticsError> {
        self.check_trace_inputs(rays, source, &[receiver])?;
        let position = source.position();
        let paths =
            image_sources::find_specular_paths(self.data(), rays, source, receiver).into_iter();
        Ok(paths
            .map(|path| EarlyPath {
                points: image_sources::path_vertices(self.planes(), &path, position, receiver),
                path,
            })
            .collect())
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
            .early_paths(&rays, &SoundSourcePose::omni(source), receiver)
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
