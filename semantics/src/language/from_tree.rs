//! Trees to forms: the meanings of the grammar's functions.

use super::lexicon::RELATION;
use crate::form::{
    AttributeKind, Clause, Description, Form, Modifier, Noun, Phrase, PlaceInOrder, Quality,
    Quantifier, Question, Request, RequestStep,
};
use crate::grammar::Tree;
use crate::size::SizeClass;

/// The function of a tree with its arguments; `None` for words and numbers.
fn parts(tree: &Tree) -> Option<(&str, &[Tree])> {
    match tree {
        Tree::Apply {
            function,
            arguments,
        } => Some((function, arguments)),
        Tree::Entry { .. } | Tree::Number { .. } => None,
    }
}

fn id(tree: &Tree) -> Option<String> {
    match tree {
        Tree::Entry { id, .. } => Some(id.clone()),
        Tree::Apply { .. } | Tree::Number { .. } => None,
    }
}

fn number(tree: &Tree) -> Option<u32> {
    match tree {
        Tree::Number { value, .. } => Some(*value),
        Tree::Apply { .. } | Tree::Entry { .. } => None,
    }
}

/// The form of the tree of a sentence; `None` for trees without a form.
pub(super) fn form(tree: &Tree) -> Option<Form> {
    Some(match parts(tree)? {
        ("claim", [inner]) => Form::Claim(clause(inner)?),
        ("request", [inner]) => Form::Request(plan(inner)?),
        ("ask", [inner]) => Form::Question(question(inner)?),
        _ => return None,
    })
}

fn clause(tree: &Tree) -> Option<Clause> {
    Some(match parts(tree)? {
        ("one_clause", [inner]) => simple(inner)?,
        ("all_clauses", [inner]) => Clause::All(list(inner)?),
        ("any_clause", [inner]) => Clause::Any(list(inner)?),
        _ => return None,
    })
}

fn list(tree: &Tree) -> Option<Vec<Clause>> {
    match parts(tree)? {
        ("and_pair" | "or_pair", [a, b]) => Some(vec![simple(a)?, simple(b)?]),
        ("and_more" | "or_more", [first, rest]) => {
            let mut all = vec![simple(first)?];
            all.extend(list(rest)?);
            Some(all)
        }
        _ => None,
    }
}

fn holds(predicate: &str, arguments: Vec<Phrase>) -> Clause {
    Clause::Holds {
        predicate: predicate.to_owned(),
        arguments,
    }
}

fn simple(tree: &Tree) -> Option<Clause> {
    let (function, arguments) = parts(tree)?;
    if let Some(plain) = function.strip_suffix("_not") {
        let inner = affirmed(plain, arguments)?;
        return Some(Clause::Not(Box::new(inner)));
    }
    affirmed(function, arguments)
}

fn affirmed(function: &str, arguments: &[Tree]) -> Option<Clause> {
    Some(match (function, arguments) {
        ("holds" | "holds_verb" | "whether_holds", [subject, word, object]) => {
            holds(&id(word)?, vec![phrase(subject)?, phrase(object)?])
        }
        ("holds_between", [subject, a, b]) => {
            holds("between", vec![phrase(subject)?, phrase(a)?, phrase(b)?])
        }
        ("holds_place" | "whether_place", [subject, place]) => {
            let (predicate, place) = place_of(place)?;
            holds(predicate, vec![phrase(subject)?, place])
        }
        ("is" | "whether_is", [subject, quality]) => Clause::Is {
            subject: phrase(subject)?,
            quality: quality_of(quality)?,
        },
        ("exists" | "whether_exists", [what]) => Clause::Exists(phrase(what)?),
        _ => return None,
    })
}

fn quality_of(tree: &Tree) -> Option<Quality> {
    Some(match parts(tree)? {
        ("quality_color", [word]) => Quality::Color(id(word)?),
        ("quality_material", [word]) => Quality::Material(id(word)?),
        ("quality_size", [word]) => Quality::Size(size(word)?),
        ("quality_state", [word]) => Quality::State(id(word)?),
        _ => return None,
    })
}

fn size(tree: &Tree) -> Option<SizeClass> {
    let word = id(tree)?;
    SizeClass::ALL
        .into_iter()
        .find(|size| size.word() == Some(&word))
}

fn place_of(tree: &Tree) -> Option<(&'static str, Phrase)> {
    Some(match parts(tree)? {
        ("place", [room]) => ("in_room", self::room(room)?),
        ("on_storey", [place]) => ("on_storey", Phrase::Storey(number(place)?)),
        _ => return None,
    })
}

