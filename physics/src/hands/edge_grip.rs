//! Grips of a large thing's edge: several agents lift and carry together what one cannot.
//!
//! Who takes hold is tied to the place where it stands beside the thing, by [`SLACK_M`]. Holders on different sides who are strong
//! enough together lift it by [`LIFT_M`]; then its pose is the one that fits the places of all of them best in the sense of least squares,
//! so that its middle moves by the mean of their movements. A movement that would take somebody further from its place, or the thing into
//! something else, is cut short for all who hold it, by the same share: no agent's number decides anything.

use super::{HandGrasp, Hands, HeldObject};
use crate::body::BodyStatus;
use crate::dynamics::Dynamics;
use crate::outcome::{DelayedOutcome, OutcomeCode, fail};
use dwell_scene::{AgentId, AgentState, ObjectId, State, math};
use glam::{Quat, Vec3};
use rapier3d::dynamics::{RigidBody, RigidBodyHandle, RigidBodyType};
use rapier3d::math::Pose as RapierPose;
use serde::{Deserialize, Serialize};

/// Furthest that a holder gets from its place beside the thing, m.
pub(crate) const SLACK_M: f32 = 0.15;
/// Height by which a thing is lifted, m, and the speed, m/s.
const LIFT_M: f32 = 0.02;
const LIFT_M_S: f32 = 0.1;
/// What a holder bears with both hands close to its body, as a multiple of what a hand lifts at arm's length.
///
/// # Source
/// Health and Safety Executive, "Manual handling at work" (INDG143), lifting and lowering filter for men: 25 kg close to the body at
/// knuckle height, 10 kg at arm's length at shoulder height.
pub const BOTH_HANDS: f32 = 2.5;
/// Distance beyond the slack at which a grip slips, m: nobody walks that far, but things and agents may be put elsewhere.
const SLIPS_M: f32 = 0.05;
/// Rounding of a holder's distance from its place, m.
const ROUNDING_M: f32 = 1e-4;
/// Deepest overlap of a carried thing with what stands firm, and with what it pushes away, m.
const FIRM_M: f32 = 0.003;
const LOOSE_M: f32 = 0.03;
/// Halvings in the search for the share of a movement that is free.
const HALVINGS: u32 = 7;

/// The grip of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct EdgeGrip {
    /// Where the hands are: the point of the edge of the box around the thing nearest to its holder, in the body's frame, m.
    point_in_body: Vec3,
    /// Where its holder stands, in the body's frame, m.
    feet_in_body: Vec3,
    /// How far the thing has been lifted, m.
    raised_m: f32,
}

/// The holders of one thing in a physics step, by agent.
struct Carriers {
    body: usize,
    agents: Vec<AgentId>,
    feet_in_body: Vec<Vec3>,
    lifted: bool,
    raised_m: f32,
    pose: RapierPose,
}

/// Returns the pose of a body at the end of the present step as far as it is known.
fn next_pose(rigid: &RigidBody) -> RapierPose {
    match rigid.body_type() {
        RigidBodyType::KinematicPositionBased => *rigid.next_position(),
        _ => *rigid.position(),
    }
}

/// The mean of some points.
fn mean(points: &[Vec3]) -> Vec3 {
    points.iter().copied().sum::<Vec3>() / points.len().max(1) as f32
}

/// Returns the pose, turned about the vertical and moved, that brings the places beside the thing nearest to where the holders are.
fn fitted_pose(pose: &RapierPose, feet_in_body: &[Vec3], feet: &[Vec3]) -> RapierPose {
    let places: Vec<Vec3> = feet_in_body.iter().map(|feet| *pose * *feet).collect();
    let (from, to) = (mean(&places), mean(feet));
    let (mut sine, mut cosine) = (0.0, 0.0);
    for (place, foot) in places.iter().zip(feet) {
        let (a, b) = (*place - from, *foot - to);
        sine += a.z * b.x - a.x * b.z;
        cosine += a.x * b.x + a.z * b.z;
    }
    let (sine, cosine) = math::sin_cos(0.5 * math::atan2(sine, cosine));
    let turn = Quat::from_xyzw(0.0, sine, 0.0, cosine);
    let mut fitted = RapierPose::from_rotation((turn * pose.rotation).normalize());
    fitted.translation = to + turn * (pose.translation - from);
    fitted
}

