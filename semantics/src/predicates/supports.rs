//! The predicate `supports`.

use super::{OBJECT, OBJECT_OR_STRUCTURE, Predicate, RelationProperties, on::On};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;
use dwell_scene::{ObjectId, interrupt};
use std::collections::BTreeMap;

impl SemanticScene<'_> {
    /// Returns the objects on an object or a structure piece, ascending.
    pub(crate) fn supported_objects(&self, carrier: Term) -> &[ObjectId] {
        let loads = self.loads.get_or_init(|| {
            let mut loads: BTreeMap<Term, Vec<ObjectId>> = BTreeMap::new();
            for thing in self.house().objects.ids() {
                interrupt::unwind_if_cancelled();
                for by in On.related(self, Term::Object(thing)) {
                    loads.entry(by).or_default().push(thing);
                }
            }
            loads
        });
        loads.get(&carrier).map_or(&[], Vec::as_slice)
    }
}

/// The converse of [`On`].
pub(super) struct Supports;

impl Predicate for Supports {
    fn name(&self) -> &'static str {
        "supports"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT_OR_STRUCTURE, OBJECT]
    }

    fn definition(&self) -> &'static str {
        "A thing or a piece of the building supports another thing exactly when that is on it."
    }

    fn source(&self) -> &'static str {
        "As of `on`."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            irreflexive: true,
            converse: Some("on"),
            ..RelationProperties::default()
        }
    }

    fn is_listed(&self) -> bool {
        true
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], viewer: Option<&Viewer>) -> Truth {
        On.decide(scene, &[args[1], args[0]], viewer)
    }

    fn related(&self, scene: &SemanticScene<'_>, subject: Term) -> Vec<Term> {
        scene
            .supported_objects(subject)
            .iter()
            .map(|id| Term::Object(*id))
            .collect()
    }
}
