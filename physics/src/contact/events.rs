//! Impacts: where two things hit, how hard and how fast.

use super::entry::{Entry, Toucher, entry_index};
use super::substances::ContactTable;
use crate::engine::Engine;
use glam::Vec3;
use rapier3d::dynamics::{RigidBodyHandle, RigidBodySet, SoftBodySet, SoftBodyTearEvent};
use rapier3d::geometry::{ColliderSet, CollisionEvent, ContactPair};
use rapier3d::pipeline::EventHandler;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// Physics steps over which one impact may last: the solver stops a body at the surface in one step and bounces it in
/// the next.
const LONGEST_IMPACT_STEPS: u8 = 3;

/// Two things that hit each other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ContactEvent {
    /// Simulated time since the world was made, s.
    pub time_s: f64,
    /// Where, m: the mean of the contact points, weighted by impulse.
    pub position: Vec3,
    /// The thing that sorts first: structure, then parts, then agents, each by number.
    pub a: Toucher,
    /// The other one.
    pub b: Toucher,
    /// What `a` is made of there, as the materials library names it.
    pub substance_a: &'static str,
    /// What `b` is made of there.
    pub substance_b: &'static str,
    /// The sum of all normal impulses of the impact, N·s.
    pub impulse_n_s: f32,
    /// How fast they approached along the normal, m/s; at least 0.
    pub relative_normal_speed_m_s: f32,
}

/// An impact that may still go on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Impact {
    first_tick: u64,
    steps: u8,
    impulse_n_s: f32,
    /// Sum of position times impulse.
    moment: Vec3,
    speed_m_s: f32,
    classes: (u16, u16),
}

/// All impacts that may still go on, by the pair that hits.
pub(crate) type Impacts = BTreeMap<(Toucher, Toucher), Impact>;

/// What rapier reports of one pair of colliders in one step.
struct Report {
    pair: (Toucher, Toucher),
    classes: (u16, u16),
    impulse: f32,
    moment: Vec3,
    speed: f32,
}

/// Velocity of a body before the step, at its centre of mass.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Motion {
    linear: Vec3,
    angular: Vec3,
    center: Vec3,
    /// A bound on the speed of all its points, m/s.
    fastest: f32,
}

impl Motion {
    fn at(&self, point: Vec3) -> Vec3 {
        self.linear + self.angular.cross(point - self.center)
    }
}

/// Gathers impacts while rapier steps.
pub(crate) struct Collector<'a> {
    entries: &'a [Entry],
    min_speed: f32,
    /// Motion before the step of every body that was awake, by its arena index.
    before: &'a [Motion],
    reports: Mutex<Vec<Report>>,
}

/// Notes the motion of all bodies that are awake before a step.
pub(crate) fn note_motion(engine: &Engine, out: &mut Vec<Motion>) {
    out.clear();
    for handle in engine.islands.active_bodies() {
        let Some(body) = engine.bodies.get(handle) else {
            continue;
        };
        let index = handle.into_raw_parts().0 as usize;
        if out.len() <= index {
            out.resize(index + 1, Motion::default());
        }
        let (linear, angular) = (body.linvel(), body.angvel());
        let reach = body.mass_properties().max_extent();
        out[index] = Motion {
            linear,
            angular,
            center: body.center_of_mass(),
            fastest: linear.length() + angular.length() * reach,
        };
    }
}

impl<'a> Collector<'a> {
    pub(crate) fn new(entries: &'a [Entry], before: &'a [Motion], min_speed: f32) -> Self {
        Self {
            entries,
            min_speed,
            before,
            reports: Mutex::new(Vec::new()),
        }
    }

    fn motion(&self, body: Option<RigidBodyHandle>) -> Motion {
        body.and_then(|body| self.before.get(body.into_raw_parts().0 as usize))
            .copied()
            .unwrap_or_default()
    }

