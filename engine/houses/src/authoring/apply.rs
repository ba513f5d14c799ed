//! Edits, one after another, into a new house.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use dwell_scene::interrupt;
use dwell_scene::parallel::Threads;
use dwell_scene::{Aabb, House, HouseData, Level, ObjectId, Pose, State};
use glam::{Quat, Vec3};

use super::edit_errors::{check_range, checked_point, invalid_field, prefix_field, unknown_name};
use super::edits::{AddRobot, Edit, MoveObject, RemoveObject, Rename};
use super::files::FileAccess;
use super::mesh_file::LoadedMesh;
use super::object_index::ObjectIndex;
use super::overlap_check::{intersects_wall, overlapping_pairs};
use super::{add, agent_start, describe, doors, fixtures, place, remove_objects, surfaces};
use crate::error::HousesError;
use crate::import::room_kind;
use crate::object_name::check_is_name;
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// Largest number of edits that are made at once.
const MAX_EDITS: usize = 10_000;

/// A house with edits made in it, one after another. Meshes, textures and materials are shared with `house`. Adding never
/// changes the number of anything that was there; taking out closes the gap, so that what stood behind moves up. Names stay
/// in any case.
///
/// The report holds what was wrong with files that were read, and names what was added or moved to where no room is, into a wall or into
/// another thing.
///
/// # Errors
/// [`HousesError::Spec`] names the edit and the field, what was found and what is possible, with the nearest names for an
/// unknown one; what the reader of a file says; [`HousesError::Scene`] when the result breaks a rule of the scene.
///
/// # Determinism
/// The same house, edits and files give the same house for any number of threads.
///
/// ```
/// use dwell_houses::authoring::{Edit, FileAccess, edit};
/// let house = dwell_houses::builtin::build("studio").ok_or("no studio")?;
/// let edits: Vec<Edit> = serde_json::from_str(
///     r#"[{"add": {"what": {"catalogue": {"kind": "mug"}}, "place": {"on": "dining_table_1"}}}]"#,
/// )?;
/// # let has = house.object_named("dining_table_1").is_some();
/// # if !has { return Ok(()); }
/// let (edited, _) = edit(&house, &edits, &FileAccess::Anywhere)?;
/// assert_eq!(edited.objects.len(), house.objects.len() + 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn edit(
    house: &House,
    edits: &[Edit],
    files: &FileAccess,
) -> Result<(House, LoadReport), HousesError> {
    if edits.len() > MAX_EDITS {
        return Err(HousesError::TooLarge {
            at: FileLocation::file("edits"),
            what: "edit count",
            found: edits.len() as u64,
            allowed: MAX_EDITS as u64,
        });
    }
    let mut session = EditSession::new(house.data().clone(), files);
    for (k, edit) in edits.iter().enumerate() {
        interrupt::unwind_if_cancelled();
        let place = format!("edits[{k}].{}", edit.json_name());
        session.apply(edit).map_err(prefix_field(place))?;
    }
    session.flush_removals();
    let at = FileLocation::file("edits");
    let edited = House::new(session.data).map_err(HousesError::scene(&at))?;
    let mut report = session.report;
    let put = added_or_moved_objects(house, &edited, edits);
    let named = |id: ObjectId| &edited.objects[id].name;
    let state = State::new(&edited);
    for id in &put {
        interrupt::unwind_if_cancelled();
        if is_outside(&edited, &state, *id) {
            report.warn(at.field(named(*id)), WarningKind::OutsideRooms);
        } else if intersects_wall(&edited, *id) {
            report.warn(at.field(named(*id)), WarningKind::InWall);
        }
    }
    for (k, start) in edited.agent_starts.iter().enumerate() {
        let is_new = house.agent_starts.get(k) != Some(start);
        if is_new && edited.is_outside(start.position) {
            let at = at.field(format_args!("agent_starts[{k}]"));
            report.warn(at, WarningKind::OutsideRooms);
        }
    }
    for (one, other) in overlapping_pairs(&edited, &put) {
        let other = named(other).clone();
        report.warn(at.field(named(one)), WarningKind::Overlap { other });
    }
    Ok((edited, report))
}

/// The objects that were added or moved.
fn added_or_moved_objects(before: &House, after: &House, edits: &[Edit]) -> Vec<ObjectId> {
    let known: BTreeSet<&str> = before.objects.iter().map(|o| o.name.as_str()).collect();
    let moved: BTreeSet<&str> = edits
        .iter()
        .filter_map(|edit| match edit {
            Edit::Move(change) => Some(change.object.as_str()),
            _ => None,
        })
        .collect();
    let put = |name: &str| !known.contains(name) || moved.contains(name);
    let objects = after.objects.iter_ids();
    let new = objects.filter(|(_, object)| put(&object.name));
    new.map(|(id, _)| id).collect()
}

