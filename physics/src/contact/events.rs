//! Contact events: impacts, sliding and rolling.

use super::collider_entry::ContactEntity;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// The kind of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactKind {
    /// An impact.
    Impact,
    /// One slides over the other.
    Scrape,
    /// One rolls over the other: the contact point moves, and there is hardly any slip.
    Roll,
}

/// The phase of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactPhase {
    /// The whole event: an impact.
    Once,
    /// Sliding or rolling that began in this control step.
    Begin,
    /// Sliding or rolling that went on in this control step.
    Continue,
    /// The end of sliding or rolling; impulse, force and speeds are 0.
    End,
}

/// A contact event: an impact, or a control step of sliding or rolling.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ContactEvent {
    /// The kind of contact.
    pub kind: ContactKind,
    /// Begin, continuation or end.
    pub phase: ContactPhase,
    /// Simulated time since the world was made, s. Impacts: the time at which the surfaces met, within the physics step,
    /// from their gap and approach. Others: the first physics step of contact in this control step, or after the last one.
    pub time_s: f64,
    /// Its duration within this control step, s; 0 for impacts and ends.
    pub duration_s: f32,
    /// Position, m: the mean of the contact points, weighted by impulse.
    pub position: Vec3,
    /// The entity that sorts first: structure, then parts, then agents, each by number.
    pub a: ContactEntity,
    /// The other one.
    pub b: ContactEntity,
    /// The substance of `a` at the contact, by its name in the materials library.
    pub substance_a: &'static str,
    /// The substance of `b` at the contact.
    pub substance_b: &'static str,
    /// The friction coefficient of the two, with overrides; laws may change the value that acts.
    pub friction: f32,
    /// The restitution of the two, likewise.
    pub restitution: f32,
    /// The sum of all normal impulses of the impact, or of this control step, N·s.
    pub impulse_n_s: f32,
    /// Friction impulse in the same time, N·s: the sum over its physics steps. It is exact for a body with no other contact
    /// in the step; otherwise estimated from its share of the normal impulse in the last substep.
    pub tangential_impulse_n_s: f32,
    /// Impacts: approach speed along the normal, m/s; at least 0. Others: 0.
    pub relative_normal_speed_m_s: f32,
    /// Slip speed at the contact, m/s: at the beginning of an impact, the mean of sliding or rolling.
    pub relative_tangential_speed_m_s: f32,
    /// Rolling: speed of the contact point, m/s; else 0.
    pub rolling_speed_m_s: f32,
}

impl ContactEvent {
    /// The mean normal force while it lasted, N; 0 for impacts and ends.
    pub fn normal_force_n(&self) -> f32 {
        if self.duration_s > 0.0 {
            self.impulse_n_s / self.duration_s
        } else {
            0.0
        }
    }

    /// The mean friction force while it lasted, N; 0 for impacts and ends.
    pub fn friction_force_n(&self) -> f32 {
        if self.duration_s > 0.0 {
            self.tangential_impulse_n_s / self.duration_s
        } else {
            0.0
        }
    }
}

/// Events of a control step beyond its limit, which are merged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ExcessEventTotals {
    /// Number of events.
    pub count: usize,
    /// The sum of their normal impulses, N·s.
    pub impulse_n_s: f32,
}

/// Sorts the events from `first` on by time and pair, and keeps at most `most` of them: impacts before sliding and rolling,
/// the strongest impulse first.
pub(crate) fn merge_excess(
    events: &mut Vec<ContactEvent>,
    first: usize,
    most: usize,
) -> ExcessEventTotals {
    let new = &mut events[first..];
    let mut merged = ExcessEventTotals::default();
    if new.len() > most {
        new.sort_by(|x, y| {
            let impact = |event: &ContactEvent| event.kind != ContactKind::Impact;
            let strength = y.impulse_n_s.total_cmp(&x.impulse_n_s);
            let order = impact(x).cmp(&impact(y)).then(strength);
            order.then((x.a, x.b, x.kind, x.phase).cmp(&(y.a, y.b, y.kind, y.phase)))
        });
        for event in &new[most..] {
            merged.count += 1;
            merged.impulse_n_s += event.impulse_n_s;
        }
        events.truncate(first + most);
    }
    events[first..].sort_by(|x, y| {
        let order = x.time_s.total_cmp(&y.time_s);
        order.then((x.a, x.b, x.kind, x.phase).cmp(&(y.a, y.b, y.kind, y.phase)))
    });
    merged
}
