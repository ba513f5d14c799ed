//! Sliding on slopes that are too steep to stand on.
//!
//! Feet hold on a slope like a block with the friction `tan(max_slope)`: up to the steepest slope that the body walks up,
//! and not beyond. There it slides along the surface with `g (sin a - tan(max_slope) cos a)`, and on level ground it comes
//! to rest under the same friction.

use super::character_controller::CharacterController;
use dwell_scene::math;
use glam::Vec3;

/// Margin by which a slope must exceed the limit to count as too steep (difference of cosines).
const MARGIN: f32 = 1e-3;
/// Highest sliding speed, m/s.
const FASTEST_M_S: f32 = 30.0;

impl CharacterController<'_> {
    /// Returns whether the surface under the middle of the feet, near `height_m`, is too steep to walk up.
    pub(super) fn is_too_steep(&self, feet: Vec3, height_m: f32) -> bool {
        let steepest = math::cos(self.probe.body.max_slope_rad);
        self.probe
            .ground_normal(feet, height_m)
            .is_some_and(|normal| normal.y < steepest - MARGIN && normal.y > MARGIN)
    }

    /// Returns the slide's horizontal velocity after a step with the displacement `made`: obstacles end it.
    pub(super) fn velocity_after_obstacles(&self, slide: Vec3, made: Vec3) -> Vec3 {
        let speed = slide.length();
        if speed == 0.0 {
            return slide;
        }
        let along = made.dot(slide) / (speed * self.dt_s);
        slide * (along.clamp(0.0, speed) / speed)
    }

    /// Returns the slide's horizontal velocity after a step on the ground at `feet`.
    pub(super) fn velocity_on_slope(&self, feet: Vec3, slide: Vec3) -> Vec3 {
        let resting = slide == Vec3::ZERO;
        let Some(normal) = self.probe.ground_normal(feet, feet.y) else {
            return if resting {
                slide
            } else {
                self.braked(slide, 1.0)
            };
        };
        let limit = self.probe.body.max_slope_rad;
        if normal.y >= math::cos(limit) - MARGIN || normal.y <= MARGIN {
            return if resting {
                slide
            } else {
                self.braked(slide, normal.y)
            };
        }
        let level = Vec3::new(normal.x, 0.0, normal.z);
        let steepness = level.length();
        let downhill = level / steepness;
        // dv = g (sin a - tan(max_slope) cos a) h.
        let along = self.gravity_m_s2 * (steepness - math::tan(limit) * normal.y) * self.dt_s;
        // The horizontal part of the velocity along the surface.
        let speed = slide.dot(downhill).max(0.0) + along.max(0.0) * normal.y;
        downhill * speed.min(FASTEST_M_S)
    }

    /// Returns a slide after a step of friction on a surface whose normal has the vertical component `levelness`.
    fn braked(&self, slide: Vec3, levelness: f32) -> Vec3 {
        let friction = math::tan(self.probe.body.max_slope_rad).max(0.1);
        // dv = mu g cos a h.
        let lost = self.gravity_m_s2 * friction * levelness * self.dt_s;
        let speed = slide.length();
        if speed <= lost {
            Vec3::ZERO
        } else {
            slide * (1.0 - lost / speed)
        }
    }
}
