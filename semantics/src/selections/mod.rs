//! Superlatives and ordinals: the choice of one of several things by its place in an order, "the second chair from the left".
//!
//! To add one: a file here that implements [`Selection`], and a line in [`all`].

mod closest_to;
mod farthest;
mod farthest_from;
mod from_left;
mod from_right;
mod highest;
mod largest;
mod lowest;
mod nearest;
mod smallest;
mod tallest;
mod widest;

use crate::error::SemanticsError;
use crate::predicates;
use crate::scene::{SemanticScene, Term, Viewer};
use crate::truth::UndecidedReason;

/// The least difference of logarithms of sizes: a ratio of 1.1, that of `larger_than`.
const RATIO_MARGIN: f32 = 0.095_310_18;
/// The least difference of distances and heights, m.
const LENGTH_MARGIN_M: f32 = 0.1;
const WEBER: &str = "A ratio of 1.1 of lengths is three times Weber's fraction of visual length, 0.029: R. Teghtsoonian, \
     Psychol. Rev. 78, 71 (1971).";
const OWN: &str = "Chosen here.";

/// An order of things, out of which one is selected by its place.
pub trait Selection: Sync {
    /// The name, in letters and underscores.
    fn name(&self) -> &'static str;

    /// The definition of the order, in one sentence with units.
    fn definition(&self) -> &'static str;

    /// The source of the order and of its margin.
    fn source(&self) -> &'static str;

    /// Returns whether it depends on a viewer.
    fn needs_viewer(&self) -> bool {
        false
    }

    /// Returns whether it depends on a reference, such as the bed in "closest to the bed".
    fn needs_reference(&self) -> bool {
        false
    }

    /// The sort key of a candidate; the smallest comes first. `None` for a thing that has no place in the order.
    fn key(
        &self,
        scene: &SemanticScene<'_>,
        candidate: Term,
        reference: Option<Term>,
        viewer: Option<&Viewer>,
    ) -> Option<f32>;

    /// The least difference of the keys of neighbours in the order that a person can see.
    fn margin(&self) -> f32;

    /// Selects the `n`-th of `candidates`, counted from 1. Things without a place in the order and the reference do not count.
    ///
    /// # Errors
    /// [`UndecidedReason::NoViewer`] and [`UndecidedReason::NoReference`] where one is needed and not given;
    /// [`UndecidedReason::NotInFront`] where no candidate is in front of the viewer; [`UndecidedReason::TooFew`] for fewer than
    /// `n`; [`UndecidedReason::TooClose`] where a neighbour in the order differs by less than the margin.
    fn select(
        &self,
        scene: &SemanticScene<'_>,
        candidates: &[Term],
        n: usize,
        reference: Option<Term>,
        viewer: Option<&Viewer>,
    ) -> Result<Term, UndecidedReason> {
        if self.needs_viewer() && viewer.is_none() {
            return Err(UndecidedReason::NoViewer);
        }
        if self.needs_reference() && reference.is_none() {
            return Err(UndecidedReason::NoReference);
        }
        let exists = |term: &Term| term.exists(scene.house(), scene.state);
        if !candidates.iter().chain(&reference).all(exists) {
            return Err(UndecidedReason::UnknownTerm);
        }
        let counted = candidates.iter().filter(|term| reference != Some(**term));
        let mut order: Vec<(f32, Term)> = counted
            .filter_map(|term| Some((self.key(scene, *term, reference, viewer)?, *term)))
            .filter(|(key, _)| key.is_finite())
            .collect();
        order.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
        order.dedup_by_key(|(_, term)| *term);
        if order.is_empty() && !candidates.is_empty() && self.needs_viewer() {
            return Err(UndecidedReason::NotInFront);
        }
        let place = n.checked_sub(1).ok_or(UndecidedReason::TooFew)?;
        let (key, chosen) = *order.get(place).ok_or(UndecidedReason::TooFew)?;
        let before = place.checked_sub(1).map(|place| key - order[place].0);
        let after = order.get(place + 1).map(|(next, _)| next - key);
        let apart = |gap: Option<f32>| gap.is_none_or(|gap| gap >= self.margin());
        if apart(before) && apart(after) {
            Ok(chosen)
        } else {
            Err(UndecidedReason::TooClose)
        }
    }
}

/// All orders.
pub fn all() -> &'static [&'static dyn Selection] {
    &[
        &from_left::FromLeft,
        &from_right::FromRight,
        &nearest::NearestToViewer,
        &farthest::FarthestFromViewer,
        &closest_to::ClosestTo,
        &farthest_from::FarthestFrom,
        &largest::Largest,
        &smallest::Smallest,
        &tallest::Tallest,
        &widest::Widest,
        &highest::Highest,
        &lowest::Lowest,
    ]
}

/// The order called `name`.
///
/// # Errors
/// [`SemanticsError::UnknownSelection`] lists those that exist.
pub fn find(name: &str) -> Result<&'static dyn Selection, SemanticsError> {
    let mut all_of_them = all().iter();
    let found = all_of_them.find(|selection| selection.name() == name);
    found
        .copied()
        .ok_or_else(|| SemanticsError::UnknownSelection {
            name: name.to_owned(),
            known: all().iter().map(|selection| selection.name()).collect(),
        })
}

/// The gap between two things, m.
fn gap_m(scene: &SemanticScene<'_>, a: Term, b: Term) -> Option<f32> {
    predicates::gap_m(scene, a, b)
}

/// The natural logarithm of a size; `None` unless it is positive.
fn logarithm(size: f32) -> Option<f32> {
    (size > 0.0).then(|| dwell_scene::math::ln(size))
}
