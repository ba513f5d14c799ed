//! Integration of a tree over one physics step.
//!
//! Efforts are implicit and computed together for all joints; inertia, gravity and velocity terms are taken at the middle
//! of the step, which is found by iteration: the implicit midpoint rule, symmetric in time, so that oscillations keep their
//! energy. Fast rotations take shorter steps.
//!
//! # Source
//! E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), II.1.1 and XI.3: the midpoint rule, and the
//! energy of symmetric methods.

use super::base_contacts::{self, BaseResponse, ReducedProblem, SupportContactState};
use super::chain::{FreeJointChain, LawWrenchEvaluator};
use super::convex_solver::{EffortProblem, EffortTerm, SymmetricMatrix};
use super::effort_term::JointDof;
use super::tree::KinematicTree;
use super::tree_dynamics::TreeDynamics;
use super::{JointLoad, JointResistance};
use super::{JointStepInputs, PhysicsJoint};

/// Displacement in a step, rad or m, below which a tree counts as at rest.
pub(super) const REST_DISPLACEMENT: f64 = 1e-5;
/// Longest displacement of a joint in one part of a step, rad or m.
const MAX_PART_DISPLACEMENT: f64 = 0.05;
/// Most parts of a step: those of the highest speed that may be set, 1000 rad/s, at 120 Hz.
const MOST_PARTS: f64 = 168.0;
/// Iterations for the middle of a part.
const MIDPOINT_ITERATIONS: usize = 3;
/// Most iterations of friction and the load that depends on it.
const FRICTION_ITERATIONS: usize = 8;
/// Convergence tolerance of loads: N·m or N, and as a share.
const LOAD_TOLERANCE: f64 = 1e-6;
/// Bounds on the slope of a load over the load assumed for it.
const LOAD_SLOPE_BOUNDS: [f64; 2] = [-20.0, 0.5];
/// Most iterations of the support contacts.
const SUPPORT_ITERATIONS: usize = 6;

/// The free joints of a tree in a step.
pub(super) struct TreeSolver<'a> {
    pub(super) tree: &'a KinematicTree,
    /// Their indices in the tree.
    pub(super) free: &'a [usize],
    pub(super) joints: &'a [&'a PhysicsJoint],
    pub(super) drivers: &'a JointStepInputs<'a>,
}

/// The motion of a tree in a step that nothing else touches. Shape (freedom,) each.
pub(super) struct TreeIntegration<'a> {
    /// Set if it moves by more than rounding.
    pub(super) is_moving: bool,
    pub(super) positions: Vec<f64>,
    pub(super) velocities: Vec<f64>,
    /// Mean accelerations.
    pub(super) mean_accelerations: Vec<f64>,
    /// The response of a free root.
    pub(super) base_response: Option<BaseResponse>,
    /// The tree at the middle of the step.
    pub(super) midpoint_dynamics: TreeDynamics<'a>,
}

/// Accelerations of the joints and of a free root.
struct SubstepResult {
    gained: Vec<f64>,
    answer: Option<BaseResponse>,
}

/// The initial values of a part of a step. Shape (freedom,).
#[derive(Clone, Copy)]
struct SubstepStart<'a> {
    from: &'a [f64],
    now: &'a [f64],
    weights: &'a [f64],
    /// The inertia matrix without support contacts. Shape (freedom, freedom).
    bare: &'a SymmetricMatrix,
    part_s: f64,
}

fn plus(a: &[f64], b: &[f64], share: f64) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + share * b).collect()
}

/// Returns the rate of change, per second.
fn rate(before: &[f64], after: &[f64], time_s: f64) -> Vec<f64> {
    let pairs = before.iter().zip(after);
    pairs
        .map(|(before, after)| (after - before) / time_s)
        .collect()
}

/// Returns the next estimate of the loads, where `taken` led to `seen`: the latter or, where a load depends on the
/// estimate, the fixed point of the line through both pairs (Steffensen). Shape (freedom,).
fn relaxed_load(taken: &[f64], seen: &[f64], before: Option<&[Vec<f64>; 2]>) -> Vec<f64> {
    let Some([taken_before, seen_before]) = before else {
        return seen.to_vec();
    };
    let next = |k: usize| {
        let way = taken[k] - taken_before[k];
        if way.abs() < 1e-9 {
            return seen[k];
        }
        let fall =
            ((seen[k] - seen_before[k]) / way).clamp(LOAD_SLOPE_BOUNDS[0], LOAD_SLOPE_BOUNDS[1]);
        taken[k] + (seen[k] - taken[k]) / (1.0 - fall)
    };
    (0..taken.len()).map(next).collect()
}

