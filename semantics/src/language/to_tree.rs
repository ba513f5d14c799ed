//! Forms to trees: the functions of the grammar that express a form.

use super::existence::is_bare;
use super::lexicon::{
    ADJECTIVE_STATE, GATHERED, GATHERING, NOUN, ORDER, ORDER_TO, RELATION, ROOM, ROOM_NOUN,
    ROOM_SPOT, SUPERLATIVE, VERB_RELATION,
};
use super::places;
use crate::form::{
    Clause, Description, Form, Modifier, Noun, OrdinalSelection, Phrase, Quality, Quantifier,
};
use crate::grammar::{Lexicon, Tree};
use crate::size::SizeClass;

/// A builder of trees from forms, with the words of a lexicon.
pub(super) struct TreeBuilder<'a> {
    pub(super) lexicon: &'a Lexicon,
}

pub(super) fn count(value: u32) -> Tree {
    let class = "count".to_owned();
    Tree::Number { class, value }
}

pub(super) fn digits(value: u32) -> Tree {
    let class = "digits".to_owned();
    Tree::Number { class, value }
}

fn ordinal(value: u32) -> Tree {
    let class = "ordinal".to_owned();
    Tree::Number { class, value }
}

/// The position of a noun phrase. Landmarks have grammar functions of their own (`i_the`), with fewer modifiers.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum PhrasePosition {
    /// Subject, object, or the topic of a question.
    Free,
    /// Inside another noun phrase.
    Landmark,
}

