//! The actions of pushing and pulling: a force for a short time, and the distance that the object moved.

use super::hand_action::{HandAction, HandContext};
use super::request::Target;
use super::target::ResolvedTarget;
use super::{ActionContext, ActionResult, Actor};
use crate::body::BodyStatus;
use crate::dynamics::Dynamics;
use crate::outcome::{ActionOutcome, DelayedOutcome, OutcomeCode, done, fail};
use dwell_scene::{AgentId, ObjectId, State};
use glam::Vec3;
use rapier3d::dynamics::RigidBody;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Duration of a push, s.
const PUSH_S: f32 = 0.25;
/// Distance beyond the reach at which a hand loses the object that it pushes, m.
const SLACK_M: f32 = 0.3;
/// Least displacement that counts as moved, m.
const MOVED_M: f32 = 0.01;

/// A push or pull in progress.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct OngoingPush {
    agent: AgentId,
    object: ObjectId,
    body: u32,
    /// Contact point of the hand on the body, m.
    point_in_body: Vec3,
    /// In world space, N.
    force: Vec3,
    left_s: f32,
    /// Initial contact point of the hand, m.
    start: Vec3,
    /// Set once the hand has been used for something else.
    left: bool,
}

/// What a hand pushes.
pub(super) struct PushTarget {
    object: ObjectId,
    body: usize,
    /// Where, if that is stated, m.
    point: Option<Vec3>,
    /// The force that is asked for, N.
    wanted_n: f32,
}

fn verb(way: f32) -> &'static str {
    if way > 0.0 { "push" } else { "pull" }
}

/// Pushes an object away for a quarter of a second.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Push {
    /// The object to push; a ray also gives the point.
    pub target: Target,
    /// Force, N, above 0; limited to the agent's strength. Default: all of it.
    pub force_n: Option<f32>,
}

impl HandAction for Push {
    fn perform(&self, hand: &mut HandContext<'_>) -> ActionResult {
        hand.context
            .start_push(hand.state, hand.actor, &self.target, self.force_n, 1.0)
    }

    fn check(&self, hand: &HandContext<'_>) -> Result<(), Box<ActionOutcome>> {
        let found =
            hand.context
                .object_to_push(hand.state, hand.actor, &self.target, self.force_n, 1.0);
        found.map(|_| ())
    }
}

impl ActionContext<'_> {
    /// Returns the object that a hand pushes or pulls, its body, where, and the force that is asked for, N.
    pub(super) fn object_to_push(
        &self,
        state: &State,
        actor: Actor<'_>,
        target: &Target,
        force_n: Option<f32>,
        way: f32,
    ) -> Result<PushTarget, Box<ActionOutcome>> {
        let verb = verb(way);
        let (object, aim) = self.resolve_object_target(state, actor, target)?;
        let name = self.dynamics.name_of(object);
        let refuse = |code, sentence: String| Err(Box::new(fail(code, sentence, Some(object))));
        let wanted_n = force_n.unwrap_or(actor.body.body.push_force_n);
        if !wanted_n.is_finite() || wanted_n <= 0.0 {
            let sentence = format!("You cannot {verb} with {wanted_n} N; give a force above 0.");
            return refuse(OutcomeCode::BadNumber, sentence);
        }
        if way < 0.0 && actor.body.holding.is_some() {
            let sentence = "Your hand is full. Drop what you hold before you pull.";
            return refuse(OutcomeCode::HandFull, sentence.to_owned());
        }
        if let Some(holder) = state.held_by[object] {
            let sentence = format!(
                "Agent {} holds the {name}. Choose something else.",
                holder.0
            );
            return refuse(OutcomeCode::HeldByOther, sentence);
        }
        let body = self.body_to_push(object, &aim)?;
        let refusal = self
            .check_not_stood_on(state, actor.id, object)
            .or_else(|| self.check_reach(state, actor, object));
        match refusal {
            Some(refusal) => Err(Box::new(refusal)),
            None => Ok(PushTarget {
                object,
                body,
                point: aim.point,
                wanted_n,
            }),
        }
    }

    pub(super) fn start_push(
        &mut self,
        state: &State,
        actor: Actor<'_>,
        target: &Target,
        force_n: Option<f32>,
        way: f32,
    ) -> ActionResult {
        let found = self.object_to_push(state, actor, target, force_n, way)?;
        let (object, body) = (found.object, found.body);
        let most = actor.body.body.push_force_n;
        let (verb, name) = (verb(way), self.dynamics.name_of(object));
        let handle = self.dynamics.bodies[body].handle;
        let Some(rigid) = self.dynamics.engine.bodies.get(handle) else {
            return Ok(fail(
                OutcomeCode::NotMovable,
                "It does not move.",
                Some(object),
            ));
        };
        let eye = actor.body.eye_position();
        // Without a point, a free object is pushed through its centre of mass, a leaf at its middle.
        let middle = self.dynamics.model.bodies[body]
            .bounds(rigid.position())
            .center();
        let jointed = self.dynamics.model.bodies[body].joint.is_some();
        let point = found.point.unwrap_or(if jointed {
            middle
        } else {
            rigid.center_of_mass()
        });
        let level = Vec3::new(point.x - eye.x, 0.0, point.z - eye.z);
        let ahead = dwell_scene::space::forward_from_yaw(actor.body.yaw_rad);
        let direction = level.try_normalize().unwrap_or(ahead) * way;
        let force = found.wanted_n.min(most);
        let point_in_body = rigid.position().inverse() * point;
        // One push a hand: its previous push ends in the next step, with an outcome.
        for shove in self
            .pushes
            .iter_mut()
            .filter(|shove| shove.agent == actor.id)
        {
            shove.left = true;
        }
        self.pushes.push(OngoingPush {
            agent: actor.id,
            object,
            body: body as u32,
            point_in_body,
            force: direction * force,
            left_s: PUSH_S,
            start: point,
            left: false,
        });
        self.pushes.sort_by_key(|shove| shove.agent);
        let limit = if force < found.wanted_n {
            ", all you have"
        } else {
            ""
        };
        let sentence = format!("You {verb} the {name} with {force:.0} N{limit}.");
        Ok(done(OutcomeCode::Started, sentence, Some(object)))
    }

    /// Returns the body of an object that a push moves.
    fn body_to_push(
        &self,
        object: ObjectId,
        aim: &ResolvedTarget,
    ) -> Result<usize, Box<ActionOutcome>> {
        let name = self.dynamics.name_of(object);
        let model = &self.dynamics.model;
        let refuse = |code, sentence: String| Err(Box::new(fail(code, sentence, Some(object))));
        let bodies = match aim.part {
            Some(part) => model.body_of_part[part]
                .map(|body| body as usize)
                .into_iter()
                .collect(),
            None => self.dynamics.bodies_of(object),
        };
        if let Some(body) = bodies
            .iter()
            .find(|body| self.dynamics.statuses[**body] == BodyStatus::Free)
        {
            return Ok(*body);
        }
        match bodies.first().map(|body| self.dynamics.statuses[*body]) {
            None => refuse(
                OutcomeCode::NotMovable,
                format!("The {name} stands firm. Choose something loose."),
            ),
            Some(BodyStatus::Latched) => refuse(
                OutcomeCode::Latched,
                format!("The {name} is shut and does not give way. Open it first."),
            ),
            Some(_) => refuse(
                OutcomeCode::Stuck,
                format!("The {name} is stuck where it stands. Choose something else."),
            ),
        }
    }
}

