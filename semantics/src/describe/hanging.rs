//! Hanging things, and their mounts.

use super::contents::grouped;
use crate::english::list;
use crate::predicates::mount_of;
use crate::scene::{SemanticScene, Term};
use dwell_scene::{ObjectId, StructureId, StructureKind};

/// Largest distance across the wall between the middles of two pieces of one wall, m.
const SAME_WALL_M: f32 = 0.2;

/// The kind of a mount, in the order of telling.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum MountKind {
    Wall,
    Ceiling,
    Window,
}

/// A thing that hangs.
#[derive(Clone, Copy, Debug)]
pub(super) struct MountedObject {
    pub(super) thing: ObjectId,
    pub(super) hold: MountKind,
    mount: Term,
    /// True if its room has other windows beside the one it hangs at.
    other_windows: bool,
}

impl MountKind {
    /// The places of several: "on the walls", "at the windows".
    fn places(self) -> &'static str {
        match self {
            Self::Wall => "on the walls",
            Self::Ceiling => "from the ceiling",
            Self::Window => "at the windows",
        }
    }
}

impl MountedObject {
    /// Returns the mounted object if `thing` hangs.
    pub(super) fn of(scene: &SemanticScene<'_>, thing: ObjectId) -> Option<Self> {
        let mount = mount_of(scene, thing)?;
        let hold = match mount {
            Term::Structure(piece)
                if scene.house().structure[piece].kind == StructureKind::Ceiling =>
            {
                MountKind::Ceiling
            }
            Term::Structure(_) => MountKind::Wall,
            _ => MountKind::Window,
        };
        let other_windows = hold == MountKind::Window
            && scene
                .room_of(thing)
                .is_some_and(|room| scene.windows_in(room) > 1);
        Some(Self {
            thing,
            hold,
            mount,
            other_windows,
        })
    }

    /// Returns whether its noun implies it already: a wall lamp, a ceiling lamp.
    pub(super) fn is_in_noun(&self, scene: &SemanticScene<'_>) -> bool {
        let said = match self.hold {
            MountKind::Wall => "wall",
            MountKind::Ceiling => "ceiling",
            MountKind::Window => "window",
        };
        let mut words = scene.facts(self.thing).noun.split(' ');
        words.any(|word| word == said)
    }

    /// Returns its place, after its name: "on the wall", "at the window"; empty where its noun implies it.
    pub(super) fn place(&self, scene: &SemanticScene<'_>) -> String {
        match self.hold {
            _ if self.is_in_noun(scene) => String::new(),
            // "From the ceiling" needs a verb.
            MountKind::Ceiling => " on the ceiling".to_owned(),
            _ => format!(" {}", self.unqualified_place()),
        }
    }

    /// "On the wall", "at the window", "at a window" where there are others.
    fn unqualified_place(&self) -> &'static str {
        match self.hold {
            MountKind::Wall => "on the wall",
            MountKind::Ceiling => "from the ceiling",
            MountKind::Window if self.other_windows => "at a window",
            MountKind::Window => "at the window",
        }
    }
}

/// "On the wall hang two pictures and a clock", "at the window hangs a curtain": one each of what `hanging` hangs on, in
/// order.
pub(super) fn clauses(scene: &SemanticScene<'_>, hanging: &[MountedObject]) -> Vec<String> {
    let mut clauses = Vec::new();
    for hold in [MountKind::Wall, MountKind::Ceiling, MountKind::Window] {
        let here: Vec<&MountedObject> = hanging.iter().filter(|one| one.hold == hold).collect();
        let Some((first, others)) = here.split_first() else {
            continue;
        };
        let several = others
            .iter()
            .any(|other| !is_one(scene, first.mount, other.mount));
        let things: Vec<ObjectId> = here.iter().map(|one| one.thing).collect();
        let texts: Vec<String> = grouped(scene, &things)
            .iter()
            .map(|group| group.text(scene))
            .collect();
        let verb = if things.len() == 1 { "hangs" } else { "hang" };
        let place = if several {
            hold.places()
        } else {
            first.unqualified_place()
        };
        clauses.push(format!("{place} {verb} {}", list(&texts)));
    }
    clauses
}

/// Returns whether two mounts look like one: the same, or pieces of one wall between its windows.
fn is_one(scene: &SemanticScene<'_>, one: Term, other: Term) -> bool {
    let (Term::Structure(p), Term::Structure(q)) = (one, other) else {
        return one == other;
    };
    // Across a wall its box is thin; walls at an angle count as walls of their own.
    let across = |piece: StructureId| {
        let bounds = scene.semantics.structure_bounds(piece);
        let (size, middle) = (bounds.size(), bounds.center());
        if size.x < size.z {
            (true, middle.x)
        } else {
            (false, middle.z)
        }
    };
    let ((p_along_z, p_m), (q_along_z, q_m)) = (across(p), across(q));
    p == q || (p_along_z == q_along_z && (p_m - q_m).abs() <= SAME_WALL_M)
}
