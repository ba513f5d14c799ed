//! Places that need no landmark phrase of their own: mounts, ways through doors, sides of the viewer.

use super::existence::is_bare;
use super::from_tree::{entry_id, parts, room};
use super::lexicon::STRUCTURE;
use super::to_tree::{PhrasePosition, TreeBuilder};
use crate::form::{Clause, Description, Modifier, Noun, Phrase, Quantifier};
use crate::grammar::Tree;

/// Sides of the viewer: grammar function and predicate.
const SIDES: [(&str, &str); 3] = [
    ("side_left", "on_left"),
    ("side_ahead", "straight_ahead"),
    ("side_right", "on_right"),
];

/// The end of the functions of sides that do not say of what: "to the left".
const ANY_LANDMARK: &str = "_of_any";

fn mount_nouns() -> [(&'static str, Noun); 3] {
    [
        ("mount_wall", Noun::Structure("wall".to_owned())),
        ("mount_ceiling", Noun::Structure("ceiling".to_owned())),
        ("mount_window", Noun::Object("window".to_owned())),
    ]
}

/// Any room: that of "in the corner".
pub(super) fn any_room() -> Phrase {
    let noun = Noun::Room(Noun::ANY_ROOM.to_owned());
    Description::new(Quantifier::Some, noun).into()
}

/// A piece of the building: any of its kind, or of those that a modifier holds of.
pub(super) fn structure(noun: &Tree, modifier: Option<Modifier>) -> Option<Phrase> {
    let mut own = structure_description(noun)?;
    own.modifiers.extend(modifier);
    Some(own.into())
}

/// Every piece of a kind in the room that the listener is in.
pub(super) fn every_piece_here(noun: &Tree) -> Option<Phrase> {
    let here = Description::room_of_listener();
    quantified(
        Quantifier::Every,
        structure(noun, Some(Modifier::new("in_room", [here.into()])))?,
    )
}

/// Every piece of the building of a kind, or none of them.
pub(super) fn quantified_piece(
    quantifier: Quantifier,
    noun: &Tree,
    place: Option<&Tree>,
) -> Option<Phrase> {
    let there = match place {
        Some(place) => Some(Modifier::new("in_room", [room(place)?])),
        None => None,
    };
    quantified(quantifier, structure(noun, there)?)
}

fn quantified(quantifier: Quantifier, phrase: Phrase) -> Option<Phrase> {
    match phrase {
        Phrase::Described(own) => Some(own.with_quantifier(quantifier).into()),
        _ => None,
    }
}

/// A piece of the building with its colour and substance: "the white brick wall".
fn structure_description(noun: &Tree) -> Option<Description> {
    let plain = |noun: &Tree| {
        Some(Description::new(
            Quantifier::Some,
            Noun::Structure(entry_id(noun)?),
        ))
    };
    match parts(noun) {
        Some(("piece", [noun])) => plain(noun),
        Some(("piece_color", [color, inner])) => {
            let mut own = structure_description(inner)?;
            own.colors.insert(0, entry_id(color)?);
            (own.colors.len() == 1).then_some(own)
        }
        Some(("piece_material", [material, inner])) => {
            let mut own = structure_description(inner)?;
            let before = own.material.replace(entry_id(material)?);
            before.is_none().then_some(own)
        }
        _ => plain(noun),
    }
}

fn some(noun: Noun) -> Phrase {
    Description::new(Quantifier::Some, noun).into()
}

pub(super) fn mount_to_tree(mount: &Phrase) -> Option<Tree> {
    let found = mount_nouns()
        .into_iter()
        .find(|(_, noun)| *mount == some(noun.clone()));
    if let Some((function, _)) = found {
        return Some(Tree::apply(function, []));
    }
    let Phrase::Described(own) = mount else {
        return None;
    };
    let [side] = &own.modifiers[..] else {
        return None;
    };
    let wall = Noun::Structure("wall".to_owned());
    let any = Description::new(Quantifier::Some, wall).with_modifier(side.clone());
    (**own == any).then_some(())?;
    Some(Tree::apply(
        "mount_flank",
        [attributive_side_to_tree(side)?],
    ))
}

pub(super) fn mount_from_tree(tree: &Tree) -> Option<Phrase> {
    let (function, arguments) = parts(tree)?;
    if let ("mount_side" | "mount_flank", [side]) = (function, arguments) {
        let wall = Noun::Structure("wall".to_owned());
        let wall = Description::new(Quantifier::Some, wall);
        return Some(wall.with_modifier(side_from_tree(side)?).into());
    }
    let found = mount_nouns().into_iter().find(|(own, _)| *own == function);
    found.map(|(_, noun)| some(noun))
}

pub(super) fn side_to_tree(modifier: &Modifier) -> Option<Tree> {
    if modifier.negated || !modifier.arguments.is_empty() {
        return None;
    }
    side_of(&modifier.predicate)
}

/// The tree of a side before a noun: "the left wall".
fn attributive_side_to_tree(modifier: &Modifier) -> Option<Tree> {
    let side = side_to_tree(modifier)?;
    let (function, _) = parts(&side)?;
    Some(Tree::apply(&function.replace("side_", "flank_"), []))
}

/// The tree of a side by its predicate.
pub(super) fn side_of(predicate: &str) -> Option<Tree> {
    let found = SIDES.iter().find(|(_, own)| *own == predicate);
    found.map(|(function, _)| Tree::apply(function, []))
}

/// Puts the landmark that a clause has on a side in place of the listener in those after it: "The bin is to the left of the
/// toilet, and the basket is to the right."
pub(super) fn inherit_side_landmarks(clauses: &mut [Clause], trees: &[&Tree]) {
    let mut before: Option<Phrase> = None;
    for (clause, tree) in clauses.iter_mut().zip(trees) {
        let Clause::Holds {
            predicate,
            arguments,
        } = clause
        else {
            continue;
        };
        match (predicate.as_str(), &arguments[..], &before) {
            ("left_of" | "right_of", [_, landmark], _) => before = Some(landmark.clone()),
            ("on_left" | "on_right", [_], Some(landmark)) if has_side_without_landmark(tree) => {
                *predicate = predicate.replace("on_", "") + "_of";
                arguments.push(landmark.clone());
            }
            _ => {}
        }
    }
}

fn has_side_without_landmark(tree: &Tree) -> bool {
    parts(tree).is_some_and(|(function, arguments)| {
        function.ends_with(ANY_LANDMARK) || arguments.iter().any(has_side_without_landmark)
    })
}

pub(super) fn side_from_tree(tree: &Tree) -> Option<Modifier> {
    let (function, _) = parts(tree)?;
    let function = function.strip_suffix(ANY_LANDMARK).unwrap_or(function);
    // "The left wall" is the one on your left.
    let side = function.strip_prefix("flank_");
    let found = SIDES
        .iter()
        .find(|(own, _)| *own == function || side.is_some_and(|side| own.ends_with(side)));
    found.map(|(_, predicate)| Modifier::new(predicate, []))
}

/// The predicate and the place of a way through a door.
pub(super) fn passage_from_tree(tree: &Tree) -> Option<Modifier> {
    Some(match parts(tree)? {
        ("passage_to", [to]) => Modifier::new("leads_to", [room(to)?]),
        ("passage_from", [from]) => Modifier::new("leads_from", [room(from)?]),
        ("passage_outside", []) => Modifier::new("leads_outside", []),
        _ => return None,
    })
}

impl TreeBuilder<'_> {
    /// The tree of "the wall", which means any of that kind, with a side or a room.
    pub(super) fn structure(&self, own: &Description, position: PhrasePosition) -> Option<Tree> {
        let Noun::Structure(noun) = &own.noun else {
            return None;
        };
        let bare = Description {
            modifiers: Vec::new(),
            colors: Vec::new(),
            material: None,
            ..own.clone()
        };
        let noun = self.lexicon_entry(STRUCTURE, noun)?;
        if own.quantifier == Quantifier::Every && position == PhrasePosition::Free {
            let any = bare.with_quantifier(Quantifier::Some);
            return is_bare(&any).then(|| self.every_piece(own, noun))?;
        }
        if own.quantifier != Quantifier::Some || !is_bare(&bare) {
            return None;
        }
        if !own.colors.is_empty() || own.material.is_some() {
            return self.piece(own, noun, position);
        }
        let prefix = if position == PhrasePosition::Landmark {
            "i_"
        } else {
            ""
        };
        let named = |name: &str| format!("{prefix}{name}");
        Some(match &own.modifiers[..] {
            [] if position == PhrasePosition::Landmark => Tree::apply("i_structure", [noun]),
            [] => Tree::apply("structure_np", [noun]),
            [side] if attributive_side_to_tree(side).is_some() => Tree::apply(
                &named("structure_flank"),
                [attributive_side_to_tree(side)?, noun],
            ),
            [
                Modifier {
                    negated: false,
                    predicate,
                    arguments,
                },
            ] if predicate == "in_room" => {
                let room = self.room(arguments.first()?)?;
                Tree::apply(&named("structure_of"), [noun, room])
            }
            _ => return None,
        })
    }

    /// The tree of every piece of a kind, of a room or of all.
    fn every_piece(&self, own: &Description, noun: Tree) -> Option<Tree> {
        let piece = self.structure_noun_phrase(own, noun)?;
        match &own.modifiers[..] {
            [] => Some(Tree::apply("every_piece", [piece])),
            [there] if there.predicate == "in_room" && !there.negated => {
                let room = self.room(there.arguments.first()?)?;
                Some(Tree::apply("every_piece_of", [piece, room]))
            }
            _ => None,
        }
    }

    /// The tree of a piece with its colour and substance.
    fn structure_noun_phrase(&self, own: &Description, noun: Tree) -> Option<Tree> {
        let mut tree = Tree::apply("piece", [noun]);
        if let Some(word) = &own.material {
            tree = Tree::apply(
                "piece_material",
                [self.lexicon_entry("material", word)?, tree],
            );
        }
        match &own.colors[..] {
            [] => {}
            [color] => {
                tree = Tree::apply("piece_color", [self.lexicon_entry("color", color)?, tree]);
            }
            _ => return None,
        }
        Some(tree)
    }

    /// The tree of any piece with its colour and substance.
    fn piece(&self, own: &Description, noun: Tree, position: PhrasePosition) -> Option<Tree> {
        let tree = self.structure_noun_phrase(own, noun)?;
        match (&own.modifiers[..], position) {
            ([], PhrasePosition::Landmark) => Some(Tree::apply("i_piece_np", [tree])),
            ([], PhrasePosition::Free) => Some(Tree::apply("piece_np", [tree])),
            ([there], position) if there.predicate == "in_room" && !there.negated => {
                let function = match position {
                    PhrasePosition::Landmark => "i_piece_of",
                    PhrasePosition::Free => "piece_of",
                };
                let room = self.room(there.arguments.first()?)?;
                Some(Tree::apply(function, [tree, room]))
            }
            _ => None,
        }
    }

    pub(super) fn passage(&self, predicate: &str, others: &[Phrase]) -> Option<Tree> {
        match (predicate, others) {
            ("leads_to", [to]) => Some(Tree::apply("passage_to", [self.room(to)?])),
            ("leads_from", [from]) => Some(Tree::apply("passage_from", [self.room(from)?])),
            ("leads_outside", []) => Some(Tree::apply("passage_outside", [])),
            _ => None,
        }
    }

    /// The tree of a modifier of this file; `None` for others.
    pub(super) fn place_modifier(&self, modifier: &Modifier) -> Option<Tree> {
        let others = &modifier.arguments[..];
        match (modifier.predicate.as_str(), others) {
            ("hangs_on", [mount]) => Some(Tree::apply("modifier_mount", [mount_to_tree(mount)?])),
            ("held", []) => Some(Tree::apply("modifier_held", [])),
            ("visible", []) => Some(Tree::apply("modifier_seen", [])),
            (state, []) if self.lexicon_entry("state", state).is_some() => Some(Tree::apply(
                "modifier_state",
                [self.lexicon_entry("state", state)?],
            )),
            (predicate, []) if side_of(predicate).is_some() => {
                Some(Tree::apply("modifier_side", [side_of(predicate)?]))
            }
            (predicate, others) => Some(Tree::apply(
                "modifier_passage",
                [self.passage(predicate, others)?],
            )),
        }
    }
}

/// The modifier of a tree of this file; `None` for others.
pub(super) fn modifier_from_tree(function: &str, arguments: &[Tree]) -> Option<Modifier> {
    Some(match (function, arguments) {
        ("modifier_mount", [mount]) => Modifier::new("hangs_on", [mount_from_tree(mount)?]),
        ("modifier_held", []) => Modifier::new("held", []),
        ("modifier_seen", []) => Modifier::new("visible", []),
        ("modifier_side", [side]) => side_from_tree(side)?,
        ("modifier_passage", [passage]) => passage_from_tree(passage)?,
        _ => return None,
    })
}
