//! Projections: the kinds of cameras, and the parameters that each allows.

use super::fault;
use super::{fisheye, lens};
use crate::error::RenderError;
use serde::{Deserialize, Serialize};

/// The projection from camera space to pixels.
///
/// Cameras with one axis (pinhole, with or without a lens, and orthographic) count depth along it; the others count range, the
/// distance from the camera.
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
    /// A pinhole behind a lens that bends straight lines.
    ///
    /// # Source
    /// D. C. Brown, "Close-Range Camera Calibration", Photogrammetric Engineering 37 (1971) 855, in OpenCV's form: with
    /// x = X/Z, y = Y/Z and r² = x² + y², the point appears where a pinhole has
    /// x (1 + k1 r² + k2 r⁴ + k3 r⁶) + 2 p1 x y + p2 (r² + 2 x²), y (1 + k1 r² + k2 r⁴ + k3 r⁶) + p1 (r² + 2 y²) + 2 p2 x y.
    BrownConrady {
        /// Focal length in pixel widths.
        fx: f32,
        /// Focal length in pixel heights.
        fy: f32,
        /// Principal point, pixels from the left edge.
        cx: f32,
        /// Principal point, pixels from the upper edge.
        cy: f32,
        /// Radial, by r².
        #[serde(default)]
        k1: f32,
        /// Radial, by r⁴.
        #[serde(default)]
        k2: f32,
        /// Radial, by r⁶.
        #[serde(default)]
        k3: f32,
        /// Tangential.
        #[serde(default)]
        p1: f32,
        /// Tangential.
        #[serde(default)]
        p2: f32,
    },
    /// A fisheye: a ray at the angle a from the axis appears (a + k1 a³ + k2 a⁵ + k3 a⁷ + k4 a⁹) focal lengths from the
    /// principal point; with all k 0 it is equidistant. Pixels beyond `half_angle_deg` see nothing and are black.
    ///
    /// # Source
    /// J. Kannala, S. S. Brandt, IEEE TPAMI 28 (2006) 1335, equation 6, with k1 of that paper 1 as in OpenCV's fisheye.
    Fisheye {
        /// Focal length in pixel widths a radian.
        fx: f32,
        /// Focal length in pixel heights a radian.
        fy: f32,
        /// Principal point, pixels from the left edge.
        cx: f32,
        /// Principal point, pixels from the upper edge.
        cy: f32,
        /// By a³.
        #[serde(default)]
        k1: f32,
        /// By a⁵.
        #[serde(default)]
        k2: f32,
        /// By a⁷.
        #[serde(default)]
        k3: f32,
        /// By a⁹.
        #[serde(default)]
        k4: f32,
        /// The largest angle from the axis that is seen, degrees; at most 180, default 90.
        #[serde(default = "right_angle_deg")]
        half_angle_deg: f32,
    },
    /// All around: columns are even steps of azimuth from -180 degrees at the left edge over 0 (ahead) in the middle to the
    /// right, rows even steps of elevation from 90 degrees at the upper edge to -90.
    Equirectangular {},
    /// All around, as six square pictures below one another: ahead, left, behind, right, up, down. The first four stand
    /// upright; up is what is seen after pitching up by 90 degrees, down after pitching down. The image is six times as high
    /// as wide.
    Cubemap {},
    /// All rays are parallel; the image is centred on the camera.
    Orthographic {
        /// Width of the image, from left to right, m.
        width_m: f32,
        /// Height of the image, from top to bottom, m.
        height_m: f32,
    },
}

fn right_angle_deg() -> f32 {
    90.0
}

impl Projection {
    /// Returns whether depth is the distance from the camera, and not along its axis.
    pub fn depth_is_range(&self) -> bool {
        matches!(
            self,
            Self::Fisheye { .. } | Self::Equirectangular {} | Self::Cubemap {}
        )
    }

    /// Returns whether straight lines appear straight.
    pub fn preserves_straight_lines(&self) -> bool {
        matches!(self, Self::Pinhole { .. } | Self::Orthographic { .. })
    }

    /// Focal lengths and principal point in pixels `(fx, fy, cx, cy)`; `None` for a projection without them.
    pub fn intrinsics(&self) -> Option<(f32, f32, f32, f32)> {
        match *self {
            Self::Pinhole { fx, fy, cx, cy }
            | Self::BrownConrady { fx, fy, cx, cy, .. }
            | Self::Fisheye { fx, fy, cx, cy, .. } => Some((fx, fy, cx, cy)),
            Self::Equirectangular {} | Self::Cubemap {} | Self::Orthographic { .. } => None,
        }
    }

    /// The same camera with other focal lengths and principal point; as it was where it has none.
    #[must_use]
    pub fn with_intrinsics(mut self, (f_x, f_y, c_x, c_y): (f32, f32, f32, f32)) -> Self {
        if let Self::Pinhole { fx, fy, cx, cy }
        | Self::BrownConrady { fx, fy, cx, cy, .. }
        | Self::Fisheye { fx, fy, cx, cy, .. } = &mut self
        {
            (*fx, *fy, *cx, *cy) = (f_x, f_y, c_x, c_y);
        }
        self
    }

    /// Checks every number for an image of this size.
    pub(super) fn check(&self, width: u32, height: u32) -> Result<(), RenderError> {
        if let Some((fx, fy, cx, cy)) = self.intrinsics() {
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
        match *self {
            Self::Pinhole { .. } | Self::Equirectangular {} => Ok(()),
            Self::BrownConrady {
                k1, k2, k3, p1, p2, ..
            } => {
                for (field, k) in [("k1", k1), ("k2", k2), ("k3", k3), ("p1", p1), ("p2", p2)] {
                    if !(-lens::MAX_COEFFICIENT..=lens::MAX_COEFFICIENT).contains(&k) {
                        return fault(field, k, "-100 to 100");
                    }
                }
                Ok(())
            }
            Self::Fisheye {
                k1,
                k2,
                k3,
                k4,
                half_angle_deg,
                ..
            } => {
                if !(1.0..=180.0).contains(&half_angle_deg) {
                    return fault("half_angle_deg", half_angle_deg, "1 to 180 degrees");
                }
                let k = [k1, k2, k3, k4];
                for (field, k) in ["k1", "k2", "k3", "k4"].into_iter().zip(k) {
                    if !(-lens::MAX_COEFFICIENT..=lens::MAX_COEFFICIENT).contains(&k) {
                        return fault(field, k, "-100 to 100");
                    }
                }
                if let Some(angle) = fisheye::max_injective_angle(k, half_angle_deg.to_radians()) {
                    let found = format!(
                        "[{k1}, {k2}, {k3}, {k4}], which turn back at {:.1} degrees",
                        angle.to_degrees()
                    );
                    return fault(
                        "k1 to k4",
                        found,
                        "those with which the image only grows with the angle, up to half_angle_deg",
                    );
                }
                Ok(())
            }
            Self::Cubemap {} => {
                if u64::from(height) == 6 * u64::from(width) {
                    Ok(())
                } else {
                    fault("height", height, "six times the width for a cube map")
                }
            }
            Self::Orthographic { width_m, height_m } => {
                for (field, span) in [("width_m", width_m), ("height_m", height_m)] {
                    if !(1e-3..=1e5).contains(&span) {
                        return fault(field, span, "0.001 to 100000 m");
                    }
                }
                Ok(())
            }
        }
    }
}