/// Applies all pushes for one physics step and reports those that end.
pub(crate) fn advance_pushes(
    pushes: &mut Vec<OngoingPush>,
    dynamics: &mut Dynamics,
    state: &State,
    notices: &mut Vec<DelayedOutcome>,
) {
    let dt_s = dynamics.settings.dt_s;
    let mut place = 0;
    while place < pushes.len() {
        let shove = pushes[place];
        let index = shove.body as usize;
        let handle = dynamics.bodies[index].handle;
        let agent = &state.agents[shove.agent];
        let reach = agent.body.reach_m + SLACK_M;
        let free =
            dynamics.statuses[index] == BodyStatus::Free && state.held_by[shove.object].is_none();
        let point = dynamics
            .engine
            .bodies
            .get(handle)
            .map(|rigid| *rigid.position() * shove.point_in_body);
        let near =
            point.is_some_and(|point| free && (point - agent.eye_position()).length() <= reach);
        if shove.left_s > 0.5 * dt_s
            && near
            && !shove.left
            && let Some(point) = point
        {
            dynamics.engine.wake(handle);
            if let Some(rigid) = dynamics.engine.bodies.get_mut(handle) {
                rigid.apply_impulse_at_point(shove.force * dt_s, point, false);
            }
            pushes[place].left_s -= dt_s;
            place += 1;
            continue;
        }
        pushes.remove(place);
        let moved = point.map_or(0.0, |point| (point - shove.start).length());
        let name = dynamics.name_of(shove.object);
        let outcome = if shove.left {
            let sentence = format!(
                "You let go of the {name} and turned to something else; it had moved by {moved:.2} m."
            );
            fail(OutcomeCode::Blocked, sentence, Some(shove.object))
        } else if moved >= MOVED_M {
            let sentence = format!("The {name} moved by {moved:.2} m.");
            done(OutcomeCode::Done, sentence, Some(shove.object))
        } else {
            let mass = dynamics
                .engine
                .bodies
                .get(handle)
                .map_or(0.0, RigidBody::mass);
            let sentence = format!(
                "The {name} ({mass:.1} kg) did not move. Use more force, or clear what holds it."
            );
            fail(OutcomeCode::Blocked, sentence, Some(shove.object))
        };
        notices.push(DelayedOutcome {
            agent: Some(shove.agent),
            outcome,
        });
    }
}