impl Carriers {
    /// Returns the furthest that each is from its place under a pose, level m. Shape (holder,).
    fn distances_m(&self, pose: &RapierPose, feet: &[Vec3]) -> Vec<f32> {
        let places = self.feet_in_body.iter().map(|feet| *pose * *feet);
        let ways = places.zip(feet).map(|(place, foot)| *foot - place);
        ways.map(|way| way.with_y(0.0).length()).collect()
    }

    /// Returns the pose for where the holders are.
    fn pose_for(&self, feet: &[Vec3]) -> RapierPose {
        if self.lifted {
            fitted_pose(&self.pose, &self.feet_in_body, feet)
        } else {
            self.pose
        }
    }
}

impl HeldObject {
    /// Grips the edge of a body.
    pub(crate) fn at_edge(
        dynamics: &Dynamics,
        (object, body): (ObjectId, usize),
        (agent, holder): (AgentId, &AgentState),
    ) -> Self {
        let pose = *dynamics.engine.bodies[dynamics.bodies[body].handle].position();
        let bounds = dynamics.model.bodies[body].bounds(&RapierPose::IDENTITY);
        let feet_in_body = pose.inverse() * holder.position;
        let grip = EdgeGrip {
            point_in_body: edge_point(feet_in_body, bounds.min, bounds.max),
            feet_in_body,
            raised_m: 0.0,
        };
        Self {
            object,
            body: body as u32,
            agent,
            hand_from_body: Quat::IDENTITY,
            middle_in_body: bounds.center(),
            half_m: 0.0,
            last_center: pose * bounds.center(),
            stuck_s: 0.0,
            grasp: HandGrasp::Edge(grip),
            loaded: false,
        }
    }

    /// Returns its grip, if it is one of an edge.
    pub(crate) fn edge(&self) -> Option<&EdgeGrip> {
        match &self.grasp {
            HandGrasp::Edge(grip) => Some(grip),
            _ => None,
        }
    }

    fn edge_mut(&mut self) -> Option<&mut EdgeGrip> {
        match &mut self.grasp {
            HandGrasp::Edge(grip) => Some(grip),
            _ => None,
        }
    }

    /// Returns where it is held, level, from the middle of the thing in its own frame, m.
    fn side(&self) -> Vec3 {
        let point = self.edge().map_or(Vec3::ZERO, |grip| grip.point_in_body);
        (point - self.middle_in_body).with_y(0.0)
    }
}

/// Returns the point of the outline of a box, seen from above, that is nearest to a point.
pub(crate) fn edge_point(point: Vec3, min: Vec3, max: Vec3) -> Vec3 {
    let inside = point.clamp(min, max);
    if inside.x != point.x || inside.z != point.z {
        return inside.with_y(max.y);
    }
    let sides = [
        (point.x - min.x, point.with_x(min.x)),
        (max.x - point.x, point.with_x(max.x)),
        (point.z - min.z, point.with_z(min.z)),
        (max.z - point.z, point.with_z(max.z)),
    ];
    let nearest = sides.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.map_or(point, |(_, point)| point).with_y(max.y)
}

impl Hands {
    /// Returns whether somebody holds an edge.
    pub(crate) fn has_edge_grips(&self) -> bool {
        self.held_objects.iter().any(|grip| grip.edge().is_some())
    }

    /// The bodies whose edges are held, each once, rising.
    fn bodies_held_at_edges(&self) -> Vec<usize> {
        let grips = self.held_objects.iter().filter(|own| own.edge().is_some());
        let mut bodies: Vec<usize> = grips.map(|grip| grip.body as usize).collect();
        bodies.sort_unstable();
        bodies.dedup();
        bodies
    }

