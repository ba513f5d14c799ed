//! Questions: forms to trees.

use super::existence::is_bare;
use super::lexicon::{RELATION, ROOM_NOUN};
use super::to_tree::{PhrasePosition, TreeBuilder};
use crate::form::{AttributeKind, Clause, Description, Noun, Phrase, Question};
use crate::grammar::Tree;

impl TreeBuilder<'_> {
    /// The tree of a question.
    pub(super) fn question(&self, question: &Question) -> Option<Tree> {
        Some(match question {
            Question::Whether(clause) => self.whether_question(clause)?,
            Question::HowMany(what) => match &what.noun {
                Noun::Room(noun) if is_bare(what) => {
                    Tree::apply("how_many_rooms", [self.lexicon_entry(ROOM_NOUN, noun)?])
                }
                Noun::Storey if is_bare(what) => Tree::apply("how_many_storeys", []),
                _ => Tree::apply("how_many", [self.with_modifiers(what)?]),
            },
            Question::Alternatives(clauses) => self.alternatives(clauses)?,
            Question::Which { kind, clause } => self.which(kind.as_deref(), clause)?,
            Question::HowFar {
                subject,
                from: Phrase::Listener,
            } => Tree::apply(
                "how_far_away",
                [self.phrase(subject, PhrasePosition::Free)?],
            ),
            Question::HowFar { subject, from } => Tree::apply(
                "how_far",
                [
                    self.phrase(subject, PhrasePosition::Free)?,
                    self.phrase(from, PhrasePosition::Free)?,
                ],
            ),
            Question::Attribute { kind, of } => {
                let function = match kind {
                    AttributeKind::Color => "what_color",
                    AttributeKind::Material => "what_material",
                    AttributeKind::Place => "where",
                    AttributeKind::Room => "which_room",
                };
                Tree::apply(function, [self.phrase(of, PhrasePosition::Free)?])
            }
        })
    }

    pub(super) fn whether_question(&self, clause: &Clause) -> Option<Tree> {
        let (function, arguments) = match clause {
            Clause::Holds {
                predicate,
                arguments,
            } => {
                let (name, arguments) = self.relation(predicate, arguments)?;
                let function = match name {
                    "holds" => "whether_holds",
                    "holds_place" => "whether_place",
                    "holds_mount" => "whether_mount",
                    "holds_each_other" => "whether_each_other",
                    "holds_closer" => "whether_closer",
                    "see_room_from" => "whether_see_room_from",
                    _ => return None,
                };
                (function, arguments)
            }
            Clause::Is { subject, quality } => {
                let subject = self.phrase(subject, PhrasePosition::Free)?;
                ("whether_is", vec![subject, self.quality(quality)?])
            }
            Clause::Exists(what) => ("whether_exists", vec![self.item(what)?]),
            Clause::More { more, than } => {
                let (more, than) = self.compared_nouns(more, than)?;
                ("whether_more", vec![more, than])
            }
            _ => return None,
        };
        Some(Tree::apply(function, arguments))
    }

    fn which(&self, kind: Option<&Description>, clause: &Clause) -> Option<Tree> {
        let kind = match kind {
            Some(kind) if kind.modifiers.is_empty() && kind.selection.is_none() => {
                Some(self.noun_with_adjectives(kind)?)
            }
            Some(_) => return None,
            None => None,
        };
        match (kind, clause) {
            (
                None,
                Clause::Holds {
                    predicate,
                    arguments,
                },
            ) if predicate == "between" => {
                let [Phrase::Hole, one, other] = &arguments[..] else {
                    return None;
                };
                let free = |phrase| self.phrase(phrase, PhrasePosition::Free);
                Some(Tree::apply("what_between", [free(one)?, free(other)?]))
            }
            (
                kind,
                Clause::Holds {
                    predicate,
                    arguments,
                },
            ) => {
                let [Phrase::Hole, object] = &arguments[..] else {
                    return None;
                };
                if let Some(word) = self.lexicon_entry(RELATION, predicate) {
                    let object = self.phrase(object, PhrasePosition::Free)?;
                    return Some(match kind {
                        Some(kind) => Tree::apply("which_holds", [kind, word, object]),
                        None => Tree::apply("what_holds", [word, object]),
                    });
                }
                if let Some(passage) = self.passage(predicate, std::slice::from_ref(object)) {
                    return Some(Tree::apply("which_leads", [kind?, passage]));
                }
                ["in_room", "on_storey"]
                    .contains(&predicate.as_str())
                    .then_some(())?;
                Some(Tree::apply("which_place", [kind?, self.place(object)?]))
            }
            (
                Some(kind),
                Clause::Is {
                    subject: Phrase::Hole,
                    quality,
                },
            ) => Some(Tree::apply("which_is", [kind, self.quality(quality)?])),
            _ => None,
        }
    }
}
