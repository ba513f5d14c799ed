//! Robust losses: samples far from the rest count less.

use crate::median::median;

/// Number of robust standard deviations from which on a residual counts less.
const TURN: f64 = 3.0;

/// Huber's loss, scaled so that it equals the square inside.
///
/// # Source
/// P. J. Huber, Ann. Math. Stat. 35, 73 (1964).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HuberLoss {
    /// The residual at which the square turns into a line; infinite: never.
    turn: f64,
}

impl HuberLoss {
    /// Plain least squares.
    pub(crate) const QUADRATIC: Self = Self {
        turn: f64::INFINITY,
    };

    /// Huber's loss for residuals of this size.
    pub(crate) fn from_residuals<'a>(residuals: impl Iterator<Item = &'a f64>) -> Self {
        let mut sizes: Vec<f64> = residuals.map(|r| r.abs()).collect();
        let scale = 1.4826 * median(&mut sizes);
        if scale > 0.0 && scale.is_finite() {
            Self { turn: TURN * scale }
        } else {
            Self::QUADRATIC
        }
    }

    /// The loss of a residual.
    pub(crate) fn loss(self, residual: f64) -> f64 {
        let size = residual.abs();
        if size <= self.turn {
            size * size
        } else {
            self.turn * (2.0 * size - self.turn)
        }
    }

    /// The weight of a residual in the normal equations.
    pub(crate) fn weight(self, residual: f64) -> f64 {
        let size = residual.abs();
        if size <= self.turn {
            1.0
        } else {
            self.turn / size
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_loss_is_the_square_inside_and_a_line_outside() {
        let loss = HuberLoss { turn: 2.0 };
        assert!((loss.loss(-1.5) - 2.25).abs() < 1e-12);
        assert!((loss.loss(5.0) - loss.loss(4.0) - 4.0).abs() < 1e-12);
        // The weight is half the loss's slope over the residual.
        let slope = (loss.loss(5.0 + 1e-6) - loss.loss(5.0 - 1e-6)) / 2e-6;
        assert!((loss.weight(5.0) - slope / 10.0).abs() < 1e-6);
    }

    #[test]
    fn the_scale_does_not_see_outliers() {
        let mut residuals: Vec<f64> = (0..100).map(|k| f64::from(k) / 50.0 - 1.0).collect();
        residuals[3] = 1e9;
        let loss = HuberLoss::from_residuals(residuals.iter());
        assert!(loss.turn < 3.0, "{loss:?}");
    }
}
