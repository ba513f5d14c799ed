//! Containers and their contents.

use super::inside::{BESIDE_M, is_in};
use crate::scene::SemanticScene;
use dwell_scene::{ObjectId, ReceptacleKind, interrupt};
use std::collections::BTreeMap;

/// Returns whether an object can contain things.
pub(super) fn is_container(scene: &SemanticScene<'_>, object: ObjectId) -> bool {
    let row = scene.facts(object).category;
    row.is_some_and(|row| row.contains) || spaces(scene, object).next().is_some()
}

/// The volume of an object's receptacles for things inside it, m³; of its box where it has none.
pub(super) fn space_m3(scene: &SemanticScene<'_>, object: ObjectId) -> f32 {
    let marked: f32 = spaces(scene, object).sum();
    if marked > 0.0 {
        marked
    } else {
        scene.extent(object).bounds.volume()
    }
}

fn spaces(scene: &SemanticScene<'_>, object: ObjectId) -> impl Iterator<Item = f32> {
    let spaces = scene.house().receptacles_of(object);
    let inside = spaces.filter(|space| space.holding == ReceptacleKind::In);
    inside.map(|space| space.space_in_part.volume())
}

impl SemanticScene<'_> {
    /// Returns the contents of an object, ascending.
    pub(crate) fn contents_of(&self, container: ObjectId) -> Vec<ObjectId> {
        if let Some(known) = self.contents.get() {
            return known.get(&container).cloned().unwrap_or_default();
        }
        let reach = self.extent(container).bounds.grown(2.0 * BESIDE_M);
        self.objects_near(&reach, usize::MAX, |thing| is_in(self, thing, container))
    }

    /// Returns the contents of every object, ascending, in one pass over all things.
    pub(crate) fn all_contents(&self) -> &BTreeMap<ObjectId, Vec<ObjectId>> {
        self.contents.get_or_init(|| {
            let mut contents: BTreeMap<ObjectId, Vec<ObjectId>> = BTreeMap::new();
            for thing in self.house().objects.ids() {
                interrupt::unwind_if_cancelled();
                for around in self.containers(thing) {
                    if !self.is_seat_or_bed(*around) {
                        contents.entry(*around).or_default().push(thing);
                    }
                }
            }
            contents
        })
    }
}
