//! The action of putting the held object into a container.

use super::hand_action::{HandAction, HandContext};
use super::request::Target;
use super::stable_pose::StablePose;
use super::target::ResolvedTarget;
use super::{ActionContext, ActionResult, Actor};
use crate::contact::ContactEntity;
use crate::convert::to_rapier;
use crate::dynamics::SupportSurfaceFilter;
use crate::hands::HeldObject;
use crate::model::BodyDefinition;
use crate::outcome::{ActionOutcome, OutcomeCode, done, fail};
use dwell_scene::{Aabb, House, ObjectId, Pose, Receptacle, ReceptacleKind, State};
use glam::Vec3;
use rapier3d::geometry::{Collider, ColliderHandle, Ray};
use rapier3d::math::Pose as RapierPose;
use rapier3d::pipeline::QueryFilter;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Grid points along a side that are tried inside.
const GRID: u32 = 7;
/// Distance beyond the reach at which a hand still gets into a container, m.
const STRETCH_M: f32 = 0.2;
/// Largest share of an object's height that may stick out of an open container; a closed one must hold all of it.
const MAX_PROTRUSION: f32 = 0.6;
/// Openness from which a container's doors count as open.
const OPEN: f32 = 0.7;

/// Steps along the path out of a container.
const PATH_STEPS: u32 = 32;

/// The result of the search for a free spot inside.
#[derive(Default)]
struct InsertionSearch {
    pose: Option<RapierPose>,
    fits: bool,
    in_reach: bool,
    in_sight: bool,
}

/// Puts the held object into a container: a drawer, cupboard, bowl, box or basin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PutIn {
    /// The container.
    pub target: Target,
}

/// The spaces within an object that hold things.
fn spaces_inside(house: &House, object: ObjectId) -> impl Iterator<Item = &Receptacle> {
    let own = house.receptacles.iter();
    own.filter(move |space| space.object == object && space.holding == ReceptacleKind::In)
}

impl HandAction for PutIn {
    fn perform(&self, hand: &mut HandContext<'_>) -> ActionResult {
        hand.context.place_in(hand.state, hand.actor, &self.target)
    }

    fn check(&self, hand: &HandContext<'_>) -> Result<(), Box<ActionOutcome>> {
        let found = hand
            .context
            .container_to_fill(hand.state, hand.actor, &self.target);
        found.map(|_| ())
    }
}

impl ActionContext<'_> {
    /// Returns what the hand holds and the container that it can reach, with the target as it was meant.
    fn container_to_fill(
        &self,
        state: &State,
        actor: Actor<'_>,
        container: &Target,
    ) -> Result<(HeldObject, ObjectId, ResolvedTarget), Box<ActionOutcome>> {
        let grip = self.held_object_of(actor)?;
        let (object, aim) = self.resolve_object_target(state, actor, container)?;
        let name = self.dynamics.name_of(object);
        let refuse = |code, sentence: String| Err(Box::new(fail(code, sentence, Some(object))));
        if grip.object == object {
            let sentence = "A thing cannot be put into itself. Choose something else.";
            return refuse(OutcomeCode::NoSpace, sentence.to_owned());
        }
        if let Some(holder) = state.held_by[object] {
            let sentence = format!(
                "Agent {} holds the {name}. Choose something else.",
                holder.0
            );
            return refuse(OutcomeCode::HeldByOther, sentence);
        }
        if spaces_inside(&self.dynamics.model.house, object)
            .next()
            .is_none()
        {
            let sentence = format!(
                "The {name} holds nothing inside. Choose a drawer, cupboard, bowl, box or basin."
            );
            return refuse(OutcomeCode::NotContainer, sentence);
        }
        match self.check_reach(state, actor, object) {
            Some(refusal) => Err(Box::new(refusal)),
            None => Ok((grip, object, aim)),
        }
    }

    pub(super) fn place_in(
        &mut self,
        state: &mut State,
        actor: Actor<'_>,
        container: &Target,
    ) -> ActionResult {
        let (grip, object, aim) = self.container_to_fill(state, actor, container)?;
        let (held, name) = (
            self.dynamics.name_of(grip.object),
            self.dynamics.name_of(object),
        );
        let refuse = |code, sentence: String| Ok(fail(code, sentence, Some(object)));
        let house = self.dynamics.model.house.clone();
        let mut search = InsertionSearch::default();
        // The space that was pointed at comes first, then the others.
        let meant = |space: &&Receptacle| is_meant(space, &aim, state);
        let (first, rest): (Vec<_>, Vec<_>) = spaces_inside(&house, object).partition(meant);
        for space in first.into_iter().chain(rest) {
            self.search_space(state, actor, grip.body as usize, space, &mut search);
            if search.pose.is_some() {
                break;
            }
        }
        let Some(pose) = search.pose else {
            let shut = house
                .joints_of(object)
                .any(|id| house.joints[id].openness(state.joint_position[id]) < OPEN);
            return match search {
                InsertionSearch { fits: false, .. } => refuse(
                    OutcomeCode::TooLarge,
                    format!("The {held} is too large for the {name}. Choose something roomier."),
                ),
                InsertionSearch {
                    in_reach: false, ..
                } => refuse(
                    OutcomeCode::TooFar,
                    format!("You do not reach into the {name}. Walk closer."),
                ),
                InsertionSearch {
                    in_sight: false, ..
                } if shut => refuse(
                    OutcomeCode::Closed,
                    format!("The {name} is closed. Open it first."),
                ),
                InsertionSearch {
                    in_sight: false, ..
                } => refuse(
                    OutcomeCode::NotVisible,
                    format!("You cannot get into the {name} from here. Step in front of it."),
                ),
                _ => refuse(
                    OutcomeCode::Full,
                    format!(
                        "There is no room left for the {held} in the {name}. Take something out first."
                    ),
                ),
            };
        };
        self.release_at(state, actor, &pose);
        let sentence = format!("You put the {held} in the {name}.");
        Ok(done(OutcomeCode::Done, sentence, Some(object)))
    }

    /// Searches for a spot in one space.
    fn search_space(
        &self,
        state: &State,
        actor: Actor<'_>,
        body: usize,
        space: &Receptacle,
        search: &mut InsertionSearch,
    ) {
        let house = &self.dynamics.model.house;
        let plan = &self.dynamics.model.bodies[body];
        let world_from_part = state.part_pose[space.part];
        let inside = space.space_in_part;
        let outer = house.object_bounds(state, space.object);
        let eye = actor.body.eye_position();
        let reach = actor.body.body.reach_m + STRETCH_M;
        let sticks_out = if house.joints_of(space.object).next().is_some() {
            0.0
        } else {
            MAX_PROTRUSION
        };
        let root = house.objects[space.object].first_part;
        let loose_with_lid = !house.parts[root].fixed
            && house
                .joints_of(space.object)
                .any(|id| house.joints[id].is_openable());
        for stance in self.stable_poses(body) {
            let size = size_in(plan, &stance, &world_from_part);
            let room = inside.size();
            if size.x > room.x || size.z > room.z || size.y * (1.0 - sticks_out) > room.y {
                continue;
            }
            search.fits = true;
            for k in 0..GRID * GRID {
                let share = |k: u32, size: f32, room: f32| {
                    0.5 * size + (room - size) * (k as f32 + 0.5) / GRID as f32
                };
                let x = inside.min.x + share(k % GRID, size.x, room.x);
                let z = inside.min.z + share(k / GRID, size.z, room.z);
                let top = world_from_part.transform_point(Vec3::new(x, inside.max.y, z));
                let levels = self.dynamics.support_heights(
                    body,
                    SupportSurfaceFilter::Any,
                    top,
                    room.y + 0.02,
                );
                for height in levels {
                    let foot = top.with_y(height);
                    let middle = foot + Vec3::Y * (0.5 * stance.size().y);
                    if height + size.y * (1.0 - sticks_out) > top.y {
                        continue;
                    }
                    if (foot - eye).length() > reach {
                        continue;
                    }
                    search.in_reach = true;
                    let inner = bounds_on(&stance, foot);
                    let gets_in = if loose_with_lid {
                        self.can_hand_enter(eye, middle, space.object, &outer, &world_from_part)
                    } else {
                        self.dynamics.first_reach_obstacle(eye, middle).is_none()
                    };
                    if !gets_in || !house.encloses(state, space.object, &outer, &inner) {
                        continue;
                    }
                    search.in_sight = true;
                    if let Ok(pose) = self.stable_pose_at(body, &stance, foot) {
                        search.pose = Some(pose);
                        return;
                    }
                }
            }
        }
    }
}

