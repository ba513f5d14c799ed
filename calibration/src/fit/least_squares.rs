//! Least squares over a few parameters, for any function that returns residuals.

use super::robust::HuberLoss;
use crate::error::CalibrationError;
use nalgebra::{DMatrix, DVector};

/// A parameter that is fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Variable {
    pub(crate) start: f64,
    pub(crate) low: f64,
    pub(crate) high: f64,
    /// Step of the finite differences: small, but large enough to be seen.
    pub(crate) step: f64,
}

const MOST_DAMPINGS: usize = 5;
/// Relative decrease of the loss at which the iteration ends.
const TOLERANCE: f64 = 1e-4;

/// The values that minimize the residuals, with Huber's loss for outliers: damped Gauss-Newton with forward
/// differences, `most` iterations. A parameter that nothing depends on stays where it starts.
pub(crate) fn least_squares(
    variables: &[Variable],
    most: usize,
    mut residuals: impl FnMut(&[f64]) -> Result<Vec<f64>, CalibrationError>,
) -> Result<Vec<f64>, CalibrationError> {
    let mut values: Vec<f64> = variables.iter().map(|v| v.start).collect();
    let mut now = residuals(&values)?;
    let mut damping = 1e-6;
    for _ in 0..most {
        let loss = HuberLoss::from_residuals(now.iter());
        let total = |all: &[f64]| all.iter().map(|r| loss.loss(*r)).sum::<f64>();
        let before = total(&now);
        let mut jacobian = DMatrix::zeros(now.len(), values.len());
        for (k, variable) in variables.iter().enumerate() {
            let mut there = values.clone();
            let inward = if there[k] + variable.step > variable.high {
                -1.0
            } else {
                1.0
            };
            there[k] += inward * variable.step;
            for (row, (a, b)) in residuals(&there)?.iter().zip(&now).enumerate() {
                jacobian[(row, k)] = inward * (a - b);
            }
        }
        let weights: Vec<f64> = now.iter().map(|r| loss.weight(*r)).collect();
        let mut weighted = jacobian.clone();
        for (mut row, weight) in weighted.row_iter_mut().zip(&weights) {
            row.scale_mut(*weight);
        }
        let normal = jacobian.transpose() * &weighted;
        let right = weighted.transpose() * DVector::from_column_slice(&now);
        let mut after = before;
        for _ in 0..MOST_DAMPINGS {
            let mut damped = normal.clone();
            for k in 0..values.len() {
                damped[(k, k)] = normal[(k, k)] * (1.0 + damping) + f64::MIN_POSITIVE.sqrt();
            }
            let Some(step) = damped.cholesky().map(|c| c.solve(&right)) else {
                damping = (damping * 30.0).max(1e-3);
                continue;
            };
            let trial: Vec<f64> = (0..values.len())
                .map(|k| {
                    let v = &variables[k];
                    (values[k] - step[k] * v.step).clamp(v.low, v.high)
                })
                .collect();
            let there = residuals(&trial)?;
            let lower = total(&there);
            if lower < before {
                (values, now, after) = (trial, there, lower);
                damping *= 0.1;
                break;
            }
            damping = (damping * 30.0).max(1e-3);
        }
        if before - after <= TOLERANCE * before {
            break;
        }
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An exponential decay with two gross outliers; a third parameter does nothing.
    #[test]
    fn a_curve_is_found_beside_outliers_and_idle_parameters() {
        let truth = |t: f64| 2.5 * (-0.7 * t).exp();
        let variable = |start, low, high| Variable {
            start,
            low,
            high,
            step: 1e-5,
        };
        let variables = [
            variable(1.0, 0.0, 10.0),
            variable(0.1, 0.0, 5.0),
            variable(0.3, 0.0, 1.0),
        ];
        let found = least_squares(&variables, 30, |x| {
            Ok((0..40)
                .map(|k| {
                    let t = 0.1 * f64::from(k);
                    let noise = 1e-3 * f64::from((k * 7) % 5 - 2);
                    let outlier = if k % 19 == 3 { 4.0 } else { 0.0 };
                    x[0] * (-x[1] * t).exp() - truth(t) - noise - outlier
                })
                .collect())
        })
        .unwrap();
        assert!((found[0] - 2.5).abs() < 2e-2, "{found:?}");
        assert!((found[1] - 0.7).abs() < 1e-2, "{found:?}");
        assert!((found[2] - 0.3).abs() < 1e-12);
    }
}
