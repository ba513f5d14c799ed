//! Cameras: where a pixel looks, and where a point appears.

use crate::error::RenderError;
use dwell_scene::math;
use glam::{Quat, Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// Where pixels look.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Projection {
    /// All rays pass one point. OpenCV's form: image x = `fx` X/Z + `cx`, image y = `fy` Y/Z + `cy` with Y down and Z
    /// forward, the origin at the top left **corner** of the image, so that pixel centres lie at +0.5.
    Pinhole {
        /// Focal length in pixel widths.
        fx: f32,
        /// Focal length in pixel heights.
        fy: f32,
        /// Principal point, pixels from the left edge.
        cx: f32,
        /// Principal point, pixels from the upper edge.
        cy: f32,
    },
    /// All rays are parallel; the image is centred on the camera.
    Orthographic {
        /// What the image spans from left to right, m.
        width_m: f32,
        /// What the image spans from top to bottom, m.
        height_m: f32,
    },
}

/// A camera without a place: image size, projection, and the range of depth in which things are seen.
///
/// Checked when made; equal cameras see equal pixels.
///
/// ```
/// use dwell_render::Camera;
/// let camera = Camera::from_fov(128, 128, 90.0)?;
/// assert_eq!((camera.near_m(), camera.far_m()), (0.05, 50.0));
/// # Ok::<(), dwell_render::RenderError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Plain", into = "Plain")]
pub struct Camera {
    width: u32,
    height: u32,
    projection: Projection,
    near_m: f32,
    far_m: f32,
}

/// A camera as files hold it.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Plain {
    width: u32,
    height: u32,
    projection: Projection,
    #[serde(default = "default_near")]
    near_m: f32,
    #[serde(default = "default_far")]
    far_m: f32,
}

fn default_near() -> f32 {
    Camera::DEFAULT_NEAR_M
}

fn default_far() -> f32 {
    Camera::DEFAULT_FAR_M
}

impl TryFrom<Plain> for Camera {
    type Error = RenderError;
    fn try_from(plain: Plain) -> Result<Self, RenderError> {
        Self::new(plain.width, plain.height, plain.projection)?
            .with_range(plain.near_m, plain.far_m)
    }
}

impl From<Camera> for Plain {
    fn from(camera: Camera) -> Self {
        let Camera {
            width,
            height,
            projection,
            near_m,
            far_m,
        } = camera;
        Self {
            width,
            height,
            projection,
            near_m,
            far_m,
        }
    }
}

impl Camera {
    /// Default nearest depth, m.
    pub const DEFAULT_NEAR_M: f32 = 0.05;
    /// Default furthest depth, m.
    pub const DEFAULT_FAR_M: f32 = 50.0;
    /// Most pixels along an edge.
    pub const MAX_EDGE: u32 = 16_384;

    /// The rotation between the two usual camera frames, its own inverse: ours looks along -Z with +Y up (OpenGL),
    /// OpenCV's along +Z with +Y down.
    pub const CAMERA_FROM_OPENCV: Quat = Quat::from_xyzw(1.0, 0.0, 0.0, 0.0);

    /// A camera of any projection, depth 0.05 to 50 m.
    ///
    /// # Errors
    /// [`RenderError::Camera`] names the number that is out of range.
    pub fn new(width: u32, height: u32, projection: Projection) -> Result<Self, RenderError> {
        for (field, edge) in [("width", width), ("height", height)] {
            if !(1..=Self::MAX_EDGE).contains(&edge) {
                return fault(field, edge, "1 to 16384 pixels");
            }
        }
        match projection {
            Projection::Pinhole { fx, fy, cx, cy } => {
                for (field, focal) in [("fx", fx), ("fy", fy)] {
                    if !(1e-3..=1e7).contains(&focal) {
                        return fault(field, focal, "0.001 to 1e7 pixels");
                    }
                }
                for (field, center) in [("cx", cx), ("cy", cy)] {
                    if !(-1e6..=1e6).contains(&center) {
                        return fault(field, center, "-1e6 to 1e6 pixels");
                    }
                }
            }
            Projection::Orthographic { width_m, height_m } => {
                for (field, span) in [("width_m", width_m), ("height_m", height_m)] {
                    if !(1e-3..=1e5).contains(&span) {
                        return fault(field, span, "0.001 to 100000 m");
                    }
                }
            }
        }
        Ok(Self {
            width,
            height,
            projection,
            near_m: Self::DEFAULT_NEAR_M,
            far_m: Self::DEFAULT_FAR_M,
        })
    }