impl TreeBuilder<'_> {
    fn has(&self, class: &str, id: &str) -> bool {
        self.lexicon.find(class, id).is_some()
    }

    pub(super) fn lexicon_entry(&self, class: &str, id: &str) -> Option<Tree> {
        self.has(class, id).then(|| Tree::entry(class, id))
    }

    pub(super) fn form(&self, form: &Form) -> Option<Tree> {
        Some(match form {
            Form::Claim(clause) => Tree::apply("claim", [self.clause(clause)?]),
            Form::Request(steps) => Tree::apply("request", [self.plan(steps)?]),
            Form::Several(forms) => self.form_pair(forms)?,
            Form::Question(question) => Tree::apply("ask", [self.question(question)?]),
            Form::NounPhrase(phrase) => match self.room(phrase) {
                Some(room) => Tree::apply("phrase_room", [room]),
                None => Tree::apply("phrase", [self.phrase(phrase, PhrasePosition::Free)?]),
            },
        })
    }

    pub(super) fn simple_clause(&self, clause: &Clause) -> Option<Tree> {
        let (clause, negated) = match clause {
            Clause::Not(inner) => (&**inner, true),
            clause => (clause, false),
        };
        let function = |plain: &str| format!("{plain}{}", if negated { "_not" } else { "" });
        Some(match clause {
            Clause::Holds {
                predicate,
                arguments,
            } => {
                let (name, trees) = self.relation(predicate, arguments)?;
                Tree::apply(&function(name), trees)
            }
            Clause::Is {
                subject: Phrase::List(items),
                quality,
            } if !negated => {
                Tree::apply("list_is", [self.subjects(items)?, self.quality(quality)?])
            }
            Clause::Is { subject, quality } => Tree::apply(
                &function("is"),
                [
                    self.phrase(subject, PhrasePosition::Free)?,
                    self.quality(quality)?,
                ],
            ),
            Clause::Exists(what) => self.existence(what, negated)?,
            Clause::More { more, than } if !negated => {
                let (more, than) = self.compared_nouns(more, than)?;
                Tree::apply("more", [more, than])
            }
            Clause::Area {
                room,
                square_metres,
            } if !negated => self.area(room, *square_metres)?,
            Clause::Distance {
                subject,
                from,
                metres,
            } if !negated => self.distance(subject, from, *metres)?,
            Clause::HasSurfaces { room, surfaces } if !negated => self.surfaces(room, surfaces)?,
            Clause::Area { .. }
            | Clause::Distance { .. }
            | Clause::More { .. }
            | Clause::HasSurfaces { .. }
            | Clause::Now(_)
            | Clause::Not(_)
            | Clause::All(_)
            | Clause::Any(_) => return None,
        })
    }

    /// The word of a relation to `landmark`; "on the wall" means hanging there.
    pub(super) fn relation_word(&self, predicate: &str, landmark: &Phrase) -> Option<Tree> {
        let hung = |own: &Description| match &own.noun {
            Noun::Structure(noun) => noun == "wall" || noun == "ceiling",
            _ => false,
        };
        match landmark {
            Phrase::Described(own) if predicate == "on" && hung(own) => None,
            _ => self.lexicon_entry(RELATION, predicate),
        }
    }

    /// The function of a clause with a relation, and its arguments.
    pub(super) fn relation(
        &self,
        predicate: &str,
        arguments: &[Phrase],
    ) -> Option<(&'static str, Vec<Tree>)> {
        let free = |phrase: &Phrase| self.phrase(phrase, PhrasePosition::Free);
        match (predicate, arguments) {
            ("in_room" | "on_storey", [Phrase::List(items), place]) => Some((
                "list_holds_place",
                vec![self.subjects(items)?, self.place(place)?],
            )),
            ("in_room" | "on_storey", [subject, place]) => {
                Some(("holds_place", vec![free(subject)?, self.place(place)?]))
            }
            ("visible_from_room", [subject, place]) if self.room(subject).is_some() => Some((
                "see_room_from",
                vec![self.room(place)?, self.room(subject)?],
            )),
            ("closer_to", [subject, near, far]) => Some((
                "holds_closer",
                vec![free(subject)?, free(near)?, free(far)?],
            )),
            (_, [subject, place]) if self.place_in_room(predicate, place).is_some() => Some((
                "holds_place",
                vec![free(subject)?, self.place_in_room(predicate, place)?],
            )),
            ("open_to", [from, to]) => self.open_to(from, to),
            ("leads_to" | "leads_from" | "leads_outside", [door, others @ ..]) => {
                let passage = self.passage(predicate, others)?;
                Some(("leads", vec![free(door)?, passage]))
            }
            ("hangs_on", [subject, mount]) if places::mount_to_tree(mount).is_some() => Some((
                "holds_mount",
                vec![free(subject)?, places::mount_to_tree(mount)?],
            )),
            (_, [Phrase::List(items), Phrase::EachOther]) => Some((
                "list_holds_each_other",
                vec![
                    self.subjects(items)?,
                    self.lexicon_entry(RELATION, predicate)?,
                ],
            )),
            (_, [subject, Phrase::EachOther]) => Some((
                "holds_each_other",
                vec![free(subject)?, self.lexicon_entry(RELATION, predicate)?],
            )),
            (side, [subject]) => Some(("holds_side", vec![free(subject)?, places::side_of(side)?])),
            (_, [Phrase::List(items), object]) => {
                let word = self.relation_word(predicate, object)?;
                Some((
                    "list_holds",
                    vec![self.subjects(items)?, word, free(object)?],
                ))
            }
            ("between", [subject, a, b]) => {
                Some(("holds_between", vec![free(subject)?, free(a)?, free(b)?]))
            }
            (_, [subject, landmark]) => {
                let (subject, object) = (free(subject)?, free(landmark)?);
                if let Some(word) = self.relation_word(predicate, landmark) {
                    return Some(("holds", vec![subject, word, object]));
                }
                let word = self.lexicon_entry(VERB_RELATION, predicate)?;
                Some(("holds_verb", vec![subject, word, object]))
            }
            _ => None,
        }
    }

    /// "The red chair, the white chair or the chair next to the bed".
    pub(super) fn disjunction(&self, items: &[Phrase]) -> Option<Tree> {
        let free = |phrase: &Phrase| self.phrase(phrase, PhrasePosition::Free);
        match items {
            [first, last] => Some(Tree::apply("any_pair", [free(first)?, free(last)?])),
            [first, rest @ ..] if rest.len() > 1 => Some(Tree::apply(
                "any_more",
                [free(first)?, self.disjunction(rest)?],
            )),
            _ => None,
        }
    }

    /// The noun of a description alone.
    pub(super) fn noun_of(&self, kind: &Description) -> Option<Tree> {
        match &kind.noun {
            Noun::Room(noun) => self.lexicon_entry(ROOM_NOUN, noun),
            _ => self.noun_with_adjectives(kind),
        }
    }

    fn subjects(&self, items: &[Phrase]) -> Option<Tree> {
        let free = |phrase: &Phrase| self.phrase(phrase, PhrasePosition::Free);
        match items {
            [first, last] => Some(Tree::apply("subjects_pair", [free(first)?, free(last)?])),
            [first, rest @ ..] if rest.len() > 1 => Some(Tree::apply(
                "subjects_more",
                [free(first)?, self.subjects(rest)?],
            )),
            _ => None,
        }
    }

    pub(super) fn place(&self, place: &Phrase) -> Option<Tree> {
        match place {
            Phrase::Storey(number) => Some(Tree::apply("on_storey", [ordinal(*number)])),
            place => Some(Tree::apply("place", [self.room(place)?])),
        }
    }

    /// A place within a room: "in the corner of the kitchen".
    pub(super) fn place_in_room(&self, predicate: &str, place: &Phrase) -> Option<Tree> {
        if predicate == "in_corner_of" && *place == places::any_room() {
            return Some(Tree::apply("place_corner", []));
        }
        let word = self.lexicon_entry(ROOM_SPOT, predicate)?;
        Some(Tree::apply("place_spot", [word, self.room(place)?]))
    }

    pub(super) fn quality(&self, quality: &Quality) -> Option<Tree> {
        Some(match quality {
            Quality::Color(word) => {
                Tree::apply("quality_color", [self.lexicon_entry("color", word)?])
            }
            Quality::Material(word) => {
                Tree::apply("quality_material", [self.lexicon_entry("material", word)?])
            }
            Quality::Size(size) => {
                Tree::apply("quality_size", [self.lexicon_entry("size", size.word()?)?])
            }
            Quality::State(name) => {
                Tree::apply("quality_state", [self.lexicon_entry("state", name)?])
            }
        })
    }

    pub(super) fn room(&self, phrase: &Phrase) -> Option<Tree> {
        let Phrase::Described(description) = phrase else {
            return None;
        };
        let Noun::Room(noun) = &description.noun else {
            return None;
        };
        let is_plain = description.size.is_none()
            && description.state.is_none()
            && description.colors.is_empty()
            && description.material.is_none();
        if !is_plain {
            return None;
        }
        let kind = Tree::apply("room_kind", [self.lexicon_entry(ROOM, noun)?]);
        match (
            &description.selection,
            &description.modifiers[..],
            description.quantifier,
        ) {
            (Some(selection), [], Quantifier::The)
                if selection.order == OrdinalSelection::OF_HOUSE =>
            {
                Some(Tree::apply("room_nth", [ordinal(selection.place), kind]))
            }
            (None, [with], quantifier @ (Quantifier::The | Quantifier::Some))
                if with.predicate == "room_contains" && !with.negated =>
            {
                let [thing] = &with.arguments[..] else {
                    return None;
                };
                let function = match quantifier {
                    Quantifier::The => "room_with",
                    _ => "room_some_with",
                };
                let thing = self.phrase(thing, PhrasePosition::Landmark)?;
                Some(Tree::apply(function, [kind, thing]))
            }
            (None, [other], Quantifier::Some)
                if other.predicate == Modifier::IDENTICAL && other.negated =>
            {
                let other = self.room(other.arguments.first()?)?;
                Some(Tree::apply("room_other_than", [kind, other]))
            }
            (None, [], quantifier) => {
                let function = match quantifier {
                    Quantifier::The => "room_the",
                    Quantifier::Some => "room_a",
                    Quantifier::Every => "room_every",
                    Quantifier::No => "room_no",
                    Quantifier::ThePlural
                    | Quantifier::All(_)
                    | Quantifier::Exactly(_)
                    | Quantifier::AtLeast(_)
                    | Quantifier::AtMost(_) => return None,
                };
                Some(Tree::apply(function, [kind]))
            }
            _ => None,
        }
    }

    pub(super) fn phrase(&self, phrase: &Phrase, position: PhrasePosition) -> Option<Tree> {
        let landmark = position == PhrasePosition::Landmark;
        Some(match phrase {
            Phrase::Pronoun => Tree::apply(if landmark { "i_it" } else { "it" }, []),
            Phrase::Described(description) if matches!(description.noun, Noun::Structure(_)) => {
                self.structure(description, position)?
            }
            Phrase::Id(id) => {
                Tree::apply(if landmark { "i_by_id" } else { "by_id" }, [digits(*id)])
            }
            Phrase::Listener => Tree::apply(if landmark { "i_you" } else { "you" }, []),
            Phrase::Described(description) if landmark => self.landmark(description)?,
            Phrase::Described(description) => self.described(description)?,
            Phrase::Speaker => Tree::apply(if landmark { "i_me" } else { "me" }, []),
            Phrase::Storey(_)
            | Phrase::EachOther
            | Phrase::Hole
            | Phrase::NamedBefore
            | Phrase::List(_) => return None,
        })
    }

    /// "Nothing", with modifiers.
    fn nothing(&self, description: &Description) -> Option<Tree> {
        let bare = Description {
            modifiers: Vec::new(),
            ..description.clone()
        };
        let any = Noun::Object(Noun::ANY_OBJECT.to_owned());
        if description.quantifier != Quantifier::No || description.noun != any || !is_bare(&bare) {
            return None;
        }
        let mut tree = Tree::apply("nothing", []);
        for modifier in &description.modifiers {
            if modifier.negated {
                return None;
            }
            tree = Tree::apply("nothing_with", [tree, self.modifier(modifier)?]);
        }
        Some(Tree::apply("np_nothing", [tree]))
    }

    fn landmark(&self, description: &Description) -> Option<Tree> {
        let own = self.noun_with_adjectives(description)?;
        if description.selection.is_some() {
            return None;
        }
        match (description.quantifier, &description.modifiers[..]) {
            (Quantifier::The, []) => Some(Tree::apply("i_the", [own])),
            (Quantifier::Some, []) => Some(Tree::apply("i_some", [own])),
            (Quantifier::Every, []) => Some(Tree::apply("i_every", [own])),
            (Quantifier::All(2), []) => Some(Tree::apply("i_both", [own])),
            (Quantifier::All(number), []) => {
                Some(Tree::apply("i_every_counted", [count(number), own]))
            }
            (Quantifier::Exactly(number), []) if number != 1 => {
                Some(Tree::apply("i_exactly", [count(number), own]))
            }
            (Quantifier::AtLeast(number), []) if number > 1 => {
                Some(Tree::apply("i_at_least", [count(number), own]))
            }
            (quantifier @ (Quantifier::The | Quantifier::Some), [only]) if !only.negated => {
                let [other] = &only.arguments[..] else {
                    return None;
                };
                let article = if quantifier == Quantifier::The {
                    "the"
                } else {
                    "some"
                };
                let named = |ending: &str| format!("i_{article}_that{ending}");
                if matches!(only.predicate.as_str(), "in_room" | "on_storey") {
                    return Some(Tree::apply(&named("_place"), [own, self.place(other)?]));
                }
                let other = self.phrase(other, PhrasePosition::Landmark)?;
                if only.predicate == "belongs_to" {
                    return Some(Tree::apply(&format!("i_{article}_from"), [own, other]));
                }
                if let Some(word) = self.lexicon_entry(RELATION, &only.predicate) {
                    return Some(Tree::apply(&named(""), [own, word, other]));
                }
                let word = self.lexicon_entry(VERB_RELATION, &only.predicate)?;
                Some(Tree::apply(&named("_verb"), [own, word, other]))
            }
            _ => None,
        }
    }

    fn described(&self, description: &Description) -> Option<Tree> {
        if let Some(nothing) = self.nothing(description) {
            return Some(nothing);
        }
        let noun = self.with_modifiers(description)?;
        if let Some(selection) = &description.selection {
            return self.selected(selection, description.quantifier, noun);
        }
        Some(match description.quantifier {
            Quantifier::Some => Tree::apply("some", [noun]),
            Quantifier::The => Tree::apply("the", [noun]),
            Quantifier::Every => Tree::apply("every", [noun]),
            Quantifier::ThePlural => Tree::apply("the_plural", [noun]),
            Quantifier::All(2) => Tree::apply("both", [noun]),
            Quantifier::All(number) => Tree::apply("every_counted", [count(number), noun]),
            Quantifier::No => Tree::apply("no", [noun]),
            Quantifier::Exactly(1) => Tree::apply("exactly_one", [noun]),
            Quantifier::Exactly(number) => Tree::apply("exactly", [count(number), noun]),
            Quantifier::AtMost(1) => Tree::apply("at_most_one", [noun]),
            Quantifier::AtMost(number) => Tree::apply("at_most", [count(number), noun]),
            Quantifier::AtLeast(1) => Tree::apply("at_least_one", [noun]),
            Quantifier::AtLeast(number) => Tree::apply("at_least", [count(number), noun]),
        })
    }

    fn selected(
        &self,
        selection: &OrdinalSelection,
        quantifier: Quantifier,
        noun: Tree,
    ) -> Option<Tree> {
        if quantifier != Quantifier::The {
            return None;
        }
        let OrdinalSelection {
            order,
            place,
            reference,
        } = selection;
        if let Some(reference) = reference {
            let reference = self.phrase(reference, PhrasePosition::Landmark)?;
            let order = self.lexicon_entry(ORDER_TO, order)?;
            return (*place == 1).then(|| Tree::apply("selected_to", [noun, order, reference]));
        }
        let superlative = self.lexicon_entry(SUPERLATIVE, order);
        if let Some(order) = self
            .lexicon_entry(ORDER, order)
            .filter(|_| superlative.is_none())
        {
            return Some(Tree::apply("nth", [ordinal(*place), noun, order]));
        }
        Some(match place {
            1 => Tree::apply("superlative", [superlative?, noun]),
            place => Tree::apply("nth_superlative", [ordinal(*place), superlative?, noun]),
        })
    }

    /// The noun with its adjectives and modifiers, in their order.
    pub(super) fn with_modifiers(&self, description: &Description) -> Option<Tree> {
        let mut noun = Tree::apply("plain", [self.noun_with_adjectives(description)?]);
        for modifier in &description.modifiers {
            if let Some(other) = self.other_than(modifier) {
                noun = Tree::apply("with", [noun, other]);
                continue;
            }
            let function = if modifier.negated { "but_not" } else { "with" };
            noun = Tree::apply(function, [noun, self.modifier(modifier)?]);
        }
        Some(noun)
    }

    /// "Other than the red chair"; `None` for other modifiers.
    fn other_than(&self, modifier: &Modifier) -> Option<Tree> {
        let [of] = &modifier.arguments[..] else {
            return None;
        };
        (modifier.negated && modifier.predicate == Modifier::IDENTICAL).then_some(())?;
        let of = self.phrase(of, PhrasePosition::Landmark)?;
        Some(Tree::apply("modifier_other", [of]))
    }

    fn modifier(&self, modifier: &Modifier) -> Option<Tree> {
        let landmark = |phrase: &Phrase| self.phrase(phrase, PhrasePosition::Landmark);
        if let Some(place) = self.place_modifier(modifier) {
            return Some(place);
        }
        match (modifier.predicate.as_str(), &modifier.arguments[..]) {
            ("in_room" | "on_storey", [place]) => {
                Some(Tree::apply("modifier_place", [self.place(place)?]))
            }
            (spot, [place]) if self.place_in_room(spot, place).is_some() => Some(Tree::apply(
                "modifier_place",
                [self.place_in_room(spot, place)?],
            )),
            ("belongs_to", [source]) => Some(Tree::apply("modifier_source", [landmark(source)?])),
            ("closer_to", [near, far]) => Some(Tree::apply(
                "modifier_closer",
                [landmark(near)?, landmark(far)?],
            )),
            ("between", [a, b]) => Some(Tree::apply(
                "modifier_between",
                [landmark(a)?, landmark(b)?],
            )),
            (predicate, [other]) => {
                if let Some(word) = self.relation_word(predicate, other) {
                    return Some(Tree::apply("modifier", [word, landmark(other)?]));
                }
                let word = self.lexicon_entry(VERB_RELATION, predicate)?;
                Some(Tree::apply("modifier_verb", [word, landmark(other)?]))
            }
            _ => None,
        }
    }

    /// Size, state, colours, material and noun, in this order; of groups ("pair of black shoes") colours and material stand after
    /// the "of".
    pub(super) fn noun_with_adjectives(&self, description: &Description) -> Option<Tree> {
        let Noun::Object(noun) = &description.noun else {
            return None;
        };
        let split = noun.split_once(" of ").filter(|(head, tail)| {
            self.has(GATHERING, head) && self.has(GATHERED, tail) && !self.has(NOUN, noun)
        });
        let (mut tree, ending) = match split {
            Some((_, tail)) => (Tree::apply("tail", [Tree::entry(GATHERED, tail)]), "_tail"),
            None => (Tree::apply("noun", [self.lexicon_entry(NOUN, noun)?]), ""),
        };
        let named = |plain: &str| format!("{plain}{ending}");
        if let Some(word) = &description.material {
            tree = Tree::apply(
                &named("material"),
                [self.lexicon_entry("material", word)?, tree],
            );
        }
        let color = |word: &String| self.lexicon_entry("color", word);
        tree = match &description.colors[..] {
            [] => tree,
            [one] => Tree::apply(&named("color"), [color(one)?, tree]),
            [one, two] => Tree::apply(&named("two_colors"), [color(one)?, color(two)?, tree]),
            _ => return None,
        };
        if let Some((head, _)) = split {
            tree = Tree::apply("gathered", [Tree::entry(GATHERING, head), tree]);
        }
        if let Some(state) = &description.state {
            tree = Tree::apply("state", [self.lexicon_entry(ADJECTIVE_STATE, state)?, tree]);
        }
        if let Some(word) = description.size.map(SizeClass::word) {
            tree = Tree::apply("size", [self.lexicon_entry("size", word?)?, tree]);
        }
        Some(tree)
    }
}
