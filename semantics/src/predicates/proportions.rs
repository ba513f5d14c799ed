//! The sides of things against each other and against the usual ones of their kind.

use crate::scene::{SemanticScene, Term};
use crate::truth::{Truth, UndecidedReason};

/// The ratio to the usual measure of its kind from which a thing is named by it.
const OVER_USUAL: f32 = 1.2;

/// The sides of a thing's box, in the axes of its root part, and the usual ones of its kind, m.
#[expect(clippy::struct_field_names, reason = "the unit")]
pub(super) struct Proportions {
    /// The height.
    pub(super) height_m: f32,
    /// The longer horizontal side.
    pub(super) length_m: f32,
    /// The shorter horizontal side.
    pub(super) depth_m: f32,
    /// The usual height and longer horizontal side; `None` for unknown kinds.
    usual_m: Option<[f32; 2]>,
}

impl Proportions {
    /// Returns those of an object; `None` of other things.
    pub(super) fn of(scene: &SemanticScene<'_>, term: Term) -> Option<Self> {
        let facts = scene.facts(term.object()?);
        let own = facts.extents_m;
        let usual = facts.category.map(|row| row.size_m);
        Some(Self {
            height_m: own.y,
            length_m: own.x.max(own.z),
            depth_m: own.x.min(own.z),
            usual_m: usual.map(|[x, y, z]| [y, x.max(z)]),
        })
    }

    /// Returns whether it is clearly higher than usual, and clearly lower.
    pub(super) fn height_against_usual(&self) -> [bool; 2] {
        self.against_usual(self.height_m, 0)
    }

    /// Returns whether it is clearly longer than usual, and clearly shorter.
    pub(super) fn length_against_usual(&self) -> [bool; 2] {
        self.against_usual(self.length_m, 1)
    }

    fn against_usual(&self, own_m: f32, side: usize) -> [bool; 2] {
        self.usual_m.map_or([false; 2], |usual_m| {
            [
                own_m >= OVER_USUAL * usual_m[side],
                own_m * OVER_USUAL <= usual_m[side],
            ]
        })
    }
}

/// The truth of a word that one thing speaks for and another against; undecided where neither does, or both do.
pub(super) fn weighed(is_for: bool, is_against: bool) -> Truth {
    match (is_for, is_against) {
        (true, false) => Truth::True,
        (false, true) => Truth::False,
        _ => Truth::Undecided(UndecidedReason::Borderline),
    }
}

/// Returns whether a thing is tall, as against low.
pub(super) fn is_tall(scene: &SemanticScene<'_>, term: Term) -> Truth {
    let Some(own) = Proportions::of(scene, term) else {
        return Truth::Undecided(UndecidedReason::WrongKind);
    };
    let [higher, lower] = own.height_against_usual();
    weighed(
        higher || own.height_m >= 1.5 * own.length_m,
        lower || own.length_m >= 3.0 * own.height_m,
    )
}

/// Returns whether a thing is wide, as against narrow.
pub(super) fn is_wide(scene: &SemanticScene<'_>, term: Term) -> Truth {
    let Some(own) = Proportions::of(scene, term) else {
        return Truth::Undecided(UndecidedReason::WrongKind);
    };
    let [longer, shorter] = own.length_against_usual();
    weighed(
        longer || own.length_m >= 1.5 * own.height_m,
        shorter || own.height_m >= 3.0 * own.length_m,
    )
}
