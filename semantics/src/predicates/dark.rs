//! The predicate `dark`.

use super::{OBJECT, Predicate, RelationProperties};
use crate::color::lightness;
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::{Truth, UndecidedReason};

/// The CIELAB lightness below which a surface is dark, and that from which on it is not.
const DARK: [f32; 2] = [46.0, 56.0];

/// See [`Predicate::definition`].
pub(super) struct Dark;

impl Predicate for Dark {
    fn name(&self) -> &'static str {
        "dark"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT]
    }

    fn definition(&self) -> &'static str {
        "The mean CIELAB lightness of what is seen of it, under white light, is below 46; not dark \
         from 56 on; undecided between, and of what is nearly all clear glass or mirror."
    }

    fn source(&self) -> &'static str {
        "K. L. Kelly, D. B. Judd, Color: Universal Language and Dictionary of Names, NBS Special \
         Publication 440, 1976: dark colours have Munsell values up to 4.5, which is a lightness \
         of 46; a step of value more is not dark."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties::default()
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let facts = args[0].object().map(|id| scene.facts(id));
        let seen = facts.filter(|facts| !facts.colors.is_empty());
        let [dark, not_dark] = DARK;
        match seen.and_then(|facts| lightness(&facts.patches)) {
            Some(mean) if mean < dark => Truth::True,
            Some(mean) if mean >= not_dark => Truth::False,
            _ => Truth::Undecided(UndecidedReason::Borderline),
        }
    }
}
