//! Rooms, walls with their holes, doors and windows.

use std::collections::{BTreeMap, BTreeSet};

use dwell_furniture::finishes::Finish;
use dwell_furniture::models::doors::Door;
use dwell_furniture::models::windows::{Window, clear_pane};
use dwell_furniture::shapes::extrude;
use dwell_scene::{Aabb, Mesh, Pose, Room, StructureKind};
use glam::{DVec2, Vec2, Vec3};
use serde_json::Value;

use super::covers::finish_of_material;
use super::file::{ProcThorHouse, ProcThorOpening, ProcThorRoom, ProcThorWall, Vector3};
use super::{ConvertedRoom, ProcThorReader, is_valid_position, point};
use crate::import::{UniqueNames, room_kind, triangulate};
use crate::limits::MAX_OUTLINE;
use crate::warning_kind::{UnmappedKind, WarningKind};

/// Thickness of slabs, m; the file has none.
const SLAB_M: f32 = 0.1;
/// Depth of the frames of doors and windows, m; the file's walls have no thickness.
const FRAME_M: f32 = 0.1;
/// Height of rooms without walls, m.
const CEILING_M: f32 = 2.5;
/// Distance from a wall at which the room on that side is looked up, m.
const BESIDE_M: f32 = 0.05;
/// The smallest hole that holds a door or a window, m.
const LEAST_M: f32 = 0.3;
/// The widest casement, m.
const CASEMENT_M: f32 = 0.8;
/// Largest overhang of a hole beyond its wall, m: coordinates of the file are rounded.
const BEYOND_M: f32 = 0.05;
/// Depth of window sills into the room, m.
const SILL_M: f32 = 0.02;

/// A wall's face: it runs from `foot` along `along`, `height_m` high, and looks along `normal`.
struct WallFace {
    foot: Vec3,
    /// Direction, unit length.
    along: Vec3,
    width_m: f32,
    height_m: f32,
    /// Normal, unit length.
    normal: Vec3,
}

/// A hole on a face: ends along it, ends above its foot, m.
#[derive(Clone, Copy)]
struct FaceHole {
    along: [f32; 2],
    up: [f32; 2],
}

/// A converted wall.
struct ConvertedWall {
    /// Index of the wall in the file.
    k: usize,
    face: WallFace,
    holes: Vec<FaceHole>,
}

impl WallFace {
    /// The part of a hole that is on the face, with a tolerance for rounding.
    ///
    /// # Errors
    /// A sentence when the hole reaches beyond the face.
    fn clip(&self, hole: FaceHole) -> Result<FaceHole, String> {
        for (word, [low, high], size) in [
            ("along", hole.along, self.width_m),
            ("up", hole.up, self.height_m),
        ] {
            if low < -BEYOND_M || high > size + BEYOND_M {
                return Err(format!(
                    "its hole reaches from {low} to {high} m {word} its wall of {size} m"
                ));
            }
        }
        Ok(FaceHole {
            along: hole.along.map(|a| a.clamp(0.0, self.width_m)),
            up: hole.up.map(|u| u.clamp(0.0, self.height_m)),
        })
    }

    fn at(&self, along: f32, up: f32) -> Vec3 {
        self.foot + self.along * along + Vec3::Y * up
    }

    /// The face with its holes, each cell between the lines of their edges a rectangle.
    fn mesh(&self, holes: &[FaceHole]) -> Mesh {
        let (mut along, mut up) = (vec![0.0, self.width_m], vec![0.0, self.height_m]);
        for hole in holes {
            along.extend(hole.along.map(|a| a.clamp(0.0, self.width_m)));
            up.extend(hole.up.map(|u| u.clamp(0.0, self.height_m)));
        }
        for lines in [&mut along, &mut up] {
            lines.sort_by(f32::total_cmp);
            lines.dedup();
        }
        let in_hole = |a: f32, u: f32| {
            let within = |x: f32, [low, high]: [f32; 2]| low < x && x < high;
            holes
                .iter()
                .any(|hole| within(a, hole.along) && within(u, hole.up))
        };
        let mut mesh = Mesh::default();
        for a in along.windows(2) {
            for u in up.windows(2) {
                if in_hole(0.5 * (a[0] + a[1]), 0.5 * (u[0] + u[1])) {
                    continue;
                }
                let mut corners = [(a[0], u[0]), (a[1], u[0]), (a[1], u[1]), (a[0], u[1])];
                // Counter-clockwise seen from the room.
                if self.along.cross(Vec3::Y).dot(self.normal) < 0.0 {
                    corners.reverse();
                }
                let base = mesh.positions.len() as u32;
                for (along, up) in corners {
                    mesh.positions.push(self.at(along, up));
                    mesh.normals.push(self.normal);
                    mesh.uvs.push(Vec2::new(along, up));
                }
                mesh.triangles
                    .extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
            }
        }
        mesh
    }
}

