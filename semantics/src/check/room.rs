//! Clauses about rooms: area and surfaces.

use super::Checker;
use super::witness::WitnessedTruth;
use crate::facts::shows_color;
use crate::form::{RoomSurface, RoomSurfaceKind};
use crate::scene::Term;
use crate::truth::{Truth, UndecidedReason};

/// A room's area in the whole numbers that people say, m².
pub(crate) fn rounded_area_m2(area_m2: f32) -> u32 {
    area_m2.round().max(1.0) as u32
}

impl Checker<'_> {
    pub(super) fn has_area(&self, term: Term, square_metres: u32) -> WitnessedTruth {
        let Term::Room(room) = term else {
            return WitnessedTruth::undecided(UndecidedReason::WrongKind);
        };
        let area_m2 = self.scene.semantics.room(room).area_m2;
        let truth = Truth::from(rounded_area_m2(area_m2) == square_metres);
        WitnessedTruth::fact("area", &[term], truth)
    }

    /// A room's walls have a colour.
    pub(super) fn has_walls(&self, term: Term, color: &str) -> WitnessedTruth {
        let walls = RoomSurface {
            kind: RoomSurfaceKind::Walls,
            color: Some(color.to_owned()),
            material: None,
        };
        self.has_surfaces(term, &[walls])
    }

    pub(super) fn has_surfaces(&self, term: Term, surfaces: &[RoomSurface]) -> WitnessedTruth {
        let Term::Room(room) = term else {
            return WitnessedTruth::undecided(UndecidedReason::WrongKind);
        };
        let facts = self.scene.semantics.room(room);
        WitnessedTruth::all(surfaces.iter().map(|surface| {
            let (name, color, material) = match surface.kind {
                RoomSurfaceKind::Floor => ("floor", facts.floor_color, facts.floor_word),
                RoomSurfaceKind::Walls => ("walls", facts.wall_color, None),
            };
            // No colour or substance may cover half of it.
            let color = surface
                .color
                .as_ref()
                .map_or(Truth::True, |stated| shows_color(color.into_iter(), stated));
            let stated = surface.material.as_deref();
            let truth = color.and(Truth::from(stated.is_none() || stated == material));
            WitnessedTruth::fact(name, &[term], truth)
        }))
    }
}
