//! Hanging things, and their mounts.

use crate::form::{Description, Modifier, Noun, Quantifier};
use crate::predicates::mount_of;
use crate::scene::{SemanticScene, Term};
use dwell_scene::{ObjectId, StructureKind};

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
    pub(super) object: ObjectId,
    pub(super) mount: MountKind,
}

impl MountKind {
    pub(super) const ALL: [Self; 3] = [Self::Wall, Self::Ceiling, Self::Window];

    fn name(self) -> &'static str {
        match self {
            Self::Wall => "wall",
            Self::Ceiling => "ceiling",
            Self::Window => "window",
        }
    }

    /// Hanging on some mount of this kind.
    pub(super) fn modifier(self) -> Modifier {
        let noun = match self {
            Self::Wall | Self::Ceiling => Noun::Structure(self.name().to_owned()),
            Self::Window => Noun::Object(self.name().to_owned()),
        };
        Modifier::new(
            "hangs_on",
            [Description::new(Quantifier::Some, noun).into()],
        )
    }
}

impl MountedObject {
    /// Returns the mounted object if `object` hangs.
    pub(super) fn of(scene: &SemanticScene<'_>, object: ObjectId) -> Option<Self> {
        let mount = match mount_of(scene, object)? {
            Term::Structure(piece)
                if scene.house().structure[piece].kind == StructureKind::Ceiling =>
            {
                MountKind::Ceiling
            }
            Term::Structure(_) => MountKind::Wall,
            _ => MountKind::Window,
        };
        Some(Self { object, mount })
    }

    /// Returns whether its noun says already on what it hangs: a wall lamp, a ceiling lamp.
    pub(super) fn noun_names_mount(&self, scene: &SemanticScene<'_>) -> bool {
        let mut words = scene.facts(self.object).noun.split(' ');
        words.any(|word| word == self.mount.name())
    }
}
