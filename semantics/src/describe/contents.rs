//! Things counted by kind.

use super::object::{adjectives, described, phrase};
use crate::english::{counted, with_article};
use crate::scene::SemanticScene;
use dwell_scene::ObjectId;
use std::collections::BTreeMap;

/// Things of one kind.
pub(super) struct NounGroup {
    /// The things, in order.
    pub(super) objects: Vec<ObjectId>,
}

impl NounGroup {
    /// "four brown wooden chairs": with the adjectives that all share.
    pub(super) fn text(&self, scene: &SemanticScene<'_>) -> String {
        let facts = scene.facts(self.objects[0]);
        if let [only] = self.objects[..] {
            return with_article(&phrase(scene, only));
        }
        let mut shared = adjectives(scene, self.objects[0]);
        for object in &self.objects {
            for (known, word) in shared.iter_mut().zip(adjectives(scene, *object)) {
                *known = known.take().filter(|known| word.as_ref() == Some(known));
            }
        }
        counted(
            self.objects.len(),
            &described(&shared, &facts.noun),
            &described(&shared, &facts.plural),
        )
    }
}

/// `objects` by spoken noun, the largest things first (they are seen first), then by noun.
pub(super) fn grouped(scene: &SemanticScene<'_>, objects: &[ObjectId]) -> Vec<NounGroup> {
    let mut groups: Vec<(f32, &str, NounGroup)> = Vec::new();
    let mut known: BTreeMap<&str, usize> = BTreeMap::new();
    for object in objects {
        let noun = scene.facts(*object).noun.as_str();
        let volume = scene.extent(*object).bounds.volume();
        let next = groups.len();
        let k = *known.entry(noun).or_insert(next);
        if k == next {
            groups.push((
                volume,
                noun,
                NounGroup {
                    objects: Vec::new(),
                },
            ));
        }
        let (largest, _, group) = &mut groups[k];
        *largest = largest.max(volume);
        group.objects.push(*object);
    }
    groups.sort_by(|p, q| q.0.total_cmp(&p.0).then(p.1.cmp(q.1)));
    groups.into_iter().map(|(_, _, group)| group).collect()
}
