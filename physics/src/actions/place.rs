//! The action of placing the held object on a support.

use super::hand_action::{HandAction, HandContext};
use super::request::Target;
use super::stable_pose::StablePose;
use super::{ActionContext, ActionResult, Actor};
use crate::dynamics::SupportSurfaceFilter;
use crate::hands::HeldObject;
use crate::outcome::{ActionOutcome, OutcomeCode, done, fail};
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::space::rotation_from_yaw_pitch;
use dwell_scene::{Entity, ObjectId, State, SurfaceOwner};
use glam::Vec3;
use rapier3d::math::Pose as RapierPose;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Grid points along a side that are tried on top of an object.
const GRID: u32 = 13;
/// Spacing of the rings of points that are tried around a point, m, and their number.
const RING_M: f32 = 0.06;
const RINGS: u32 = 8;
/// Directions of view, across and down, in which a surface is searched.
const LOOKS: [i32; 2] = [9, 9];
const LOOK_STEP_RAD: f32 = 0.1;
/// Height above an object's top at which downward rays start, m.
const ABOVE_M: f32 = 0.5;

/// The position of a placed object, and its support.
struct ObjectPlacement {
    pose: RapierPose,
    on: Option<ObjectId>,
    name: String,
}

/// Places the held object at a free, stable spot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Place {
    /// The support: an object, or the floor that a ray hits (the spot nearest to the hit). Without it, any level surface in
    /// view, the one nearest to the middle of the view first.
    pub target: Option<Target>,
}

impl Place {
    /// Places the held object on a support.
    pub fn on(target: impl Into<Target>) -> Self {
        Self {
            target: Some(target.into()),
        }
    }
}

impl HandAction for Place {
    fn perform(&self, hand: &mut HandContext<'_>) -> ActionResult {
        if hand.context.grip_of(hand.actor)?.edge().is_some() {
            return Ok(hand.context.release(hand.state, hand.actor.id));
        }
        hand.context
            .place_on(hand.state, hand.actor, self.target.as_ref())
    }

    fn check(&self, hand: &HandContext<'_>) -> Result<(), Box<ActionOutcome>> {
        hand.context.grip_of(hand.actor).map(|_| ())
    }
}

