//! Random logical forms of every kind that the language has words for.

mod requests_and_questions;

pub(crate) use requests_and_questions::form;

use dwell_semantics::SizeClass;
use dwell_semantics::form::{
    AttributeKind, Clause, Description, Form, Modifier, Noun, OrdinalSelection, Phrase, Quality,
    Quantifier, Question, RequestStep, RoomSurface, RoomSurfaceKind, TurnDirection,
};
use proptest::prelude::*;

fn word(words: &'static [&'static str]) -> BoxedStrategy<String> {
    proptest::sample::select(words)
        .prop_map(str::to_owned)
        .boxed()
}

fn noun() -> BoxedStrategy<Noun> {
    let words = &[
        "chair",
        "bed",
        "coffee table",
        "TV stand",
        "lamp",
        "stack of books",
        "pair of shoes",
        "sofa",
        "door",
    ];
    word(words).prop_map(Noun::Object).boxed()
}

fn adjectives(quantifier: Quantifier) -> BoxedStrategy<Description> {
    let colors = &["red", "blue", "gray", "orange"];
    let sizes = [
        SizeClass::Tiny,
        SizeClass::Small,
        SizeClass::Large,
        SizeClass::Huge,
    ];
    (
        noun(),
        proptest::option::of(proptest::sample::select(sizes.to_vec())),
        proptest::option::of(word(&[
            "open",
            "closed",
            "switched_on",
            "switched_off",
            "half_open",
            "empty",
        ])),
        proptest::collection::vec(word(colors), 0..3),
        proptest::option::of(word(&["wooden", "leather", "steel"])),
    )
        .prop_map(move |(noun, size, state, colors, material)| Description {
            size,
            state,
            colors,
            material,
            ..Description::new(quantifier, noun)
        })
        .boxed()
}

fn relation() -> BoxedStrategy<String> {
    word(&[
        "on",
        "in",
        "next_to",
        "left_of",
        "behind",
        "under",
        "facing",
        "in_front_of",
    ])
    .boxed()
}

fn some(noun: Noun) -> Phrase {
    Description::new(Quantifier::Some, noun).into()
}

/// A piece of the building. "On the wall" is said of what hangs there, so that no thing is `on` these but on the floor.
fn structure(words: &'static [&'static str]) -> BoxedStrategy<Phrase> {
    let look = || proptest::option::weighted(0.2, word(&["white", "brick", "green"]));
    (word(words), look())
        .prop_map(|(word, look)| {
            let mut own = Description::new(Quantifier::Some, Noun::Structure(word));
            match look {
                Some(material) if material == "brick" => own.material = Some(material),
                color => own.colors.extend(color),
            }
            own.into()
        })
        .boxed()
}

/// A relation to a piece of the building.
fn structure_relation() -> BoxedStrategy<(String, Phrase)> {
    let by = word(&["next_to", "under", "facing", "attached_to", "against"]);
    prop_oneof![
        (by, structure(&["wall", "floor", "ceiling"])),
        (word(&["on", "in"]), structure(&["floor"])),
    ]
    .boxed()
}

/// A mount of hanging things.
fn mount() -> BoxedStrategy<Phrase> {
    prop_oneof![
        word(&["wall", "ceiling"]).prop_map(|word| some(Noun::Structure(word))),
        Just(some(Noun::Object("window".to_owned()))),
    ]
    .boxed()
}

fn side() -> BoxedStrategy<String> {
    word(&["on_left", "straight_ahead", "on_right"])
}

/// A way through a door: predicate and arguments after the door.
fn passage() -> BoxedStrategy<(String, Vec<Phrase>)> {
    prop_oneof![
        (word(&["leads_to", "leads_from"]), room()).prop_map(|(name, room)| (name, vec![room])),
        Just(("leads_outside".to_owned(), Vec::new())),
    ]
    .boxed()
}