    /// A pinhole camera with square pixels and its axis in the middle of the image.
    ///
    /// `horizontal_fov_deg`: full angle from the left to the right edge, 1 to 175 degrees.
    ///
    /// # Errors
    /// [`RenderError::Camera`] names the number that is out of range.
    pub fn from_fov(width: u32, height: u32, horizontal_fov_deg: f32) -> Result<Self, RenderError> {
        let f = focal(width, "horizontal_fov_deg", horizontal_fov_deg)?;
        Self::centred(width, height, f, f)
    }

    /// A pinhole camera with its axis in the middle of the image and a field of view for either direction, each 1 to 175
    /// degrees from edge to edge.
    ///
    /// # Errors
    /// [`RenderError::Camera`] names the number that is out of range.
    pub fn from_fovs(
        width: u32,
        height: u32,
        horizontal_fov_deg: f32,
        vertical_fov_deg: f32,
    ) -> Result<Self, RenderError> {
        let fx = focal(width, "horizontal_fov_deg", horizontal_fov_deg)?;
        let fy = focal(height, "vertical_fov_deg", vertical_fov_deg)?;
        Self::centred(width, height, fx, fy)
    }

    fn centred(width: u32, height: u32, fx: f32, fy: f32) -> Result<Self, RenderError> {
        let (cx, cy) = (width as f32 * 0.5, height as f32 * 0.5);
        Self::new(width, height, Projection::Pinhole { fx, fy, cx, cy })
    }

    /// A camera with parallel rays whose image spans `width_m` by `height_m`.
    ///
    /// # Errors
    /// [`RenderError::Camera`] names the number that is out of range.
    pub fn orthographic(
        width: u32,
        height: u32,
        width_m: f32,
        height_m: f32,
    ) -> Result<Self, RenderError> {
        Self::new(
            width,
            height,
            Projection::Orthographic { width_m, height_m },
        )
    }

    /// The same camera for another range of depth, m; what lies outside it is not seen.
    ///
    /// # Errors
    /// [`RenderError::Camera`] unless `0 <= near_m < far_m <= 1e6`.
    pub fn with_range(self, near_m: f32, far_m: f32) -> Result<Self, RenderError> {
        if !(0.0..=1e6).contains(&near_m) {
            return fault("near_m", near_m, "0 to 1e6 m");
        }
        if !(far_m > near_m && far_m <= 1e6) {
            return fault("far_m", far_m, "more than near_m, at most 1e6 m");
        }
        Ok(Self {
            near_m,
            far_m,
            ..self
        })
    }

    /// Pixels across.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Pixels down.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Pixels in all.
    pub fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Where pixels look.
    pub fn projection(&self) -> Projection {
        self.projection
    }

    /// The nearest depth at which things are seen, m.
    pub fn near_m(&self) -> f32 {
        self.near_m
    }

    /// The furthest depth at which things are seen, and the depth of pixels that see nothing, m.
    pub fn far_m(&self) -> f32 {
        self.far_m
    }

    /// The ray through a point of the image, in camera space: where it starts (depth 0) and its direction **per metre of
    /// depth** (z is -1), so that the point at depth d is `start + d * direction`.
    ///
    /// `image`: pixels from the top left corner; the centre of the first pixel is (0.5, 0.5).
    #[inline]
    pub fn ray_in_camera(&self, image: Vec2) -> (Vec3, Vec3) {
        match self.projection {
            Projection::Pinhole { fx, fy, cx, cy } => (
                Vec3::ZERO,
                Vec3::new((image.x - cx) / fx, (cy - image.y) / fy, -1.0),
            ),
            Projection::Orthographic { width_m, height_m } => {
                let x = (image.x / self.width as f32 - 0.5) * width_m;
                let y = (0.5 - image.y / self.height as f32) * height_m;
                (Vec3::new(x, y, 0.0), Vec3::NEG_Z)
            }
        }
    }

    /// Where a point in camera space appears, pixels from the top left corner, and its depth, m; nothing for a point that
    /// a pinhole camera has beside or behind it. The image may end before.
    pub fn project(&self, point_in_camera: Vec3) -> Option<(Vec2, f32)> {
        let depth = -point_in_camera.z;
        let image = match self.projection {
            Projection::Pinhole { fx, fy, cx, cy } => {
                if depth <= 0.0 {
                    return None;
                }
                Vec2::new(
                    cx + fx * point_in_camera.x / depth,
                    cy - fy * point_in_camera.y / depth,
                )
            }
            Projection::Orthographic { width_m, height_m } => Vec2::new(
                (point_in_camera.x / width_m + 0.5) * self.width as f32,
                (0.5 - point_in_camera.y / height_m) * self.height as f32,
            ),
        };
        Some((image, depth))
    }

