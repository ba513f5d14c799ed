//! Collision queries of an agent's body.
//!
//! For walking, an agent is an upright cylinder whose lower end hovers at the height of the steps that it climbs, and a
//! foot that probes the ground below. The cylinder is at least as large as the capsule that others collide with, so that
//! the capsule can enter nothing that the cylinder clears.

use crate::body::{BodyHandle, BodyStatus};
use crate::contact::{ColliderMetadata, CollisionExclusions, entry_index};
use crate::engine::RapierWorld;
use crate::model::PhysicsModel;
use dwell_scene::{AgentBody, AgentId};
use glam::Vec3;
use rapier3d::dynamics::RigidBody;
use rapier3d::geometry::{Ball, Collider, ColliderHandle, Cylinder, Ray};
use rapier3d::math::Pose as RapierPose;
use rapier3d::parry::query::ShapeCastOptions;
use rapier3d::pipeline::QueryFilter;

/// Gap that the cylinder keeps from obstacles, m.
pub(crate) const SKIN_WIDTH_M: f32 = 0.008;
/// Gap between the cylinder's skin and the edge that its foot has rolled off, m.
const CLEAR_M: f32 = 0.002;
/// Height of the hovering cylinder above the highest step, m; more than the skin, so that a step never catches it.
const HOVER_M: f32 = 0.015;
/// Inset of the core, which must never overlap anything, m.
const CORE_MARGIN_M: f32 = 0.03;
/// Mass of the heaviest free body that is pushed instead of walked around, kg.
const HEAVIEST_PUSHED_KG: f32 = 30.0;
/// Height up to which light objects are stepped on, m.
const SOLE_M: f32 = 0.05;
/// Search range above and below the foot's lowest point for the surface under its middle, m; below by the foot's radius
/// more, because on a slope the surface lies lower there.
const ABOVE_GROUND_M: f32 = 0.1;
const BELOW_GROUND_M: f32 = 0.1;

/// Another agent's cylinder.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AgentCylinder {
    pub(crate) feet: Vec3,
    pub(crate) radius_m: f32,
    pub(crate) height_m: f32,
}

/// The obstacle that stops a movement.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SweepHit {
    /// Share of the motion that is free, 0 to 1.
    pub(crate) fraction: f32,
    /// Away from the obstacle, in world space.
    pub(crate) normal: Vec3,
    /// Contact point, m.
    pub(crate) point: Vec3,
    /// The light body that is hit; `None` for an obstacle that cannot be pushed.
    pub(crate) pushable_body: Option<u32>,
}

/// The kind of obstacle that a collider is to an agent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ObstacleKind {
    /// Itself, another agent, or its held object.
    Ignored,
    /// An obstacle that cannot be pushed.
    Immovable,
    /// A body that can be pushed.
    Pushable(u32),
}

/// The surroundings of one agent.
pub(crate) struct AgentQueries<'a> {
    pub(crate) engine: &'a RapierWorld,
    pub(crate) model: &'a PhysicsModel,
    pub(crate) entries: &'a [ColliderMetadata],
    pub(crate) bodies: &'a [BodyHandle],
    pub(crate) statuses: &'a [BodyStatus],
    pub(crate) excluded: &'a CollisionExclusions,
    pub(crate) others: &'a [AgentCylinder],
    pub(crate) agent: AgentId,
    pub(crate) body: AgentBody,
}

