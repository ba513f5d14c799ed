//! Stable poses of an object, and the support that they need.

use super::ActionContext;
use crate::dynamics::{HolderCollision, SupportSurfaceFilter};
use crate::model::BodyDefinition;
use glam::{Quat, Vec3};
use rapier3d::math::Pose as RapierPose;
use std::f32::consts::{FRAC_PI_2, TAU};

/// Number of directions in which an object must not tip.
const DIRECTIONS: usize = 16;
/// Slope up to which a low point of an object belongs to its sole, rad.
const TILT_RAD: f32 = 0.02;
/// Least distance of the centre of mass inside the support polygon, m; for objects that stand on a line or a point, the
/// largest distance outside it.
const SUPPORT_MARGIN_M: f32 = 0.002;
const ROUND_M: f32 = -5e-4;
/// Gap left under a placed object, m.
const GAP_M: f32 = 5e-4;
/// Largest unevenness of the ground under a sole, m.
const MAX_UNEVENNESS_M: f32 = 0.002;
/// Range of the ground search above and below a point of the sole, m.
const GROUND_PROBE_M: f32 = 0.02;

/// An object in a stable orientation. All points are relative to the body's origin, in world axes, m.
#[derive(Clone, Debug)]
pub(super) struct StablePose {
    pub(super) rotation: Quat,
    /// The lower corner of the box around it.
    pub(super) min: Vec3,
    pub(super) max: Vec3,
    center_of_mass: Vec3,
    /// The outermost point of the sole in each direction.
    sole: [Vec3; DIRECTIONS],
}

fn horizontal_direction(k: usize) -> Vec3 {
    let (s, c) = dwell_scene::math::sin_cos(TAU * k as f32 / DIRECTIONS as f32);
    Vec3::new(c, 0.0, s)
}

/// Returns the point of a body that is furthest along a direction, relative to its origin.
fn outermost(plan: &BodyDefinition, rotation: Quat, direction: Vec3) -> Option<Vec3> {
    let place = RapierPose::from_rotation(rotation);
    plan.pieces
        .iter()
        .filter_map(|piece| {
            let at = place * piece.pose;
            let map = piece.shape.as_support_map()?;
            let local = map.local_support_point(at.rotation.inverse() * direction);
            Some(at * local)
        })
        .max_by(|a, b| a.dot(direction).total_cmp(&b.dot(direction)))
}

impl StablePose {
    fn new(plan: &BodyDefinition, rotation: Quat, center_of_mass_in_body: Vec3) -> Option<Self> {
        let bounds = plan.bounds(&RapierPose::from_rotation(rotation));
        let mut sole = [Vec3::ZERO; DIRECTIONS];
        for (k, point) in sole.iter_mut().enumerate() {
            let direction = Vec3::NEG_Y + horizontal_direction(k) * TILT_RAD;
            *point = outermost(plan, rotation, direction)?;
        }
        Some(Self {
            rotation,
            min: bounds.min,
            max: bounds.max,
            center_of_mass: rotation * center_of_mass_in_body,
            sole,
        })
    }

    /// As [`Self::new`]; `None` where the object topples by itself.
    pub(super) fn resting(
        plan: &BodyDefinition,
        rotation: Quat,
        center_of_mass_in_body: Vec3,
    ) -> Option<Self> {
        let stance = Self::new(plan, rotation, center_of_mass_in_body)?;
        stance.stands(&[true; DIRECTIONS]).then_some(stance)
    }

    pub(super) fn size(&self) -> Vec3 {
        self.max - self.min
    }

    /// Returns the body's pose when the middle of its foot is on a point.
    pub(super) fn pose_on(&self, foot: Vec3) -> RapierPose {
        let middle = 0.5 * (self.min + self.max);
        let base = Vec3::new(middle.x, self.min.y - GAP_M, middle.z);
        let mut pose = RapierPose::from_rotation(self.rotation);
        pose.translation = foot - base;
        pose
    }

