//! Laws of real cameras and depth sensors. One file each, one line in the list.
//!
//! A law at its default is not installed, so that no bit changes. A law acts on the cameras of all agents, or of the agent whose
//! number is its target; on the rays (lenses, shutters) or on the finished picture, in the order in which laws were installed.

mod depth_scale_bias;
mod disparity_quantization;
mod exposure;
mod flying_pixels;
mod focal_length;
mod kinect_depth;
mod lens_distortion;
mod motion_blur;
mod principal_point;
mod redwood_depth;
mod rolling_shutter;
mod shot_read_noise;
#[cfg(test)]
mod testing;
mod vignetting;

use crate::camera::Camera;
use crate::color::SrgbTables;
use crate::error::RenderError;
use dwell_scene::law::{ActiveLaw, Law, LawRegistry};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, LawInfo, LawSpec, LawValues};
use glam::Vec3;

/// A law of this engine.
type RenderLaw = Law<RenderStage>;

/// The stage of rendering in which a law acts.
enum RenderStage {
    /// The projection of the camera.
    Lens(fn(LawValues<'_>, Camera) -> Camera),
    /// The shutter.
    Shutter(fn(LawValues<'_>, &mut Shutter)),
    /// Depths, m. Random draws depend on the key and the image's size alone.
    Depth(fn(LawValues<'_>, &DepthContext<'_>, RandomKey, &mut [f32])),
    /// As [`RenderStage::Depth`], with normals.
    DepthByNormals(fn(LawValues<'_>, &DepthContext<'_>, RandomKey, &mut [f32])),
    /// Light, linear, 1 for display white. Shape (height * width,).
    Color(fn(LawValues<'_>, &Camera, RandomKey, &mut [Vec3])),
}

/// The laws of this engine.
static LAWS: LawRegistry<RenderStage> = LawRegistry::new(&[
    focal_length::LAW,
    principal_point::LAW,
    lens_distortion::LAW,
    rolling_shutter::LAW,
    motion_blur::LAW,
    vignetting::LAW,
    exposure::LAW,
    shot_read_noise::LAW,
    redwood_depth::LAW,
    kinect_depth::LAW,
    flying_pixels::LAW,
    disparity_quantization::LAW,
    depth_scale_bias::LAW,
]);

/// Returns the descriptions of all laws of cameras.
///
/// ```
/// let law = dwell_scene::LawInfo::find(dwell_render::laws::all(), "redwood_depth").unwrap();
/// assert_eq!(law.params[0].name, "strength");
/// ```
pub fn all() -> impl Iterator<Item = &'static LawInfo> + Clone {
    LAWS.infos()
}

/// The inputs of a law of depth beside the depths.
struct DepthContext<'a> {
    camera: &'a Camera,
    /// Shape (height, width, 3); empty unless the law needs normals.
    normals: &'a [f32],
}

impl DepthContext<'_> {
    /// Pixels across and down.
    fn size(&self) -> (usize, usize) {
        (self.camera.width() as usize, self.camera.height() as usize)
    }
}

/// The times at which the rows of a picture are taken.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shutter {
    /// Delay of each row after the one above, s; the last one is taken at the picture's time.
    pub line_s: f32,
    /// Exposure time of each row, s.
    pub exposure_s: f32,
}

impl Shutter {
    /// Returns whether all rows are taken at one moment.
    pub fn is_global_instant(&self) -> bool {
        self.line_s == 0.0 && self.exposure_s == 0.0
    }
}

/// Checks that the targets of laws of cameras are existing agents.
///
/// # Errors
/// [`RenderError::LawTarget`].
pub fn check(laws: &[LawSpec], agents: usize) -> Result<(), RenderError> {
    for spec in laws {
        let ours = all().any(|info| info.id == spec.id);
        if let (true, Err(target)) = (ours, spec.target_agent(agents)) {
            return Err(RenderError::LawTarget {
                law: spec.id.clone(),
                found: target.to_owned(),
                agents,
            });
        }
    }
    Ok(())
}

/// The laws that act on one agent's cameras.
pub struct CameraLaws<'a> {
    laws: Vec<ActiveLaw<'a, RenderStage>>,
}

impl std::fmt::Debug for CameraLaws<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let specs = self.laws.iter().map(|law| law.values.spec);
        f.debug_list().entries(specs).finish()
    }
}

impl<'a> CameraLaws<'a> {
    /// Those of `laws` that act on the cameras of `agent`.
    pub fn of(laws: &'a [LawSpec], agent: AgentId) -> Self {
        let acting = LAWS.active(laws);
        Self {
            laws: acting
                .filter(|law| law.values.spec.is_on_agent(agent))
                .collect(),
        }
    }

    /// No laws.
    pub fn ideal() -> Self {
        Self { laws: Vec::new() }
    }

    /// The real camera, from the ideal one.
    #[must_use]
    pub fn apply_to_camera(&self, mut camera: Camera) -> Camera {
        for law in &self.laws {
            if let RenderStage::Lens(change) = law.effect {
                camera = change(law.values, camera);
            }
        }
        camera
    }

    /// Returns the shutter.
    pub fn shutter(&self) -> Shutter {
        let mut shutter = Shutter::default();
        for law in &self.laws {
            if let RenderStage::Shutter(change) = law.effect {
                change(law.values, &mut shutter);
            }
        }
        shutter
    }

    /// Returns whether [`Self::apply_to_depth`] needs normals.
    pub fn needs_normals(&self) -> bool {
        let mut laws = self.laws.iter();
        laws.any(|law| matches!(law.effect, RenderStage::DepthByNormals(_)))
    }

