//! Comparison of a picture with its golden image.

use super::store::StoredObservation;
use crate::flip::flip;

/// Tolerances of colours: perceptual differences (FLIP), 0 to 1.
///
/// One machine and build give the same bits; other builds may round otherwise. Set by the defects of the test `goldens`, which must
/// be found on the `cpu` back end (x86-64): one lamp of a room off has a mean of 0.0096 and 0.0185 rough pixels, a hundredth more
/// brightness a mean of 0.0575.
pub const LOOKS: Bounds = Bounds {
    mean: 0.004,
    rough: 0.1,
    rough_share: 0.005,
};

/// Tolerances of numbers, in their own unit, beside half a step of the file: 0.1 mm, a ten-thousandth. Rays that pass an
/// edge within rounding may meet the other side.
pub const EXACT: Bounds = Bounds {
    mean: f64::INFINITY,
    rough: 1e-4,
    rough_share: 0.002,
};

/// The tolerances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Of the mean difference.
    pub mean: f64,
    /// A pixel that differs more is rough.
    pub rough: f64,
    /// Greatest share of rough pixels; of numbers and ids only pixels beside an edge may be rough.
    pub rough_share: f64,
}

/// The found differences.
#[derive(Clone, Debug)]
pub struct Difference {
    bounds: Bounds,
    width: usize,
    /// Of each pixel, or of each row of a list.
    each: Vec<f64>,
    /// Rough ones that no edge excuses.
    inexcusable: usize,
}

impl Difference {
    /// The mean over all pixels.
    pub fn mean(&self) -> f64 {
        self.each.iter().sum::<f64>() / self.each.len().max(1) as f64
    }

    /// The share of pixels beyond the bound.
    pub fn rough_share(&self) -> f64 {
        let rough = self.each.iter().filter(|one| **one > self.bounds.rough);
        rough.count() as f64 / self.each.len().max(1) as f64
    }

    /// Returns whether it is allowed.
    ///
    /// # Errors
    /// A sentence with what was found and what is allowed.
    pub fn judge(&self) -> Result<(), String> {
        let (mean, share, bounds) = (self.mean(), self.rough_share(), self.bounds);
        let found = |what: String, allowed: f64| Err(format!("{what}; allowed is {allowed}"));
        if self.inexcusable > 0 {
            let count = self.inexcusable;
            return found(
                format!("{count} pixels away from edges differ by more"),
                bounds.rough,
            );
        }
        if mean.is_nan() || mean > bounds.mean {
            return found(format!("the mean difference is {mean:.5}"), bounds.mean);
        }
        if share > bounds.rough_share {
            let what = format!(
                "{share:.5} of all pixels differ by more than {}",
                bounds.rough
            );
            return found(what, bounds.rough_share);
        }
        Ok(())
    }

    /// The differences, white what is rough.
    pub(super) fn picture(&self) -> StoredObservation {
        let shade = |one: &f64| [(255.0 * (one / self.bounds.rough).min(1.0)) as u8; 3];
        StoredObservation::Color {
            width: self.width.max(1),
            rgb: self.each.iter().flat_map(shade).collect(),
        }
    }
}

/// Returns how far `found` is from `golden`.
pub(super) fn compare(
    golden: &StoredObservation,
    found: &StoredObservation,
) -> Result<Difference, String> {
    match (golden, found) {
        (StoredObservation::Color { width, rgb }, StoredObservation::Color { rgb: found, .. })
            if rgb.len() == found.len() =>
        {
            Ok(Difference {
                bounds: LOOKS,
                width: *width,
                each: flip(rgb, found, *width),
                inexcusable: 0,
            })
        }
        (StoredObservation::Ids { width, ids }, StoredObservation::Ids { ids: found, .. })
            if ids.len() == found.len() =>
        {
            let differ = |k: usize| f64::from(u8::from(ids[k] != found[k]));
            Ok(difference_beside_edges(
                *width,
                ids.len(),
                differ,
                |a, b| ids[a] != ids[b],
            ))
        }
        (
            StoredObservation::Steps { width, step, steps },
            StoredObservation::Steps { steps: found, .. },
        ) if steps.len() == found.len() => {
            let pixels = steps.len() / 3;
            let step_of = |pixel: usize| step[(pixel * step.len() / pixels).min(step.len() - 1)];
            let apart = |a: &[u16], b: &[u16]| {
                let each = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b));
                f64::from(each.max().unwrap_or(0))
            };
            let at = |pixel: usize| pixel * 3..pixel * 3 + 3;
            // Rounding alone may move a number to the next step.
            let differ =
                |k: usize| (apart(&steps[at(k)], &found[at(k)]) - 1.0).max(0.0) * step_of(k);
            // Steps of a hundredth of the range make an edge.
            let edge = |a: usize, b: usize| apart(&steps[at(a)], &steps[at(b)]) > 655.0;
            Ok(difference_beside_edges(*width, pixels, differ, edge))
        }
        (StoredObservation::List(rows), StoredObservation::List(found))
            if rows.len() == found.len() =>
        {
            // What is not a number differs from everything.
            let apart = |(a, b): (&f64, &f64)| {
                let part = (a - b).abs() / (1.0 + a.abs());
                if part.is_finite() { part } else { 1.0 }
            };
            let differ = |(row, found): (&Vec<f64>, &Vec<f64>)| {
                let whole = if row.len() == found.len() { 0.0 } else { 1.0 };
                row.iter().zip(found).map(apart).fold(whole, f64::max)
            };
            Ok(Difference {
                bounds: Bounds {
                    rough_share: 0.0,
                    ..EXACT
                },
                width: 1,
                each: rows.iter().zip(found).map(differ).collect(),
                inexcusable: 0,
            })
        }
        _ => Err("it has another size or kind than the golden one".to_owned()),
    }
}

/// Pixels that may differ beside edges alone. `differ`: by how much; `edge`: whether two pixels of the golden picture lie on
/// two sides of one.
fn difference_beside_edges(
    width: usize,
    pixels: usize,
    differ: impl Fn(usize) -> f64,
    edge: impl Fn(usize, usize) -> bool,
) -> Difference {
    let each: Vec<f64> = (0..pixels).map(differ).collect();
    let near = |k: usize| {
        let shifts = [1, width - 1, width, width + 1];
        let others = shifts
            .into_iter()
            .flat_map(move |shift| [k.checked_sub(shift), Some(k + shift)]);
        others
            .flatten()
            .filter(|other| *other < pixels)
            .any(|other| edge(k, other))
    };
    let rough = each
        .iter()
        .enumerate()
        .filter(|(_, one)| **one > EXACT.rough);
    Difference {
        bounds: EXACT,
        width,
        inexcusable: rough.filter(|(k, _)| !near(*k)).count(),
        each,
    }
}
