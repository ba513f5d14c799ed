//! Contacts over several steps: impacts that take a few steps, and pairs that slide or roll.

use super::body_motion::BodyMotion;
use super::collector::ContactReport;
use super::collider_entry::ContactEntity;
use super::events::{ContactEvent, ContactKind, ContactPhase};
use super::substances::ContactTable;
use crate::config::PhysicsConfig;
use crate::engine::RapierWorld;
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Physics steps over which one impact may last: the solver stops a body at the surface in one step and bounces it in
/// the next.
const LONGEST_IMPACT_STEPS: u8 = 3;
/// Slip of a rolling body is less than this share of its speed.
const ROLLING_SLIP: f32 = 0.2;

type ContactPair = (ContactEntity, ContactEntity);

/// An impact that may still go on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct ImpactAccumulator {
    time_s: f64,
    steps: u8,
    impulse_n_s: f32,
    tangential_n_s: f32,
    /// Sum of position times impulse.
    moment: Vec3,
    speed_m_s: f32,
    slip_m_s: f32,
    classes: (u16, u16),
}

/// The contact of a pair in the present control step, apart from impacts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct SustainedContactAccumulator {
    first_tick: u64,
    last_tick: u64,
    steps: u32,
    impulse_n_s: f32,
    tangential_n_s: f32,
    moment: Vec3,
    /// Sum of slip speed times impulse.
    slip: f32,
    /// Sum over the steps of the contact point's speed.
    travel: f32,
    /// The contact point in the last step.
    place: Vec3,
    classes: (u16, u16),
}

/// A pair that slid or rolled at the end of the last control step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct SlidingPair {
    kind: ContactKind,
    place: Vec3,
    classes: (u16, u16),
}

/// All contacts that may still go on, by pair.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct ContactTracker {
    impacts: BTreeMap<ContactPair, ImpactAccumulator>,
    touching: BTreeMap<ContactPair, SustainedContactAccumulator>,
    moving: BTreeMap<ContactPair, SlidingPair>,
    /// Displacement that the last step cut off by stopping a body at a surface, by its arena index, m.
    pub(super) undone_displacements: BTreeMap<u32, Vec3>,
}

impl ContactTracker {
    /// Drops events in progress.
    pub(crate) fn forget_events(&mut self) {
        self.impacts.clear();
        self.touching.clear();
        self.moving.clear();
    }

    /// Records the bodies that the last step stopped on their way: rapier moves fast bodies only a little into a surface,
    /// and the rest of their step is lost.
    pub(crate) fn record_ccd_lost_displacements(
        &mut self,
        engine: &RapierWorld,
        before: &[BodyMotion],
        dt_s: f32,
    ) {
        self.undone_displacements.clear();
        for handle in engine.islands.active_bodies() {
            let index = handle.into_raw_parts().0;
            let moved = before
                .get(index as usize)
                .zip(engine.bodies.get(handle))
                .and_then(|(motion, body)| motion.ccd_lost_displacement(body, dt_s));
            if let Some(rest) = moved {
                self.undone_displacements.insert(index, rest);
            }
        }
    }

    /// Adds a physics step's reports; impacts that ended go to `out`. `rebounds`: impulses added to the pairs' normal
    /// impulses, N·s.
    pub(crate) fn add_reports(
        &mut self,
        (mut reports, rebounds): (Vec<ContactReport>, &BTreeMap<ContactPair, f32>),
        tick: u64,
        config: &PhysicsConfig,
        table: &ContactTable,
        out: &mut Vec<ContactEvent>,
    ) {
        for group in reports.chunk_by_mut(|a, b| a.pair == b.pair) {
            if let Some(added) = rebounds.get(&group[0].pair) {
                let impulse: f32 = group.iter().map(|report| report.impulse).sum();
                for report in group {
                    report.scale(1.0 + added / impulse);
                }
            }
        }
        reports.retain(|report| report.impulse > 0.0);
        let mut hit: Vec<ContactPair> = Vec::new();
        let dt_s = 1.0 / f64::from(config.physics_rate_hz);
        for group in reports.chunk_by(|a, b| a.pair == b.pair) {
            let pair = group[0].pair;
            let speed = group
                .iter()
                .map(|report| report.approach_speed_m_s)
                .fold(0.0, f32::max);
            if speed >= config.event_min_speed_m_s {
                self.accumulate_impact(pair, group, tick as f64 * dt_s, dt_s as f32);
                hit.push(pair);
            } else {
                self.accumulate_contact(pair, group, tick, dt_s as f32);
            }
        }
        self.impacts.retain(|pair, impact| {
            let goes_on = impact.steps < LONGEST_IMPACT_STEPS && hit.binary_search(pair).is_ok();
            if !goes_on && impact.impulse_n_s >= config.event_min_impulse_n_s {
                out.push(impact.event(*pair, table));
            }
            goes_on
        });
    }

