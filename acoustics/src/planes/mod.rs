//! The planes and edges of a house: side tables over its triangles, made once and shared by all worlds.

mod cluster;
mod disjoint_sets;
mod edge_detection;
mod edges;
mod panels;
mod surface_relief;

pub use cluster::Plane;
pub use edges::DiffractionEdge;
pub(crate) use edges::EdgeTable;

use dwell_scene::bvh::Hit;
use dwell_scene::{Aabb, House, Id, PartId, Pose, State};
use glam::Vec3;
use std::collections::BTreeSet;

/// Marks a triangle without a plane: it reflects rays, but has no images.
pub const NO_PLANE: u32 = u32::MAX;
/// Triangles between checks for cancellation.
const TRIANGLES_PER_CHECK: usize = 512;
/// Least area of the walls of rooms, m².
pub(crate) const MIN_WALL_AREA_M2: f32 = 4.0;

/// Size from corner to corner from which parts that hang on joints affect sound, m.
const MIN_JOINTED_SIZE_M: f32 = 0.7;
/// Area of a plane from which loose parts affect sound, m²: table tops and mattresses do, chairs and plants do not.
const MIN_PANEL_AREA_M2: f64 = 0.5;

/// The piece of a plane that a triangle belongs to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReflectorPanel {
    /// 0 for triangles without a plane.
    pub(crate) area_m2: f32,
    /// Relief over a wall behind or around it, rms over both, m; infinite for panels with no wall near, for walls and for
    /// parts that can move.
    pub(crate) relief_depth_m: f32,
}

impl ReflectorPanel {
    const NONE: Self = Self {
        area_m2: 0.0,
        relief_depth_m: f32::INFINITY,
    };
}

/// The planes of one moving part.
#[derive(Clone, Debug)]
struct MovingPlanes {
    part: PartId,
    /// Its first plane among all; the others follow.
    first: usize,
    /// In part space.
    planes: Vec<Plane>,
    /// True for a part that changes how a room sounds when it moves: one that hangs on a joint, as doors and lids do, and
    /// measures at least [`MIN_JOINTED_SIZE_M`] from corner to corner, or one with a plane of at least [`MIN_PANEL_AREA_M2`].
    is_large: bool,
}

/// The plane of every triangle of a house.
#[derive(Clone, Debug)]
pub struct PlaneTable {
    /// Static planes, then those of the moving parts at their initial poses.
    pub(crate) initial_planes: Vec<Plane>,
    /// Position of the first triangle of each placed mesh in `of_triangle`. Shape (placed,).
    first_triangle: Vec<u32>,
    of_triangle: Vec<u32>,
    /// The panel of each triangle. As `of_triangle`.
    panels: Vec<ReflectorPanel>,
    moving: Vec<MovingPlanes>,
    /// Static planes, the largest first.
    largest: Vec<u32>,
    edges: EdgeTable,
}

impl PlaneTable {
    /// Clusters the triangles of `house`.
    pub fn new(house: &House) -> Self {
        let geometry = house.geometry();
        let mut first_triangle = Vec::with_capacity(geometry.placed.len());
        let mut total = 0;
        for placed in &geometry.placed {
            first_triangle.push(total as u32);
            total += house.meshes[placed.mesh].triangles.len();
        }
        let corners_of = |placed: usize, triangle: u32| {
            let placed = &geometry.placed[placed];
            let corners = house.meshes[placed.mesh].corners(triangle as usize);
            corners.map(|p| placed.world_from_mesh.transform_point3(p))
        };
        let fixed: Vec<[Vec3; 3]> = geometry
            .static_triangles
            .iter()
            .map(|source| corners_of(source.placed as usize, source.triangle))
            .collect();
        let (mut at_start, planes) = cluster::cluster_coplanar(&fixed);
        let mut of_triangle = vec![NO_PLANE; total];
        let mut panels = vec![ReflectorPanel::NONE; total];
        let pieces = panels::find_panels(&fixed, &planes);
        let reliefs = surface_relief::relief_depths_m(&fixed, &at_start, &planes, &pieces);
        let mut edges = EdgeTable::new(edge_detection::find_edges(&fixed, &planes));
        for (k, source) in geometry.static_triangles.iter().enumerate() {
            let place = (first_triangle[source.placed as usize] + source.triangle) as usize;
            of_triangle[place] = planes[k];
            panels[place] = ReflectorPanel {
                area_m2: pieces.area_m2[k],
                relief_depth_m: reliefs[k],
            };
        }
        let mut largest: Vec<u32> = (0..at_start.len() as u32).collect();
        largest.sort_by(|a, b| {
            let area = |k: &u32| at_start[*k as usize].area_m2;
            area(b).total_cmp(&area(a)).then(a.cmp(b))
        });
        // No more are needed than the configuration's upper limit.
        largest.truncate(200);

        let structures = house.structure.len();
        let jointed: BTreeSet<PartId> = house.joints.iter().map(|joint| joint.child).collect();
        let mut moving = Vec::with_capacity(geometry.movable.len());
        for part in geometry.movable.iter().copied() {
            let placed = geometry.placed_part(part);
            let mesh = &house.meshes[placed.mesh];
            let corners: Vec<[Vec3; 3]> = (0..mesh.triangles.len())
                .map(|k| {
                    let corners = mesh.corners(k);
                    corners.map(|p| placed.part_from_mesh.transform_point3(p))
                })
                .collect();
            let (planes, of_part) = cluster::cluster_coplanar(&corners);
            let base = first_triangle[structures + part.index()] as usize;
            let pieces = panels::find_panels(&corners, &of_part);
            for (panel, area_m2) in panels[base..].iter_mut().zip(pieces.area_m2) {
                panel.area_m2 = area_m2;
            }
            edges.add_moving(part, edge_detection::find_edges(&corners, &of_part));
            for (k, plane) in of_part.into_iter().enumerate() {
                if plane != NO_PLANE {
                    of_triangle[base + k] = at_start.len() as u32 + plane;
                }
            }
            let first = at_start.len();
            let pose = house.parts[part].world_from_part;
            at_start.extend(planes.iter().map(|plane| moved(plane, &pose)));
            let size_m = Aabb::from_points(corners.into_iter().flatten()).size();
            let is_panel = |plane: &Plane| plane.area_m2 >= MIN_PANEL_AREA_M2;
            moving.push(MovingPlanes {
                part,
                first,
                is_large: jointed.contains(&part) && size_m.length() >= MIN_JOINTED_SIZE_M
                    || planes.iter().any(is_panel),
                planes,
            });
        }
        Self {
            initial_planes: at_start,
            first_triangle,
            of_triangle,
            panels,
            moving,
            largest,
            edges,
        }
    }

