//! Questions as people put them; those of the first wordings are in [`super::from_tree`].

use super::from_tree::{described, holds, id, modifier, phrase, place_of, quality_of, room};
use super::{places, several};
use crate::form::{
    AttributeKind, Clause, Description, Modifier, Phrase, PlaceInOrder, Quality, Quantifier,
    Question,
};
use crate::grammar::Tree;

/// The question of a tree; `None` for other trees.
pub(super) fn from_tree(function: &str, arguments: &[Tree]) -> Option<Question> {
    let count = |description: Description| Question::HowMany(Box::new(description));
    let which = |kind: Option<Description>, clause: Clause| Question::Which {
        kind: kind.map(Box::new),
        clause,
    };
    Some(match (function, arguments) {
        ("how_many_quality", [noun, quality]) => {
            let mut description = described(noun)?;
            several::add_quality(&mut description, quality_of(quality)?)?;
            count(description)
        }
        ("how_many_quality_of", [noun, quality, added]) => {
            let mut description = described(noun)?.with_modifier(modifier(added)?);
            several::add_quality(&mut description, quality_of(quality)?)?;
            count(description)
        }
        ("whether_color_or", [subject, _, _]) => Question::Attribute {
            kind: AttributeKind::Color,
            of: phrase(subject)?,
        },
        ("whether_material_or", [subject, _, _]) => Question::Attribute {
            kind: AttributeKind::Material,
            of: phrase(subject)?,
        },
        ("whether_state_or", [subject, state, _]) => Question::Whether(Clause::Is {
            subject: phrase(subject)?,
            quality: Quality::State(id(state)?),
        }),
        ("how_many_seen_of", [noun, added]) => {
            let noun = described(noun)?.with_modifier(modifier(added)?);
            count(noun.with_modifier(Modifier::new("visible", [])))
        }
        ("how_many_of_two", [noun, one, other]) => {
            let noun = described(noun)?.with_modifier(modifier(one)?);
            count(noun.with_modifier(modifier(other)?))
        }
        ("which_carries", [kind, load]) => which(
            Some(described(kind)?),
            holds("supports", vec![Phrase::Hole, phrase(load)?]),
        ),
        ("which_holds_inside", [kind, content]) => which(
            Some(described(kind)?),
            holds("contains", vec![Phrase::Hole, phrase(content)?]),
        ),
        ("how_many_seen", [noun]) => {
            count(described(noun)?.with_modifier(Modifier::new("visible", [])))
        }
        ("how_many_room_has", [noun, place]) => {
            count(described(noun)?.with_modifier(Modifier::new("in_room", [room(place)?])))
        }
        ("what_place", [place]) => {
            let (predicate, place) = place_of(place)?;
            which(None, holds(&predicate, vec![Phrase::Hole, place]))
        }
        ("what_mount", [mount]) => {
            let mount = places::mount_from_tree(mount)?;
            which(None, holds("hangs_on", vec![Phrase::Hole, mount]))
        }
        ("which_mount", [kind, mount]) => {
            let mount = places::mount_from_tree(mount)?;
            which(
                Some(described(kind)?),
                holds("hangs_on", vec![Phrase::Hole, mount]),
            )
        }
        ("what_between", [a, b]) => which(
            None,
            holds("between", vec![Phrase::Hole, phrase(a)?, phrase(b)?]),
        ),
        ("which_stranded", [kind, subject, word]) => which(
            Some(described(kind)?),
            holds(&id(word)?, vec![phrase(subject)?, Phrase::Hole]),
        ),
        ("what_stranded", [subject, word]) => which(
            None,
            holds(&id(word)?, vec![phrase(subject)?, Phrase::Hole]),
        ),
        ("what_vps", [rest]) => which(None, several::clause(Phrase::Hole, rest)?),
        ("which_vps", [kind, rest]) => {
            which(Some(described(kind)?), several::clause(Phrase::Hole, rest)?)
        }
        ("which_superlative", [noun, order]) => {
            let kind = selected(described(noun)?, &id(order)?, None);
            which(Some(kind), Clause::Exists(Phrase::Hole))
        }
        ("which_order_to", [noun, order, reference]) => {
            let kind = selected(described(noun)?, &id(order)?, Some(phrase(reference)?));
            which(Some(kind), Clause::Exists(Phrase::Hole))
        }
        _ => return None,
    })
}

pub(super) fn selected(
    description: Description,
    order: &str,
    reference: Option<Phrase>,
) -> Description {
    Description {
        selection: Some(PlaceInOrder {
            order: order.to_owned(),
            place: 1,
            reference: reference.map(Box::new),
        }),
        ..description.with_quantifier(Quantifier::The)
    }
}