impl ActionContext<'_> {
    /// Returns whether a hand gets to a point inside a loose object with a lid or a door, whose walls would otherwise be
    /// reached around: on some side the straight path out of it is free of its parts, and the path from there to the eye of
    /// all else.
    fn can_hand_enter(
        &self,
        eye: Vec3,
        inside: Vec3,
        container: ObjectId,
        outer: &Aabb,
        world_from_part: &Pose,
    ) -> bool {
        let house = &self.dynamics.model.house;
        let own = |_: ColliderHandle, collider: &Collider| {
            let part = self.dynamics.entry_of(collider).contact_entity;
            matches!(part, Some(ContactEntity::Part(part)) if house.parts[part].object == container)
        };
        let queries = self
            .dynamics
            .engine
            .queries(QueryFilter::default().predicate(&own));
        let beyond = outer.size().length();
        let sides = [
            Vec3::X,
            Vec3::Y,
            Vec3::Z,
            Vec3::NEG_X,
            Vec3::NEG_Y,
            Vec3::NEG_Z,
        ];
        sides.iter().any(|side| {
            let out = world_from_part.transform_vector(*side);
            let leaves =
                (1..=PATH_STEPS).map(|k| inside + out * (beyond * k as f32 / PATH_STEPS as f32));
            let outside = leaves
                .into_iter()
                .find(|point| !outer.grown(0.01).contains(*point));
            outside.is_some_and(|outside| {
                let ray = Ray::new(inside, outside - inside);
                queries.cast_ray(&ray, 1.0, true).is_none()
                    && self.dynamics.first_reach_obstacle(eye, outside).is_none()
            })
        })
    }
}

/// Returns whether a space is the one that was pointed at: by its part, or by the point.
fn is_meant(space: &Receptacle, aim: &ResolvedTarget, state: &State) -> bool {
    match (aim.point, aim.part) {
        (Some(point), _) => {
            let point_in_part = state.part_pose[space.part].inverse().transform_point(point);
            space.space_in_part.grown(0.05).contains(point_in_part)
        }
        (None, Some(part)) => space.part == part,
        (None, None) => false,
    }
}

/// Returns the edges of a stable pose along a part's axes, m.
fn size_in(plan: &BodyDefinition, stance: &StablePose, world_from_part: &Pose) -> Vec3 {
    let turned = to_rapier(&Pose::new(
        Vec3::ZERO,
        world_from_part.rotation.inverse() * stance.rotation,
    ));
    plan.bounds(&turned).size()
}

/// Returns the box around a stable pose on a foot point, m.
fn bounds_on(stance: &StablePose, foot: Vec3) -> Aabb {
    let half = 0.5 * stance.size();
    let middle = foot + Vec3::Y * half.y;
    Aabb::new(middle - half, middle + half)
}