    /// The number of planes.
    pub fn len(&self) -> usize {
        self.initial_planes.len()
    }

    /// Returns whether there are no planes.
    pub fn is_empty(&self) -> bool {
        self.initial_planes.is_empty()
    }

    /// Returns the largest static planes, largest first, at most 200.
    pub(crate) fn largest_static_planes(&self) -> &[u32] {
        &self.largest
    }

    pub(crate) fn edges(&self) -> &EdgeTable {
        &self.edges
    }

    /// Returns the plane of a hit; [`NO_PLANE`] where it has none.
    pub(crate) fn plane_of_hit(&self, house: &House, hit: &Hit) -> u32 {
        let place = self.triangle_index(house, hit);
        place.map_or(NO_PLANE, |place| self.of_triangle[place])
    }

    /// Returns the panel of a hit.
    pub(crate) fn panel(&self, house: &House, hit: &Hit) -> ReflectorPanel {
        let place = self.triangle_index(house, hit);
        place.map_or(ReflectorPanel::NONE, |place| self.panels[place])
    }

    /// Returns the index of a hit's triangle in the tables.
    fn triangle_index(&self, house: &House, hit: &Hit) -> Option<usize> {
        let geometry = house.geometry();
        let (placed, triangle) = if let Some(instance) = hit.instance {
            let part = geometry.movable.get(instance as usize)?;
            (house.structure.len() + part.index(), hit.triangle)
        } else {
            let source = geometry.static_triangles.get(hit.triangle as usize)?;
            (source.placed as usize, source.triangle)
        };
        let place = (self.first_triangle.get(placed)? + triangle) as usize;
        (place < self.of_triangle.len()).then_some(place)
    }

    /// Returns the initial poses of the moving parts. Shape (moving part,).
    pub(crate) fn initial_poses(&self, house: &House) -> Vec<Pose> {
        let parts = self.moving.iter();
        parts
            .map(|moving| house.parts[moving.part].world_from_part)
            .collect()
    }

    /// Moves the planes of the parts whose poses in `state` differ from `poses`, and updates these. Returns whether any has
    /// moved.
    pub(crate) fn update(&self, planes: &mut [Plane], poses: &mut [Pose], state: &State) -> bool {
        let mut any = false;
        for (moving, pose) in self.moving.iter().zip(poses) {
            let Some(now) = state.part_pose.get(moving.part).filter(|now| *now != pose) else {
                continue;
            };
            *pose = *now;
            any = true;
            let places = planes[moving.first..].iter_mut();
            for (plane, in_part) in places.zip(&moving.planes) {
                *plane = moved(in_part, now);
            }
        }
        any
    }

    /// Returns the moving parts that change how a room sounds: doors, lids, table tops.
    pub(crate) fn large_parts(&self) -> impl Iterator<Item = PartId> + '_ {
        let large = self.moving.iter().filter(|moving| moving.is_large);
        large.map(|moving| moving.part)
    }
}

fn moved(plane: &Plane, world_from_part: &Pose) -> Plane {
    let rotation = world_from_part.rotation.as_dquat().normalize();
    let normal = rotation * plane.normal;
    Plane {
        normal,
        offset_m: plane.offset_m + normal.dot(world_from_part.position.as_dvec3()),
        area_m2: plane.area_m2,
        bounds: plane.bounds.transformed(&world_from_part.to_affine()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::ShoeboxMaterials;

    #[test]
    fn a_shoebox_has_six_planes() {
        let house = House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap();
        let table = PlaneTable::new(&house);
        assert_eq!(table.len(), 6);
        let area: f64 = table.initial_planes.iter().map(|plane| plane.area_m2).sum();
        assert!((area - 126.0).abs() < 1e-4);
        assert!(
            (table.initial_planes[table.largest_static_planes()[0] as usize].area_m2 - 30.0).abs()
                < 1e-4
        );
    }

    #[test]
    fn a_moved_plane_goes_through_its_moved_points() {
        let plane = Plane {
            normal: glam::DVec3::X,
            offset_m: 2.0,
            area_m2: 1.0,
            bounds: Aabb::new(Vec3::new(2.0, 0.0, 0.0), Vec3::new(2.0, 1.0, 1.0)),
        };
        let pose = Pose::from_position_yaw(Vec3::new(5.0, 1.0, -3.0), 0.6);
        let there = moved(&plane, &pose);
        for point in [Vec3::new(2.0, 0.3, 0.9), Vec3::new(2.0, -4.0, 7.0)] {
            assert!(
                there
                    .distance_m(pose.transform_point(point).as_dvec3())
                    .abs()
                    < 1e-5
            );
        }
    }
}
