//! The predicate `visible_from`, in any direction of view.

use super::{AGENT, OBJECT, Predicate, RelationProperties};
use crate::line_of_sight::{FieldOfView, is_in_line_of_sight};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct VisibleFrom;

impl Predicate for VisibleFrom {
    fn name(&self) -> &'static str {
        "visible_from"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT, AGENT]
    }

    fn definition(&self) -> &'static str {
        "One of nine rays from the agent's eyes to the middle of the thing's box and to points 60 \
         % of the way to its corners meets the thing before anything that one does not see through, \
         whichever way the agent looks."
    }

    fn source(&self) -> &'static str {
        "Chosen here: lines of sight, with no field of view."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let (Term::Object(object), Term::Agent(agent)) = (args[0], args[1]) else {
            return Truth::False;
        };
        let seen = Viewer::of_agent(scene.state, agent).is_some_and(|viewer| {
            is_in_line_of_sight(scene, scene.rays(), &viewer, object, FieldOfView::Around)
        });
        Truth::from(seen)
    }
}
