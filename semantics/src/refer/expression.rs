//! Referring expressions: their meaning and their text.

use crate::english::{qualified, with_article};
use crate::facts::ObjectFacts;
use crate::predicates;
use crate::room_kind::preposition;
use crate::scene::SemanticScene;
use crate::size::SizeClass;
use dwell_scene::ObjectId;
use dwell_scene::interrupt;
use serde::{Deserialize, Serialize};
use std::fmt::Write;

/// A description of an object by its properties. [`ReferringExpression::matches`] gives its meaning, [`ReferringExpression::text`] its
/// text; both rest on the same predicates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReferringExpression {
    /// Spoken noun.
    pub noun: String,
    /// Plain colour words, all of which the thing shows; may be empty.
    pub colors: Vec<String>,
    /// Adjective of a substance on at least a fifth of its surface.
    pub material: Option<String>,
    /// Its size for its kind.
    pub size: Option<SizeClass>,
    /// A relation to another thing.
    pub relation: Option<Relation>,
    /// The spoken noun of the room it is in.
    pub room: Option<String>,
}

/// A relation to a landmark.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Relation {
    /// The predicate's name.
    pub predicate: String,
    /// The landmark.
    pub landmark: Box<ReferringExpression>,
    /// True if the landmark's description fits one thing only, so that it takes "the".
    pub definite: bool,
}

impl ReferringExpression {
    /// A description by the noun alone.
    pub fn noun(noun: &str) -> Self {
        Self {
            noun: noun.to_owned(),
            colors: Vec::new(),
            material: None,
            size: None,
            relation: None,
            room: None,
        }
    }

    fn fits(&self, facts: &ObjectFacts) -> bool {
        let shows = |color: &String| facts.colors.iter().any(|(word, _)| word == color);
        let made_of = |word: &String| facts.adjectives().any(|adjective| adjective == *word);
        facts.is_called(&self.noun)
            && self.colors.iter().all(shows)
            && self.material.as_ref().is_none_or(made_of)
            && self.size.is_none_or(|size| facts.size == size)
    }

    /// Returns whether `object` fits the description in this scene. A relation fits when some landmark fits.
    pub fn fits_object(&self, scene: &SemanticScene<'_>, object: ObjectId) -> bool {
        let in_room = |name: &String| {
            scene
                .room_of(object)
                .is_some_and(|room| scene.semantics.room(room).is_called(name))
        };
        let related = |relation: &Relation| {
            let Ok(predicate) = predicates::find(&relation.predicate) else {
                return false;
            };
            predicates::related_objects(scene, predicate, object)
                .into_iter()
                .any(|landmark| relation.landmark.fits_object(scene, landmark))
        };
        self.fits(scene.facts(object))
            && self.room.as_ref().is_none_or(in_room)
            && self.relation.as_ref().is_none_or(related)
    }

    /// Every object that fits, in order.
    pub fn matches(&self, scene: &SemanticScene<'_>) -> Vec<ObjectId> {
        let alike = scene.distractors(&self.noun);
        let fitting = alike.matching(scene, self);
        let related = |object: &&ObjectId| {
            self.relation.is_none() || {
                interrupt::check();
                self.fits_object(scene, **object)
            }
        };
        fitting.iter().filter(related).copied().collect()
    }

    /// Adjectives and noun: "large brown wooden table".
    pub fn phrase(&self) -> String {
        let mut look = self.colors.join(" and ");
        if let Some(material) = &self.material {
            if !look.is_empty() {
                look.push(' ');
            }
            look.push_str(material);
        }
        qualified(
            self.size.and_then(SizeClass::word).unwrap_or_default(),
            &look,
            &self.noun,
        )
    }

    fn tail(&self) -> String {
        let mut text = String::new();
        if let Some(relation) = &self.relation {
            let landmark = if relation.definite {
                relation.landmark.definite()
            } else {
                relation.landmark.indefinite()
            };
            let words =
                predicates::find(&relation.predicate).map_or("near", predicates::Predicate::words);
            let _ = write!(text, " {words} {landmark}");
        }
        if let Some(room) = &self.room {
            let _ = write!(text, " {} the {room}", preposition(room));
        }
        text
    }

    /// With the definite article: "the brown chair next to the table in the kitchen".
    pub fn definite(&self) -> String {
        format!("the {}{}", self.phrase(), self.tail())
    }

    /// With the indefinite article: "a brown chair in the kitchen".
    pub fn indefinite(&self) -> String {
        format!("{}{}", with_article(&self.phrase()), self.tail())
    }

    /// "the ..." when exactly one object fits, else "a ...".
    pub fn text(&self, scene: &SemanticScene<'_>) -> String {
        if self.matches(scene).len() == 1 {
            self.definite()
        } else {
            self.indefinite()
        }
    }
}