    /// Applies the sensor's laws to the depths `image`, m; 0 to the camera's far end.
    ///
    /// `camera`: the real one. `normals`: as [`crate::FrameMut::normals`], if [`Self::needs_normals`].
    ///
    /// # Determinism
    /// Equal keys, equal bits.
    pub fn apply_to_depth(
        &self,
        camera: &Camera,
        normals: &[f32],
        key: RandomKey,
        image: &mut [f32],
    ) {
        let scan = DepthContext { camera, normals };
        if image.len() != camera.pixels() {
            return;
        }
        let mut changed = false;
        for law in &self.laws {
            let change = match law.effect {
                RenderStage::Depth(change) => change,
                RenderStage::DepthByNormals(change) if normals.len() == 3 * image.len() => change,
                _ => continue,
            };
            change(law.values, &scan, key.child(law.index as u64), image);
            changed = true;
        }
        if changed {
            for depth in image {
                // NaN, too, is no reading.
                *depth = if *depth > 0.0 {
                    depth.min(camera.far_m())
                } else {
                    0.0
                };
            }
        }
    }

    /// Applies the sensor's laws to the colours `image`, sRGB bytes. Shape (height, width, 3).
    ///
    /// # Determinism
    /// Equal keys, equal bits.
    pub fn apply_to_color(&self, camera: &Camera, key: RandomKey, image: &mut [u8]) {
        let is_color =
            |law: &ActiveLaw<'_, RenderStage>| matches!(law.effect, RenderStage::Color(_));
        if !self.laws.iter().any(is_color) || image.len() != 3 * camera.pixels() {
            return;
        }
        let srgb = SrgbTables::tables();
        let mut light: Vec<Vec3> = image
            .chunks_exact(3)
            .map(|rgb| {
                Vec3::new(
                    srgb.decode(rgb[0]),
                    srgb.decode(rgb[1]),
                    srgb.decode(rgb[2]),
                )
            })
            .collect();
        for law in &self.laws {
            if let RenderStage::Color(change) = law.effect {
                change(law.values, camera, key.child(law.index as u64), &mut light);
            }
        }
        for (rgb, light) in image.chunks_exact_mut(3).zip(&light) {
            rgb.copy_from_slice(&srgb.encode3(light.to_array()));
        }
    }
}

/// The mean of pictures of sRGB bytes, in linear light; writes into `out`, of the pictures' length.
pub fn mean_color<'a>(pictures: impl Iterator<Item = &'a [u8]>, out: &mut [u8]) {
    let srgb = SrgbTables::tables();
    let mut sum = vec![0.0_f32; out.len()];
    let mut count = 0.0_f32;
    for picture in pictures {
        for (sum, byte) in sum.iter_mut().zip(picture) {
            *sum += srgb.decode(*byte);
        }
        count += 1.0;
    }
    for (out, sum) in out.iter_mut().zip(&sum) {
        *out = srgb.encode(sum / count);
    }
}

#[cfg(test)]
mod tests {
    use super::testing::{camera, law};
    use super::*;

    #[test]
    fn a_law_at_its_default_does_nothing() {
        let camera = camera();
        let depth: Vec<f32> = (0..camera.pixels())
            .map(|k| 0.5 + k as f32 * 0.01)
            .collect();
        let normals: Vec<f32> = depth.iter().flat_map(|_| [0.0, 0.0, 1.0]).collect();
        let color: Vec<u8> = (0..3 * camera.pixels()).map(|k| (k % 256) as u8).collect();
        for info in all() {
            let none = [info.spec(&[])];
            none[0].check(info).unwrap();
            for laws in [&none[..], &[]] {
                let optics = CameraLaws::of(laws, AgentId(0));
                let (mut z, mut rgb) = (depth.clone(), color.clone());
                optics.apply_to_depth(&camera, &normals, RandomKey::root(1), &mut z);
                optics.apply_to_color(&camera, RandomKey::root(1), &mut rgb);
                assert!(z == depth && rgb == color && optics.apply_to_camera(camera) == camera);
                assert!(optics.shutter().is_global_instant() && !optics.needs_normals());
            }
        }
    }

    #[test]
    fn a_law_on_one_agent_leaves_the_others_alone() {
        let mut spec = law("depth_scale_bias", &[("bias_m", 0.5)]);
        spec.target = Some("1".to_owned());
        let camera = camera();
        let depth = |agent: u32| {
            let mut image = vec![1.0; camera.pixels()];
            let laws = [spec.clone()];
            CameraLaws::of(&laws, AgentId(agent)).apply_to_depth(
                &camera,
                &[],
                RandomKey::root(0),
                &mut image,
            );
            image[0]
        };
        assert_eq!((depth(0), depth(1), depth(2)), (1.0, 1.5, 1.0));
        assert!(check(std::slice::from_ref(&spec), 2).is_ok());
        let message = check(&[spec], 1).unwrap_err().to_string();
        assert_eq!(
            message,
            "law depth_scale_bias: target \"1\" is no agent; there are 1, counted from 0"
        );
    }

    /// Light, not bytes, is averaged: half of white is byte 188.
    #[test]
    fn a_mean_of_black_and_white_is_half_the_light() {
        let mut out = [0_u8; 3];
        mean_color([&[0_u8, 0, 255][..], &[255, 0, 255]].into_iter(), &mut out);
        assert_eq!(out, [188, 0, 255]);
    }
}