fn room(tree: &Tree) -> Option<Phrase> {
    let (function, arguments) = parts(tree)?;
    let kind = |tree: &Tree, quantifier| match parts(tree)? {
        ("room_kind", [word]) => Some(Description::new(quantifier, Noun::Room(id(word)?))),
        _ => None,
    };
    let description = match (function, arguments) {
        ("room_the", [own]) => kind(own, Quantifier::The)?,
        ("room_a", [own]) => kind(own, Quantifier::Some)?,
        ("room_every", [own]) => kind(own, Quantifier::Every)?,
        ("room_no", [own]) => kind(own, Quantifier::No)?,
        ("room_nth", [place, own]) => Description {
            selection: Some(PlaceInOrder {
                order: PlaceInOrder::OF_HOUSE.to_owned(),
                place: number(place)?,
                reference: None,
            }),
            ..kind(own, Quantifier::The)?
        },
        ("room_with", [own, thing]) => Description {
            modifiers: vec![Modifier {
                negated: false,
                predicate: "contains".to_owned(),
                arguments: vec![phrase(thing)?],
            }],
            ..kind(own, Quantifier::The)?
        },
        _ => return None,
    };
    Some(description.into())
}

/// The noun phrase of a subtree; `None` for other parts.
pub(super) fn noun_phrase(tree: &Tree) -> Option<Phrase> {
    phrase(tree).or_else(|| room(tree))
}

fn phrase(tree: &Tree) -> Option<Phrase> {
    let (function, arguments) = parts(tree)?;
    let of = |quantifier, noun: &Tree| -> Option<Phrase> {
        Some(described(noun)?.with_quantifier(quantifier).into())
    };
    let selected =
        |noun: &Tree, order: &Tree, place, reference: Option<Phrase>| -> Option<Phrase> {
            let selection = PlaceInOrder {
                order: id(order)?,
                place,
                reference: reference.map(Box::new),
            };
            let description = Description {
                selection: Some(selection),
                ..described(noun)?.with_quantifier(Quantifier::The)
            };
            Some(description.into())
        };
    let that = |quantifier, noun: &Tree, predicate: String, other: Phrase| -> Option<Phrase> {
        let mut description = described(noun)?.with_quantifier(quantifier);
        description.modifiers.push(Modifier {
            negated: false,
            predicate,
            arguments: vec![other],
        });
        Some(description.into())
    };
    match (function, arguments) {
        ("the" | "i_the", [noun]) => of(Quantifier::The, noun),
        ("some" | "i_some", [noun]) => of(Quantifier::Some, noun),
        ("every" | "i_every", [noun]) => of(Quantifier::Every, noun),
        ("no", [noun]) => of(Quantifier::No, noun),
        ("exactly_one", [noun]) => of(Quantifier::Exactly(1), noun),
        ("exactly" | "i_exactly", [count, noun]) => of(Quantifier::Exactly(number(count)?), noun),
        ("at_least_one", [noun]) => of(Quantifier::AtLeast(1), noun),
        ("at_least", [count, noun]) => of(Quantifier::AtLeast(number(count)?), noun),
        ("i_the_that" | "i_the_that_verb", [noun, relation, other]) => {
            that(Quantifier::The, noun, id(relation)?, phrase(other)?)
        }
        ("i_some_that" | "i_some_that_verb", [noun, relation, other]) => {
            that(Quantifier::Some, noun, id(relation)?, phrase(other)?)
        }
        ("i_the_that_place", [noun, place]) => {
            let (predicate, place) = place_of(place)?;
            that(Quantifier::The, noun, predicate.to_owned(), place)
        }
        ("i_some_that_place", [noun, place]) => {
            let (predicate, place) = place_of(place)?;
            that(Quantifier::Some, noun, predicate.to_owned(), place)
        }
        ("nth", [place, noun, order]) => selected(noun, order, number(place)?, None),
        ("superlative", [order, noun]) => selected(noun, order, 1, None),
        ("selected_to", [noun, order, reference]) => {
            selected(noun, order, 1, Some(phrase(reference)?))
        }
        ("by_id" | "i_by_id", [own]) => Some(Phrase::Id(number(own)?)),
        ("you" | "i_you", []) => Some(Phrase::Listener),
        _ => None,
    }
}

/// The description of a noun with its adjectives and modifiers; the caller sets its quantifier.
fn described(tree: &Tree) -> Option<Description> {
    let (function, arguments) = parts(tree)?;
    let plain = |noun: String| Description::new(Quantifier::Some, Noun::Object(noun));
    Some(match (function, arguments) {
        ("plain", [inner]) => described(inner)?,
        ("with" | "but_not", [noun, added]) => {
            let mut description = described(noun)?;
            description.modifiers.push(Modifier {
                negated: function == "but_not",
                ..modifier(added)?
            });
            description
        }
        ("noun" | "tail", [word]) => plain(id(word)?),
        ("gathered", [head, tail]) => {
            let mut description = described(tail)?;
            let Noun::Object(tail) = &description.noun else {
                return None;
            };
            description.noun = Noun::Object(format!("{} of {tail}", id(head)?));
            description
        }
        ("color" | "color_tail", [word, inner]) => {
            let mut description = described(inner)?;
            description.colors.insert(0, id(word)?);
            (description.colors.len() == 1).then_some(description)?
        }
        ("two_colors" | "two_colors_tail", [one, two, inner]) => {
            let mut description = described(inner)?;
            if !description.colors.is_empty() {
                return None;
            }
            description.colors = vec![id(one)?, id(two)?];
            description
        }
        ("material" | "material_tail", [word, inner]) => {
            let mut description = described(inner)?;
            let before = description.material.replace(id(word)?);
            before.is_none().then_some(description)?
        }
        ("size" | "size_tail", [word, inner]) => {
            let mut description = described(inner)?;
            let before = description.size.replace(size(word)?);
            before.is_none().then_some(description)?
        }
        ("state", [word, inner]) => {
            let mut description = described(inner)?;
            let before = description.state.replace(id(word)?);
            before.is_none().then_some(description)?
        }
        _ => return None,
    })
}