    fn accumulate_impact(
        &mut self,
        pair: ContactPair,
        group: &[ContactReport],
        begin_s: f64,
        dt_s: f32,
    ) {
        // The solver may stop a body shortly before it touches, or after a step in which it penetrated a little.
        let fastest = group
            .iter()
            .max_by(|a, b| a.approach_speed_m_s.total_cmp(&b.approach_speed_m_s));
        let meets_s = fastest.map_or(0.0, |report| {
            report.time_of_impact_s.clamp(-dt_s, 2.0 * dt_s)
        });
        let impulse: f32 = group.iter().map(|report| report.impulse).sum();
        let slip: f32 = group
            .iter()
            .map(|report| report.impulse_weighted_slip)
            .sum();
        let impact = self.impacts.entry(pair).or_insert(ImpactAccumulator {
            time_s: (begin_s + f64::from(meets_s)).max(0.0),
            steps: 0,
            impulse_n_s: 0.0,
            tangential_n_s: 0.0,
            moment: Vec3::ZERO,
            speed_m_s: 0.0,
            slip_m_s: slip / impulse,
            classes: group[0].classes,
        });
        impact.steps += 1;
        for report in group {
            impact.impulse_n_s += report.impulse;
            impact.tangential_n_s += report.tangential;
            impact.moment += report.impulse_weighted_position;
            impact.speed_m_s = impact.speed_m_s.max(report.impact_speed_m_s);
        }
    }

    fn accumulate_contact(
        &mut self,
        pair: ContactPair,
        group: &[ContactReport],
        tick: u64,
        dt_s: f32,
    ) {
        let impulse: f32 = group.iter().map(|report| report.impulse).sum();
        let moment: Vec3 = group
            .iter()
            .map(|report| report.impulse_weighted_position)
            .sum();
        let passing = group
            .iter()
            .map(|report| report.tangential_speed_m_s)
            .fold(0.0, f32::max);
        let place = moment / impulse;
        let before = self.touching.get(&pair).map(|touching| touching.place);
        let before = before.or(self.moving.get(&pair).map(|moving| moving.place));
        let touching = self
            .touching
            .entry(pair)
            .or_insert(SustainedContactAccumulator {
                first_tick: tick,
                classes: group[0].classes,
                ..SustainedContactAccumulator::default()
            });
        touching.last_tick = tick;
        touching.steps += 1;
        touching.impulse_n_s += impulse;
        touching.moment += moment;
        for report in group {
            touching.tangential_n_s += report.tangential;
            touching.slip += report.impulse_weighted_slip;
        }
        // The contact point moves when a body rolls, and jumps when pressure shifts under a resting one; a resting body
        // does not pass by.
        let moved = before.map_or(passing, |before| (place - before).length() / dt_s);
        touching.travel += moved.min(passing);
        touching.place = place;
    }