    fn report(
        &self,
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
        pair: &ContactPair,
    ) -> Option<Report> {
        let (one, two) = (&colliders[pair.collider1], &colliders[pair.collider2]);
        let a = self.entries.get(entry_index(one))?;
        let b = self.entries.get(entry_index(two))?;
        let (touch_a, touch_b) = (a.toucher?, b.toucher?);
        let (motion_a, motion_b) = (self.motion(one.parent()), self.motion(two.parent()));
        if motion_a.fastest + motion_b.fastest < self.min_speed {
            return None;
        }
        let (mut impulse, mut moment, mut speed) = (0.0, Vec3::ZERO, 0.0_f32);
        let (mut strongest, mut classes) = (0.0, (0, 0));
        for manifold in pair.solver_manifolds() {
            let mut here = 0.0;
            for contact in &manifold.data.solver_contacts {
                let index = contact.contact_indices()[0] as usize;
                let Some(point) = manifold.points.get(index) else {
                    continue;
                };
                let push = point.data.impulse;
                if push <= 0.0 {
                    continue;
                }
                let (p, q) = manifold.data.solver_contact_world_points(contact, bodies);
                let place = (p + q) * 0.5;
                let relative = motion_a.at(place) - motion_b.at(place);
                speed = speed.max(relative.dot(manifold.data.normal));
                impulse += push;
                here += push;
                moment += place * push;
            }
            if here > strongest {
                strongest = here;
                classes = (
                    a.surface.class(manifold.subshape1),
                    b.surface.class(manifold.subshape2),
                );
            }
        }
        let fast = impulse > 0.0 && speed >= self.min_speed;
        fast.then(|| {
            let swap = touch_a > touch_b;
            Report {
                pair: if swap {
                    (touch_b, touch_a)
                } else {
                    (touch_a, touch_b)
                },
                classes: if swap {
                    (classes.1, classes.0)
                } else {
                    classes
                },
                impulse,
                moment,
                speed,
            }
        })
    }

    /// Adds the step's reports to the impacts that go on; moves those that are over to `out`.
    pub(crate) fn settle(
        self,
        tick: u64,
        dt_s: f64,
        table: &ContactTable,
        min_impulse: f32,
        impacts: &mut Impacts,
        out: &mut Vec<ContactEvent>,
    ) {
        let mut reports = self
            .reports
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        // Sums over a pair's colliders must not depend on rapier's order of pairs.
        reports.sort_by(|a, b| {
            (a.pair, a.classes, a.impulse.to_bits()).cmp(&(b.pair, b.classes, b.impulse.to_bits()))
        });
        let mut seen: Vec<(Toucher, Toucher)> = Vec::new();
        for report in reports {
            let continues = seen.last() == Some(&report.pair);
            let impact = impacts.entry(report.pair).or_insert(Impact {
                first_tick: tick,
                steps: 0,
                impulse_n_s: 0.0,
                moment: Vec3::ZERO,
                speed_m_s: 0.0,
                classes: report.classes,
            });
            if !continues {
                impact.steps += 1;
                seen.push(report.pair);
            }
            impact.impulse_n_s += report.impulse;
            impact.moment += report.moment;
            impact.speed_m_s = impact.speed_m_s.max(report.speed);
        }
        if impacts.is_empty() {
            return;
        }
        impacts.retain(|pair, impact| {
            let goes_on = impact.steps < LONGEST_IMPACT_STEPS && seen.binary_search(pair).is_ok();
            if !goes_on && impact.impulse_n_s >= min_impulse {
                out.push(ContactEvent {
                    time_s: impact.first_tick as f64 * dt_s,
                    position: impact.moment / impact.impulse_n_s,
                    a: pair.0,
                    b: pair.1,
                    substance_a: table.substance(impact.classes.0),
                    substance_b: table.substance(impact.classes.1),
                    impulse_n_s: impact.impulse_n_s,
                    relative_normal_speed_m_s: impact.speed_m_s,
                });
            }
            goes_on
        });
    }
}

impl EventHandler for Collector<'_> {
    fn handle_collision_event(
        &self,
        _bodies: &RigidBodySet,
        _colliders: &ColliderSet,
        _event: CollisionEvent,
        _pair: Option<&ContactPair>,
    ) {
    }

    fn handle_contact_force_event(
        &self,
        _dt: f32,
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
        pair: &ContactPair,
        _total_force: f32,
    ) {
        if let Some(report) = self.report(bodies, colliders, pair) {
            self.reports
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .push(report);
        }
    }

    fn handle_soft_body_tear_event(&self, _soft: &SoftBodySet, _event: &SoftBodyTearEvent) {}
}
