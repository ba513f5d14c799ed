//! The predicate `visible_from_room`.

use super::{OBJECT_OR_ROOM, Predicate, ROOM, RelationProperties};
use crate::line_of_sight::{FieldOfView, is_in_line_of_sight};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::{Pose, RoomId};
use glam::{Vec3, Vec3Swizzles};

/// Height of eyes above the floor, m.
const EYES_M: f32 = 1.5;
/// Number of places in a room to look from.
const PLACES: usize = 32;

/// See [`Predicate::definition`].
pub(super) struct VisibleFromRoom;

impl Predicate for VisibleFromRoom {
    fn name(&self) -> &'static str {
        "visible_from_room"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT_OR_ROOM, ROOM]
    }

    fn definition(&self) -> &'static str {
        "From one of 32 places spread over the room's floor, at eyes 1.5 m above it and in no \
         thing, one of nine rays to the thing meets it first, as in `visible_from`; another room where a straight \
         line joins such places of both."
    }

    fn source(&self) -> &'static str {
        "Chosen here: lines of sight, with no field of view."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties::default()
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let Term::Room(from) = args[1] else {
            return Truth::False;
        };
        let mut eyes = eyes_in(scene, from).into_iter();
        Truth::from(match args[0] {
            Term::Object(object) => eyes.any(|eye| {
                let viewer = Viewer {
                    world_from_camera: Pose::from_position_yaw(eye, 0.0),
                };
                is_in_line_of_sight(scene, scene.rays(), &viewer, object, FieldOfView::Around)
            }),
            Term::Room(room) if room == from => true,
            Term::Room(room) => {
                let others = eyes_in(scene, room);
                eyes.any(|eye| others.iter().any(|other| is_clear(scene, eye, *other)))
            }
            _ => false,
        })
    }
}

/// Places of eyes that lie in no thing; all of them where furniture fills the room.
fn eyes_in(scene: &SemanticScene<'_>, room: RoomId) -> Vec<Vec3> {
    let height = Vec3::Y * (scene.house().rooms[room].floor_y + EYES_M);
    let points = scene.house().points_in_room(room, PLACES).into_iter();
    let eyes = points.map(|point| point * Vec3::new(1.0, 0.0, 1.0) + height);
    let (free, within): (Vec<Vec3>, Vec<Vec3>) = eyes.partition(|eye| {
        let mut things = scene.objects_in(room).iter();
        !things.any(|thing| {
            let extent = scene.extent(*thing);
            let (low, high) = (extent.bounds.min.y, extent.bounds.max.y);
            (low..=high).contains(&eye.y) && extent.footprint.contains(eye.xz())
        })
    });
    if free.is_empty() { within } else { free }
}

fn is_clear(scene: &SemanticScene<'_>, from: Vec3, to: Vec3) -> bool {
    let hit = scene
        .rays()
        .closest(&Ray::new(from, to - from), RayMask::EYE);
    hit.is_none_or(|hit| hit.distance_m >= from.distance(to))
}
