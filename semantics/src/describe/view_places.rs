//! How far things in view are, and where they are to each other.

use super::text::claim;
use super::view::{BORDER, ViewContents, ViewLimits, ViewTeller};
use crate::check::rounded_distance_m;
use crate::form::{Clause, Description, Form, Phrase};
use crate::predicates;
use crate::refer::stands_between;
use crate::scene::Term;
use crate::view::Sighting;
use dwell_scene::{Aabb, ObjectId};

/// Share of the picture from which a thing is told with its place among others.
const LEAST_ANCHOR: f32 = 0.01;
/// Distance up to which things are told by their place to each other, m: farther ones are side by side in the picture alone.
const MAX_BESIDE_M: f32 = 1.0;
/// Length by which what stands under another thing may reach out from under it, m.
const MAX_EXCESS_M: f32 = 0.1;
/// Relations between two things in view, the most telling first. "Behind" is left out: people take it of a sofa's back, not of the view.
const RELATIONS: [&str; 5] = ["above", "under", "next_to", "left_of", "right_of"];

impl ViewTeller<'_, '_> {
    /// Says how far a thing is, in whole metres, where it is no nearer than that; returns whether it did.
    fn say_distance(&mut self, subject: &Description, sighting: Sighting) -> bool {
        let clause = |metres| Clause::Distance {
            subject: subject.clone().into(),
            from: Phrase::Listener,
            metres,
        };
        // By the box around the thing, which may be nearer than what is seen of it.
        let metres = rounded_distance_m(sighting.distance_m);
        let true_one = [metres, metres.saturating_sub(1)]
            .into_iter()
            .find(|metres| *metres > 0 && self.checker.check(&clause(*metres)).truth.is_true());
        if let Some(metres) = true_one {
            self.writer.say(Form::Claim(clause(metres)));
        }
        true_one.is_some()
    }

    /// Says where a thing is to one of those that were named before: by the most telling relation, to the largest.
    fn say_relation(
        &mut self,
        object: ObjectId,
        subject: &Description,
        before: &[(ObjectId, Description)],
    ) -> bool {
        let near = |other: ObjectId| {
            let (own, other) = (self.scene().extent(object), self.scene().extent(other));
            own.bounds.grown(MAX_BESIDE_M).intersects(&other.bounds)
        };
        let near: Vec<&(ObjectId, Description)> =
            before.iter().filter(|(other, _)| near(*other)).collect();
        let on_rug = |other: ObjectId| {
            let pair = [object, other];
            let [own, mark] = pair.map(|id| self.scene().extent(id).bounds);
            pair.iter().any(|id| self.scene().facts(*id).is_rug()) && overlap_in_plan(&own, &mark)
        };
        for name in RELATIONS {
            let held = |other: ObjectId| {
                let [own, mark] = [object, other].map(|id| self.scene().extent(id).bounds);
                let level = own.min.y < mark.max.y && mark.min.y < own.max.y;
                let fits = match name {
                    "above" => true,
                    "left_of" | "right_of" if self.is_wide(object) => false,
                    "left_of" | "right_of" if !self.is_beside_in_picture(object, other) => false,
                    // Furniture that stands on a rug in part is not beside it, nor is the rug under it.
                    "next_to" | "under" if on_rug(other) => false,
                    // A chair at a table is not under it, nor is one that stands half under.
                    "under" => own.max.y < mark.max.y && is_within_in_plan(&own, &mark),
                    "next_to" if stands_between(self.scene(), object, other) => false,
                    // A lamp on the ceiling is not to the left of a chair.
                    _ => level,
                };
                let pair = [object, other].map(Term::Object);
                fits && predicates::is_true(self.scene(), name, &pair, Some(&self.viewer))
            };
            let Some((_, landmark)) = near.iter().find(|(other, _)| held(*other)) else {
                continue;
            };
            let arguments = vec![subject.clone().into(), landmark.clone().into()];
            self.writer.say(claim(name, arguments));
            return true;
        }
        false
    }

    /// Says how far the largest things are, and where they are to each other.
    pub(super) fn say_places(&mut self, contents: &ViewContents, limits: &ViewLimits) {
        let mut anchors: Vec<ObjectId> = contents
            .sides
            .iter()
            .flat_map(|(_, objects)| objects.iter().copied())
            .filter(|object| self.share(*object) >= LEAST_ANCHOR)
            .collect();
        anchors.sort_by(|p, q| self.share(*q).total_cmp(&self.share(*p)).then(p.cmp(q)));
        let (mut relations, mut distances) = (limits.relations, limits.distances);
        let mut before: Vec<(ObjectId, Description)> = Vec::new();
        for object in anchors {
            // What is told by its place already needs no other.
            let Some(subject) = self.name(object).filter(|own| own.modifiers.is_empty()) else {
                continue;
            };
            if !self.scene().facts(object).belongs_to_opening() {
                let sighting = self.survey.objects[&object];
                // Of what runs out of the picture below nobody sees where it begins.
                let begins_in_picture = sighting.bottom > -BORDER;
                if distances > 0 && begins_in_picture && self.say_distance(&subject, sighting) {
                    distances -= 1;
                }
                if relations > 0 && self.say_relation(object, &subject, &before) {
                    relations -= 1;
                }
            }
            before.push((object, subject));
        }
    }
}

/// Returns whether two boxes have ground in common.
fn overlap_in_plan(one: &Aabb, other: &Aabb) -> bool {
    one.min.x < other.max.x
        && other.min.x < one.max.x
        && one.min.z < other.max.z
        && other.min.z < one.max.z
}

/// Returns whether the ground of a box lies within that of another but for [`MAX_EXCESS_M`].
fn is_within_in_plan(one: &Aabb, other: &Aabb) -> bool {
    let other = other.grown(MAX_EXCESS_M);
    one.min.x >= other.min.x
        && one.max.x <= other.max.x
        && one.min.z >= other.min.z
        && one.max.z <= other.max.z
}