    fn carriers_of(&self, dynamics: &Dynamics, body: usize) -> Carriers {
        let mut found = Carriers {
            body,
            agents: Vec::new(),
            feet_in_body: Vec::new(),
            lifted: false,
            raised_m: 0.0,
            pose: RapierPose::IDENTITY,
        };
        if let Some(rigid) = dynamics.engine.bodies.get(dynamics.bodies[body].handle) {
            found.lifted = is_lifted(rigid);
            found.pose = next_pose(rigid);
        }
        for grip in &self.held_objects {
            if let Some(edge) = grip.edge().filter(|_| grip.body as usize == body) {
                found.agents.push(grip.agent);
                found.feet_in_body.push(edge.feet_in_body);
                found.raised_m = edge.raised_m;
            }
        }
        found
    }

    /// The bodies that are lifted by their edges.
    pub(crate) fn lifted_bodies(&self, dynamics: &Dynamics) -> Vec<RigidBodyHandle> {
        let bodies = self.bodies_held_at_edges().into_iter();
        let lifted = bodies.filter(|body| self.is_lifted(dynamics, *body));
        lifted.map(|body| dynamics.bodies[body].handle).collect()
    }

    /// Returns whether a body is lifted by its edges.
    pub(crate) fn is_lifted(&self, dynamics: &Dynamics, body: usize) -> bool {
        self.carriers_of(dynamics, body).lifted
    }

    /// Takes hold of an edge.
    pub(crate) fn grip_edge(
        &mut self,
        dynamics: &mut Dynamics,
        state: &mut State,
        mut grip: HeldObject,
    ) {
        let (body, agent, object) = (grip.body as usize, grip.agent, grip.object);
        let now = self.carriers_of(dynamics, body);
        if let Some(edge) = grip.edge_mut() {
            edge.raised_m = now.raised_m;
        }
        self.held_objects.push(grip);
        self.held_objects.sort_by_key(|grip| grip.agent);
        dynamics
            .collision_exclusions
            .exclude_carried(body as u32, agent);
        state.agents[agent].holding = Some(object);
        self.report_holder(state, object);
        self.update_lift(dynamics, state, body);
        dynamics.flush();
    }

    /// Lets go of an edge; what can no longer be held up is set down.
    pub(super) fn release_edge(
        &mut self,
        dynamics: &mut Dynamics,
        state: &mut State,
        grip: &HeldObject,
    ) {
        state.agents[grip.agent].holding = None;
        self.report_holder(state, grip.object);
        self.released_overlapping.push((grip.body, grip.agent));
        self.update_lift(dynamics, state, grip.body as usize);
    }

    /// Of several holders the state names the first.
    fn report_holder(&self, state: &mut State, object: ObjectId) {
        let mut grips = self.held_objects.iter();
        let first = grips.find(|grip| grip.object == object);
        state.held_by[object] = first.map(|grip| grip.agent);
    }

    /// Returns whether those who hold a body's edges can lift it: two of them on different sides, so that the directions from its middle to
    /// their hands are at least a right angle apart, and all together strong enough.
    fn can_lift(&self, dynamics: &Dynamics, state: &State, body: usize) -> bool {
        let grips = || {
            let all = self.held_objects.iter();
            all.filter(|grip| grip.edge().is_some() && grip.body as usize == body)
        };
        let opposite =
            grips().any(|a| grips().any(|b| a.agent != b.agent && a.side().dot(b.side()) <= 0.0));
        let strength = grips().map(|grip| state.agents[grip.agent].body.lift_kg * BOTH_HANDS);
        let rigid = dynamics.engine.bodies.get(dynamics.bodies[body].handle);
        let mass = rigid.map_or(f32::INFINITY, RigidBody::mass);
        opposite && dynamics.statuses[body] == BodyStatus::Free && strength.sum::<f32>() >= mass
    }

