//! Ways to put things in their place in a room.

use super::assembly::{Assembly, Kind, Placed};
use super::plan::CEILING_M;
use dwell_furniture::model::Model;
use dwell_furniture::shapes::turn;
use dwell_scene::{Aabb, Pose, RoomId};
use glam::{Quat, Vec3};

/// Space left between a thing and the wall behind it, m.
const WALL_GAP_M: f32 = 0.003;
/// Space left under a thing that stands on another: below what physics counts as contact, m.
const REST_GAP_M: f32 = 0.0004;

/// A wall of a room, by the direction in which one looks at it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// At the smallest z; what stands there faces +Z.
    North,
    /// At the largest x; what stands there faces -X.
    East,
    /// At the largest z; what stands there faces -Z.
    South,
    /// At the smallest x; what stands there faces +X.
    West,
}

impl Side {
    /// Yaw of a thing that turns its back to this wall, degrees.
    pub(crate) fn yaw_deg(self) -> f32 {
        match self {
            Self::North => 0.0,
            Self::East => -90.0,
            Self::South => 180.0,
            Self::West => 90.0,
        }
    }

    /// The point at `depth_m` before the wall's face at `wall_m`, `along_m` along it.
    fn point(self, wall_m: f32, along_m: f32, depth_m: f32) -> Vec3 {
        match self {
            Self::North => Vec3::new(along_m, 0.0, wall_m + depth_m),
            Self::South => Vec3::new(along_m, 0.0, wall_m - depth_m),
            Self::West => Vec3::new(wall_m + depth_m, 0.0, along_m),
            Self::East => Vec3::new(wall_m - depth_m, 0.0, along_m),
        }
    }
}

/// The rotation about +Y, positive counter-clockwise from above.
pub(crate) fn yaw(degrees: f32) -> Quat {
    turn(Vec3::Y, degrees.to_radians())
}

/// A room that is being furnished.
pub(crate) struct Site<'a> {
    pub(crate) assembly: &'a mut Assembly,
    pub(crate) room: RoomId,
}

impl Site<'_> {
    /// Makes a model known to the house.
    pub(crate) fn kind(&mut self, model: Model) -> Kind {
        self.assembly.kind(model)
    }

    /// Puts a thing anywhere.
    pub(crate) fn place(&mut self, kind: &Kind, world_from_model: Pose) -> Placed {
        self.assembly.place(kind, world_from_model, self.room, 0.0)
    }

    /// Stands a thing on the floor.
    pub(crate) fn stand(&mut self, kind: &Kind, x: f32, z: f32, yaw_deg: f32) -> Placed {
        self.stand_at(kind, x, 0.0, z, yaw_deg)
    }

    /// Stands a thing on something flat at height `y`.
    pub(crate) fn stand_at(&mut self, kind: &Kind, x: f32, y: f32, z: f32, yaw_deg: f32) -> Placed {
        self.place(
            kind,
            Pose::new(Vec3::new(x, y + REST_GAP_M, z), yaw(yaw_deg)),
        )
    }

    /// Stands a thing on the floor with its back to a wall, `along_m` along it, `gap_m` before it.
    pub(crate) fn against(
        &mut self,
        kind: &Kind,
        side: Side,
        wall_m: f32,
        along_m: f32,
        gap_m: f32,
    ) -> Placed {
        let back = -kind.model.bounds().min.z;
        let point = side.point(wall_m, along_m, back + WALL_GAP_M + gap_m);
        self.stand(kind, point.x, point.z, side.yaw_deg())
    }

    /// Hangs a thing on a wall, its origin `y` above the floor.
    pub(crate) fn hang(
        &mut self,
        kind: &Kind,
        side: Side,
        wall_m: f32,
        along_m: f32,
        y: f32,
    ) -> Placed {
        let point = side.point(wall_m, along_m, 0.0) + Vec3::Y * y;
        self.place(kind, Pose::new(point, yaw(side.yaw_deg())))
    }

    /// Hangs a thing from the ceiling.
    pub(crate) fn ceiling(&mut self, kind: &Kind, x: f32, z: f32, yaw_deg: f32) -> Placed {
        self.place(kind, Pose::new(Vec3::new(x, CEILING_M, z), yaw(yaw_deg)))
    }

    /// Puts a thing on or into the space `space` of another one: (`dx`, `dz`) from the middle of its floor, in the other
    /// one's directions, turned by `yaw_deg` against it. A space that does not exist is the highest point.
    pub(crate) fn put(
        &mut self,
        kind: &Kind,
        host: &Placed,
        space: &str,
        [dx, dz]: [f32; 2],
        yaw_deg: f32,
    ) -> Placed {
        let found = host.model.spaces.iter().find(|known| known.name == space);
        let (bounds, part) = found.map_or_else(
            || {
                let all = host.model.bounds();
                (Aabb::new(all.min.with_y(all.max.y), all.max), 0)
            },
            |found| (found.space, found.part),
        );
        let middle = bounds.center();
        let at = Vec3::new(middle.x + dx, bounds.min.y + REST_GAP_M, middle.z + dz);
        let world_from_part = host.world_from_model * host.model.model_from_part(part);
        self.place(kind, world_from_part * Pose::new(at, yaw(yaw_deg)))
    }

    /// Mounts a thing at a point of another one, in that one's space, turned by `yaw_deg` against it.
    pub(crate) fn mount(
        &mut self,
        kind: &Kind,
        host: &Placed,
        point: [f32; 3],
        yaw_deg: f32,
    ) -> Placed {
        let at = Vec3::from(point) + Vec3::Y * REST_GAP_M;
        self.place(kind, host.world_from_model * Pose::new(at, yaw(yaw_deg)))
    }

    /// Leans a flat thing (a pillow) against the back of a seat: it stands on the space `space` of `host`, pitched by
    /// `pitch_deg` from lying, and touches the plane at the space's back, `dx` to the right of its middle.
    pub(crate) fn lean(
        &mut self,
        kind: &Kind,
        host: &Placed,
        space: &str,
        dx: f32,
        pitch_deg: f32,
    ) -> Placed {
        let tilt = turn(Vec3::X, pitch_deg.to_radians());
        let mut bounds = Aabb::EMPTY;
        for part in &kind.model.parts {
            for point in part.colliders.iter().flat_map(collider_corners) {
                bounds.add_point(tilt * point);
            }
        }
        let found = host.model.spaces.iter().find(|known| known.name == space);
        let floor = found.map_or_else(|| host.model.bounds(), |found| found.space);
        let at = Vec3::new(
            floor.center().x + dx,
            floor.min.y - bounds.min.y + REST_GAP_M,
            floor.min.z - bounds.min.z + REST_GAP_M,
        );
        self.place(kind, host.world_from_model * Pose::new(at, tilt))
    }
}

/// Points whose hull is (or surrounds) a collider.
fn collider_corners(collider: &dwell_scene::Collider) -> Vec<Vec3> {
    match collider {
        dwell_scene::Collider::Hull { points } => points.clone(),
        other => other
            .bounds()
            .map_or_else(Vec::new, |bounds| bounds.corners().to_vec()),
    }
}