fn landmark() -> BoxedStrategy<Phrase> {
    let plain =
        || prop_oneof![Just(Quantifier::The), Just(Quantifier::Some)].prop_flat_map(adjectives);
    let of = |mut outer: Description, predicate: String, inner: Phrase| {
        outer.modifiers.push(Modifier {
            negated: false,
            predicate,
            arguments: vec![inner],
        });
        outer
    };
    let to_thing = (plain(), relation(), plain());
    let by_verb = (plain(), word(&["contains", "supports"]), plain());
    let nested = prop_oneof![
        to_thing.prop_map(move |(outer, name, inner)| of(outer, name, inner.into())),
        by_verb.prop_map(move |(outer, name, inner)| of(outer, name, inner.into())),
        (plain(), room()).prop_map(move |(outer, inner)| of(outer, "in_room".to_owned(), inner)),
        (plain(), plain()).prop_map(move |(outer, inner)| of(
            outer,
            "belongs_to".to_owned(),
            inner.into()
        )),
    ];
    prop_oneof![
        4 => plain().prop_map(Phrase::from),
        1 => nested.prop_map(Phrase::from),
        1 => (2..40_u32).prop_flat_map(|n| adjectives(Quantifier::Exactly(n))).prop_map(Phrase::from),
        1 => (1..400_u32).prop_map(Phrase::Id),
        1 => Just(Phrase::Listener),
    ].boxed()
}

fn room() -> BoxedStrategy<Phrase> {
    let noun = word(&["kitchen", "bedroom", "living room", "balcony", "hall"]);
    let kinds = (0..7_u8, noun, 1..15_u32, adjectives(Quantifier::Some));
    kinds
        .prop_map(|(kind, noun, place, thing)| {
            let plain = |quantifier| Description::new(quantifier, Noun::Room(noun.clone()));
            let description = match kind {
                0 => plain(Quantifier::Some),
                1 => plain(Quantifier::Every),
                2 => Description {
                    selection: Some(OrdinalSelection {
                        order: "house".to_owned(),
                        place,
                        reference: None,
                    }),
                    ..plain(Quantifier::The)
                },
                3 => Description {
                    modifiers: vec![Modifier {
                        negated: false,
                        predicate: "room_contains".to_owned(),
                        arguments: vec![thing.into()],
                    }],
                    ..plain(Quantifier::The)
                },
                4 => plain(Quantifier::Some).with_modifier(Modifier {
                    negated: true,
                    ..Modifier::new(
                        Modifier::IDENTICAL,
                        [Description::new(Quantifier::The, Noun::Room("hall".to_owned())).into()],
                    )
                }),
                _ => plain(Quantifier::The),
            };
            description.into()
        })
        .boxed()
}

fn modifier() -> BoxedStrategy<Modifier> {
    let made = |predicate: String, arguments| Modifier {
        negated: false,
        predicate,
        arguments,
    };
    prop_oneof![
        (relation(), landmark()).prop_map(move |(name, to)| made(name, vec![to])),
        room().prop_map(move |room| made("in_room".to_owned(), vec![room])),
        (1..20_u32).prop_map(move |n| made("on_storey".to_owned(), vec![Phrase::Storey(n)])),
        (landmark(), landmark()).prop_map(move |(a, b)| made("between".to_owned(), vec![a, b])),
        structure_relation().prop_map(move |(name, to)| made(name, vec![to])),
        mount().prop_map(move |mount| made("hangs_on".to_owned(), vec![mount])),
        passage().prop_map(move |(name, to)| made(name, to)),
        side().prop_map(move |side| made(side, Vec::new())),
        landmark().prop_map(move |source| made("belongs_to".to_owned(), vec![source])),
        landmark().prop_map(|named| Modifier {
            negated: true,
            ..Modifier::new(Modifier::IDENTICAL, [named])
        }),
        word(&["visible", "held"]).prop_map(move |name| made(name, Vec::new())),
    ]
    .boxed()
}

fn quantifier() -> BoxedStrategy<Quantifier> {
    prop_oneof![
        Just(Quantifier::Some),
        Just(Quantifier::The),
        Just(Quantifier::Every),
        (2..30_u32).prop_map(Quantifier::All),
        Just(Quantifier::No),
        (1..30_u32).prop_map(Quantifier::Exactly),
        (1..30_u32).prop_map(Quantifier::AtLeast),
        (1..30_u32).prop_map(Quantifier::AtMost),
    ]
    .boxed()
}