    /// Emits the sliding and rolling of a control step that ends at `tick`.
    pub(crate) fn emit_events(
        &mut self,
        tick: u64,
        config: &PhysicsConfig,
        table: &ContactTable,
        out: &mut Vec<ContactEvent>,
    ) {
        let dt_s = 1.0 / f64::from(config.physics_rate_hz);
        let mut still = BTreeMap::new();
        for (pair, touching) in std::mem::take(&mut self.touching) {
            let Some(kind) = touching.kind(config) else {
                continue;
            };
            let goes_on = self
                .moving
                .get(&pair)
                .is_some_and(|moving| moving.kind == kind);
            if goes_on {
                self.moving.remove(&pair);
            }
            let phase = if goes_on {
                ContactPhase::Continue
            } else {
                ContactPhase::Begin
            };
            out.push(touching.event(pair, (kind, phase), dt_s, table));
            let (place, classes) = (touching.place, touching.classes);
            still.insert(
                pair,
                SlidingPair {
                    kind,
                    place,
                    classes,
                },
            );
        }
        for (pair, moving) in std::mem::replace(&mut self.moving, still) {
            out.push(ContactEvent {
                time_s: tick as f64 * dt_s,
                ..empty_event(
                    pair,
                    (moving.kind, ContactPhase::End),
                    moving.place,
                    moving.classes,
                    table,
                )
            });
        }
    }
}

impl ContactReport {
    /// Scales its normal impulse by `times`.
    fn scale(&mut self, times: f32) {
        let times = times.max(0.0);
        self.impulse *= times;
        self.impulse_weighted_position *= times;
        self.impulse_weighted_slip *= times;
    }
}

impl ImpactAccumulator {
    fn event(&self, pair: ContactPair, table: &ContactTable) -> ContactEvent {
        let what = (ContactKind::Impact, ContactPhase::Once);
        ContactEvent {
            time_s: self.time_s,
            impulse_n_s: self.impulse_n_s,
            tangential_impulse_n_s: self.tangential_n_s,
            relative_normal_speed_m_s: self.speed_m_s,
            relative_tangential_speed_m_s: self.slip_m_s,
            ..empty_event(
                pair,
                what,
                self.moment / self.impulse_n_s,
                self.classes,
                table,
            )
        }
    }
}

impl SustainedContactAccumulator {
    fn slip_m_s(&self) -> f32 {
        self.slip / self.impulse_n_s
    }

    fn travel_m_s(&self) -> f32 {
        self.travel / self.steps as f32
    }

    /// Returns its kind; `None` when the two rested, rocked or hardly touched.
    fn kind(&self, config: &PhysicsConfig) -> Option<ContactKind> {
        if self.impulse_n_s < config.event_min_impulse_n_s {
            return None;
        }
        let (slip, travel) = (self.slip_m_s(), self.travel_m_s());
        let slowest = config.slide_min_speed_m_s;
        if slip >= slowest && slip >= ROLLING_SLIP * travel {
            Some(ContactKind::Scrape)
        } else {
            (travel >= slowest).then_some(ContactKind::Roll)
        }
    }

    fn event(
        &self,
        pair: ContactPair,
        what: (ContactKind, ContactPhase),
        dt_s: f64,
        table: &ContactTable,
    ) -> ContactEvent {
        let rolls = what.0 == ContactKind::Roll;
        ContactEvent {
            time_s: self.first_tick as f64 * dt_s,
            duration_s: self.steps as f32 * dt_s as f32,
            impulse_n_s: self.impulse_n_s,
            tangential_impulse_n_s: self.tangential_n_s,
            relative_tangential_speed_m_s: self.slip_m_s(),
            rolling_speed_m_s: if rolls { self.travel_m_s() } else { 0.0 },
            ..empty_event(
                pair,
                what,
                self.moment / self.impulse_n_s,
                self.classes,
                table,
            )
        }
    }
}

/// An event of a pair at a place, without time, force or speed.
fn empty_event(
    (a, b): ContactPair,
    (kind, phase): (ContactKind, ContactPhase),
    position: Vec3,
    classes: (u16, u16),
    table: &ContactTable,
) -> ContactEvent {
    let values = table.pair_contact(classes.0, classes.1);
    ContactEvent {
        kind,
        phase,
        time_s: 0.0,
        duration_s: 0.0,
        position,
        a,
        b,
        substance_a: table.substance(classes.0),
        substance_b: table.substance(classes.1),
        friction: values.friction,
        restitution: values.restitution,
        impulse_n_s: 0.0,
        tangential_impulse_n_s: 0.0,
        relative_normal_speed_m_s: 0.0,
        relative_tangential_speed_m_s: 0.0,
        rolling_speed_m_s: 0.0,
    }
}