    /// Returns the distance of the centre of mass inside the supported part of the sole, in the worst direction, m.
    fn stability_margin_m(&self, carried: &[bool; DIRECTIONS]) -> f32 {
        let points = || {
            self.sole
                .iter()
                .zip(carried)
                .filter(|(_, c)| **c)
                .map(|(p, _)| *p)
        };
        (0..DIRECTIONS)
            .map(|k| {
                let out = horizontal_direction(k);
                points()
                    .map(|point| (point - self.center_of_mass).dot(out))
                    .fold(f32::NEG_INFINITY, f32::max)
            })
            .fold(f32::INFINITY, f32::min)
    }

    /// Returns whether an object in this pose on level ground is stable, or at least stays when nothing touches it.
    fn stands(&self, carried: &[bool; DIRECTIONS]) -> bool {
        let whole = self.stability_margin_m(&[true; DIRECTIONS]);
        let least = if whole >= SUPPORT_MARGIN_M {
            SUPPORT_MARGIN_M
        } else {
            ROUND_M
        };
        self.stability_margin_m(carried) >= least
    }
}

impl ActionContext<'_> {
    /// Returns the poses in which a body may be put down: upright as in the house and as held, a quarter turned, then lying
    /// on each side. Each once, without those that topple by themselves.
    pub(super) fn stable_poses(&self, body: usize) -> Vec<StablePose> {
        let plan = &self.dynamics.model.bodies[body];
        let Some(rigid) = self
            .dynamics
            .engine
            .bodies
            .get(self.dynamics.bodies[body].handle)
        else {
            return Vec::new();
        };
        let now = rigid.position().rotation;
        let com = rigid.mass_properties().local_mprops.local_com;
        let up_in_body = self.dynamics.model.house.parts[plan.root()]
            .world_from_part
            .rotation
            .inverse()
            * Vec3::Y;
        let mut stances: Vec<StablePose> = Vec::new();
        let sides = [
            up_in_body,
            Vec3::Y,
            Vec3::Z,
            Vec3::X,
            -up_in_body,
            Vec3::NEG_Y,
            Vec3::NEG_Z,
            Vec3::NEG_X,
        ];
        for up in sides {
            let upright = (Quat::from_rotation_arc((now * up).normalize_or(Vec3::Y), Vec3::Y)
                * now)
                .normalize();
            for turn in [0.0, FRAC_PI_2] {
                let rotation =
                    (dwell_scene::space::rotation_from_yaw_pitch(turn, 0.0) * upright).normalize();
                if stances
                    .iter()
                    .any(|s| s.rotation.dot(rotation).abs() > 0.9999)
                {
                    continue;
                }
                stances.extend(StablePose::resting(plan, rotation, com));
            }
        }
        stances
    }

    /// Returns the resting pose of a body with its foot's middle on a point: free of overlaps, on supporting ground. The error
    /// is the obstacle's name, or `None` when the body would not stay.
    pub(super) fn stable_pose_at(
        &self,
        body: usize,
        stance: &StablePose,
        foot: Vec3,
    ) -> Result<RapierPose, Option<String>> {
        let pose = stance.pose_on(foot);
        if let Some(blocker) = self
            .dynamics
            .first_overlap(body, &pose, HolderCollision::Included)
        {
            return Err(Some(self.name_of_collider(blocker)));
        }
        let carried = stance.sole.map(|point| {
            let above = pose.translation + point + Vec3::Y * GROUND_PROBE_M;
            let bottom = foot.y + (point.y - stance.min.y);
            self.dynamics
                .support_heights(body, SupportSurfaceFilter::Any, above, 2.0 * GROUND_PROBE_M)
                .iter()
                .any(|height| (height - bottom).abs() <= MAX_UNEVENNESS_M)
        });
        if !stance.stands(&carried) {
            return Err(None);
        }
        self.simulated_rest_pose(body, &pose).ok_or(None)
    }
}