impl ProcThorReader<'_> {
    /// Rooms with floors and ceilings, walls, doors and windows.
    pub(super) fn shell(&mut self, file: &ProcThorHouse) {
        let mut names = UniqueNames::default();
        let lowest = file
            .rooms
            .iter()
            .flat_map(|room| room.floor_polygon.iter().map(|p| p.y));
        self.floor_y = lowest.fold(f32::INFINITY, f32::min);
        if !self.floor_y.is_finite() {
            self.floor_y = 0.0;
        }
        for (k, room) in file.rooms.iter().enumerate() {
            self.room(k, room, file, &mut names);
        }
        let mut walls: BTreeMap<&str, ConvertedWall> = BTreeMap::new();
        for (k, wall) in file.walls.iter().enumerate() {
            let at = format!("walls[{k}]");
            if walls.contains_key(wall.id.as_str()) {
                let reason = format!("the id {:?} is that of another wall", wall.id);
                self.warn(&at, WarningKind::BadFace { reason });
                continue;
            }
            match self.face(wall) {
                Ok(Some(face)) => {
                    let holes = Vec::new();
                    walls.insert(&wall.id, ConvertedWall { k, face, holes });
                }
                Ok(None) => {}
                Err(reason) => self.warn(&at, WarningKind::BadFace { reason }),
            }
        }
        let ids: BTreeSet<&str> = file.walls.iter().map(|wall| wall.id.as_str()).collect();
        let kinds = [("doors", &file.doors), ("windows", &file.windows)];
        for (field, rows) in kinds {
            for (k, row) in rows.iter().enumerate() {
                let at = format!("{field}[{k}]");
                let Some(hole) = rectangle(row) else {
                    let reason =
                        "its hole is no rectangle of corners with x and y in metres".to_owned();
                    self.warn(&at, WarningKind::BadFace { reason });
                    continue;
                };
                let Some(wall) = walls.get_mut(row.wall0.as_str()) else {
                    let reason = format!("there is no wall {:?}", row.wall0);
                    self.warn(&at, WarningKind::BadFace { reason });
                    continue;
                };
                let hole = match wall.face.clip(hole) {
                    Ok(clipped) => clipped,
                    Err(reason) => {
                        self.warn(&at, WarningKind::BadFace { reason });
                        continue;
                    }
                };
                wall.holes.push(hole);
                self.filling(row, &wall.face, hole, &at, field == "windows");
                if !row.wall1.is_empty() && !ids.contains(row.wall1.as_str()) {
                    let expected = "the id of a wall, or null";
                    self.bad_field(&format!("{at}.wall1"), format!("{:?}", row.wall1), expected);
                }
                if let Some(other) = walls.get_mut(row.wall1.as_str()) {
                    // The wall behind runs the other way.
                    let [from, to] = hole.along.map(|a| other.face.width_m - a);
                    let along = [to, from];
                    other.holes.push(FaceHole { along, ..hole });
                }
            }
        }
        let mut wall_names = UniqueNames::default();
        for (k, wall) in file.walls.iter().enumerate() {
            let converted = walls.get(wall.id.as_str());
            let Some(ConvertedWall { face, holes, .. }) =
                converted.filter(|converted| converted.k == k && !wall.empty)
            else {
                continue;
            };
            let finish = self.finish(&wall.material, &format!("walls[{k}].material"));
            let room = self.rooms.iter().find(|room| room.file_id == wall.room_id);
            let name = wall_names.unique(&format!("wall_{}", wall.id));
            let room = room.map(|room| room.id);
            let mesh = face.mesh(holes);
            if !mesh.triangles.is_empty() {
                self.assembly
                    .add_structure(&name, StructureKind::Wall, room, mesh, &[finish]);
            }
        }
    }

    fn finish(&mut self, material: &Value, field: &str) -> Finish {
        let (finish, unknown) = finish_of_material(material);
        if let Some(name) = unknown {
            let what = UnmappedKind::Substance;
            self.warn(field, WarningKind::Unmapped { what, name });
        }
        finish
    }

    fn room(
        &mut self,
        k: usize,
        room: &ProcThorRoom,
        file: &ProcThorHouse,
        names: &mut UniqueNames,
    ) {
        let at = format!("rooms[{k}]");
        let corners: Vec<Vec3> = room.floor_polygon.iter().copied().map(point).collect();
        let mut outline: Vec<DVec2> = corners
            .iter()
            .map(|p| DVec2::new(f64::from(p.x), f64::from(p.z)))
            .collect();
        outline.dedup();
        if outline.first() == outline.last() {
            outline.pop();
        }
        let area: f64 = (0..outline.len())
            .map(|k| outline[k].perp_dot(outline[(k + 1) % outline.len()]))
            .sum();
        if outline.len() < 3
            || outline.len() > MAX_OUTLINE
            || !corners.iter().all(|p| is_valid_position(*p))
            || area.abs() < 1e-3
        {
            let reason = format!(
                "its floor is no polygon of 3 to {MAX_OUTLINE} corners with x, y and z in metres, within 10000 m: \
                 found {} corners that enclose {:.3} m2, where the outline crosses itself counted off",
                outline.len(),
                0.5 * area.abs()
            );
            return self.warn(&at, WarningKind::BadFace { reason });
        }
        // Seen from above with z downwards: what turns clockwise there is counter-clockwise in (x, z).
        if area < 0.0 {
            outline.reverse();
        }
        let top = file
            .walls
            .iter()
            .filter(|wall| wall.room_id == room.id)
            .flat_map(|wall| wall.polygon.iter().map(|p| p.y))
            .filter(|y| y.is_finite() && y.abs() < 1e4)
            .fold(f32::NEG_INFINITY, f32::max);
        let floor_y = corners[0].y;
        let ceiling_y = if top > floor_y + 0.5 {
            top
        } else {
            floor_y + CEILING_M
        };
        let plan: Vec<[f32; 2]> = outline.iter().map(|p| [p.x as f32, p.y as f32]).collect();
        let flat = |p: DVec2| Vec2::new(p.x as f32, p.y as f32);
        let footprint = triangulate(&outline)
            .into_iter()
            .map(|t| t.map(|k| flat(outline[k])))
            .collect();
        let kind = split_camel_case(&room.room_type);
        let kind = room_kind(&kind).unwrap_or_else(|name| {
            if !name.is_empty() {
                let what = UnmappedKind::RoomType;
                let damage = WarningKind::Unmapped {
                    what,
                    name: name.clone(),
                };
                self.warn(&format!("{at}.roomType"), damage);
            }
            name
        });
        let mut bounds = Aabb::EMPTY;
        for [x, z] in &plan {
            bounds.add_point(Vec3::new(*x, floor_y, *z));
            bounds.add_point(Vec3::new(*x, ceiling_y, *z));
        }
        let name = names.numbered(&kind.replace(' ', "_"));
        if self.rooms.iter().any(|other| other.file_id == room.id) {
            let (id, renamed) = (room.id.clone(), name.clone());
            self.warn(
                &format!("{at}.id"),
                WarningKind::DuplicateId { id, renamed },
            );
        }
        let mut built = Room {
            name: name.clone(),
            level: self.assembly.level,
            kinds: if kind.is_empty() {
                Vec::new()
            } else {
                vec![kind]
            },
            footprint,
            floor_y,
            ceiling_y,
            bounds,
        };
        built.repair_footprint_and_ceiling();
        let id = self.assembly.data.rooms.push(built);
        let floor = self.finish(&room.floor_material, &format!("{at}.floorMaterial"));
        let above = &file.procedural_parameters.ceiling_material;
        let ceiling = self.finish(above, "proceduralParameters.ceilingMaterial");
        let slabs = [
            (StructureKind::Floor, "floor", floor_y, floor),
            (
                StructureKind::Ceiling,
                "ceiling",
                ceiling_y + SLAB_M,
                ceiling,
            ),
        ];
        for (kind, word, top, finish) in slabs {
            // The prism's (x, y) plane becomes the world's (x, z), its depth runs down.
            let slab = extrude(&plan, SLAB_M)
                .rotated_x(std::f32::consts::FRAC_PI_2)
                .translated(0.0, top, 0.0);
            let name = format!("{word}_{name}");
            self.assembly
                .add_structure(&name, kind, Some(id), slab.mesh, &[finish]);
        }
        self.rooms.push(ConvertedRoom {
            id,
            file_id: room.id.clone(),
            outline,
            ceiling_y,
        });
    }

    /// The face of a wall; `None` for a wall of no size.
    fn face(&self, wall: &ProcThorWall) -> Result<Option<WallFace>, String> {
        let mut corners: Vec<Vec3> = wall.polygon.iter().copied().map(point).collect();
        if !corners.iter().all(|p| is_valid_position(*p)) {
            return Err("a corner is no place of x, y and z in metres".to_owned());
        }
        // As AI2-THOR does: of the corners by height, the first two are the wall's foot, in the order of the file.
        corners.sort_by(|a, b| a.y.total_cmp(&b.y));
        let [foot, end, .., top] = corners.as_slice() else {
            return Err(format!("{} corners", corners.len()));
        };
        let run = (*end - *foot).with_y(0.0);
        let height_m = top.y - foot.y;
        if run.length() < 1e-3 || height_m < 1e-3 {
            return Ok(None);
        }
        let along = run.normalize();
        let side = along.cross(Vec3::Y);
        let middle = *foot + run * 0.5;
        let on = |sign: f32| self.containing_room(middle + side * (sign * BESIDE_M));
        let faces_front = match (on(1.0), on(-1.0)) {
            (Some(front), Some(back)) => {
                front.file_id == wall.room_id || back.file_id != wall.room_id
            }
            // The faces of outer walls look away from the room.
            (Some(front), None) => front.file_id == wall.room_id,
            (None, Some(back)) => back.file_id != wall.room_id,
            (None, None) => true,
        };
        Ok(Some(WallFace {
            foot: *foot,
            along,
            width_m: run.length(),
            height_m,
            normal: if faces_front { side } else { -side },
        }))
    }

    /// A door or window of the hole's size; a frame without a leaf stays a hole.
    fn filling(
        &mut self,
        row: &ProcThorOpening,
        face: &WallFace,
        hole: FaceHole,
        at: &str,
        is_window: bool,
    ) {
        let [width_m, height_m] = [hole.along, hole.up].map(|[low, high]| high - low);
        let odd = !is_window && !(0.0..=1.0).contains(&row.openness);
        if odd {
            let expected = "0 (shut) to 1 (open)";
            self.bad_field(
                &format!("{at}.openness"),
                row.openness.to_string(),
                expected,
            );
        }
        let openness = if is_window || odd { 0.0 } else { row.openness };
        if width_m < LEAST_M || height_m < LEAST_M {
            return;
        }
        if !is_window && row.asset_id.starts_with("Doorframe") {
            return;
        }
        let middle = 0.5 * (hole.along[0] + hole.along[1]);
        let up = if is_window {
            0.5 * (hole.up[0] + hole.up[1])
        } else {
            hole.up[0]
        };
        let place = face.at(middle, up);
        let Some(room) = self
            .containing_or_nearest_room(place + face.normal * 0.1)
            .map(|room| room.id)
        else {
            return;
        };
        let model = if is_window {
            let lights = (width_m / CASEMENT_M).ceil().clamp(1.0, 12.0) as usize;
            let (wall_m, pane, sill_m) = (FRAME_M, clear_pane(), SILL_M);
            Window {
                width_m,
                height_m,
                wall_m,
                casements: lights,
                pane,
                sill_m,
            }
            .build()
        } else {
            let wall_m = FRAME_M;
            Door {
                width_m,
                height_m,
                wall_m,
                ..Door::default()
            }
            .build()
        };
        let kind = self.assembly.add_model(model);
        let turn = glam::Quat::from_rotation_arc(Vec3::Z, face.normal);
        self.assembly
            .add_instance(&kind, Pose::new(place, turn), room, openness);
        self.rename_last_object(&row.id, &row.asset_id, at);
    }

    /// Renames the newest object to its name in the file; `at` is the place of its row.
    pub(super) fn rename_last_object(&mut self, id: &str, asset: &str, at: &str) {
        let Some(object) = self.assembly.data.objects.as_mut_slice().last_mut() else {
            return;
        };
        id.clone_into(&mut object.source_id);
        asset.clone_into(&mut object.model);
        let renamed = object.name.clone();
        if !id.is_empty() && !self.ids.insert(id.to_owned()) {
            let id = id.to_owned();
            let damage = WarningKind::DuplicateId { id, renamed };
            self.warn(&format!("{at}.id"), damage);
        }
    }
}

/// The rectangle of a hole on its first wall.
fn rectangle(row: &ProcThorOpening) -> Option<FaceHole> {
    let corners: Vec<Vector3> = match row.bounding_box {
        Some(bounds) if row.hole_polygon.len() < 2 => vec![bounds.min, bounds.max],
        _ => row.hole_polygon.clone(),
    };
    let range = |of: fn(&Vector3) -> f32| {
        let values = corners.iter().map(of);
        values.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], value| {
            [low.min(value), high.max(value)]
        })
    };
    let (along, up) = (range(|p| p.x), range(|p| p.y));
    let is_range = |[low, high]: [f32; 2]| low > -1e4 && high < 1e4 && low < high;
    let finite = corners.iter().all(|p| p.x.is_finite() && p.y.is_finite());
    (finite && is_range(along) && is_range(up)).then_some(FaceHole { along, up })
}

/// `LivingRoom` as words: `living room`.
pub(super) fn split_camel_case(name: &str) -> String {
    let mut words = String::new();
    for c in name.chars() {
        if c.is_ascii_uppercase() && !words.is_empty() {
            words.push(' ');
        }
        words.push(c.to_ascii_lowercase());
    }
    words
}