    /// Lifts a body, or sets it down.
    pub(super) fn update_lift(&mut self, dynamics: &mut Dynamics, state: &State, body: usize) {
        let handle = dynamics.bodies[body].handle;
        let can = self.can_lift(dynamics, state, body);
        let Some(rigid) = dynamics.engine.bodies.get(handle) else {
            return;
        };
        if is_lifted(rigid) == can {
            return;
        }
        let pose = next_pose(rigid);
        let lowered = lowered_pose(dynamics, body, &pose);
        dynamics.engine.wake_around(handle);
        let Some(rigid) = dynamics.engine.bodies.get_mut(handle) else {
            return;
        };
        rigid.set_body_type(RigidBodyType::Dynamic, true);
        rigid.set_linvel(Vec3::ZERO, true);
        rigid.set_angvel(Vec3::ZERO, true);
        if can {
            rigid.set_body_type(RigidBodyType::KinematicPositionBased, true);
            rigid.set_next_kinematic_position(pose);
        } else {
            rigid.set_position(lowered, true);
        }
        for grip in &mut self.held_objects {
            let (holder, of_body) = (grip.agent, grip.body as usize == body);
            if let Some(edge) = grip.edge_mut().filter(|_| of_body) {
                edge.raised_m = 0.0;
                // All are where they stand now: nobody is ahead of the others.
                let pose = if can { &pose } else { &lowered };
                edge.feet_in_body = pose.inverse() * state.agents[holder].position;
            }
        }
        dynamics.flush();
    }

    /// Sets down what has become too heavy for those who hold it, after a change of their strength or of its mass.
    pub(super) fn update_lifts(&mut self, dynamics: &mut Dynamics, state: &State) {
        for body in self.bodies_held_at_edges() {
            self.update_lift(dynamics, state, body);
        }
    }

    /// Cuts short the movements of agents who hold edges, so that nobody gets too far from its place and what they carry into nothing.
    ///
    /// `ends`: where each agent's movement in a physics step ends, m. Shape (agent,).
    pub(crate) fn limit_holder_movements(
        &self,
        dynamics: &Dynamics,
        state: &State,
        ends: &mut [Vec3],
    ) {
        for body in self.bodies_held_at_edges() {
            let carriers = self.carriers_of(dynamics, body);
            let starts: Vec<Vec3> = carriers
                .agents
                .iter()
                .map(|agent| state.agents[*agent].position)
                .collect();
            let wanted: Vec<Vec3> = carriers
                .agents
                .iter()
                .map(|agent| ends[agent.0 as usize])
                .collect();
            if starts == wanted {
                continue;
            }
            let limits = limits(dynamics, &carriers, &starts);
            let along = lines(&starts);
            let cut = |whole: f32, on_line: f32| -> Vec<Vec3> {
                let ways = starts.iter().zip(&wanted).zip(&along);
                ways.map(|((start, end), line)| {
                    let way = *end - *start;
                    let part = *line * way.dot(*line);
                    *start + (way - part * (1.0 - on_line)) * whole
                })
                .collect()
            };
            let is_free = |feet: &[Vec3]| is_free(dynamics, &carriers, &limits, feet);
            let made = if is_free(&wanted) {
                continue;
            } else if is_free(&cut(1.0, 0.0)) {
                // Past each other they may go on; only apart or together they may not.
                cut(1.0, free_share(|share| is_free(&cut(1.0, share))))
            } else {
                cut(free_share(|share| is_free(&cut(share, 1.0))), 1.0)
            };
            for (agent, end) in carriers.agents.iter().zip(made) {
                ends[agent.0 as usize] = end;
            }
        }
    }

    /// Returns groups of agents who hold one thing, each at least two.
    pub(crate) fn holder_groups(&self, dynamics: &Dynamics) -> Vec<Vec<AgentId>> {
        let bodies = self.bodies_held_at_edges().into_iter();
        let groups = bodies.map(|body| self.carriers_of(dynamics, body).agents);
        groups.filter(|agents| agents.len() > 1).collect()
    }