fn described() -> BoxedStrategy<Description> {
    (
        quantifier().prop_flat_map(adjectives),
        proptest::collection::vec(modifier(), 0..3),
    )
        .prop_map(|(description, modifiers)| with_modifiers(description, modifiers))
        .boxed()
}

/// With more modifiers. Doors alone lead somewhere: "bring the chair to the kitchen" is not about a chair to a kitchen.
fn with_modifiers(mut description: Description, modifiers: Vec<Modifier>) -> Description {
    let any = Noun::Object(Noun::ANY_OBJECT.to_owned());
    let mut leading = modifiers.iter().map(|modifier| &modifier.predicate);
    if leading.any(|name| name.starts_with("leads_")) && description.noun != any {
        description.noun = Noun::Object("door".to_owned());
    }
    description.modifiers.extend(modifiers);
    description
}

/// "Nothing", with modifiers.
fn nothing() -> BoxedStrategy<Description> {
    let noun = || Noun::Object(Noun::ANY_OBJECT.to_owned());
    proptest::collection::vec(modifier(), 0..2)
        .prop_map(move |modifiers| Description {
            modifiers,
            ..Description::new(Quantifier::No, noun())
        })
        .boxed()
}

/// Two to four phrases of which a clause holds one by one.
fn list() -> BoxedStrategy<Phrase> {
    proptest::collection::vec(phrase(), 2..5)
        .prop_map(Phrase::List)
        .boxed()
}

/// A number of rooms or storeys.
fn counted() -> BoxedStrategy<Description> {
    let room = || word(&["room", "kitchen", "bedroom", "balcony", "children's room"]);
    prop_oneof![
        (room(), 2..30_u32)
            .prop_map(|(noun, n)| Description::new(Quantifier::Exactly(n), Noun::Room(noun))),
        (room(), 2..30_u32)
            .prop_map(|(noun, n)| Description::new(Quantifier::AtLeast(n), Noun::Room(noun))),
        (1..9_u32).prop_map(|n| Description::new(Quantifier::Exactly(n), Noun::Storey)),
    ]
    .boxed()
}

/// An item of what there is.
fn item() -> BoxedStrategy<Phrase> {
    prop_oneof![
        6 => phrase(),
        1 => nothing().prop_map(Phrase::from),
        1 => counted().prop_map(Phrase::from),
        1 => room(),
    ]
    .boxed()
}

/// Modifiers that all items of a list share: a place, a side of the viewer.
fn shared() -> BoxedStrategy<Vec<Modifier>> {
    let seen = || Modifier::new("visible", []);
    let hung = |(mount, room): (Phrase, Phrase)| {
        vec![
            Modifier::new("hangs_on", [mount]),
            Modifier::new("in_room", [room]),
        ]
    };
    prop_oneof![
        3 => modifier().prop_map(|one| vec![one]),
        1 => (mount(), room()).prop_map(hung),
        1 => side().prop_map(move |side| vec![Modifier::new(&side, []), seen()]),
    ]
    .boxed()
}

/// What there is: one item or a list of them, with what they share.
fn existing() -> BoxedStrategy<Phrase> {
    let things = (
        proptest::collection::vec(prop_oneof![5 => described(), 1 => nothing()], 1..4),
        shared(),
    );
    let rooms = (proptest::collection::vec(counted(), 1..4), 1..9_u32);
    let of = |mut items: Vec<Phrase>| match items.len() {
        1 => items.remove(0),
        _ => Phrase::List(items),
    };
    prop_oneof![
        3 => item(),
        2 => proptest::collection::vec(item(), 2..5).prop_map(Phrase::List),
        2 => things.prop_map(move |(items, shared)| {
            let items = items.into_iter();
            let items = items.map(|item| with_modifiers(item, shared.clone()).into());
            of(items.collect())
        }),
        1 => rooms.prop_map(move |(items, storey)| {
            let on = Modifier::new("on_storey", [Phrase::Storey(storey)]);
            let rooms = items.into_iter();
            let rooms = rooms.filter(|item| item.noun != Noun::Storey);
            let items: Vec<Phrase> = rooms.map(|item| item.with_modifier(on.clone()).into()).collect();
            if items.is_empty() { some(Noun::Object("bed".to_owned())) } else { of(items) }
        }),
    ]
    .boxed()
}