    /// The area that a pixel covers of a plane across the axis: m² at depth 0, and m² per square metre of depth.
    pub(crate) fn pixel_area(&self) -> (f32, f32) {
        match self.projection {
            Projection::Pinhole { fx, fy, .. } => (0.0, 1.0 / (fx * fy)),
            Projection::Orthographic { width_m, height_m } => (
                (width_m / self.width as f32) * (height_m / self.height as f32),
                0.0,
            ),
        }
    }
}

fn focal(edge: u32, field: &'static str, fov_deg: f32) -> Result<f32, RenderError> {
    if !(1.0..=175.0).contains(&fov_deg) {
        return fault(field, fov_deg, "1 to 175 degrees");
    }
    Ok(edge as f32 * 0.5 / math::tan(fov_deg.to_radians() * 0.5))
}

fn fault<T>(
    field: &'static str,
    found: impl std::fmt::Display,
    allowed: &'static str,
) -> Result<T, RenderError> {
    Err(RenderError::Camera {
        field,
        found: found.to_string(),
        allowed,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn ninety_degrees_over_128_pixels_are_a_focal_length_of_64() {
        let camera = Camera::from_fov(128, 96, 90.0).unwrap();
        let Projection::Pinhole { fx, fy, cx, cy } = camera.projection() else {
            panic!("a pinhole")
        };
        assert!((fx - 64.0).abs() < 1e-4 && (fy - 64.0).abs() < 1e-4);
        assert_eq!((cx, cy), (64.0, 48.0));
        let both = Camera::from_fovs(128, 96, 90.0, 90.0).unwrap();
        let Projection::Pinhole { fy, .. } = both.projection() else {
            panic!("a pinhole")
        };
        assert!((fy - 48.0).abs() < 1e-4);
    }

    #[test]
    fn points_appear_where_opencv_puts_them() {
        let projection = Projection::Pinhole {
            fx: 500.0,
            fy: 520.0,
            cx: 310.0,
            cy: 255.0,
        };
        let camera = Camera::new(640, 480, projection).unwrap();
        // X right 0.4, Y down 0.3, Z forward 2 in OpenCV's frame.
        let in_opencv = Vec3::new(0.4, 0.3, 2.0);
        let (image, depth) = camera
            .project(Camera::CAMERA_FROM_OPENCV * in_opencv)
            .unwrap();
        assert!(
            (image - Vec2::new(500.0 * 0.2 + 310.0, 520.0 * 0.15 + 255.0)).length() < 1e-3,
            "{image}"
        );
        assert!((depth - 2.0).abs() < 1e-6);
        assert_eq!(camera.project(Vec3::new(0.0, 0.0, 1.0)), None);
    }

    #[test]
    fn what_is_out_of_range_is_named() {
        let message = |result: Result<Camera, RenderError>| result.unwrap_err().to_string();
        assert_eq!(
            message(Camera::from_fov(0, 4, 90.0)),
            "camera: width is 0; allowed is 1 to 16384 pixels"
        );
        assert_eq!(
            message(Camera::from_fov(4, 4, 180.0)),
            "camera: horizontal_fov_deg is 180; allowed is 1 to 175 degrees"
        );
        assert!(message(Camera::from_fov(4, 4, f32::NAN)).contains("NaN"));
        assert!(
            message(Camera::from_fov(4, 4, 90.0).unwrap().with_range(1.0, 1.0)).contains("far_m")
        );
        assert!(
            message(Camera::from_fov(4, 4, 90.0).unwrap().with_range(-1.0, 1.0)).contains("near_m")
        );
        assert!(message(Camera::orthographic(4, 4, 0.0, 1.0)).contains("width_m"));
        let projection = Projection::Pinhole {
            fx: f32::INFINITY,
            fy: 1.0,
            cx: 0.0,
            cy: 0.0,
        };
        assert!(message(Camera::new(4, 4, projection)).contains("fx"));
    }

    proptest! {
        #[test]
        fn a_ray_meets_the_point_that_it_was_projected_from(
            x in -3.0_f32..3.0, y in -3.0_f32..3.0, depth in 0.1_f32..20.0, fov in 20.0_f32..120.0, flat in any::<bool>(),
        ) {
            let camera = if flat {
                Camera::orthographic(640, 480, 8.0, 6.0)
            } else {
                Camera::from_fov(640, 480, fov)
            }.unwrap();
            let point = Vec3::new(x, y, -depth);
            let (image, found) = camera.project(point).unwrap();
            let (start, direction) = camera.ray_in_camera(image);
            prop_assert!((direction.z + 1.0).abs() < 1e-9);
            let back = start + direction * found;
            prop_assert!((back - point).length() < 1e-3 * (1.0 + depth), "{} {}", back, point);
        }
    }
}