impl AgentQueries<'_> {
    /// Returns the kind of obstacle that a collider is.
    fn obstacle_kind(&self, collider: &Collider) -> ObstacleKind {
        let Some(entry) = self.entries.get(entry_index(collider)) else {
            return ObstacleKind::Ignored;
        };
        if entry.agent().is_some() {
            return ObstacleKind::Ignored;
        }
        let Some(body) = entry.body else {
            return ObstacleKind::Immovable;
        };
        let carriers = &self.excluded.carriers;
        if carriers.binary_search(&(body, self.agent)).is_ok() {
            return ObstacleKind::Ignored;
        }
        let light = self.statuses[body as usize] == BodyStatus::Free
            && (self.model.bodies[body as usize].joint.is_some()
                || self.mass_kg(body) <= HEAVIEST_PUSHED_KG);
        if light {
            ObstacleKind::Pushable(body)
        } else {
            ObstacleKind::Immovable
        }
    }

    pub(crate) fn mass_kg(&self, body: u32) -> f32 {
        let handle = self.bodies[body as usize].handle;
        self.engine.bodies.get(handle).map_or(0.0, RigidBody::mass)
    }

    fn lower_end(&self, light: bool) -> f32 {
        let solid = (self.body.step_height_m + HOVER_M).min(self.body.height_m - 0.1);
        if light { solid.min(SOLE_M) } else { solid }
    }

    /// Returns the cylinder and its centre above the feet.
    fn cylinder(&self, light: bool) -> (Cylinder, f32) {
        let low = self.lower_end(light);
        let half = 0.5 * (self.body.height_m - low);
        (Cylinder::new(half, self.body.radius_m), low + half)
    }

    /// Returns the first obstacle of a motion.
    pub(crate) fn cast(&self, feet: Vec3, motion: Vec3) -> Option<SweepHit> {
        let hits = [
            self.cast_kind(feet, motion, false),
            self.cast_kind(feet, motion, true),
        ];
        let shells = self
            .others
            .iter()
            .map(|shell| self.cast_shell(feet, motion, shell));
        hits.into_iter()
            .chain(shells)
            .flatten()
            .min_by(|a, b| a.fraction.total_cmp(&b.fraction))
    }

    fn cast_kind(&self, feet: Vec3, motion: Vec3, light: bool) -> Option<SweepHit> {
        let predicate = |_: ColliderHandle, collider: &Collider| match self.obstacle_kind(collider)
        {
            ObstacleKind::Ignored => false,
            ObstacleKind::Immovable => !light,
            ObstacleKind::Pushable(_) => light,
        };
        let (cylinder, center) = self.cylinder(light);
        let options = ShapeCastOptions {
            max_time_of_impact: 1.0,
            target_distance: SKIN_WIDTH_M,
            stop_at_penetration: false,
            compute_impact_geometry_on_penetration: true,
        };
        let queries = self
            .engine
            .queries(QueryFilter::default().predicate(&predicate));
        let place = RapierPose::from_translation(feet + Vec3::Y * center);
        let (handle, hit) = queries.cast_shape(&place, motion, &cylinder, options)?;
        let collider = self.engine.colliders.get(handle)?;
        Some(SweepHit {
            fraction: hit.time_of_impact.clamp(0.0, 1.0),
            normal: hit.normal1,
            point: hit.witness1,
            pushable_body: match self.obstacle_kind(collider) {
                ObstacleKind::Pushable(body) => Some(body),
                _ => None,
            },
        })
    }

    /// Sweeps one upright cylinder against another.
    fn cast_shell(&self, feet: Vec3, motion: Vec3, shell: &AgentCylinder) -> Option<SweepHit> {
        let apart =
            feet.y >= shell.feet.y + shell.height_m || shell.feet.y >= feet.y + self.body.height_m;
        let from = Vec3::new(feet.x - shell.feet.x, 0.0, feet.z - shell.feet.z);
        let reach = self.body.radius_m + shell.radius_m + SKIN_WIDTH_M;
        let (a, b) = (motion.length_squared(), from.dot(motion));
        let c = from.length_squared() - reach * reach;
        if apart || b >= 0.0 || a == 0.0 {
            return None;
        }
        let fraction = if c <= 0.0 {
            0.0
        } else {
            let discriminant = b * b - a * c;
            if discriminant < 0.0 {
                return None;
            }
            (-b - discriminant.sqrt()) / a
        };
        let at = from + motion * fraction;
        (fraction <= 1.0).then(|| SweepHit {
            fraction,
            normal: at.normalize_or(-motion.normalize_or_zero()),
            point: shell.feet + at * (shell.radius_m / reach),
            pushable_body: None,
        })
    }

    /// Returns the share of `down_m` that the cylinder can go down.
    pub(crate) fn drop_fraction(&self, feet: Vec3, down_m: f32) -> f32 {
        let hit = self.cast_kind(feet, Vec3::NEG_Y * down_m, false);
        hit.map_or(1.0, |hit| hit.fraction)
    }

    /// Returns the share of `up_m` that the cylinder can go up.
    pub(crate) fn rise_fraction(&self, feet: Vec3, up_m: f32) -> f32 {
        let hit = self.cast_kind(feet, Vec3::Y * up_m, false);
        hit.map_or(1.0, |hit| hit.fraction)
    }

    /// Returns whether the cylinder can rise by `up_m`.
    pub(crate) fn can_rise(&self, feet: Vec3, up_m: f32) -> bool {
        self.cast_kind(feet, Vec3::Y * up_m, false).is_none()
    }

    fn core(&self) -> (Cylinder, f32) {
        let (cylinder, center) = self.cylinder(false);
        let radius = (cylinder.radius - CORE_MARGIN_M).max(0.5 * cylinder.radius);
        let half = (cylinder.half_height - CORE_MARGIN_M).max(0.5 * cylinder.half_height);
        (Cylinder::new(half, radius), center)
    }

    /// Returns the radius of the core.
    pub(crate) fn core_radius_m(&self) -> f32 {
        self.core().0.radius
    }

    /// Returns whether the core overlaps something immovable.
    pub(crate) fn is_core_blocked(&self, feet: Vec3) -> bool {
        self.overlaps(feet, self.core())
    }

    /// Returns whether the whole cylinder overlaps something immovable, or another agent.
    pub(crate) fn is_cylinder_blocked(&self, feet: Vec3) -> bool {
        let beside = |shell: &AgentCylinder| {
            let apart = (shell.feet - feet).with_y(0.0).length();
            apart < self.body.radius_m + shell.radius_m
                && shell.feet.y < feet.y + self.body.height_m
                && feet.y < shell.feet.y + shell.height_m
        };
        self.others.iter().any(beside) || self.overlaps(feet, self.cylinder(false))
    }

    fn overlaps(&self, feet: Vec3, (cylinder, center): (Cylinder, f32)) -> bool {
        let predicate = |_: ColliderHandle, collider: &Collider| {
            self.obstacle_kind(collider) == ObstacleKind::Immovable
        };
        let queries = self
            .engine
            .queries(QueryFilter::default().predicate(&predicate));
        let place = RapierPose::from_translation(feet + Vec3::Y * center);
        queries.intersect_shape(place, &cylinder).next().is_some()
    }

    /// Returns the push, at most `most_m` long and horizontal, that leads out of an overlap of the core; `None` if a
    /// surface is in the way.
    pub(crate) fn exit_displacement(&self, feet: Vec3, most_m: f32) -> Option<Vec3> {
        let predicate = |_: ColliderHandle, collider: &Collider| {
            self.obstacle_kind(collider) == ObstacleKind::Immovable
        };
        let queries = self
            .engine
            .queries(QueryFilter::default().predicate(&predicate));
        let (core, center) = self.core();
        let middle = feet + Vec3::Y * center;
        let place = RapierPose::from_translation(middle);
        let mut out = Vec3::ZERO;
        for (_, collider) in queries.intersect_shape(place, &core) {
            let contact = queries.dispatcher.contact(
                &collider.position().inv_mul(&place),
                collider.shape(),
                &core,
                0.0,
            );
            if let Ok(Some(contact)) = contact
                && contact.dist < 0.0
            {
                let normal = collider.position().rotation * contact.normal1;
                let level = Vec3::new(normal.x, 0.0, normal.z).normalize_or_zero();
                out += level * (-contact.dist + 1e-3);
            }
        }
        let out = out.clamp_length_max(most_m);
        let ray = Ray::new(middle, out);
        let free = out != Vec3::ZERO && queries.cast_ray(&ray, 1.0, false).is_none();
        free.then_some(out)
    }

    /// Returns half of the body's radius; less for one that climbs only low steps, so that a foot that rolls off an edge
    /// does not let the cylinder down on it.
    fn foot_radius_m(&self) -> f32 {
        let most = self.lower_end(false) - SKIN_WIDTH_M - CLEAR_M;
        (0.5 * self.body.radius_m).min(most).max(1e-3)
    }

    /// Returns the height of the ground under the feet, between the highest step above them and `down_m` below, m.
    pub(crate) fn ground(&self, feet: Vec3, down_m: f32) -> Option<f32> {
        let predicate = |_: ColliderHandle, collider: &Collider| {
            self.obstacle_kind(collider) != ObstacleKind::Ignored
        };
        let queries = self
            .engine
            .queries(QueryFilter::default().predicate(&predicate));
        let radius = self.foot_radius_m();
        let start = feet + Vec3::Y * (self.lower_end(false) + radius);
        let fall = self.lower_end(false) + down_m;
        let options = ShapeCastOptions {
            max_time_of_impact: 1.0,
            target_distance: 0.0,
            stop_at_penetration: true,
            compute_impact_geometry_on_penetration: false,
        };
        let place = RapierPose::from_translation(start);
        let (_, hit) =
            queries.cast_shape(&place, Vec3::NEG_Y * fall, &Ball::new(radius), options)?;
        Some(start.y - radius - fall * hit.time_of_impact)
    }

    /// Returns whether some surface lies under the feet, however deep: agents do not walk out of the house into the void.
    pub(crate) fn has_surface_below(&self, feet: Vec3) -> bool {
        let predicate = |_: ColliderHandle, collider: &Collider| {
            let entry = self.entries.get(entry_index(collider));
            entry.is_some_and(|entry| entry.contact_entity.is_some())
                && self.obstacle_kind(collider) != ObstacleKind::Ignored
        };
        let queries = self
            .engine
            .queries(QueryFilter::default().predicate(&predicate));
        let start = feet + Vec3::Y * self.lower_end(false);
        let deepest = (start.y - self.model.bounds.min.y).max(0.0) + ABOVE_GROUND_M;
        let ray = Ray::new(start, Vec3::NEG_Y);
        queries.cast_ray(&ray, deepest, true).is_some()
    }

    /// Returns the unit normal of the surface directly under the middle, on its upper side; `None` without one near `height_m`.
    pub(crate) fn ground_normal(&self, feet: Vec3, height_m: f32) -> Option<Vec3> {
        let predicate = |_: ColliderHandle, collider: &Collider| {
            self.obstacle_kind(collider) != ObstacleKind::Ignored
        };
        let queries = self
            .engine
            .queries(QueryFilter::default().predicate(&predicate));
        let start = Vec3::new(feet.x, height_m + ABOVE_GROUND_M, feet.z);
        let ray = Ray::new(start, Vec3::NEG_Y);
        let longest = ABOVE_GROUND_M + BELOW_GROUND_M + self.foot_radius_m();
        let (_, hit) = queries.cast_ray_and_get_normal(&ray, longest, true)?;
        let up = if hit.normal.y < 0.0 {
            -hit.normal
        } else {
            hit.normal
        };
        (hit.time_of_impact > 0.0).then_some(up)
    }

    /// Returns whether there is room above for a body that is taller by `up_m`.
    pub(crate) fn has_headroom(&self, feet: Vec3, up_m: f32) -> bool {
        let rise = Vec3::Y * up_m;
        let top = feet.y + self.body.height_m;
        let under_another = self.others.iter().any(|shell| {
            let apart = (shell.feet - feet).with_y(0.0).length();
            apart < self.body.radius_m + shell.radius_m
                && shell.feet.y < top + up_m
                && shell.feet.y + shell.height_m > top
        });
        !under_another
            && self.cast_kind(feet, rise, false).is_none()
            && self.cast_kind(feet, rise, true).is_none()
    }
}