/// Returns whether a thing lies outside of all rooms, in a house that has rooms.
fn is_outside(house: &House, state: &State, id: ObjectId) -> bool {
    let bounds = house.object_bounds(state, id);
    !house.rooms.is_empty() && !bounds.is_empty() && house.room_at(bounds.center()).is_none()
}

/// A house that is being edited, and the files that were read for it.
pub(super) struct EditSession<'a> {
    pub(super) data: HouseData,
    pub(super) files: &'a FileAccess,
    pub(super) threads: Threads,
    pub(super) report: LoadReport,
    pub(super) object_index: ObjectIndex,
    /// Objects to remove before anything else is done.
    removed: BTreeSet<ObjectId>,
    /// Mesh files by path, scale and axis.
    pub(super) meshes: BTreeMap<String, Arc<LoadedMesh>>,
    /// Other houses by their HOUSE strings.
    pub(super) houses: BTreeMap<String, Arc<House>>,
}

impl<'a> EditSession<'a> {
    pub(super) fn new(mut data: HouseData, files: &'a FileAccess) -> Self {
        if data.levels.is_empty() {
            let (name, bounds) = ("0".to_owned(), Aabb::EMPTY);
            data.levels.push(Level { name, bounds });
        }
        Self {
            data,
            files,
            threads: Threads::default(),
            report: LoadReport::new(),
            object_index: ObjectIndex::default(),
            removed: BTreeSet::new(),
            meshes: BTreeMap::new(),
            houses: BTreeMap::new(),
        }
    }

    fn apply(&mut self, edit: &Edit) -> Result<(), HousesError> {
        if let Edit::Remove(remove) = edit
            && !remove.with_contents
            && let Some(id) = self.object_index.find(&remove.object)
            && self.removed.insert(id)
        {
            return Ok(());
        }
        self.flush_removals();
        self.object_index.update(&self.data);
        match edit {
            Edit::Add(add) => add::add(self, add).map(drop),
            Edit::Remove(remove) => self.remove(remove),
            Edit::Move(change) => self.move_object(change),
            Edit::ReMaterial(change) => surfaces::change_material(self, change),
            Edit::AddEmitter(emitter) => fixtures::add_emitter(self, emitter),
            Edit::AddLamp(lamp) => fixtures::add_lamp(self, lamp),
            Edit::AddRobot(robot) => self.add_robot(robot),
            Edit::AgentStart(start) => agent_start::set(self, start),
            Edit::SetDoor(door) => {
                let id = self.object("object", &door.object)?;
                let joints = self.object_index.joints_of(&self.data, id);
                self.object_index.mark_moved([id]);
                doors::set_opening(&mut self.data, id, &joints, door)
            }
            Edit::Describe(change) => {
                let id = self.object("object", &change.object)?;
                describe::set_attributes(&mut self.data, id, &change.attributes)
                    .map_err(prefix_field("traits"))
            }
            Edit::Rename(rename) => self.rename(rename),
        }
    }

    /// Removes the objects that edits in a row have named, all at once.
    fn flush_removals(&mut self) {
        if !self.removed.is_empty() {
            remove_objects::remove(&mut self.data, &self.removed);
            self.removed.clear();
            self.object_index.clear();
        }
    }

    /// The object of a name.
    ///
    /// # Errors
    /// [`HousesError::Spec`] with the nearest names.
    pub(super) fn object(&self, field: &str, name: &str) -> Result<ObjectId, HousesError> {
        self.object_index.find(name).ok_or_else(|| {
            let names = self.data.objects.iter().map(|object| object.name.as_str());
            unknown_name(field, name, "objects", names)
        })
    }

    /// The house as it is now.
    pub(super) fn build_house(&self) -> Result<House, HousesError> {
        House::new(self.data.clone()).map_err(HousesError::scene(&FileLocation::file("edits")))
    }

    /// An object, and the objects that move with it.
    fn object_with_contents(
        &mut self,
        id: ObjectId,
        with_things: bool,
    ) -> Result<BTreeSet<ObjectId>, HousesError> {
        if !with_things {
            return Ok(BTreeSet::from([id]));
        }
        let boxes = self.object_index.bounding_boxes(&self.data);
        place::with_supported_objects(&self.data, boxes, id)
    }

