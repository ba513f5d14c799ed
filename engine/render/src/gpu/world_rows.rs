//! Worlds as kernels read them: the tree over what moves, and its instances.

use super::house_buffers::point;
use crate::cpu::{RenderJob, VISIBLE_MASK};
use dwell_scene::Pose;
use dwell_scene::bvh::flat::{INSTANCE_ROWS, NODE_ROWS, PackedRow, flat_pose};
use dwell_scene::parallel::Threads;

/// The worlds of a batch. Their memory is reused.
#[derive(Debug, Default)]
pub(super) struct WorldRows {
    /// The rows of each world, positions counted from its own first row.
    lists: Vec<Vec<PackedRow>>,
}

/// Returns whether two views are of one world.
fn is_same(a: &RenderJob<'_>, b: &RenderJob<'_>) -> bool {
    std::ptr::eq(a.scene, b.scene) && std::ptr::eq(a.state, b.state)
}

/// Views of one world follow one another as a rule: the runs of those that do.
pub(super) fn runs_of_same_world<'j, 'a>(jobs: &'j [RenderJob<'a>]) -> Vec<&'j [RenderJob<'a>]> {
    jobs.chunk_by(is_same).collect()
}

impl WorldRows {
    /// Lists the world of each run.
    pub(super) fn fill(&mut self, runs: &[&[RenderJob<'_>]], threads: Threads) {
        if self.lists.len() < runs.len() {
            self.lists.resize_with(runs.len(), Vec::new);
        }
        let mut work: Vec<_> = runs.iter().zip(&mut self.lists).collect();
        threads.for_each(&mut work, |_, (run, rows)| {
            rows.clear();
            if let Some(job) = run.first() {
                pack_world(job, rows);
            }
        });
    }

    /// Appends the world of a run; returns its first row.
    pub(super) fn append(&self, run: usize, rows: &mut Vec<PackedRow>) -> u32 {
        let world = rows.len();
        rows.extend_from_slice(&self.lists[run]);
        rows[world][1] += world as u32;
        world as u32
    }
}

/// The tree over a world's instances, then the instances.
fn pack_world(job: &RenderJob<'_>, rows: &mut Vec<PackedRow>) {
    let moving = job.scene.bvh().moving;
    rows.resize(3, [0; 4]);
    let top = moving.flatten_tree(rows);
    debug_assert_eq!((rows.len() - 3) % NODE_ROWS, 0);
    let bounds = moving.bounds();
    rows[0] = [top, rows.len() as u32, moving.len() as u32, 0];
    rows[1] = point(bounds.min, 0);
    rows[2] = point(bounds.max, 0);
    let parts = &job.scene.house().geometry().movable;
    for instance in 0..moving.len() {
        let hidden = [[0; 4]; INSTANCE_ROWS];
        rows.extend(
            moving
                .flat_instance(instance, VISIBLE_MASK)
                .unwrap_or(hidden),
        );
        let pose = parts
            .get(instance)
            .and_then(|part| job.state.part_pose.get(*part));
        let piece = job.scene.person_piece(instance as u32);
        let pose = pose.or(piece.map(|piece| &piece.pose));
        let [rotation, mut position] = flat_pose(pose.unwrap_or(&Pose::IDENTITY));
        // The colour of a person's piece.
        position[3] = piece.map_or(0, |piece| {
            let [r, g, b] = piece.srgb;
            u32::from_le_bytes([r, g, b, 255])
        });
        rows.extend([rotation, position]);
    }
}

#[cfg(test)]
mod tests {
    use dwell_scene::rays::BODY_PIECES;

    #[test]
    fn shaders_count_the_pieces_of_bodies_as_the_scene_does() {
        let line = format!("const BODY_PIECES: u32 = {BODY_PIECES}u;");
        assert!(include_str!("shaders/walk.wgsl").contains(&line), "{line}");
    }
}