    /// Moves what is lifted to where its holders take it in this physics step; `ends` as for [`Self::limit_holder_movements`].
    pub(crate) fn move_carried(&mut self, dynamics: &mut Dynamics, state: &State, ends: &[Vec3]) {
        for body in self.bodies_held_at_edges() {
            let carriers = self.carriers_of(dynamics, body);
            if !carriers.lifted {
                continue;
            }
            let feet: Vec<Vec3> = carriers
                .agents
                .iter()
                .map(|agent| ends[agent.0 as usize])
                .collect();
            let mut moves = carriers.agents.iter().zip(&feet);
            let stand = moves.all(|(agent, end)| state.agents[*agent].position == *end);
            // Rounding moves nothing that is held still.
            let mut pose = if stand {
                carriers.pose
            } else {
                carriers.pose_for(&feet)
            };
            let up_m = (LIFT_M - carriers.raised_m).clamp(0.0, LIFT_M_S * dynamics.settings.dt_s);
            // The places are relative to the thing, and stay on the floor.
            pose.translation.y += up_m;
            for grip in &mut self.held_objects {
                let of_body = grip.body as usize == body;
                if let Some(edge) = grip.edge_mut().filter(|_| of_body) {
                    edge.raised_m += up_m;
                    edge.feet_in_body.y -= up_m;
                }
            }
            let handle = dynamics.bodies[body].handle;
            if let Some(rigid) = dynamics.engine.bodies.get_mut(handle)
                && *rigid.position() != pose
            {
                rigid.set_next_kinematic_position(pose);
            }
        }
    }

    /// Opens hands that are no longer where they took hold, as after things or agents were put elsewhere.
    pub(super) fn drop_distant_edges(
        &mut self,
        dynamics: &mut Dynamics,
        state: &mut State,
        notices: &mut Vec<DelayedOutcome>,
    ) {
        for body in self.bodies_held_at_edges() {
            let carriers = self.carriers_of(dynamics, body);
            let feet = carriers.agents.iter().map(|id| state.agents[*id].position);
            let feet: Vec<Vec3> = feet.collect();
            let distances = carriers.distances_m(&carriers.pose, &feet);
            for (agent, distance_m) in carriers.agents.iter().zip(distances) {
                let own = |grip: &HeldObject| grip.agent == *agent;
                let place = self.held_objects.iter().position(own);
                let Some(place) = place.filter(|_| distance_m > SLACK_M + SLIPS_M) else {
                    continue;
                };
                let object = self.held_objects[place].object;
                self.open_hand(dynamics, state, place);
                let name = dynamics.name_of(object);
                notices.push(DelayedOutcome {
                    agent: Some(*agent),
                    outcome: fail(
                        OutcomeCode::Slipped,
                        format!("The {name} is no longer where you held it, and slipped from your hands."),
                        Some(object),
                    ),
                });
            }
        }
    }
}

/// Returns whether a body is lifted.
fn is_lifted(rigid: &RigidBody) -> bool {
    rigid.body_type() == RigidBodyType::KinematicPositionBased
}

/// Directions in which holders go apart, level: from the middle of all to each; none for one alone.
fn lines(starts: &[Vec3]) -> Vec<Vec3> {
    let middle = mean(starts);
    let ways = starts.iter().map(|start| (*start - middle).with_y(0.0));
    ways.map(Vec3::normalize_or_zero).collect()
}

/// What holders may not exceed: the distance of each from its place, m, and the overlaps of the thing, m. Where something is too far or
/// too deep already, it may not become worse.
struct Limits {
    distances_m: Vec<f32>,
    depths_m: [f32; 2],
}

fn limits(dynamics: &Dynamics, carriers: &Carriers, starts: &[Vec3]) -> Limits {
    let now = carriers.distances_m(&carriers.pose, starts).into_iter();
    let depths = if carriers.lifted {
        dynamics.overlap_depths_m(carriers.body, &carriers.pose)
    } else {
        [0.0; 2]
    };
    Limits {
        // The rounding is added once, not to where they have come to: they must not creep away.
        distances_m: now.map(|now_m| now_m.max(SLACK_M + ROUNDING_M)).collect(),
        depths_m: [depths[0].max(FIRM_M), depths[1].max(LOOSE_M)],
    }
}

