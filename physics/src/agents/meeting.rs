//! Movements of several agents at the same time: two who would meet stop where they meet.
//!
//! Each agent has found its way past everything, the others where they stood before the step. Two such movements can still end in
//! one place. All are uniform over the step, so who meets whom is solved exactly, event by event, and both of a pair stop: no
//! agent's number decides anything.

use super::shape_queries::SKIN_WIDTH_M;
use glam::{Vec2, Vec3, Vec3Swizzles};

/// Gap that two who meet leave, besides the skin, m; as before other obstacles.
const MEETING_GAP_M: f32 = 1e-4;

/// The movement of an agent in a step: straight, at one speed.
#[derive(Clone, Copy, Debug)]
pub(super) struct AgentPath {
    pub(super) from: Vec3,
    pub(super) to: Vec3,
    pub(super) radius_m: f32,
    pub(super) height_m: f32,
}

impl AgentPath {
    fn displacement(&self) -> Vec2 {
        (self.to - self.from).xz()
    }

    /// Returns where it is at a time, of a movement that ends early.
    fn at(&self, time: f32, end: f32) -> Vec2 {
        self.from.xz() + self.displacement() * time.min(end)
    }

    /// Returns whether one is above the other.
    fn is_on_other_level(&self, other: &Self) -> bool {
        self.from.y >= other.from.y + other.height_m || other.from.y >= self.from.y + self.height_m
    }
}

/// Returns the share of its movement that each agent makes, 0 to 1, so that no two who were apart overlap, and none who overlapped
/// come closer. Shape (agent,).
pub(super) fn collision_free_fractions(paths: &[AgentPath]) -> Vec<f32> {
    let mut shares = vec![1.0_f32; paths.len()];
    // Each round stops at least one agent, and only later meetings depend on it.
    for _ in 0..paths.len() {
        let mut first: Option<(f32, usize, usize)> = None;
        for (a, path) in paths.iter().enumerate() {
            for (b, other) in paths.iter().enumerate().skip(a + 1) {
                let time = meeting_time((path, shares[a]), (other, shares[b]));
                if let Some(time) = time.filter(|time| first.is_none_or(|(best, ..)| *time < best))
                {
                    first = Some((time, a, b));
                }
            }
        }
        let Some((time, a, b)) = first else { break };
        shares[a] = shares[a].min(time);
        shares[b] = shares[b].min(time);
    }
    shares
}

/// Returns when two meet, 0 to 1, if one of them still moves then; each with the time at which its movement ends.
fn meeting_time(
    (path, end): (&AgentPath, f32),
    (other, other_end): (&AgentPath, f32),
) -> Option<f32> {
    if path.is_on_other_level(other) {
        return None;
    }
    let reach = path.radius_m + other.radius_m + SKIN_WIDTH_M;
    let (both, last) = (end.min(other_end), end.max(other_end));
    // While both move, then while one does.
    [(0.0, both), (both, last)]
        .into_iter()
        .filter(|(begin, finish)| finish > begin)
        .find_map(|(begin, finish)| {
            let between = |time| path.at(time, end) - other.at(time, other_end);
            let (from, to) = (between(begin), between(finish));
            let share = approach_share(from, to - from, reach)?;
            Some(begin + (finish - begin) * share)
        })
}

