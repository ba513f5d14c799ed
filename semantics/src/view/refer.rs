//! Referring expressions for a listener who sees the thing.

use super::ViewSurvey;
use crate::check::Checker;
use crate::form::{Description, Modifier, Noun, OrdinalSelection, Phrase, Quantifier};
use crate::refer::{property_descriptions, relation_modifiers};
use crate::scene::Term;
use dwell_scene::ObjectId;
use dwell_scene::interrupt;

/// Relations to what stands beside a thing in the picture, in the order of trying.
const IN_PICTURE: [&str; 4] = ["in_front_of", "behind", "left_of", "right_of"];
/// Largest number of landmarks that are tried for relations in the picture.
const MAX_LANDMARKS: usize = 12;
/// Largest number of things of one noun that are counted from the left.
const MAX_COUNTED: usize = 6;

/// The shortest description of `target` that fits nothing else that the checker's listener sees, or that fits nothing else at all: by
/// its own properties, by what it lies on, in or beside, by its place among things of its kind from the left, and by what is before,
/// behind or beside it in the picture, in this order. `None` when none of them tells it apart, and without a viewer. Properties on
/// which people divide tell nothing apart, and no landmark is out of sight.
///
/// # Source
/// The order is that of R. Dale and E. Reiter, Cognitive Science 19, 233 (1995): properties before relations; a description is
/// accepted when a check of it finds the target alone.
pub fn refer_in_view(
    checker: &Checker<'_>,
    survey: &ViewSurvey,
    target: ObjectId,
) -> Option<Description> {
    let scene = checker.scene();
    let denotes = |description: &Description| {
        interrupt::unwind_if_cancelled();
        checker.certain_referent(description) == Some(Term::Object(target))
    };
    let own = property_descriptions(scene, target);
    if let Some(found) = own.iter().find(|description| denotes(description)) {
        return Some(found.clone());
    }
    let relations = relation_modifiers(scene, target).into_iter().filter(|relation| {
        let landmark = &relation.arguments[0];
        survey.objects.keys().any(
            |other| matches!(landmark, Phrase::Described(own) if scene.facts(*other).may_match_properties(own)),
        )
    });
    let relations: Vec<Modifier> = relations.collect();
    for description in own.iter().take(2) {
        for relation in &relations {
            let related = description.clone().with_modifier(relation.clone());
            if denotes(&related) {
                return Some(related);
            }
        }
    }
    if let Some(found) = counted_from_left(checker, survey, target) {
        return Some(found);
    }
    let mut landmarks: Vec<(f32, ObjectId)> = survey
        .objects
        .iter()
        .filter(|(other, _)| **other != target)
        .map(|(other, sighting)| (sighting.share, *other))
        .collect();
    landmarks.sort_by(|p, q| q.0.total_cmp(&p.0).then(p.1.cmp(&q.1)));
    for (_, landmark) in landmarks.into_iter().take(MAX_LANDMARKS) {
        let mut named = property_descriptions(scene, landmark).into_iter().take(2);
        let is_landmark =
            |own: &Description| checker.certain_referent(own) == Some(Term::Object(landmark));
        let Some(named) = named.find(is_landmark) else {
            continue;
        };
        for name in IN_PICTURE {
            let modifier = Modifier::new(name, [named.clone().into()]);
            let related = own[0].clone().with_modifier(modifier);
            if denotes(&related) {
                return Some(related);
            }
        }
    }
    None
}

/// "The second book from the left", of at most [`MAX_COUNTED`] that are seen.
fn counted_from_left(
    checker: &Checker<'_>,
    survey: &ViewSurvey,
    target: ObjectId,
) -> Option<Description> {
    let scene = checker.scene();
    let noun = &scene.facts(target).noun;
    let alike = survey.objects.keys();
    let alike = alike.filter(|other| scene.facts(**other).is_called(noun));
    let number = alike.count();
    if number > MAX_COUNTED {
        return None;
    }
    (1..=number as u32).find_map(|place| {
        let description = Description {
            selection: Some(OrdinalSelection {
                order: "from_left".to_owned(),
                place,
                reference: None,
            }),
            ..Description::new(Quantifier::The, Noun::Object(noun.clone()))
        };
        (checker.certain_referent(&description) == Some(Term::Object(target)))
            .then_some(description)
    })
}
