//! The diffraction edges of a house: made once and shared by all worlds.

use dwell_scene::{House, PartId, Pose, State};
use glam::Vec3;

/// A straight edge with more air than solid around it: the rim of a sheet, or a convex corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffractionEdge {
    /// Its ends, m.
    pub ends: [Vec3; 2],
    /// Away from the solid, in the middle of the air around it, unit length, perpendicular to the edge.
    pub outward_direction: Vec3,
    /// Angle of the air around it, rad; from 210 degrees up to a full turn, which is a sheet's.
    pub air_angle_rad: f32,
}

impl DiffractionEdge {
    fn moved(&self, pose: &Pose) -> Self {
        Self {
            ends: self.ends.map(|end| pose.transform_point(end)),
            outward_direction: (pose.rotation * self.outward_direction).normalize_or_zero(),
            air_angle_rad: self.air_angle_rad,
        }
    }
}

/// The edges of one moving part.
#[derive(Clone, Debug)]
struct MovingEdges {
    part: PartId,
    /// In part space.
    edges: Vec<DiffractionEdge>,
}

/// All edges of a house.
#[derive(Clone, Debug)]
pub(crate) struct EdgeTable {
    /// Of everything that never moves.
    pub(crate) static_edges: Vec<DiffractionEdge>,
    /// Of the parts that have edges.
    moving: Vec<MovingEdges>,
}

impl EdgeTable {
    pub(super) fn new(fixed: Vec<DiffractionEdge>) -> Self {
        Self {
            static_edges: fixed,
            moving: Vec::new(),
        }
    }

    pub(super) fn add_moving(&mut self, part: PartId, edges: Vec<DiffractionEdge>) {
        if !edges.is_empty() {
            self.moving.push(MovingEdges { part, edges });
        }
    }

    /// Returns the edges of the moving parts at their initial poses.
    pub(crate) fn initial_edges(&self, house: &House) -> Vec<DiffractionEdge> {
        self.moved(|part| house.parts[part].world_from_part)
    }

    /// Returns the same in a state.
    pub(crate) fn moving_edges_in_state(
        &self,
        house: &House,
        state: &State,
    ) -> Vec<DiffractionEdge> {
        let start = |part| house.parts[part].world_from_part;
        self.moved(|part| {
            state
                .part_pose
                .get(part)
                .copied()
                .unwrap_or_else(|| start(part))
        })
    }

    fn moved(&self, pose: impl Fn(PartId) -> Pose) -> Vec<DiffractionEdge> {
        let mut edges = Vec::new();
        for moving in &self.moving {
            let pose = pose(moving.part);
            edges.extend(moving.edges.iter().map(|edge| edge.moved(&pose)));
        }
        edges
    }
}
