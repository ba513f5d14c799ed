//! Clauses about rooms: their area, the look of their surfaces, open passages between them.

use super::from_tree::{number, parts, room};
use super::to_tree::{TreeBuilder, digits};
use crate::form::{Clause, Description, Noun, Phrase, Quantifier, RoomSurface, RoomSurfaceKind};
use crate::grammar::Tree;

fn entry_id(tree: &Tree) -> Option<String> {
    match tree {
        Tree::Entry { id, .. } => Some(id.clone()),
        Tree::Apply { .. } | Tree::Number { .. } => None,
    }
}

impl TreeBuilder<'_> {
    /// A room as the subject of a clause: "the kitchen", "it".
    fn room_subject(&self, room: &Phrase) -> Option<Tree> {
        Some(match room {
            Phrase::Pronoun => Tree::apply("room_it", []),
            room => Tree::apply("room_subject", [self.room(room)?]),
        })
    }

    pub(super) fn area(&self, room: &Phrase, square_metres: u32) -> Option<Tree> {
        let room = self.room_subject(room)?;
        Some(match square_metres {
            1 => Tree::apply("area_one", [room]),
            number => Tree::apply("area", [room, digits(number)]),
        })
    }

    pub(super) fn surfaces(&self, room: &Phrase, surfaces: &[RoomSurface]) -> Option<Tree> {
        let trees = surfaces.iter().map(|surface| self.surface(surface));
        let trees: Option<Vec<Tree>> = trees.collect();
        let kinds: Vec<RoomSurfaceKind> = surfaces.iter().map(|surface| surface.kind).collect();
        let function = match kinds[..] {
            [RoomSurfaceKind::Floor] => "surfaces_floor",
            [RoomSurfaceKind::Walls] => "surfaces_walls",
            [RoomSurfaceKind::Floor, RoomSurfaceKind::Walls] => "surfaces_both",
            _ => return None,
        };
        let surfaces = Tree::apply(function, trees?);
        Some(Tree::apply(
            "surfaces",
            [self.room_subject(room)?, surfaces],
        ))
    }

    fn surface(&self, surface: &RoomSurface) -> Option<Tree> {
        let color = |word: &String| self.lexicon_entry("color", word);
        let material = |word: &String| self.lexicon_entry("material", word);
        match (surface.kind, &surface.color, &surface.material) {
            (RoomSurfaceKind::Floor, Some(own), Some(substance)) => Some(Tree::apply(
                "floor_color_material",
                [color(own)?, material(substance)?],
            )),
            (RoomSurfaceKind::Floor, Some(own), None) => {
                Some(Tree::apply("floor_color", [color(own)?]))
            }
            (RoomSurfaceKind::Floor, None, Some(substance)) => {
                Some(Tree::apply("floor_material", [material(substance)?]))
            }
            (RoomSurfaceKind::Walls, Some(own), None) => {
                Some(Tree::apply("walls_color", [color(own)?]))
            }
            _ => None,
        }
    }

    /// The function of "`from` is open to `to`", and its arguments.
    pub(super) fn open_to(&self, from: &Phrase, to: &Phrase) -> Option<(&'static str, Vec<Tree>)> {
        let from = self.room_subject(from)?;
        Some(match to {
            Phrase::List(rooms) => ("open_to_list", vec![from, self.rooms(rooms)?]),
            one => ("open_to", vec![from, self.room(one)?]),
        })
    }

    fn rooms(&self, rooms: &[Phrase]) -> Option<Tree> {
        match rooms {
            [first, last] => Some(Tree::apply(
                "rooms_pair",
                [self.room(first)?, self.room(last)?],
            )),
            [first, rest @ ..] if rest.len() > 1 => Some(Tree::apply(
                "rooms_more",
                [self.room(first)?, self.rooms(rest)?],
            )),
            _ => None,
        }
    }
}

fn rooms_from_tree(tree: &Tree) -> Option<Vec<Phrase>> {
    match parts(tree)? {
        ("rooms_pair", [first, last]) => Some(vec![room(first)?, room(last)?]),
        ("rooms_more", [first, rest]) => {
            let mut all = vec![room(first)?];
            all.extend(rooms_from_tree(rest)?);
            Some(all)
        }
        _ => None,
    }
}

fn surface_from_tree(tree: &Tree) -> Option<RoomSurface> {
    let (kind, color, material) = match parts(tree)? {
        ("floor_color_material", [color, material]) => {
            (RoomSurfaceKind::Floor, Some(color), Some(material))
        }
        ("floor_color", [color]) => (RoomSurfaceKind::Floor, Some(color), None),
        ("floor_material", [material]) => (RoomSurfaceKind::Floor, None, Some(material)),
        ("walls_color", [color]) => (RoomSurfaceKind::Walls, Some(color), None),
        _ => return None,
    };
    Some(RoomSurface {
        kind,
        color: color.and_then(entry_id),
        material: material.and_then(entry_id),
    })
}

/// The clause of a tree about a room; `None` for other trees.
pub(super) fn from_tree(function: &str, arguments: &[Tree]) -> Option<Clause> {
    Some(match (function, arguments) {
        ("area", [own, metres]) => Clause::Area {
            room: room(own)?,
            square_metres: number(metres)?,
        },
        ("area_one", [own]) => Clause::Area {
            room: room(own)?,
            square_metres: 1,
        },
        ("surfaces" | "whether_surfaces", [own, surfaces]) => {
            let (_, surfaces) = parts(surfaces)?;
            let surfaces: Option<Vec<RoomSurface>> =
                surfaces.iter().map(surface_from_tree).collect();
            Clause::HasSurfaces {
                room: room(own)?,
                surfaces: surfaces?,
            }
        }
        ("walls_are" | "room_walls_are" | "floor_is", [place, look]) => {
            let place = match entry_id(place) {
                Some(noun) => Description::new(Quantifier::The, Noun::Room(noun)).into(),
                None => room(place)?,
            };
            let surface = match (entry_id(look), parts(look)) {
                (Some(color), _) => RoomSurface {
                    kind: RoomSurfaceKind::Walls,
                    color: Some(color),
                    material: None,
                },
                (_, Some((function, [word]))) => {
                    let is_color = function == "floor_look_color";
                    RoomSurface {
                        kind: RoomSurfaceKind::Floor,
                        color: entry_id(word).filter(|_| is_color),
                        material: entry_id(word).filter(|_| !is_color),
                    }
                }
                _ => return None,
            };
            Clause::HasSurfaces {
                room: place,
                surfaces: vec![surface],
            }
        }
        ("open_to", [from, to]) => Clause::Holds {
            predicate: "open_to".to_owned(),
            arguments: vec![room(from)?, room(to)?],
        },
        ("open_to_list", [from, to]) => Clause::Holds {
            predicate: "open_to".to_owned(),
            arguments: vec![room(from)?, Phrase::List(rooms_from_tree(to)?)],
        },
        _ => return None,
    })
}
