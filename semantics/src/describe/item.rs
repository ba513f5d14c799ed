//! Things of one kind as an item of a list: "four brown wooden chairs".

use super::options::TextStyle;
use crate::color::SurfacePattern;
use crate::form::{Description, Noun, Quantifier};
use crate::predicates;
use crate::scene::{SemanticScene, Term};
use crate::size::SizeClass;
use dwell_scene::ObjectId;
use std::collections::BTreeMap;

/// Things of one noun.
pub(super) struct NounGroup {
    /// The things, in order.
    pub(super) objects: Vec<ObjectId>,
}

/// The states of joints: a thing that opens is in one of them.
const JOINT_STATES: [&str; 3] = ["open", "half_open", "closed"];

/// The state of a thing that a description names: how far it is open, of doors also that it is closed.
fn joint_state(scene: &SemanticScene<'_>, object: ObjectId) -> Option<&'static str> {
    let state = JOINT_STATES
        .into_iter()
        .find(|name| holds(scene, name, object))?;
    // A cupboard is closed as a rule; a door's state is always of interest.
    (state != "closed" || scene.facts(object).belongs_to_opening()).then_some(state)
}

fn holds(scene: &SemanticScene<'_>, name: &str, object: ObjectId) -> bool {
    predicates::is_true(scene, name, &[Term::Object(object)], None)
}

/// A description of a thing by its noun and openness, in rich style also by its size, pattern, colours and main substance.
pub(super) fn appearance(
    scene: &SemanticScene<'_>,
    object: ObjectId,
    style: TextStyle,
) -> Description {
    let facts = scene.facts(object);
    let state = joint_state(scene, object);
    let plain = Description::new(Quantifier::Some, Noun::Object(facts.noun.clone()));
    if style == TextStyle::Plain {
        return Description {
            state: state.map(str::to_owned),
            ..plain
        };
    }
    // No white whiteboard.
    let is_said = |word: &str| facts.noun.contains(word);
    let colors = facts.spoken_colors().iter();
    let colors = colors.filter(|(word, _)| !is_said(word));
    Description {
        // A usual size is an estimate: "tiny" and "huge" are told of nothing unasked.
        size: [SizeClass::Small, SizeClass::Large]
            .contains(&facts.size)
            .then_some(facts.size),
        state: state
            .or_else(|| facts.pattern.map(SurfacePattern::name))
            .map(str::to_owned),
        colors: colors.map(|(word, _)| (*word).to_owned()).collect(),
        material: facts.material_word().map(str::to_owned),
        ..plain
    }
}

/// Returns whether a thing fits what [`appearance`] may say of another.
fn fits(scene: &SemanticScene<'_>, object: ObjectId, description: &Description) -> bool {
    let in_state = |name: &String| holds(scene, name, object);
    scene.facts(object).matches_properties(description)
        && description.state.as_ref().is_none_or(in_state)
}

impl NounGroup {
    /// The group as an item of the list of what is in a place: with the adjectives that all of it share, and with the number of
    /// things in that place that fit. `candidates` are all things in the place.
    pub(super) fn item(
        &self,
        scene: &SemanticScene<'_>,
        candidates: &[ObjectId],
        style: TextStyle,
    ) -> Description {
        let mut shared = appearance(scene, self.objects[0], style);
        for object in &self.objects[1..] {
            let other = appearance(scene, *object, style);
            shared.size = shared.size.filter(|size| other.size == Some(*size));
            shared.state = shared
                .state
                .filter(|state| other.state.as_ref() == Some(state));
            shared.material = shared
                .material
                .filter(|material| other.material.as_ref() == Some(material));
            if shared.colors != other.colors {
                shared.colors.clear();
            }
        }
        let fitting = candidates
            .iter()
            .filter(|object| fits(scene, **object, &shared));
        let fitting: Vec<ObjectId> = fitting.copied().collect();
        let noun = &scene.facts(self.objects[0]).noun;
        let alike = |object: &ObjectId| scene.facts(*object).noun == *noun;
        let number = self.objects.len() as u32;
        let is_divided = |object: &ObjectId| {
            let facts = scene.facts(*object);
            facts.may_match_properties(&shared) && !facts.matches_properties(&shared)
        };
        let is_exact = fitting.iter().all(alike) && !candidates.iter().any(is_divided);
        // "Two tables" would be false beside a coffee table, which is a table, too; of "two white chairs" beside a cream one people
        // could count three.
        let quantifier = match (number, is_exact) {
            (1, _) => Quantifier::Some,
            (_, true) => Quantifier::Exactly(fitting.len() as u32),
            (number, false) => Quantifier::AtLeast(number),
        };
        shared.with_quantifier(quantifier)
    }
}

/// `objects` by spoken noun, the largest things first (they are seen first), then by noun.
pub(super) fn grouped(scene: &SemanticScene<'_>, objects: &[ObjectId]) -> Vec<NounGroup> {
    let mut groups: Vec<(f32, &str, NounGroup)> = Vec::new();
    let mut known: BTreeMap<&str, usize> = BTreeMap::new();
    for object in objects {
        let noun = scene.facts(*object).noun.as_str();
        let volume = scene.extent(*object).bounds.volume();
        let next = groups.len();
        let k = *known.entry(noun).or_insert(next);
        if k == next {
            let objects = Vec::new();
            groups.push((volume, noun, NounGroup { objects }));
        }
        let (largest, _, group) = &mut groups[k];
        *largest = largest.max(volume);
        group.objects.push(*object);
    }
    groups.sort_by(|p, q| q.0.total_cmp(&p.0).then(p.1.cmp(q.1)));
    groups.into_iter().map(|(_, _, group)| group).collect()
}

/// The items of the list of `objects`, which are among the `candidates` of one place.
pub(super) fn items(
    scene: &SemanticScene<'_>,
    objects: &[ObjectId],
    candidates: &[ObjectId],
    style: TextStyle,
) -> Vec<Description> {
    grouped(scene, objects)
        .iter()
        .map(|group| group.item(scene, candidates, style))
        .collect()
}