    fn remove(&mut self, change: &RemoveObject) -> Result<(), HousesError> {
        let id = self.object("object", &change.object)?;
        self.removed = self.object_with_contents(id, change.with_contents)?;
        Ok(())
    }

    fn move_object(&mut self, change: &MoveObject) -> Result<(), HousesError> {
        let id = self.object("object", &change.object)?;
        let all = self.object_with_contents(id, change.with_contents)?;
        let first = place::placement_transform(self, id, &change.place)?;
        let by = checked_point("by", change.translation_m)?;
        let turn_rad = check_range(
            "turn_deg",
            change.turn_deg,
            [-36_000.0, 36_000.0],
            "degrees",
        )?
        .to_radians();
        place::transform_objects(self, &all, &first);
        let pivot = place::anchor_in_world(&self.data, id, change.place.anchor);
        let turn = if turn_rad == 0.0 {
            Quat::IDENTITY
        } else {
            dwell_scene::space::rotation_from_yaw_pitch(turn_rad, 0.0)
        };
        place::transform_objects(self, &all, &Pose::new(pivot + by - turn * pivot, turn));
        for object in all {
            place::update_room_and_level(&mut self.data, object);
        }
        Ok(())
    }

    fn add_robot(&mut self, robot: &AddRobot) -> Result<(), HousesError> {
        let at = checked_point("at", robot.at)?;
        let yaw =
            check_range("yaw_deg", robot.yaw_deg, [-36_000.0, 36_000.0], "degrees")?.to_radians();
        self.check_name_is_free("name", &robot.name)?;
        let path = self.files.resolve_path("path", &robot.path)?;
        let (model, report) = crate::open_robot(&path)?;
        self.report.append(report);
        let fixed = robot.fixed_base.unwrap_or_else(|| model.has_fixed_base());
        let base = Pose::from_position_yaw(at, yaw) * crate::robot::dwell_from_robot();
        crate::robot::add(
            &mut self.data,
            &model,
            &robot.name,
            base,
            fixed,
            &mut crate::robot::MaterialNames::default(),
        );
        Ok(())
    }

    fn rename(&mut self, change: &Rename) -> Result<(), HousesError> {
        check_is_name("to", &change.new_name)?;
        if change.kind.is_some() && change.room.is_none() {
            return Err(invalid_field(
                "kind",
                "a kind without a room",
                "`room` and `kind`",
            ));
        }
        match (&change.object, &change.room) {
            (Some(_), Some(_)) => Err(invalid_field(
                "object",
                "an object and a room",
                "one of them",
            )),
            (Some(name), None) => {
                let id = self.object("object", name)?;
                if *name != change.new_name {
                    self.check_name_is_free("to", &change.new_name)?;
                }
                self.data.objects[id].name.clone_from(&change.new_name);
                self.object_index.clear();
                Ok(())
            }
            (None, Some(name)) => {
                let id = surfaces::room(&self.data, "room", name)?;
                let taken = self
                    .data
                    .rooms
                    .iter()
                    .any(|room| room.name == change.new_name);
                if taken && *name != change.new_name {
                    return Err(invalid_field(
                        "to",
                        format_args!("{:?}", change.new_name),
                        "a name that no other room has",
                    ));
                }
                let room = &mut self.data.rooms[id];
                room.name.clone_from(&change.new_name);
                if let Some(kind) = &change.kind {
                    room.kinds = vec![room_kind(kind).unwrap_or_else(|plain| plain)];
                }
                Ok(())
            }
            (None, None) => {
                self.data.name.clone_from(&change.new_name);
                Ok(())
            }
        }
    }

    /// Refuses an object's name that is empty or taken.
    pub(super) fn check_name_is_free(&self, field: &str, name: &str) -> Result<(), HousesError> {
        check_is_name(field, name)?;
        if self.object_index.find(name).is_some() {
            let possible = "a name that no other object has";
            return Err(invalid_field(field, format_args!("{name:?}"), possible));
        }
        Ok(())
    }

    /// The middle of an object's root, in the space of that part, m.
    pub(super) fn root_centre_in_part(&self, id: ObjectId) -> Vec3 {
        let part = &self.data.parts[self.data.objects[id].first_part];
        let bounds = self.data.meshes[part.mesh].bounds();
        if bounds.is_empty() {
            return Vec3::ZERO;
        }
        bounds.transformed(&part.part_from_mesh).center()
    }
}
