//! Distances between things.

use super::Checker;
use super::witness::WitnessedTruth;
use crate::form::Phrase;
use crate::scene::{SemanticScene, Term};
use crate::truth::{Truth, UndecidedReason};
use dwell_scene::Aabb;
use glam::Vec3;

/// A distance in the whole numbers that people say, m.
pub(crate) fn rounded_distance_m(distance_m: f32) -> u32 {
    distance_m.round().max(1.0) as u32
}

fn bounds_of(scene: &SemanticScene<'_>, term: Term) -> Option<Aabb> {
    match term {
        Term::Object(object) => Some(scene.extent(object).bounds),
        Term::Agent(agent) => {
            let agent = scene.state.agents.get(agent)?;
            let eye = agent.world_from_eye().position;
            Some(Aabb::new(eye, eye))
        }
        Term::Structure(_) | Term::Room(_) | Term::Storey(_) | Term::Part(_) => None,
    }
}

/// The distance between the nearest points of the boxes around two things, m; of an agent that to its eyes. `None` for pieces of the building,
/// rooms, storeys and parts.
fn distance_m(scene: &SemanticScene<'_>, one: Term, other: Term) -> Option<f32> {
    let (one, other) = (bounds_of(scene, one)?, bounds_of(scene, other)?);
    let gap = (one.min - other.max).max(other.min - one.max);
    Some(gap.max(Vec3::ZERO).length())
}

/// The distance from an eye to the nearest point of the box around a thing, m; `None` as of [`distance_m`].
fn eye_distance_m(scene: &SemanticScene<'_>, eye: Vec3, term: Term) -> Option<f32> {
    let bounds = bounds_of(scene, term)?;
    Some(eye.distance(eye.clamp(bounds.min, bounds.max)))
}

impl Checker<'_> {
    /// The distance between two things, or from where the listener looks from, rounded to whole metres.
    pub(super) fn distance_between(
        &self,
        subject: &Phrase,
        from: &Phrase,
    ) -> Result<u32, UndecidedReason> {
        let subject = self.unique_referent(subject)?;
        let distance_m = if let (Phrase::Listener, Some(viewer)) = (from, &self.listener.viewer) {
            eye_distance_m(self.scene, viewer.world_from_camera.position, subject)
        } else {
            let from = self.unique_referent(from)?;
            distance_m(self.scene, subject, from)
        };
        let metres = distance_m.map(rounded_distance_m);
        metres.ok_or(UndecidedReason::WrongKind)
    }

    /// A thing is as far from another, or from where the listener looks from, as said, when rounded to whole metres.
    pub(super) fn is_at_distance(
        &self,
        subject: &Phrase,
        from: &Phrase,
        metres: u32,
    ) -> WitnessedTruth {
        let decide = |distance_m: Option<f32>, terms: &[Term]| {
            let truth = match distance_m {
                Some(distance_m) => Truth::from(rounded_distance_m(distance_m) == metres),
                None => Truth::Undecided(UndecidedReason::WrongKind),
            };
            WitnessedTruth::fact("distance", terms, truth)
        };
        if let (Phrase::Listener, Some(viewer)) = (from, &self.listener.viewer) {
            let eye = viewer.world_from_camera.position;
            let body = |terms: &[Term]| decide(eye_distance_m(self.scene, eye, terms[0]), terms);
            return self.quantify(std::slice::from_ref(subject), &mut Vec::new(), &body);
        }
        let body = |terms: &[Term]| decide(distance_m(self.scene, terms[0], terms[1]), terms);
        self.quantify(&[subject.clone(), from.clone()], &mut Vec::new(), &body)
    }
}