/// Returns whether holders may be at some places.
fn is_free(dynamics: &Dynamics, carriers: &Carriers, limits: &Limits, feet: &[Vec3]) -> bool {
    let pose = carriers.pose_for(feet);
    let distances = carriers.distances_m(&pose, feet);
    let mut near = distances.iter().zip(&limits.distances_m);
    if !near.all(|(distance_m, most_m)| distance_m <= most_m) {
        return false;
    }
    if !carriers.lifted || pose == carriers.pose {
        return true;
    }
    let depths = dynamics.overlap_depths_m(carriers.body, &pose);
    depths[0] <= limits.depths_m[0] && depths[1] <= limits.depths_m[1]
}

/// Returns the largest share found of something of which nothing is free, 0 to 1.
fn free_share(is_free: impl Fn(f32) -> bool) -> f32 {
    if is_free(1.0) {
        return 1.0;
    }
    let (mut free, mut step) = (0.0, 0.5);
    for _ in 0..HALVINGS {
        if is_free(free + step) {
            free += step;
        }
        step *= 0.5;
    }
    free
}

/// Returns the pose in which a lifted body is set down: lower, as far as it was lifted and nothing is in the way.
fn lowered_pose(dynamics: &Dynamics, body: usize, pose: &RapierPose) -> RapierPose {
    let allowed = dynamics.overlap_depths_m(body, pose);
    let lower = |by_m: f32| {
        let mut lower = *pose;
        lower.translation.y -= by_m;
        lower
    };
    let is_free = |by_m: f32| {
        let depths = dynamics.overlap_depths_m(body, &lower(by_m));
        depths[0] <= allowed[0] && depths[1] <= allowed[1]
    };
    lower(free_share(|share| is_free(share * LIFT_M)) * LIFT_M)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of two places 2 m apart: both ahead moves, one ahead and one back turns, apart does neither.
    #[test]
    fn a_pose_follows_two_holders() {
        let places = [Vec3::new(-1.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0)];
        let at = RapierPose::IDENTITY;
        let moved = fitted_pose(&at, &places, &places.map(|p| p + Vec3::new(0.3, 0.0, 0.2)));
        assert!((moved.translation - Vec3::new(0.3, 0.0, 0.2)).length() < 1e-6);
        assert!(moved.rotation.angle_between(Quat::IDENTITY) < 1e-6);
        // A quarter turn to the left, seen from above, brings +x to -z.
        let quarter = [Vec3::new(0.0, 0.0, 1.0), Vec3::new(0.0, 0.0, -1.0)];
        let turned = fitted_pose(&at, &places, &quarter);
        assert!((turned.rotation * Vec3::X - Vec3::NEG_Z).length() < 1e-5);
        let apart = fitted_pose(&at, &places, &places.map(|p| p * 1.1));
        assert!(apart.translation.length() < 1e-6);
        // In the other order the same bits.
        let feet = [Vec3::new(-0.93, 0.0, 0.21), Vec3::new(1.07, 0.0, -0.4)];
        let one = fitted_pose(&at, &places, &feet);
        let other = fitted_pose(&at, &[places[1], places[0]], &[feet[1], feet[0]]);
        assert_eq!(one, other);
    }

    #[test]
    fn an_edge_is_held_at_its_nearest_point() {
        let (min, max) = (Vec3::new(-1.0, 0.0, -0.5), Vec3::new(1.0, 0.7, 0.5));
        let point = |x: f32, z: f32| edge_point(Vec3::new(x, 0.0, z), min, max);
        assert_eq!(point(1.4, 0.2), Vec3::new(1.0, 0.7, 0.2));
        assert_eq!(point(1.4, -0.9), Vec3::new(1.0, 0.7, -0.5));
        assert_eq!(point(0.1, 0.4), Vec3::new(0.1, 0.7, 0.5));
    }
}
