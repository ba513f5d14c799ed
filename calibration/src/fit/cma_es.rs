//! Minimization without derivatives: evolution of a normal distribution whose covariance adapts.
//!
//! # Source
//! N. Hansen, "The CMA Evolution Strategy: A Tutorial", arXiv 1604.00772 (2016): weights and constants of its table 1,
//! updates of its equations (38) to (49), without negative weights.

use dwell_scene::random::{RandomKey, RandomStream};
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// A search in the unit cube. It proposes points, and takes their losses from the caller.
pub(crate) struct CmaEs {
    mean: DVector<f64>,
    sigma: f64,
    covariance: DMatrix<f64>,
    path_sigma: DVector<f64>,
    path_c: DVector<f64>,
    generation: u32,
    stream: RandomStream,
    constants: Constants,
}

struct Constants {
    lambda: usize,
    weights: Vec<f64>,
    mu_eff: f64,
    c_sigma: f64,
    d_sigma: f64,
    c_c: f64,
    c_1: f64,
    c_mu: f64,
    /// Expected length of a standard normal vector.
    chi: f64,
}

impl Constants {
    fn new(dimension: usize, lambda: usize) -> Self {
        let n = dimension as f64;
        let mu = lambda / 2;
        let raw: Vec<f64> = (1..=mu)
            .map(|i| libm::log(f64::midpoint(lambda as f64, 1.0)) - libm::log(i as f64))
            .collect();
        let sum: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|w| w / sum).collect();
        let mu_eff = 1.0 / weights.iter().map(|w| w * w).sum::<f64>();
        let c_sigma = (mu_eff + 2.0) / (n + mu_eff + 5.0);
        let c_1 = 2.0 / ((n + 1.3).powi(2) + mu_eff);
        let c_mu = 2.0 * (mu_eff - 2.0 + 1.0 / mu_eff) / ((n + 2.0).powi(2) + mu_eff);
        Self {
            lambda,
            weights,
            mu_eff,
            c_sigma,
            d_sigma: 1.0 + 2.0 * (((mu_eff - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + c_sigma,
            c_c: (4.0 + mu_eff / n) / (n + 4.0 + 2.0 * mu_eff / n),
            c_1,
            c_mu: c_mu.min(1.0 - c_1),
            chi: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
        }
    }
}

impl CmaEs {
    /// A search around `mean` (each in 0..1) with the standard deviation `sigma` and `lambda` points a generation (at
    /// least 4).
    pub(crate) fn new(mean: &[f64], sigma: f64, lambda: usize, key: RandomKey) -> Self {
        let n = mean.len();
        Self {
            mean: DVector::from_column_slice(mean),
            sigma,
            covariance: DMatrix::identity(n, n),
            path_sigma: DVector::zeros(n),
            path_c: DVector::zeros(n),
            generation: 0,
            stream: key.stream(),
            constants: Constants::new(n, lambda.max(4)),
        }
    }

    /// The points of the next generation, in the unit cube. Shape (lambda, parameter).
    pub(crate) fn sample_population(&mut self) -> Vec<Vec<f64>> {
        let (root, _) = self.covariance_square_roots();
        let n = self.mean.len();
        (0..self.constants.lambda)
            .map(|_| {
                let z = DVector::from_fn(n, |_, _| self.stream.normal());
                let x = &self.mean + self.sigma * (&root * z);
                x.iter()
                    .map(|value| fold_into_unit_interval(*value))
                    .collect()
            })
            .collect()
    }

    /// Takes the points with their costs; a cost that is no number is the worst.
    pub(crate) fn update(&mut self, points: &[Vec<f64>], costs: &[f64]) {
        let mut order: Vec<usize> = (0..points.len().min(costs.len())).collect();
        let cost = |k: usize| {
            if costs[k].is_nan() {
                f64::INFINITY
            } else {
                costs[k]
            }
        };
        order.sort_by(|a, b| cost(*a).total_cmp(&cost(*b)).then(a.cmp(b)));
        let (_, inverse_root) = self.covariance_square_roots();
        let c = &self.constants;
        let n = self.mean.len() as f64;
        let steps: Vec<DVector<f64>> = order
            .iter()
            .take(c.weights.len())
            .map(|k| (DVector::from_column_slice(&points[*k]) - &self.mean) / self.sigma)
            .collect();
        let mut shift = DVector::zeros(self.mean.len());
        for (weight, step) in c.weights.iter().zip(&steps) {
            shift += *weight * step;
        }
        self.mean += self.sigma * &shift;
        let gain = (c.c_sigma * (2.0 - c.c_sigma) * c.mu_eff).sqrt();
        self.path_sigma = (1.0 - c.c_sigma) * &self.path_sigma + gain * (&inverse_root * &shift);
        self.generation += 1;
        let age = 1.0 - (1.0 - c.c_sigma).powi(2 * self.generation as i32);
        let length = self.path_sigma.norm();
        // Stalls the other path while the step size still grows fast.
        let steady = length / age.sqrt() < (1.4 + 2.0 / (n + 1.0)) * c.chi;
        let steady = f64::from(u8::from(steady));
        let gain = (c.c_c * (2.0 - c.c_c) * c.mu_eff).sqrt();
        self.path_c = (1.0 - c.c_c) * &self.path_c + steady * gain * &shift;
        let lost = (1.0 - steady) * c.c_1 * c.c_c * (2.0 - c.c_c);
        let mut covariance = (1.0 + lost - c.c_1 - c.c_mu) * &self.covariance
            + c.c_1 * (&self.path_c * self.path_c.transpose());
        for (weight, step) in c.weights.iter().zip(&steps) {
            covariance += c.c_mu * *weight * (step * step.transpose());
        }
        self.covariance = 0.5 * (&covariance + covariance.transpose());
        let grown = (c.c_sigma / c.d_sigma) * (length / c.chi - 1.0);
        self.sigma = (self.sigma * libm::exp(grown)).clamp(1e-6, 0.5);
    }

    /// The mean of the distribution, in the unit cube.
    pub(crate) fn mean(&self) -> Vec<f64> {
        self.mean
            .iter()
            .map(|value| fold_into_unit_interval(*value))
            .collect()
    }

    /// The symmetric square root of the covariance, and its inverse.
    fn covariance_square_roots(&self) -> (DMatrix<f64>, DMatrix<f64>) {
        let eigen = SymmetricEigen::new(self.covariance.clone());
        let scaled = |f: &dyn Fn(f64) -> f64| {
            let values = eigen.eigenvalues.map(|value| f(value.max(1e-20).sqrt()));
            &eigen.eigenvectors * DMatrix::from_diagonal(&values) * eigen.eigenvectors.transpose()
        };
        (scaled(&|root| root), scaled(&|root| 1.0 / root))
    }
}

/// A number folded back into 0..1 at both ends.
fn fold_into_unit_interval(value: f64) -> f64 {
    let folded = value.rem_euclid(2.0);
    if folded > 1.0 { 2.0 - folded } else { folded }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn minimum(f: &dyn Fn(&[f64]) -> f64, dimension: usize, seed: u64) -> Vec<f64> {
        let mut search = CmaEs::new(&vec![0.5; dimension], 0.3, 10, RandomKey::root(seed));
        for _ in 0..150 {
            let points = search.sample_population();
            let costs: Vec<f64> = points.iter().map(|x| f(x)).collect();
            search.update(&points, &costs);
        }
        search.mean()
    }

    /// A bent valley with its floor at (0.7, 0.49), and a bowl of very unequal axes: found from five seeds each.
    #[test]
    fn valleys_and_unequal_bowls_are_searched_to_their_floor() {
        let valley = |x: &[f64]| 100.0 * (x[1] - x[0] * x[0]).powi(2) + (0.7 - x[0]).powi(2);
        let bowl = |x: &[f64]| {
            let target = [0.2, 0.9, 0.5, 0.31];
            let terms = x.iter().zip(target).enumerate();
            terms
                .map(|(k, (x, t))| 10.0_f64.powi(k as i32) * (x - t).powi(2))
                .sum()
        };
        for seed in 0..5 {
            let found = minimum(&valley, 2, seed);
            assert!(
                (found[0] - 0.7).abs() < 1e-3 && (found[1] - 0.49).abs() < 1e-3,
                "{found:?}"
            );
            let found = minimum(&bowl, 4, seed);
            for (x, t) in found.iter().zip([0.2, 0.9, 0.5, 0.31]) {
                assert!((x - t).abs() < 1e-3, "{found:?}");
            }
        }
    }

    /// A floor at the very edge of the cube, costs that are no numbers, and the same search twice.
    #[test]
    fn edges_faults_and_repetition_do_no_harm() {
        let edge = |x: &[f64]| {
            if x[1] > 0.9 {
                f64::NAN
            } else {
                x[0] + (x[1] - 0.4).powi(2)
            }
        };
        let found = minimum(&edge, 2, 3);
        assert!(
            found[0] < 0.02 && (found[1] - 0.4).abs() < 0.05,
            "{found:?}"
        );
        assert_eq!(found, minimum(&edge, 2, 3));
    }
}