/// What the surfaces of a room look like.
fn surfaces() -> BoxedStrategy<Vec<RoomSurface>> {
    let color = || word(&["red", "white", "gray"]);
    let material = || word(&["wooden", "parquet"]);
    let floor = |color: Option<String>, material: Option<String>| RoomSurface {
        kind: RoomSurfaceKind::Floor,
        color,
        material,
    };
    let floor = prop_oneof![
        color().prop_map(move |color| floor(Some(color), None)),
        material().prop_map(move |material| floor(None, Some(material))),
        (color(), material()).prop_map(move |(color, material)| floor(Some(color), Some(material))),
    ];
    let walls = color().prop_map(|color| RoomSurface {
        kind: RoomSurfaceKind::Walls,
        color: Some(color),
        material: None,
    });
    (
        proptest::option::of(floor),
        proptest::option::of(walls.boxed()),
        color(),
    )
        .prop_map(|(floor, walls, color)| {
            let walls = match (&floor, walls) {
                (None, None) => Some(RoomSurface {
                    kind: RoomSurfaceKind::Walls,
                    color: Some(color),
                    material: None,
                }),
                (_, walls) => walls,
            };
            floor.into_iter().chain(walls).collect()
        })
        .boxed()
}

/// Clauses about rooms, which have no negation in words but that of "open to".
fn of_room() -> BoxedStrategy<Clause> {
    let open = |from, to| Clause::Holds {
        predicate: "open_to".to_owned(),
        arguments: vec![from, to],
    };
    prop_oneof![
        (room(), 1..99_u32).prop_map(|(room, square_metres)| Clause::Area {
            room,
            square_metres
        }),
        (room(), surfaces()).prop_map(|(room, surfaces)| Clause::HasSurfaces { room, surfaces }),
        (
            phrase(),
            prop_oneof![Just(Phrase::Listener), phrase()],
            1..99_u32
        )
            .prop_map(|(subject, from, metres)| Clause::Distance {
                subject,
                from,
                metres
            }),
        (room(), room()).prop_map(move |(from, to)| open(from, to)),
        (room(), proptest::collection::vec(room(), 2..4))
            .prop_map(move |(from, to)| open(from, Phrase::List(to))),
    ]
    .boxed()
}

fn selected() -> BoxedStrategy<Phrase> {
    let order = word(&[
        "from_left",
        "from_right",
        "largest",
        "nearest",
        "closest_to",
    ]);
    (adjectives(Quantifier::The), order, 1..20_u32, landmark())
        .prop_map(|(description, order, place, reference)| {
            let counted = order.starts_with("from");
            let reference = (order == "closest_to").then(|| Box::new(reference));
            let selection = OrdinalSelection {
                order,
                place: if counted { place } else { 1 },
                reference,
            };
            Description {
                selection: Some(selection),
                ..description
            }
            .into()
        })
        .boxed()
}

/// What something can be said to be on.
fn reference() -> BoxedStrategy<Phrase> {
    prop_oneof![
        6 => described().prop_map(Phrase::from),
        1 => selected(),
        1 => (1..400_u32).prop_map(Phrase::Id),
        1 => Just(Phrase::Listener),
        1 => structure(&["floor"]),
    ]
    .boxed()
}

fn phrase() -> BoxedStrategy<Phrase> {
    prop_oneof![
        12 => reference(),
        1 => structure(&["wall", "ceiling"]),
    ]
    .boxed()
}

fn quality() -> BoxedStrategy<Quality> {
    prop_oneof![
        word(&["red", "green"]).prop_map(Quality::Color),
        word(&["wooden", "leather"]).prop_map(Quality::Material),
        Just(Quality::Size(SizeClass::Small)),
        word(&["open", "half_open", "switched_off"]).prop_map(Quality::State),
    ]
    .boxed()
}