impl TreeSolver<'_> {
    /// Integrates the tree from here.
    pub(super) fn integrate<'c>(
        &self,
        chain: &'c FreeJointChain,
        positions: &[f64],
        velocities: &[f64],
    ) -> TreeIntegration<'c> {
        let dt_s = f64::from(self.drivers.dt_s);
        let fastest = velocities
            .iter()
            .fold(0.0, |most: f64, v| most.max(v.abs()));
        let moves = fastest * dt_s > REST_DISPLACEMENT && chain.is_root_at_rest();
        let parts = if moves {
            (fastest * dt_s / MAX_PART_DISPLACEMENT)
                .ceil()
                .clamp(1.0, MOST_PARTS)
        } else {
            1.0
        };
        let part_s = dt_s / parts;
        let at = |middle: bool| {
            self.drivers.wrench_fn.map(|push| LawWrenchEvaluator {
                wrench_fn: push,
                dt_s: part_s,
                at_midpoint: middle,
            })
        };
        let (mut q, mut v) = (positions.to_vec(), velocities.to_vec());
        let mut answer = None;
        let mut left = parts;
        while left > 0.0 {
            let SubstepResult {
                mut gained,
                answer: of_root,
            } = self.solve_substep(&chain.dynamics_at(&q, &v, at(false)), &q, &v, part_s);
            answer = of_root;
            for _ in 0..if moves { MIDPOINT_ITERATIONS } else { 0 } {
                // The implicit midpoint rule, by fixed-point iteration: a = a(q + h/2 v_m, v_m) with v_m = v + h/2 a.
                let between = plus(&v, &gained, 0.5 * part_s);
                let middle =
                    chain.dynamics_at(&plus(&q, &between, 0.5 * part_s), &between, at(true));
                gained = self.solve_substep(&middle, &q, &v, part_s).gained;
            }
            // q' = q + h v_m and v' = v + h a.
            let next = plus(&q, &plus(&v, &gained, 0.5 * part_s), part_s);
            q = self.within_stops(&q, next);
            v = plus(&v, &gained, part_s);
            left -= 1.0;
        }
        // Velocities that overflow stop at their last value.
        if !q.iter().chain(&v).all(|number| number.is_finite()) {
            (q, v, answer) = (positions.to_vec(), vec![0.0; velocities.len()], None);
        }
        let middle = if moves {
            let half = |a: &[f64], b: &[f64]| {
                a.iter()
                    .zip(b)
                    .map(|(a, b)| 0.5 * (a + b))
                    .collect::<Vec<_>>()
            };
            chain.dynamics_at(&half(positions, &q), &half(velocities, &v), at(true))
        } else {
            chain.dynamics_at(positions, velocities, at(false))
        };
        TreeIntegration {
            is_moving: moves,
            mean_accelerations: rate(velocities, &v, dt_s),
            positions: q,
            velocities: v,
            base_response: answer,
            midpoint_dynamics: middle,
        }
    }

    /// Returns the joints' positions after a part of a step that would end at `next`. Stops act on the velocity at its end,
    /// and the mean velocity may pass them.
    fn within_stops(&self, from: &[f64], mut next: Vec<f64>) -> Vec<f64> {
        for ((joint, from), next) in self.joints.iter().zip(from).zip(&mut next) {
            if let Some([low, high]) = joint.values.limits.map(|limits| limits.map(f64::from)) {
                *next = next.clamp(low.min(*from), high.max(*from));
            }
        }
        next
    }

    /// Returns the accelerations in a part of a step that begins with positions `from` and velocities `now`, with inertia
    /// and loads as in `motion`.
    fn solve_substep(
        &self,
        motion: &TreeDynamics<'_>,
        from: &[f64],
        now: &[f64],
        part_s: f64,
    ) -> SubstepResult {
        let loads = motion.loads();
        let weights = motion.weight_support_efforts(&loads);
        let bare = motion.joint_space_inertia();
        let mut holds = vec![SupportContactState::Sticking; motion.supports.len()];
        let mut round = 0;
        loop {
            let reduced = ReducedProblem::of(motion, &loads, now, &holds, part_s);
            let seen = SubstepStart {
                from,
                now,
                weights: &weights,
                bare: &bare,
                part_s,
            };
            let velocity = self.solve(&reduced, &seen);
            let gained = rate(now, &velocity, part_s);
            let footing = reduced.base_contacts.as_ref();
            let answer = footing.map(|footing| footing.base_response(&velocity, &holds));
            round += 1;
            match answer {
                Some(answer)
                    if round < SUPPORT_ITERATIONS
                        && base_contacts::update_support_states(
                            motion, &loads, &answer, &mut holds,
                        ) => {}
                answer => return SubstepResult { gained, answer },
            }
        }
    }

    /// Returns the velocities at the end of a part of a step.
    fn solve(&self, reduced: &ReducedProblem, seen: &SubstepStart<'_>) -> Vec<f64> {
        let SubstepStart {
            from,
            now,
            weights,
            bare,
            part_s,
        } = *seen;
        let freedom = |k: usize| JointDof {
            index: k,
            position: from[k],
            velocity: now[k],
            inertia: bare.get(k, k).max(1e-9),
            weight: weights[k],
            dt_s: part_s,
        };
        let freedoms: Vec<JointDof> = (0..from.len()).map(freedom).collect();
        let pulls: Vec<Option<EffortTerm>> = freedoms
            .iter()
            .map(|freedom| {
                let place = self.tree.joints[self.free[freedom.index]];
                let pull = self.drivers.actuations[place].as_ref();
                pull.map(|pull| freedom.actuation(pull))
            })
            .collect();
        let gives = |k: usize, velocity: f64| {
            pulls[k]
                .as_ref()
                .map_or(0.0, |pull| pull.effort_and_slope(velocity).0)
        };
        // Each joint's resistance depends on its load and speed, and these on its resistance.
        let mut ends = now.to_vec();
        let mut external: Vec<f64> = weights.iter().map(|weight| -weight).collect();
        let mut before: Option<[Vec<f64>; 2]> = None;
        let mut sweep = 0;
        loop {
            let resistances: Vec<JointResistance> = (0..from.len())
                .map(|k| {
                    let load = JointLoad {
                        position: from[k] as f32,
                        velocity: (0.5 * (now[k] + ends[k])) as f32,
                        motor_effort: gives(k, ends[k]) as f32,
                        external_effort: external[k] as f32,
                        is_driven: pulls[k].is_some(),
                    };
                    self.resistance(k, &load)
                })
                .collect();
            let mut inertia = reduced.inertia.clone();
            let mut momentum = reduced.momentum.clone();
            let mut freedoms = freedoms.clone();
            // H + diag(armature), and its momentum.
            for (k, resistance) in resistances.iter().enumerate() {
                let armature = f64::from(resistance.armature).max(1e-9);
                inertia.add(k, k, armature);
                momentum[k] += armature * now[k];
                freedoms[k].inertia += armature;
            }
            let velocity = EffortProblem {
                free_velocities: inertia.cholesky().solve(&momentum),
                inertia,
                terms: self.elements(&freedoms, &resistances),
                dt_s: part_s,
            }
            .solve();
            sweep += 1;
            if self.drivers.resistance_fn.is_none() || sweep == FRICTION_ITERATIONS {
                return velocity;
            }
            let seen: Vec<f64> = freedoms
                .iter()
                .zip(&resistances)
                .map(|(freedom, resistance)| {
                    let velocity = velocity[freedom.index];
                    let own = self.joint_effort_terms(freedom, resistance);
                    let own: f64 = own
                        .map(|element| element.effort_and_slope(velocity).0)
                        .sum();
                    // All others' effort is what is missing in m a = own + others.
                    freedom.inertia * (velocity - freedom.velocity) / part_s - own
                })
                .collect();
            let same = |a: f64, b: f64| (a - b).abs() <= LOAD_TOLERANCE * b.abs().max(1.0);
            let pairs = external.iter().zip(&seen);
            let speeds = ends.iter().zip(&velocity);
            if pairs.chain(speeds).all(|(a, b)| same(*a, *b)) {
                return velocity;
            }
            let next = relaxed_load(&external, &seen, before.as_ref());
            before = Some([std::mem::replace(&mut external, next), seen]);
            ends = velocity;
        }
    }

    /// Returns a joint's resistance under a load.
    fn resistance(&self, k: usize, load: &JointLoad) -> JointResistance {
        let joint = self.joints[k];
        let mut resistance = JointResistance {
            friction: joint.values.friction,
            damping: joint.values.damping,
            armature: joint.values.armature,
            elastic: None,
        };
        if let Some(resist) = self.drivers.resistance_fn {
            resist(joint.id, load, &mut resistance);
        }
        resistance
    }

    /// Returns the efforts along a joint of its motor and its resistance.
    fn joint_effort_terms<'a>(
        &'a self,
        freedom: &'a JointDof,
        resistance: &'a JointResistance,
    ) -> impl Iterator<Item = EffortTerm> + 'a {
        let damps = (resistance.damping > 0.0).then(|| freedom.damping(resistance.damping.into()));
        let rubs = resistance.friction > 0.0;
        let rubs = rubs.then(|| freedom.friction(resistance.friction.into()));
        let springs = resistance.elastic.as_ref().map(|e| freedom.slip_spring(e));
        let place = self.tree.joints[self.free[freedom.index]];
        let pulls = self.drivers.actuations[place].as_ref();
        let pulls = pulls.map(|pull| freedom.actuation(pull));
        [damps, rubs, springs, pulls].into_iter().flatten()
    }

    /// Returns all efforts along the joints.
    fn elements(&self, freedoms: &[JointDof], resistances: &[JointResistance]) -> Vec<EffortTerm> {
        let mut elements = Vec::with_capacity(3 * freedoms.len());
        for ((joint, freedom), place) in self.joints.iter().zip(freedoms).zip(self.free) {
            let resistance = &resistances[freedom.index];
            elements.extend(self.joint_effort_terms(freedom, resistance));
            if let Some([low, high]) = joint.values.limits {
                elements.push(freedom.limit_stop(low.into(), 1.0));
                elements.push(freedom.limit_stop(high.into(), -1.0));
            }
            if let Some(leader) = self.tree.mimic_leaders[*place]
                && let Some(mimic) = &joint.values.mimic
                && let Some(leader) = self.free.iter().position(|other| *other == leader)
            {
                let leader = &freedoms[leader];
                let law = [mimic.multiplier.into(), mimic.offset.into()];
                elements.push(freedom.mimic_constraint(leader, law, joint.stops()));
            }
        }
        elements
    }
}