fn modifier(tree: &Tree) -> Option<Modifier> {
    let (predicate, arguments) = match parts(tree)? {
        ("modifier" | "modifier_verb", [word, other]) => (id(word)?, vec![phrase(other)?]),
        ("modifier_between", [a, b]) => ("between".to_owned(), vec![phrase(a)?, phrase(b)?]),
        ("modifier_place", [place]) => {
            let (predicate, place) = place_of(place)?;
            (predicate.to_owned(), vec![place])
        }
        _ => return None,
    };
    Some(Modifier {
        negated: false,
        predicate,
        arguments,
    })
}

fn plan(tree: &Tree) -> Option<Request> {
    match parts(tree)? {
        ("one_step", [only]) => Some(Request::Sequence(vec![step(only)?])),
        ("then", [first, rest]) => {
            let Request::Sequence(rest) = plan(rest)? else {
                return None;
            };
            let mut steps = vec![step(first)?];
            steps.extend(rest);
            Some(Request::Sequence(steps))
        }
        ("if", [condition, then]) => Some(Request::If(simple(condition)?, step(then)?)),
        _ => None,
    }
}

fn step(tree: &Tree) -> Option<RequestStep> {
    Some(match parts(tree)? {
        ("go_to", [to]) => RequestStep::GoTo(room(to)?),
        ("do", [verb, object]) => RequestStep::Do {
            verb: id(verb)?,
            object: phrase(object)?,
        },
        ("do_not", [verb, object]) => RequestStep::DoNot {
            verb: id(verb)?,
            object: phrase(object)?,
        },
        ("put" | "put_modified", [object, relation, to]) => RequestStep::Put {
            object: phrase(object)?,
            predicate: id(relation)?,
            to: phrase(to)?,
        },
        ("put_in_place" | "put_modified_in_place", [object, place]) => {
            let (predicate, to) = place_of(place)?;
            RequestStep::Put {
                object: phrase(object)?,
                predicate: predicate.to_owned(),
                to,
            }
        }
        ("bring", [object, to]) => RequestStep::Bring {
            object: phrase(object)?,
            to: phrase(to)?,
        },
        ("bring_to_place", [object, to]) => RequestStep::Bring {
            object: phrase(object)?,
            to: room(to)?,
        },
        _ => return None,
    })
}

fn question(tree: &Tree) -> Option<Question> {
    let (function, arguments) = parts(tree)?;
    let attribute = |kind, of: &Tree| {
        let of = phrase(of)?;
        Some(Question::Attribute { kind, of })
    };
    let which = |kind: Option<&Tree>, clause: Clause| {
        let kind = match kind {
            Some(kind) => Some(Box::new(described(kind)?)),
            None => None,
        };
        Some(Question::Which { kind, clause })
    };
    match (function, arguments) {
        ("how_many", [what]) => Some(Question::HowMany(Box::new(described(what)?))),
        ("how_many_of", [what, added]) => {
            let mut description = described(what)?;
            description.modifiers.push(modifier(added)?);
            Some(Question::HowMany(Box::new(description)))
        }
        ("what_holds", [relation @ Tree::Entry { class, .. }, object]) if class == RELATION => {
            which(
                None,
                holds(&id(relation)?, vec![Phrase::Hole, phrase(object)?]),
            )
        }
        ("which_holds", [kind, relation, object]) => {
            let clause = holds(&id(relation)?, vec![Phrase::Hole, phrase(object)?]);
            which(Some(kind), clause)
        }
        ("which_place", [kind, place]) => {
            let (predicate, place) = place_of(place)?;
            which(Some(kind), holds(predicate, vec![Phrase::Hole, place]))
        }
        ("which_is", [kind, quality]) => {
            let quality = quality_of(quality)?;
            let subject = Phrase::Hole;
            which(Some(kind), Clause::Is { subject, quality })
        }
        ("where", [of]) => attribute(AttributeKind::Place, of),
        ("which_room", [of]) => attribute(AttributeKind::Room, of),
        ("what_color", [of]) => attribute(AttributeKind::Color, of),
        ("what_material", [of]) => attribute(AttributeKind::Material, of),
        _ => Some(Question::Whether(affirmed(function, arguments)?)),
    }
}