fn affirmed() -> BoxedStrategy<Clause> {
    let holds = |predicate: String, arguments| Clause::Holds {
        predicate,
        arguments,
    };
    prop_oneof![
        (phrase(), relation(), reference()).prop_map(move |(a, name, b)| holds(name, vec![a, b])),
        (phrase(), word(&["supports", "same_color"]), phrase())
            .prop_map(move |(a, name, b)| holds(name, vec![a, b])),
        (phrase(), room()).prop_map(move |(a, b)| holds("in_room".to_owned(), vec![a, b])),
        (phrase(), phrase(), phrase())
            .prop_map(move |(a, b, c)| holds("between".to_owned(), vec![a, b, c])),
        (phrase(), quality()).prop_map(|(subject, quality)| Clause::Is { subject, quality }),
        (described(), relation(), 2..9_u32).prop_map(move |(what, name, n)| {
            let several = what.with_quantifier(Quantifier::Exactly(n)).into();
            holds(name, vec![several, Phrase::EachOther])
        }),
        described().prop_map(|what| Clause::Exists(what.into())),
        nothing().prop_map(|what| Clause::Exists(what.into())),
        counted().prop_map(|what| Clause::Exists(what.into())),
        (phrase(), structure_relation()).prop_map(move |(a, (name, b))| holds(name, vec![a, b])),
        (phrase(), mount()).prop_map(move |(a, b)| holds("hangs_on".to_owned(), vec![a, b])),
        (room(), room()).prop_map(move |(a, b)| holds("open_to".to_owned(), vec![a, b])),
    ]
    .boxed()
}

/// Clauses without a negation in words.
fn affirmed_only() -> BoxedStrategy<Clause> {
    let holds = |predicate: String, arguments| Clause::Holds {
        predicate,
        arguments,
    };
    prop_oneof![
        3 => existing().prop_map(Clause::Exists),
        2 => of_room(),
        1 => (phrase(), side()).prop_map(move |(subject, side)| holds(side, vec![subject])),
        1 => (phrase(), passage()).prop_map(move |(door, (name, to))| {
            let arguments = std::iter::once(door).chain(to).collect();
            holds(name, arguments)
        }),
        1 => (list(), relation(), reference()).prop_map(move |(a, name, b)| holds(name, vec![a, b])),
        1 => (list(), room()).prop_map(move |(a, b)| holds("in_room".to_owned(), vec![a, b])),
        1 => (list(), relation())
            .prop_map(move |(a, name)| holds(name, vec![a, Phrase::EachOther])),
        1 => (list(), 1..9_u32)
            .prop_map(move |(a, n)| holds("on_storey".to_owned(), vec![a, Phrase::Storey(n)])),
        1 => (list(), quality()).prop_map(|(subject, quality)| Clause::Is { subject, quality }),
    ]
    .boxed()
}

/// Clauses about "it", which a sentence before names.
fn pronominal() -> BoxedStrategy<Clause> {
    let holds = |predicate: String, other| Clause::Holds {
        predicate,
        arguments: vec![Phrase::Pronoun, other],
    };
    let it = || Phrase::Pronoun;
    prop_oneof![
        (relation(), reference()).prop_map(move |(name, other)| holds(name, other)),
        room().prop_map(move |room| holds("in_room".to_owned(), room)),
        room().prop_map(move |room| holds("open_to".to_owned(), room)),
        quality().prop_map(move |quality| Clause::Is {
            subject: it(),
            quality
        }),
        (1..99_u32).prop_map(move |square_metres| Clause::Area {
            room: it(),
            square_metres
        }),
        surfaces().prop_map(move |surfaces| Clause::HasSurfaces {
            room: it(),
            surfaces
        }),
        proptest::collection::vec(described(), 1..4).prop_map(move |items| {
            let on = Modifier::new("on", [it()]);
            let items = items.into_iter();
            let items: Vec<Phrase> = items
                .map(|item| item.with_modifier(on.clone()).into())
                .collect();
            Clause::Exists(match &items[..] {
                [one] => one.clone(),
                _ => Phrase::List(items),
            })
        }),
    ]
    .boxed()
}

fn simple() -> BoxedStrategy<Clause> {
    prop_oneof![
        3 => affirmed(),
        3 => affirmed_only(),
        1 => affirmed().prop_map(|clause| Clause::Not(Box::new(clause))),
    ]
    .boxed()
}
