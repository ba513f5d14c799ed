//! Names, boxes and joints of the objects of a house that is being edited, so that an edit looks at few of them.

use std::collections::{BTreeMap, BTreeSet};

use dwell_scene::{Aabb, HouseData, Id, JointId, ObjectId};

use super::place::world_bounds;

/// An index of the objects; it follows the tables from edit to edit.
#[derive(Default)]
pub(super) struct ObjectIndex {
    ids: BTreeMap<String, ObjectId>,
    /// The next number of each base: names with lower numbers are taken.
    numbers: BTreeMap<String, u64>,
    /// Boxes of the first objects. Shape (object,).
    boxes: Vec<Aabb>,
    /// Objects whose boxes are out of date.
    moved: BTreeSet<ObjectId>,
    joints: BTreeMap<ObjectId, Vec<JointId>>,
    /// Numbers of objects and joints that are indexed.
    counted: [usize; 2],
}

impl ObjectIndex {
    /// Adds the new objects and joints.
    pub(super) fn update(&mut self, data: &HouseData) {
        let [objects, joints] = self.counted;
        let new = data.objects.as_slice().iter().enumerate().skip(objects);
        for (k, object) in new {
            self.ids.insert(object.name.clone(), Id::from_index(k));
        }
        let new = data.joints.as_slice().iter().enumerate().skip(joints);
        for (k, joint) in new {
            let own = self.joints.entry(joint.object).or_default();
            own.push(Id::from_index(k));
        }
        self.counted = [data.objects.len(), data.joints.len()];
    }

    /// Clears the index: names or numbers of objects have changed.
    pub(super) fn clear(&mut self) {
        *self = Self::default();
    }

    /// Marks objects that have moved or have another form.
    pub(super) fn mark_moved(&mut self, ids: impl IntoIterator<Item = ObjectId>) {
        self.moved.extend(ids);
    }

    /// The object of a name, of those that existed when the edit began.
    pub(super) fn find(&self, name: &str) -> Option<ObjectId> {
        self.ids.get(name).copied()
    }

    /// `base_1`, `base_2`, ...: the first that is free.
    pub(super) fn next_numbered_name(&mut self, base: &str) -> String {
        let base = if base.is_empty() { "thing" } else { base };
        let number = self.numbers.entry(base.to_owned()).or_insert(1);
        loop {
            let name = format!("{base}_{number}");
            if !self.ids.contains_key(&name) {
                return name;
            }
            *number += 1;
        }
    }

    /// The boxes around all objects, m. Shape (object,).
    pub(super) fn bounding_boxes(&mut self, data: &HouseData) -> &[Aabb] {
        for id in std::mem::take(&mut self.moved) {
            if let Some(known) = self.boxes.get_mut(id.index()) {
                *known = world_bounds(data, id);
            }
        }
        for k in self.boxes.len()..data.objects.len() {
            self.boxes.push(world_bounds(data, Id::from_index(k)));
        }
        &self.boxes
    }

    /// The joints of an object, rising; of a new one, too.
    pub(super) fn joints_of(&self, data: &HouseData, object: ObjectId) -> Vec<JointId> {
        let known = self.joints.get(&object).into_iter().flatten().copied();
        let all = data.joints.as_slice().iter().enumerate();
        let new = all.skip(self.counted[1]);
        let new = new.filter(|(_, joint)| joint.object == object);
        known.chain(new.map(|(k, _)| Id::from_index(k))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::Object;

    fn named(names: &[&str]) -> HouseData {
        let mut data = HouseData::default();
        for name in names {
            data.objects.push(Object {
                name: (*name).to_owned(),
                source_id: String::new(),
                model: String::new(),
                category: dwell_scene::Category::default(),
                level: dwell_scene::LevelId(0),
                room: None,
                mobility: dwell_scene::Mobility::Movable,
                pickable: false,
                switch: None,
                first_part: dwell_scene::PartId(0),
                part_count: 0,
            });
        }
        data
    }

    #[test]
    fn names_are_counted_past_those_that_are_taken() {
        let mut census = ObjectIndex::default();
        census.update(&named(&["mug_1", "mug_3"]));
        assert_eq!(census.next_numbered_name("mug"), "mug_2");
        // As long as nothing has it, a name stays free.
        assert_eq!(census.next_numbered_name("mug"), "mug_2");
        census.update(&named(&["mug_1", "mug_3", "mug_2"]));
        assert_eq!(census.next_numbered_name("mug"), "mug_4");
        assert_eq!(census.find("mug_2"), Some(ObjectId(2)));
        census.clear();
        census.update(&named(&["mug_3"]));
        assert_eq!(census.next_numbered_name("mug"), "mug_1");
        assert_eq!(census.find("mug_2"), None);
        assert_eq!(census.next_numbered_name(""), "thing_1");
    }
}