impl ActionContext<'_> {
    pub(super) fn place_on(
        &mut self,
        state: &mut State,
        actor: Actor<'_>,
        on: Option<&Target>,
    ) -> ActionResult {
        let grip = self.held_object_of(actor)?;
        let stances = self.stable_poses(grip.body as usize);
        let spot = match on {
            Some(target) => self.spot_on(state, actor, &grip, &stances, target)?,
            None => self.spot_in_view(actor, &grip, &stances)?,
        };
        self.release_at(state, actor, &spot.pose);
        let sentence = format!(
            "You put the {} on the {}.",
            self.dynamics.name_of(grip.object),
            spot.name
        );
        Ok(done(OutcomeCode::Done, sentence, spot.on))
    }

    /// Returns the agent's grip of what it holds alone, or the refusal for an empty hand and for the edge of a large thing.
    pub(super) fn held_object_of(
        &self,
        actor: Actor<'_>,
    ) -> Result<HeldObject, Box<ActionOutcome>> {
        let grip = self.grip_of(actor)?;
        if grip.edge().is_none() {
            return Ok(grip);
        }
        let sentence = format!(
            "You hold the {} by its edge; it can only be set down. Drop it.",
            self.dynamics.name_of(grip.object)
        );
        Err(Box::new(fail(
            OutcomeCode::TooLarge,
            sentence,
            Some(grip.object),
        )))
    }

    /// Returns the agent's grip, or the refusal for an empty hand.
    pub(super) fn grip_of(&self, actor: Actor<'_>) -> Result<HeldObject, Box<ActionOutcome>> {
        let grip = self
            .hands
            .held_objects
            .iter()
            .find(|grip| grip.agent == actor.id);
        grip.copied().ok_or_else(|| {
            let sentence = "You hold nothing. Pick something first.";
            Box::new(fail(OutcomeCode::HandEmpty, sentence, None))
        })
    }

    /// Opens a hand and leaves the held object under a pose, at rest.
    pub(super) fn release_at(&mut self, state: &mut State, actor: Actor<'_>, pose: &RapierPose) {
        let Some(place) = self
            .hands
            .held_objects
            .iter()
            .position(|grip| grip.agent == actor.id)
        else {
            return;
        };
        let handle = self.dynamics.bodies[self.hands.held_objects[place].body as usize].handle;
        self.hands.open_hand(self.dynamics, state, place);
        if let Some(rigid) = self.dynamics.engine.bodies.get_mut(handle) {
            rigid.set_position(*pose, true);
            rigid.set_linvel(Vec3::ZERO, true);
            rigid.set_angvel(Vec3::ZERO, true);
        }
        self.dynamics.flush();
        self.articulation
            .write_bodies_and_joints(self.dynamics, state);
    }

    fn spot_on(
        &self,
        state: &State,
        actor: Actor<'_>,
        grip: &HeldObject,
        stances: &[StablePose],
        target: &Target,
    ) -> Result<ObjectPlacement, Box<ActionOutcome>> {
        let refuse = |code, sentence: String, on| Err(Box::new(fail(code, sentence, on)));
        let held = self.dynamics.name_of(grip.object);
        let aim = self.resolve_target(state, actor, target)?;
        let (ground, on, name) = match aim.entity {
            Entity::Object(object) if object == grip.object => {
                let sentence = "A thing cannot stand on itself. Choose something else.";
                return refuse(OutcomeCode::NoSpace, sentence.to_owned(), Some(object));
            }
            Entity::Object(object) => (
                SupportSurfaceFilter::Object(object),
                Some(object),
                self.dynamics.name_of(object),
            ),
            Entity::Structure(id) => {
                let name = self.surface_name(SurfaceOwner::Structure(id));
                (SupportSurfaceFilter::Structure, None, name)
            }
            _ => {
                let sentence = "Nothing can be put on somebody. Choose a surface.".to_owned();
                return refuse(OutcomeCode::NotAnObject, sentence, None);
            }
        };
        let eye = actor.body.eye_position();
        let reach = actor.body.body.reach_m;
        if let Some(object) = on {
            if let Some(holder) = state.held_by[object] {
                let sentence = format!(
                    "Agent {} holds the {name}. Choose something else.",
                    holder.0
                );
                return refuse(OutcomeCode::HeldByOther, sentence, on);
            }
            if let Some(refusal) = self.check_reach(state, actor, object) {
                return Err(Box::new(refusal));
            }
        }
        let feet = match (aim.point, on) {
            (Some(point), _) => self.ring_points_around(grip.body as usize, ground, point),
            (None, Some(object)) => {
                self.placement_points_on(state, grip.body as usize, object, eye, reach)
            }
            (None, None) => {
                let below = eye + dwell_scene::space::forward_from_yaw(actor.body.yaw_rad) * 0.5;
                let floor = actor.body.position.y;
                self.ring_points_around(
                    grip.body as usize,
                    ground,
                    Vec3::new(below.x, floor, below.z),
                )
            }
        };
        let pose = self.first_spot(actor, grip.body as usize, stances, &feet);
        pose.map(|pose| ObjectPlacement { pose, on, name: name.clone() }).ok_or_else(|| {
            let sentence = format!(
                "There is no free space for the {held} on the {name} within your reach and sight. Clear it or walk around it."
            );
            Box::new(fail(OutcomeCode::NoSpace, sentence, on))
        })
    }

    /// Returns a spot on any level surface in view, nearest to the middle of the view.
    fn spot_in_view(
        &self,
        actor: Actor<'_>,
        grip: &HeldObject,
        stances: &[StablePose],
    ) -> Result<ObjectPlacement, Box<ActionOutcome>> {
        let house = &self.dynamics.model.house;
        let held = house.entity_of_object(grip.object);
        let eye = actor.body.eye_position();
        let (yaw, pitch) = (actor.body.yaw_rad, actor.body.pitch_rad);
        let half = LOOKS.map(|count| count / 2);
        let mut looks: Vec<(i32, i32, i32)> = (-half[0]..=half[0])
            .flat_map(|x| (-half[1]..=half[1]).map(move |y| (x * x + y * y, x, y)))
            .collect();
        looks.sort_unstable();
        for (_, x, y) in looks {
            let turned = rotation_from_yaw_pitch(
                yaw + LOOK_STEP_RAD * x as f32,
                pitch + LOOK_STEP_RAD * y as f32,
            );
            let ray = Ray::new(eye, turned * Vec3::NEG_Z).with_range(0.0, actor.body.body.reach_m);
            let Some(hit) = actor.rays.closest_excluding(&ray, RayMask::EYE, held) else {
                continue;
            };
            let surface = actor.rays.surface(&hit);
            if surface.normal.y.abs() < 0.9 {
                continue;
            }
            let (ground, on) = match surface.owner {
                SurfaceOwner::Structure(_) => (SupportSurfaceFilter::Structure, None),
                SurfaceOwner::Part(part) => {
                    let object = house.parts[part].object;
                    (SupportSurfaceFilter::Object(object), Some(object))
                }
            };
            let foot = ray.point_at(hit.distance_m) + Vec3::Y * RING_M;
            let feet: Vec<Vec3> = self
                .dynamics
                .support_heights(grip.body as usize, ground, foot, 2.0 * RING_M)
                .into_iter()
                .map(|height| Vec3::new(foot.x, height, foot.z))
                .collect();
            if let Some(pose) = self.first_spot(actor, grip.body as usize, stances, &feet) {
                let name = self.surface_name(surface.owner);
                return Ok(ObjectPlacement { pose, on, name });
            }
        }
        let sentence = format!(
            "You see no free surface for the {} within your reach. Turn towards one.",
            self.dynamics.name_of(grip.object)
        );
        Err(Box::new(fail(OutcomeCode::NoSpace, sentence, None)))
    }

    /// Returns the first of `feet` on which the body can stand, within reach and sight; upright before lying.
    fn first_spot(
        &self,
        actor: Actor<'_>,
        body: usize,
        stances: &[StablePose],
        feet: &[Vec3],
    ) -> Option<RapierPose> {
        let eye = actor.body.eye_position();
        let reach = actor.body.body.reach_m;
        stances.iter().find_map(|stance| {
            feet.iter().find_map(|foot| {
                let middle = *foot + Vec3::Y * (0.5 * stance.size().y);
                let near = (*foot - eye).length() <= reach;
                if !near || self.dynamics.first_reach_obstacle(eye, middle).is_some() {
                    return None;
                }
                self.stable_pose_at(body, stance, *foot).ok()
            })
        })
    }

    /// Returns all points on an object's level surfaces within reach, the nearest to the eye first.
    fn placement_points_on(
        &self,
        state: &State,
        body: usize,
        object: ObjectId,
        eye: Vec3,
        reach_m: f32,
    ) -> Vec<Vec3> {
        let all = self.dynamics.model.house.object_bounds(state, object);
        let low = all.min.max(eye - Vec3::splat(reach_m));
        let high = all.max.min(eye + Vec3::splat(reach_m));
        let mut feet = Vec::new();
        for k in 0..GRID * GRID {
            let share = |k: u32| (k as f32 + 0.5) / GRID as f32;
            let x = low.x + (high.x - low.x) * share(k % GRID);
            let z = low.z + (high.z - low.z) * share(k / GRID);
            let from = Vec3::new(x, all.max.y + ABOVE_M, z);
            let down_m = all.size().y + 2.0 * ABOVE_M;
            let levels = self.dynamics.support_heights(
                body,
                SupportSurfaceFilter::Object(object),
                from,
                down_m,
            );
            feet.extend(levels.into_iter().map(|height| Vec3::new(x, height, z)));
        }
        feet.retain(|foot| (*foot - eye).length() <= reach_m);
        feet.sort_by(|a, b| (*a - eye).length().total_cmp(&(*b - eye).length()));
        feet
    }

    /// Returns points on rings around a point, the nearest first.
    fn ring_points_around(
        &self,
        body: usize,
        ground: SupportSurfaceFilter,
        point: Vec3,
    ) -> Vec<Vec3> {
        let mut feet = Vec::new();
        for ring in 0..RINGS {
            let count = if ring == 0 { 1 } else { 6 * ring };
            for k in 0..count {
                let angle = std::f32::consts::TAU * k as f32 / count as f32;
                let (s, c) = dwell_scene::math::sin_cos(angle);
                let radius = RING_M * ring as f32;
                let from = point + Vec3::new(radius * c, RING_M, radius * s);
                let levels = self
                    .dynamics
                    .support_heights(body, ground, from, 2.0 * RING_M);
                feet.extend(levels.first().map(|height| from.with_y(*height)));
            }
        }
        feet
    }
}
