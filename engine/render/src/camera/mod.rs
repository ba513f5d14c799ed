//! Cameras: rays of pixels, and projection of points.

mod fisheye;
mod lens;
mod panorama;
mod projection;
#[cfg(test)]
mod tests;

pub use projection::Projection;

use crate::error::RenderError;
use dwell_scene::math;
use glam::{Quat, Vec2, Vec3};
use serde::{Deserialize, Serialize};
use std::f32::consts::{PI, TAU};

/// A camera without a pose: image size, projection, and the range of depth in which things are seen.
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
#[serde(try_from = "CameraFile", into = "CameraFile")]
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
struct CameraFile {
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

impl TryFrom<CameraFile> for Camera {
    type Error = RenderError;
    fn try_from(plain: CameraFile) -> Result<Self, RenderError> {
        Self::new(plain.width, plain.height, plain.projection)?
            .with_range(plain.near_m, plain.far_m)
    }
}

impl From<Camera> for CameraFile {
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
        projection.check(width, height)?;
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
        let f = focal(width, "fov_deg", horizontal_fov_deg)?;
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

    /// The same camera with another projection; as it was where that is out of range.
    #[must_use]
    pub(crate) fn with_projection(self, projection: Projection) -> Self {
        match projection.check(self.width, self.height) {
            Ok(()) => Self { projection, ..self },
            Err(_) => self,
        }
    }

    /// The same camera with other focal lengths and principal point `(fx, fy, cx, cy)`; as it was where it has none.
    #[must_use]
    pub(crate) fn with_changed_intrinsics(
        self,
        change: impl FnOnce((f32, f32, f32, f32)) -> (f32, f32, f32, f32),
    ) -> Self {
        let own = self.projection.intrinsics();
        own.map_or(self, |own| {
            self.with_projection(self.projection.with_intrinsics(change(own)))
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

    /// Returns the projection.
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

    /// A camera that sees all around, `width` pixels for 360 degrees and half as many for 180.
    ///
    /// # Errors
    /// [`RenderError::Camera`] names the number that is out of range.
    pub fn equirectangular(width: u32) -> Result<Self, RenderError> {
        Self::new(width, (width / 2).max(1), Projection::Equirectangular {})
    }

    /// A camera that sees all around, as six pictures of `edge` by `edge` pixels below one another.
    ///
    /// # Errors
    /// [`RenderError::Camera`] names the number that is out of range.
    pub fn cubemap(edge: u32) -> Result<Self, RenderError> {
        Self::new(edge, edge.saturating_mul(6), Projection::Cubemap {})
    }

    fn size(&self) -> (f32, f32) {
        (self.width as f32, self.height as f32)
    }

    /// The ray through a point of the image, in camera space: its origin (depth 0) and its direction **per metre of
    /// depth**, so that the point at depth d is `start + d * direction`. For cameras whose depth is range the direction has
    /// unit length, for others z is -1. A direction of zero: this point of the image sees nothing.
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
            _ => (Vec3::ZERO, self.bent_ray(image)),
        }
    }

    /// The direction of [`Self::ray_in_camera`] for cameras that bend straight lines.
    fn bent_ray(&self, image: Vec2) -> Vec3 {
        match self.projection {
            Projection::BrownConrady {
                fx,
                fy,
                cx,
                cy,
                k1,
                k2,
                k3,
                p1,
                p2,
            } => {
                let seen = Vec2::new((image.x - cx) / fx, (image.y - cy) / fy);
                lens::undistort([k1, k2, k3, p1, p2], seen)
                    .map_or(Vec3::ZERO, |p| Vec3::new(p.x, -p.y, -1.0))
            }
            Projection::Fisheye {
                fx,
                fy,
                cx,
                cy,
                k1,
                k2,
                k3,
                k4,
                half_angle_deg,
            } => {
                let at = Vec2::new((image.x - cx) / fx, (image.y - cy) / fy);
                fisheye::direction(at, [k1, k2, k3, k4], half_angle_deg.to_radians())
            }
            Projection::Equirectangular {} => panorama::sphere_direction(image, self.size()),
            Projection::Cubemap {} => panorama::cube_direction(image, self.width as f32),
            Projection::Pinhole { .. } | Projection::Orthographic { .. } => {
                self.ray_in_camera(image).1
            }
        }
    }

    /// Returns the image of a point in camera space, pixels from the top left corner, and its depth, m; `None` for a point that
    /// the camera cannot see wherever its image ends, such as one beside or behind a pinhole. The image may end before.
    pub fn project(&self, point_in_camera: Vec3) -> Option<(Vec2, f32)> {
        let depth = -point_in_camera.z;
        let range = point_in_camera.length();
        let flat = Vec2::new(point_in_camera.x, -point_in_camera.y) / depth;
        match self.projection {
            Projection::Pinhole { fx, fy, cx, cy } => {
                let image = Vec2::new(
                    cx + fx * point_in_camera.x / depth,
                    cy - fy * point_in_camera.y / depth,
                );
                (depth > 0.0).then_some((image, depth))
            }
            Projection::BrownConrady {
                fx,
                fy,
                cx,
                cy,
                k1,
                k2,
                k3,
                p1,
                p2,
            } => {
                if depth <= 0.0 {
                    return None;
                }
                let bent = lens::distort([k1, k2, k3, p1, p2], flat)?;
                Some((Vec2::new(cx + fx * bent.x, cy + fy * bent.y), depth))
            }
            Projection::Fisheye {
                fx,
                fy,
                cx,
                cy,
                k1,
                k2,
                k3,
                k4,
                half_angle_deg,
            } => {
                let half_angle = half_angle_deg.to_radians();
                let at = fisheye::project(point_in_camera, [k1, k2, k3, k4], half_angle)?;
                Some((Vec2::new(cx + fx * at.x, cy + fy * at.y), range))
            }
            Projection::Equirectangular {} => Some((
                panorama::sphere_project(point_in_camera, self.size())?,
                range,
            )),
            Projection::Cubemap {} => {
                let image = panorama::cube_project(point_in_camera, self.width as f32)?;
                Some((image, range))
            }
            Projection::Orthographic { width_m, height_m } => Some((
                Vec2::new(
                    (point_in_camera.x / width_m + 0.5) * self.width as f32,
                    (0.5 - point_in_camera.y / height_m) * self.height as f32,
                ),
                depth,
            )),
        }
    }

    /// The area that a pixel covers of a plane across the axis (of a sphere where depth is range): m² at depth 0, and m² per
    /// square metre of depth.
    pub(crate) fn pixel_area(&self) -> (f32, f32) {
        match self.projection {
            Projection::Pinhole { fx, fy, .. }
            | Projection::BrownConrady { fx, fy, .. }
            | Projection::Fisheye { fx, fy, .. } => (0.0, 1.0 / (fx * fy)),
            // Where pixels are largest.
            Projection::Equirectangular {} => {
                let (width, height) = self.size();
                (0.0, (TAU / width) * (PI / height))
            }
            Projection::Cubemap {} => (0.0, (2.0 / self.width as f32).powi(2)),
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