/// Returns the share of a relative motion after which two are a gap short of `reach` apart, if they get that close.
fn approach_share(from: Vec2, motion: Vec2, reach: f32) -> Option<f32> {
    // |from + t motion| = reach.
    let (a, b) = (motion.length_squared(), from.dot(motion));
    let c = from.length_squared() - reach * reach;
    if a == 0.0 || b >= 0.0 {
        return None;
    }
    if c <= 0.0 {
        return Some(0.0);
    }
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return None;
    }
    let share = (-b - discriminant.sqrt()) / a;
    (share < 1.0).then(|| (share - MEETING_GAP_M / a.sqrt()).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::RandomKey;

    const RADIUS_M: f32 = 0.2;

    fn path(from: [f32; 2], to: [f32; 2]) -> AgentPath {
        AgentPath {
            from: Vec3::new(from[0], 0.0, from[1]),
            to: Vec3::new(to[0], 0.0, to[1]),
            radius_m: RADIUS_M,
            height_m: 1.5,
        }
    }

    #[test]
    fn one_alone_and_those_who_pass_are_free() {
        assert_eq!(
            collision_free_fractions(&[path([0.0, 0.0], [1.0, 0.0])]),
            [1.0]
        );
        let apart = [
            path([0.0, 0.0], [1.0, 0.0]),
            path([1.0, 0.5], [0.0, 0.5]),
            path([0.0, 5.0], [0.0, 5.0]),
        ];
        assert_eq!(collision_free_fractions(&apart), [1.0; 3]);
        // One who walks behind another as fast as it, and one on the floor above.
        let row = [path([0.0, 0.0], [1.0, 0.0]), path([0.5, 0.0], [1.5, 0.0])];
        assert_eq!(collision_free_fractions(&row), [1.0; 2]);
        let mut above = path([0.5, 0.0], [0.5, 0.0]);
        (above.from.y, above.to.y) = (2.0, 2.0);
        assert_eq!(collision_free_fractions(&[row[0], above]), [1.0; 2]);
    }

    /// Head on both stop in the middle; one who stands is walked up to; the third of a row is stopped by the second's stop.
    #[test]
    fn those_who_meet_both_stop_where_they_meet() {
        let reach = 2.0 * RADIUS_M + SKIN_WIDTH_M;
        let shares =
            collision_free_fractions(&[path([0.0, 0.0], [1.0, 0.0]), path([1.0, 0.0], [0.0, 0.0])]);
        assert!((shares[0] - 0.5 * (1.0 - reach)).abs() < 1e-3, "{shares:?}");
        assert_eq!(shares[0], shares[1]);
        let shares = collision_free_fractions(&[
            path([0.0, 0.0], [1.0, 0.0]),
            path([1.0, 0.0], [1.0, 0.0]),
            path([-0.5, 0.0], [0.5, 0.0]),
        ]);
        assert!((shares[0] - (1.0 - reach)).abs() < 1e-3, "{shares:?}");
        // Stops when the gap of 0.5 m to the first, which has stopped, is used up.
        assert!((shares[2] - (1.5 - 2.0 * reach)).abs() < 2e-3, "{shares:?}");
    }

    #[test]
    fn those_who_overlap_may_part_but_not_come_closer() {
        let closer = [path([0.0, 0.0], [0.1, 0.0]), path([0.2, 0.0], [0.2, 0.0])];
        assert_eq!(collision_free_fractions(&closer), [0.0, 0.0]);
        let parting = [path([0.0, 0.0], [-0.1, 0.0]), path([0.2, 0.0], [0.3, 0.0])];
        assert_eq!(collision_free_fractions(&parting), [1.0, 1.0]);
    }

    /// Random crowds: nobody overlaps at any moment, as sampled finely, and in any order each has the same share.
    #[test]
    fn crowds_never_overlap_and_order_decides_nothing() {
        let mut random = RandomKey::root(3).stream();
        let mut met = 0;
        for _ in 0..300 {
            let mut paths: Vec<AgentPath> = Vec::new();
            while paths.len() < 6 {
                let mut place = |low, high| [random.range(low, high), random.range(low, high)];
                let (from, way) = (place(0.0, 2.0), place(-0.8, 0.8));
                let own = path(from, [from[0] + way[0], from[1] + way[1]]);
                let free = |other: &AgentPath| {
                    (other.from - own.from).length() > 2.0 * RADIUS_M + SKIN_WIDTH_M
                };
                if paths.iter().all(free) {
                    paths.push(own);
                }
            }
            let shares = collision_free_fractions(&paths);
            met += shares.iter().filter(|share| **share < 1.0).count();
            for moment in 0..=100 {
                let time = moment as f32 * 0.01;
                for a in 0..6 {
                    for b in 0..a {
                        let between = paths[a].at(time, shares[a]) - paths[b].at(time, shares[b]);
                        assert!(between.length() > 2.0 * RADIUS_M, "{paths:?} {shares:?}");
                    }
                }
            }
            let turned: Vec<AgentPath> = paths.iter().rev().copied().collect();
            let mut again = collision_free_fractions(&turned);
            again.reverse();
            for (share, other) in shares.iter().zip(&again) {
                assert!((share - other).abs() < 1e-5, "{shares:?} {again:?}");
            }
        }
        assert!(met > 600, "{met}");
    }
}
