//! The predicate `attached_to`.

use super::mount::mount_of;
use super::{OBJECT_OR_STRUCTURE, Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;
use dwell_scene::{ObjectId, StructureId, StructureKind};

/// The largest gap between an opening and its wall, m.
const WALL_GAP_M: f32 = 0.06;
const ATTACHED: &[TermKind] = &[TermKind::Object, TermKind::Part];

/// Returns the term to which a thing or a part is attached.
fn holder_of(scene: &SemanticScene<'_>, term: Term) -> Option<Term> {
    match term {
        Term::Part(id) => Some(Term::Object(scene.house().parts[id].object)),
        Term::Object(id) => {
            mount_of(scene, id).or_else(|| Some(Term::Structure(wall_of(scene, id)?)))
        }
        _ => None,
    }
}

/// The nearest wall of a door or window; the first where several are equally near.
fn wall_of(scene: &SemanticScene<'_>, opening: ObjectId) -> Option<StructureId> {
    let row = scene.facts(opening).category?;
    if !["door", "window"].contains(&row.nyu40_name) {
        return None;
    }
    let extent = scene.extent(opening);
    let (house, semantics) = (scene.house(), scene.semantics);
    let reach = extent.bounds.grown(WALL_GAP_M);
    let walls = semantics.structures_in_box(&reach).filter_map(|piece| {
        let away_m = extent
            .footprint
            .distance(semantics.structure_outline(piece));
        let is_wall = house.structure[piece].kind == StructureKind::Wall;
        (is_wall && away_m <= WALL_GAP_M).then_some((away_m, piece))
    });
    let nearest = walls.min_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
    nearest.map(|(_, piece)| piece)
}

/// See [`Predicate::definition`].
pub(super) struct AttachedTo;

impl Predicate for AttachedTo {
    fn name(&self) -> &'static str {
        "attached_to"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[ATTACHED, OBJECT_OR_STRUCTURE]
    }

    fn definition(&self) -> &'static str {
        "A part is attached to its object; a door or a window to the wall that is nearest to it \
         from above, at its height and at most 0.06 m away; anything else to what it hangs on."
    }

    fn source(&self) -> &'static str {
        "Chosen here; the largest gap is that of hanging."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            functional: true,
            ..RelationProperties::default()
        }
    }

    fn is_listed(&self) -> bool {
        true
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        Truth::from(holder_of(scene, args[0]) == Some(args[1]))
    }

    fn related(&self, scene: &SemanticScene<'_>, subject: Term) -> Vec<Term> {
        holder_of(scene, subject).into_iter().collect()
    }
}
