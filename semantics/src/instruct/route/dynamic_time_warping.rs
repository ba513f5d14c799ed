//! How closely a path keeps to another.

use dwell_scene::math::exp;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Distance by which differences of places are divided, m.
const SCALE_M: f64 = 3.0;

/// The dynamic time warping of a path to a reference, place by place.
///
/// # Source
/// G. Ilharco et al., "General Evaluation for Instruction Conditioned Navigation using Dynamic Time Warping", arXiv:1907.05446 (2019):
/// nDTW = exp(-DTW(P, R) / (|R| r)), with Euclidean distances, repeated places of P dropped, and r = 3 m as in VLN-CE.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DynamicTimeWarping {
    reference: Vec<Vec3>,
    /// The cost of the path so far to each beginning of the reference, m; empty before the first place.
    costs: Vec<f64>,
    last: Option<Vec3>,
}

impl DynamicTimeWarping {
    /// Begins with a reference of places on a line with corners at `way`, `spacing_m` apart.
    pub fn new(way: &[Vec3], spacing_m: f32) -> Self {
        let mut reference: Vec<Vec3> = way.first().copied().into_iter().collect();
        let mut since_m = 0.0;
        for piece in way.windows(2) {
            let length_m = piece[0].distance(piece[1]);
            let mut at_m = spacing_m - since_m;
            while at_m <= length_m {
                reference.push(piece[0].lerp(piece[1], at_m / length_m));
                at_m += spacing_m;
            }
            since_m = length_m - (at_m - spacing_m);
        }
        let end = way.last().copied();
        if reference.last().copied() != end {
            reference.extend(end);
        }
        Self {
            reference,
            costs: Vec::new(),
            last: None,
        }
    }

    /// The path goes on to a place, m.
    pub fn add(&mut self, place: Vec3) {
        if self.last.replace(place) == Some(place) {
            return;
        }
        let distance = |to: &Vec3| f64::from(place.distance(*to));
        let is_first = self.costs.is_empty();
        self.costs.resize(self.reference.len(), f64::INFINITY);
        let mut diagonal = if is_first { 0.0 } else { f64::INFINITY };
        let mut left = f64::INFINITY;
        for (to, cost) in self.reference.iter().zip(&mut self.costs) {
            let above = *cost;
            left = distance(to) + above.min(left).min(diagonal);
            (*cost, diagonal) = (left, above);
        }
    }

    /// nDTW of the path so far, 0 to 1; 0 before its first place.
    pub fn ndtw(&self) -> f64 {
        let Some(cost) = self.costs.last() else {
            return 0.0;
        };
        let places = self.reference.len() as f64;
        f64::from(exp((-cost / (places * SCALE_M)) as f32))
    }

    /// The path so far, as [`Self::restore`] takes it: costs (m), and the last place.
    pub fn progress(&self) -> (Vec<f64>, Option<Vec3>) {
        (self.costs.clone(), self.last)
    }

    /// Goes to a [`Self::progress`] with the same reference; `false` for one that is none, which changes nothing.
    #[must_use]
    pub fn restore(&mut self, (costs, last): (Vec<f64>, Option<Vec3>)) -> bool {
        let fits = costs.is_empty() || costs.len() == self.reference.len();
        if fits {
            (self.costs, self.last) = (costs, last);
        }
        fits
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The definition by recursion over all pairs.
    fn dtw(path: &[Vec3], reference: &[Vec3]) -> f64 {
        let (Some((p, before)), Some((r, earlier))) = (path.split_last(), reference.split_last())
        else {
            return if path.is_empty() && reference.is_empty() {
                0.0
            } else {
                f64::INFINITY
            };
        };
        let steps = [
            dtw(before, reference),
            dtw(path, earlier),
            dtw(before, earlier),
        ];
        f64::from(p.distance(*r)) + steps.into_iter().fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn place_by_place_it_is_the_recursion_over_all_pairs() {
        let place = |k: u8, scale: f32| {
            let k = f32::from(k);
            Vec3::new(k, 0.0, (k * scale) % 1.7)
        };
        let way: Vec<Vec3> = (0..6).map(|k| place(k, 0.3)).collect();
        let path: Vec<Vec3> = (0..7).map(|k| place(k, 1.1)).collect();
        let mut warp = DynamicTimeWarping::new(&way, 1.4);
        assert!(warp.ndtw().abs() < 1e-12);
        for (k, place) in path.iter().enumerate() {
            warp.add(*place);
            warp.add(*place);
            let expected =
                (-dtw(&path[..=k], &warp.reference) / (warp.reference.len() as f64 * 3.0)).exp();
            assert!((warp.ndtw() - expected).abs() < 1e-6, "{k}");
        }
        assert!(warp.ndtw() < 0.9);
    }

    #[test]
    fn the_reference_itself_is_one_and_its_places_lie_apart() {
        let way = [
            Vec3::ZERO,
            Vec3::new(0.55, 0.0, 0.0),
            Vec3::new(0.55, 0.0, 0.7),
        ];
        let mut warp = DynamicTimeWarping::new(&way, 0.25);
        assert_eq!(warp.reference.len(), 6);
        // 0.75 m of the way are 0.2 m beyond its corner.
        assert!(warp.reference[3].distance(Vec3::new(0.55, 0.0, 0.2)) < 1e-5);
        for place in warp.reference.clone() {
            warp.add(place);
        }
        assert!((warp.ndtw() - 1.0).abs() < 1e-6);
    }
}
