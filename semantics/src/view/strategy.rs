//! Strategies of referring to things.

use super::refer::refer_in_view;
use super::survey::ViewSurvey;
use crate::check::Checker;
use crate::form::{Description, Modifier, Noun, Phrase, Quantifier};
use crate::refer::{property_descriptions, refer, relation_modifiers, room_phrase};
use crate::scene::Term;
use dwell_scene::ObjectId;
use dwell_scene::interrupt;

/// How the description of a thing is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ReferStrategy {
    /// The shortest that fits the thing alone: properties before relations.
    #[default]
    Shortest,
    /// Properties in the order that speakers prefer (colour, material, size, room), each that rules out something else.
    ///
    /// # Source
    /// R. Dale and E. Reiter, Cognitive Science 19, 233 (1995).
    Incremental,
    /// By a relation to another thing wherever one tells it apart.
    Relational,
}

impl ReferStrategy {
    /// All strategies.
    pub const ALL: [Self; 3] = [Self::Shortest, Self::Incremental, Self::Relational];

    /// The name in the interfaces.
    pub fn name(self) -> &'static str {
        match self {
            Self::Shortest => "shortest",
            Self::Incremental => "incremental",
            Self::Relational => "relational",
        }
    }

    /// The strategy of a name.
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|own| own.name() == name)
    }
}

/// A description of `target` that the checker's listener takes for it alone: where there is a viewer and it sees `target`, of all
/// that is in sight, else of all that is in the house. `None` where no description of the strategy or a shorter one does that.
pub fn refer_to(
    checker: &Checker<'_>,
    target: ObjectId,
    strategy: ReferStrategy,
) -> Option<Description> {
    let viewer = checker.listener().viewer.as_ref();
    let survey = viewer.map(|viewer| ViewSurvey::of(checker.scene(), viewer));
    refer_by_survey(checker, survey.as_ref(), target, strategy)
}

/// As [`refer_to`], where what the listener sees is known.
pub fn refer_by_survey(
    checker: &Checker<'_>,
    survey: Option<&ViewSurvey>,
    target: ObjectId,
    strategy: ReferStrategy,
) -> Option<Description> {
    let scene = checker.scene();
    let denotes = |own: &Description| {
        interrupt::unwind_if_cancelled();
        checker.certain_referent(own) == Some(Term::Object(target))
    };
    let found = match strategy {
        ReferStrategy::Shortest => None,
        ReferStrategy::Incremental => Some(incremental(checker, target)).filter(denotes),
        ReferStrategy::Relational => {
            let own = property_descriptions(scene, target);
            let related = relation_modifiers(scene, target)
                .into_iter()
                .flat_map(|relation| {
                    let own = own.iter().take(2).cloned();
                    own.map(move |own| own.with_modifier(relation.clone()))
                });
            let related: Vec<Description> = related.collect();
            related.into_iter().find(denotes)
        }
    };
    let shortest = || match survey.filter(|survey| survey.objects.contains_key(&target)) {
        Some(survey) => refer_in_view(checker, survey, target),
        None => refer(scene, target).filter(denotes),
    };
    found.or_else(shortest)
}

/// The noun with each property that rules out something that the ones before leave.
fn incremental(checker: &Checker<'_>, target: ObjectId) -> Description {
    let scene = checker.scene();
    let facts = scene.facts(target);
    let noun = Noun::Object(facts.noun.clone());
    let mut description = Description::new(Quantifier::The, noun);
    let color = facts.spoken_colors().first();
    let room = scene.room_of(target).map(|room| room_phrase(scene, room));
    let with_color = |own: &Description| {
        let colors = color.map(|(word, _)| (*word).to_owned());
        Description {
            colors: colors.into_iter().collect(),
            ..own.clone()
        }
    };
    let with_material = |own: &Description| Description {
        material: facts.material_word().map(str::to_owned),
        ..own.clone()
    };
    let with_size = |own: &Description| Description {
        size: facts.size.word().map(|_| facts.size),
        ..own.clone()
    };
    let with_room = |own: &Description| {
        let room: Option<Phrase> = room.clone();
        let mut own = own.clone();
        let room = room.map(|room| Modifier::new("in_room", [room]));
        own.modifiers.extend(room);
        own
    };
    let steps: [&dyn Fn(&Description) -> Description; 4] =
        [&with_color, &with_material, &with_size, &with_room];
    for step in steps {
        let left = checker.possible_count(&description);
        if left <= 1 {
            break;
        }
        let longer = step(&description);
        let still = checker.possible_count(&longer);
        if still >= 1 && still < left {
            description = longer;
        }
    }
    description
}
