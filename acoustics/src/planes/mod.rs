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
use dwell_scene::parallel::Threads;
use dwell_scene::{Aabb, House, Id, PartId, PlacedMesh, Pose, State};
use glam::Vec3;
use std::collections::{BTreeSet, HashMap};

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

/// What the triangles that cannot move make.
struct FixedPlanes {
    planes: Vec<Plane>,
    of_triangle: Vec<u32>,
    pieces: panels::PanelTable,
    reliefs: Vec<f32>,
    edges: Vec<DiffractionEdge>,
}

impl FixedPlanes {
    fn new(corners: &[[Vec3; 3]]) -> Self {
        let (planes, of_triangle) = cluster::cluster_coplanar(corners);
        let pieces = panels::find_panels(corners, &of_triangle);
        Self {
            reliefs: surface_relief::relief_depths_m(corners, &planes, &of_triangle, &pieces),
            edges: edge_detection::find_edges(corners, &of_triangle),
            planes,
            of_triangle,
            pieces,
        }
    }
}

/// What the triangles of a part that can move make, in part space.
struct PartPlanes {
    planes: Vec<Plane>,
    of_triangle: Vec<u32>,
    /// Shape (triangle,).
    panel_area_m2: Vec<f32>,
    edges: Vec<DiffractionEdge>,
    /// From corner to corner of its box, m.
    size_m: f32,
}

impl PartPlanes {
    fn new(house: &House, placed: &PlacedMesh) -> Self {
        let mesh = &house.meshes[placed.mesh];
        let corners: Vec<[Vec3; 3]> = (0..mesh.triangles.len())
            .map(|k| {
                let corners = mesh.corners(k);
                corners.map(|p| placed.part_from_mesh.transform_point3(p))
            })
            .collect();
        let (planes, of_triangle) = cluster::cluster_coplanar(&corners);
        Self {
            panel_area_m2: panels::find_panels(&corners, &of_triangle).area_m2,
            edges: edge_detection::find_edges(&corners, &of_triangle),
            size_m: Aabb::from_points(corners.into_iter().flatten())
                .size()
                .length(),
            planes,
            of_triangle,
        }
    }
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
        // Many parts have the mesh of another.
        let placed_parts: Vec<&PlacedMesh> = geometry
            .movable
            .iter()
            .map(|part| geometry.placed_part(*part))
            .collect();
        let mut shapes: Vec<&PlacedMesh> = Vec::new();
        let mut known: HashMap<_, usize> = HashMap::new();
        let shape_of: Vec<usize> = placed_parts
            .iter()
            .map(|placed| {
                let numbers = placed.part_from_mesh.to_cols_array().map(f32::to_bits);
                *known.entry((placed.mesh, numbers)).or_insert_with(|| {
                    shapes.push(placed);
                    shapes.len() - 1
                })
            })
            .collect();
        let threads = Threads::default();
        let (fixed_planes, shapes) = threads.join(
            || FixedPlanes::new(&fixed),
            || threads.map(shapes.len(), |k| PartPlanes::new(house, shapes[k])),
        );
        let FixedPlanes {
            planes: mut at_start,
            of_triangle: planes,
            pieces,
            reliefs,
            edges,
        } = fixed_planes;
        let mut edges = EdgeTable::new(edges);
        let mut of_triangle = vec![NO_PLANE; total];
        let mut panels = vec![ReflectorPanel::NONE; total];
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
        for (part, shape) in geometry.movable.iter().copied().zip(shape_of) {
            let shape = &shapes[shape];
            let base = first_triangle[structures + part.index()] as usize;
            for (panel, area_m2) in panels[base..].iter_mut().zip(&shape.panel_area_m2) {
                panel.area_m2 = *area_m2;
            }
            edges.add_moving(part, shape.edges.clone());
            for (k, plane) in shape.of_triangle.iter().enumerate() {
                if *plane != NO_PLANE {
                    of_triangle[base + k] = at_start.len() as u32 + plane;
                }
            }
            let first = at_start.len();
            let pose = house.parts[part].world_from_part;
            at_start.extend(shape.planes.iter().map(|plane| moved(plane, &pose)));
            let is_panel = |plane: &Plane| plane.area_m2 >= MIN_PANEL_AREA_M2;
            moving.push(MovingPlanes {
                part,
                first,
                is_large: jointed.contains(&part) && shape.size_m >= MIN_JOINTED_SIZE_M
                    || shape.planes.iter().any(is_panel),
                planes: shape.planes.clone(),
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
