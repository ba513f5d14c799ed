//! Normal equations with each episode's own nuisances eliminated.

use nalgebra::{DMatrix, DVector};

/// One episode's share of the normal equations: blocks of `JᵀWJ` and `JᵀWr`, own nuisances first.
#[derive(Clone, Debug)]
pub(super) struct NormalBlock {
    own: DMatrix<f64>,
    mixed: DMatrix<f64>,
    global: DMatrix<f64>,
    own_slope: DVector<f64>,
    global_slope: DVector<f64>,
}

/// A step of all parameters.
pub(super) struct ParameterStep {
    pub(super) global: DVector<f64>,
    /// Shape (episode, nuisance).
    pub(super) own: Vec<DVector<f64>>,
    /// The fall of the loss that a linear model would have.
    pub(super) predicted: f64,
}

impl NormalBlock {
    /// From a weighted Jacobian (own columns first) and weighted residuals.
    pub(super) fn new(jacobian: &DMatrix<f64>, residual: &DVector<f64>, own: usize) -> Self {
        let (a, g) = (
            jacobian.columns(0, own),
            jacobian.columns(own, jacobian.ncols() - own),
        );
        Self {
            own: a.tr_mul(&a),
            mixed: a.tr_mul(&g),
            global: g.tr_mul(&g),
            own_slope: a.tr_mul(residual),
            global_slope: g.tr_mul(residual),
        }
    }
}

/// A symmetric system by Cholesky after scaling to a unit diagonal; columns without effect stay where they are.
fn solve(matrix: &DMatrix<f64>, right: &DMatrix<f64>) -> DMatrix<f64> {
    let size = matrix.nrows();
    let scale = DVector::from_fn(size, |k, _| {
        let d = matrix[(k, k)];
        if d > 0.0 { 1.0 / d.sqrt() } else { 0.0 }
    });
    let mut scaled = DMatrix::from_fn(size, size, |r, c| matrix[(r, c)] * scale[r] * scale[c]);
    for k in 0..size {
        // A floor under the smallest eigenvalue; it moves well determined parameters by a part in 10^10.
        scaled[(k, k)] = if scale[k] > 0.0 {
            scaled[(k, k)] + 1e-10
        } else {
            1.0
        };
    }
    let right = DMatrix::from_fn(size, right.ncols(), |r, c| right[(r, c)] * scale[r]);
    let solution = match scaled.clone().cholesky() {
        Some(factor) => factor.solve(&right),
        None => scaled
            .lu()
            .solve(&right)
            .unwrap_or_else(|| DMatrix::zeros(size, right.ncols())),
    };
    DMatrix::from_fn(size, right.ncols(), |r, c| solution[(r, c)] * scale[r])
}

/// The matrix of the shared parameters with the own nuisances eliminated (Schur's complement).
pub(super) fn schur_complement(blocks: &[NormalBlock]) -> DMatrix<f64> {
    let size = blocks.first().map_or(0, |block| block.global.nrows());
    let mut sum = DMatrix::zeros(size, size);
    for block in blocks {
        sum += &block.global;
        if !block.own.is_empty() {
            sum -= block.mixed.tr_mul(&solve(&block.own, &block.mixed));
        }
    }
    sum
}

/// The inverse of [`reduced`].
pub(super) fn inverse(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    if matrix.is_empty() {
        return matrix.clone();
    }
    solve(matrix, &DMatrix::identity(matrix.nrows(), matrix.nrows()))
}

/// The damped step.
///
/// # Source
/// D. W. Marquardt, J. SIAM 11, 431 (1963): the diagonal is multiplied by 1 + `damping`.
pub(super) fn step(blocks: &[NormalBlock], damping: f64) -> ParameterStep {
    let damp = |matrix: &DMatrix<f64>| {
        let mut matrix = matrix.clone();
        for k in 0..matrix.nrows() {
            matrix[(k, k)] *= 1.0 + damping;
        }
        matrix
    };
    let column =
        |vector: &DVector<f64>| DMatrix::from_column_slice(vector.len(), 1, vector.as_slice());
    let size = blocks.first().map_or(0, |block| block.global.nrows());
    let (mut matrix, mut right) = (DMatrix::zeros(size, size), DMatrix::zeros(size, 1));
    let mut damped = Vec::with_capacity(blocks.len());
    for block in blocks {
        let own = damp(&block.own);
        matrix += damp(&block.global);
        right += column(&block.global_slope);
        if !own.is_empty() && size > 0 {
            matrix -= block.mixed.tr_mul(&solve(&own, &block.mixed));
            right -= block.mixed.tr_mul(&solve(&own, &column(&block.own_slope)));
        }
        damped.push(own);
    }
    let global = if size > 0 {
        solve(&matrix, &right)
    } else {
        right
    };
    let own: Vec<DVector<f64>> = blocks
        .iter()
        .zip(&damped)
        .map(|(block, own)| {
            let mut rest = column(&block.own_slope);
            if size > 0 && !own.is_empty() {
                rest -= &block.mixed * &global;
            }
            if own.is_empty() {
                DVector::zeros(0)
            } else {
                solve(own, &rest).column(0).into_owned()
            }
        })
        .collect();
    let global = global.column(0).into_owned();
    let falls = blocks
        .iter()
        .zip(&own)
        .map(|(block, own)| block.global_slope.dot(&global) + block.own_slope.dot(own));
    ParameterStep {
        predicted: falls.sum(),
        global,
        own,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Eliminating the nuisances gives the solution of the whole system.
    #[test]
    fn elimination_equals_the_whole_system() {
        let value = |k: usize| ((k * 7919 + 13) % 101) as f64 / 50.0 - 1.0;
        let (episodes, data, own, global) = (3, 9, 2, 2);
        let mut whole = DMatrix::zeros(episodes * data, episodes * own + global);
        let mut right = DVector::zeros(episodes * data);
        let mut blocks = Vec::new();
        for e in 0..episodes {
            let jacobian = DMatrix::from_fn(data, own + global, |r, c| {
                value(e * 97 + r * 11 + c * 3 + r * c)
            });
            let residual = DVector::from_fn(data, |r, _| value(e * 31 + r * 5 + 1));
            for r in 0..data {
                right[e * data + r] = residual[r];
                for c in 0..own {
                    whole[(e * data + r, e * own + c)] = jacobian[(r, c)];
                }
                for c in 0..global {
                    whole[(e * data + r, episodes * own + c)] = jacobian[(r, own + c)];
                }
            }
            blocks.push(NormalBlock::new(&jacobian, &residual, own));
        }
        let exact =
            (whole.transpose() * &whole).try_inverse().unwrap() * (whole.transpose() * right);
        let found = step(&blocks, 0.0);
        for c in 0..global {
            assert!((found.global[c] - exact[episodes * own + c]).abs() < 1e-6);
        }
        for e in 0..episodes {
            for c in 0..own {
                assert!((found.own[e][c] - exact[e * own + c]).abs() < 1e-6);
            }
        }
        let covariance = (whole.transpose() * &whole).try_inverse().unwrap();
        let reduced = inverse(&schur_complement(&blocks));
        assert!(
            (reduced[(1, 1)] - covariance[(episodes * own + 1, episodes * own + 1)]).abs() < 1e-6
        );
    }
}
