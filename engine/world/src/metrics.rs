//! Measures of navigation episodes.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Navigation measures of one episode.
///
/// # Source
/// P. Anderson et al., "On Evaluation of Embodied Navigation Agents", arXiv:1807.06757 (2018), with the corner rules of
/// `AllenAct`'s `spl_metric`: an unreachable goal counts 0, a goal at the start counts 1 if the agent never moved.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NavigationMetrics {
    /// Geodesic distance to the goal at the start, m; `None` when it cannot be reached.
    pub start_distance_m: Option<f64>,
    /// Geodesic distance to the goal now, m; `None` when it cannot be reached from here.
    pub distance_m: Option<f64>,
    /// Length of the path so far: the sum of straight steps, m.
    pub path_m: f64,
    /// Steps that were cut short by something in the way.
    pub collisions: u64,
    last_position: Vec3,
}

impl NavigationMetrics {
    /// The start of an episode.
    pub fn new(position: Vec3, distance_m: Option<f64>) -> Self {
        Self {
            start_distance_m: distance_m,
            distance_m,
            path_m: 0.0,
            collisions: 0,
            last_position: position,
        }
    }

    /// Adds one step and returns by how much the distance fell, m (0 where it is unknown).
    pub fn advance(&mut self, position: Vec3, distance_m: Option<f64>, collided: bool) -> f64 {
        self.path_m += f64::from((position - self.last_position).length());
        self.last_position = position;
        self.collisions += u64::from(collided);
        let gain = self
            .distance_m
            .zip(distance_m)
            .map_or(0.0, |(before, now)| before - now);
        // A point off the grid has no distance; the last known one stands until the agent is back on it.
        self.distance_m = distance_m.or(self.distance_m);
        gain
    }

    /// Success weighted by path length, 0 to 1.
    pub fn spl(&self, success: bool) -> f64 {
        match self.start_distance_m {
            Some(_) if !success => 0.0,
            None => 0.0,
            Some(start) if start <= 0.0 => f64::from(u8::from(self.path_m <= 0.0)),
            Some(start) => start / start.max(self.path_m),
        }
    }

    /// As [`Self::spl`] with the share of the distance that was covered in place of success; 0 to 1.
    pub fn soft_spl(&self) -> f64 {
        match (self.start_distance_m, self.distance_m) {
            (Some(start), Some(_)) if start <= 0.0 => f64::from(u8::from(self.path_m <= 0.0)),
            (Some(start), Some(now)) => {
                (1.0 - now / start).max(0.0) * start / start.max(self.path_m)
            }
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_detour_of_twice_the_distance_halves_spl() {
        let mut progress = NavigationMetrics::new(Vec3::ZERO, Some(2.0));
        progress.advance(Vec3::new(2.0, 0.0, 0.0), Some(1.0), false);
        progress.advance(Vec3::new(2.0, 0.0, 2.0), Some(0.0), true);
        assert!((progress.spl(true) - 0.5).abs() < 1e-12 && progress.spl(false) == 0.0);
        assert!((progress.soft_spl() - 0.5).abs() < 1e-12);
        assert_eq!(progress.collisions, 1);
    }

    #[test]
    fn corner_cases_give_numbers() {
        assert!((NavigationMetrics::new(Vec3::ZERO, Some(0.0)).spl(true) - 1.0).abs() < 1e-12);
        assert!(NavigationMetrics::new(Vec3::ZERO, None).spl(true).abs() < 1e-12);
        let mut moved = NavigationMetrics::new(Vec3::ZERO, Some(0.0));
        moved.advance(Vec3::X, Some(1.0), false);
        assert!(moved.spl(true).abs() < 1e-12 && moved.soft_spl().abs() < 1e-12);
    }
}
