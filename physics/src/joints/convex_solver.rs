//! Solver for the efforts of all joints of a tree in one step, together.
//!
//! Every effort here falls with the velocity at the end of the step, so velocities minimize a convex function: the kinetic
//! energy of the difference from free motion, plus each effort's integral. Newton's method with a line search finds them; a
//! few iterations suffice, whatever the gains.
//!
//! With the inertia H, the velocity v at the end of a step of length h, the velocity `v_free` that it would have without efforts, and
//! efforts tau(J v) along the rows J, that is `1/2 (v - v_free)^T H (v - v_free) - h sum of the integrals of tau`. Its minimum is
//! where the step's momentum is in balance: `H (v - v_free) = h J^T tau(J v)`.
//!
//! # Source
//! The formulation is that of J. J. Moreau's time stepping, by velocities and impulses as D. E. Stewart, J. C. Trinkle, "An
//! implicit time-stepping scheme for rigid body dynamics with inelastic collisions and Coulomb friction" (Int. J. Numer. Methods
//! Eng. 39, 1996), have it; E. Todorov, "Convex and analytically-invertible dynamics with
//! contacts and constraints" (ICRA 2014), for writing all efforts as one convex problem.

/// Most iterations; five are usual.
const MOST_ITERATIONS: usize = 60;
/// Halvings of the line search.
const HALVINGS: usize = 40;

/// An effort `offset - slope * velocity` within bounds.
#[derive(Clone, Copy, Debug)]
pub(super) struct EffortTerm {
    /// The degree of freedom it acts along.
    pub(super) index: usize,
    /// Another one that it acts against: the velocity is then that of `index` less the second number times the other's.
    pub(super) opposing: Option<(usize, f64)>,
    pub(super) offset: f64,
    /// At least 0.
    pub(super) slope: f64,
    pub(super) bounds: [f64; 2],
    /// A speed beyond which it does not drive, and the slope there.
    pub(super) speed_limit: Option<(f64, f64)>,
}

impl EffortTerm {
    fn velocity(&self, all: &[f64]) -> f64 {
        let other = self.opposing.map_or(0.0, |(k, share)| share * all[k]);
        all[self.index] - other
    }

    /// Returns the effort at a velocity, and its slope there.
    pub(super) fn effort_and_slope(&self, velocity: f64) -> (f64, f64) {
        let [low, high] = self.bounds;
        let linear = self.offset - self.slope * velocity;
        let (mut effort, mut fall) = if linear > high {
            (high, 0.0)
        } else if linear < low {
            (low, 0.0)
        } else {
            (linear, self.slope)
        };
        if let Some((most, slope)) = self.speed_limit {
            for side in [1.0, -1.0] {
                let left = slope * (most - side * velocity);
                if side * effort > left.max(0.0) {
                    (effort, fall) = (side * left.max(0.0), if left > 0.0 { slope } else { 0.0 });
                }
            }
        }
        (effort, fall)
    }

    /// Adds a value along the term's degrees of freedom.
    fn add(&self, value: f64, to: &mut [f64]) {
        to[self.index] += value;
        if let Some((k, share)) = self.opposing {
            to[k] -= share * value;
        }
    }
}

/// A symmetric matrix of inertias. Shape (freedom, freedom).
#[derive(Clone, Debug)]
pub(super) struct SymmetricMatrix {
    size: usize,
    values: Vec<f64>,
}

impl SymmetricMatrix {
    pub(super) fn zero(size: usize) -> Self {
        Self {
            size,
            values: vec![0.0; size * size],
        }
    }

    pub(super) fn get(&self, i: usize, j: usize) -> f64 {
        self.values[i * self.size + j]
    }

    /// Sets an entry and its mirror image.
    pub(super) fn set(&mut self, i: usize, j: usize, value: f64) {
        self.values[i * self.size + j] = value;
        self.values[j * self.size + i] = value;
    }

    pub(super) fn add(&mut self, i: usize, j: usize, value: f64) {
        self.set(i, j, self.get(i, j) + value);
    }

    pub(super) fn multiply(&self, vector: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; self.size];
        self.multiply_into(vector, &mut product);
        product
    }

    fn multiply_into(&self, vector: &[f64], product: &mut [f64]) {
        for (i, entry) in product.iter_mut().enumerate() {
            let row = &self.values[i * self.size..(i + 1) * self.size];
            *entry = row.iter().zip(vector).map(|(a, b)| a * b).sum();
        }
    }

    /// Returns the Cholesky factor; a diagonal entry lost to rounding becomes tiny instead of negative.
    pub(super) fn cholesky(&self) -> CholeskyFactor {
        let mut factor = CholeskyFactor::of_size(self.size);
        self.cholesky_into(&mut factor);
        factor
    }

    fn cholesky_into(&self, factor: &mut CholeskyFactor) {
        let (n, l) = (self.size, &mut factor.l);
        for j in 0..n {
            let mut pivot = self.get(j, j);
            for k in 0..j {
                pivot -= l[j * n + k] * l[j * n + k];
            }
            let root = pivot.max(1e-12 * self.get(j, j).max(1e-12)).sqrt();
            l[j * n + j] = root;
            for i in j + 1..n {
                let mut value = self.get(i, j);
                for k in 0..j {
                    value -= l[i * n + k] * l[j * n + k];
                }
                l[i * n + j] = value / root;
            }
        }
    }
}

/// A Cholesky factor.
pub(super) struct CholeskyFactor {
    size: usize,
    l: Vec<f64>,
}

impl CholeskyFactor {
    fn of_size(size: usize) -> Self {
        let l = vec![0.0; size * size];
        Self { size, l }
    }

    pub(super) fn solve(&self, right: &[f64]) -> Vec<f64> {
        let mut x = right.to_vec();
        self.solve_in_place(&mut x);
        x
    }

    fn solve_in_place(&self, x: &mut [f64]) {
        let n = self.size;
        for i in 0..n {
            for k in 0..i {
                x[i] -= self.l[i * n + k] * x[k];
            }
            x[i] /= self.l[i * n + i];
        }
        for i in (0..n).rev() {
            for k in i + 1..n {
                x[i] -= self.l[k * n + i] * x[k];
            }
            x[i] /= self.l[i * n + i];
        }
    }
}

/// Memory for gradients, which one solution wants by the hundred. Each has shape (freedom,).
struct GradientBuffers {
    velocity: Vec<f64>,
    off: Vec<f64>,
    efforts: Vec<f64>,
    gradient: Vec<f64>,
}

impl GradientBuffers {
    fn of_size(size: usize) -> Self {
        let zeros = || vec![0.0; size];
        Self {
            velocity: zeros(),
            off: zeros(),
            efforts: zeros(),
            gradient: zeros(),
        }
    }
}

/// The effort problem of a tree in one step.
pub(super) struct EffortProblem {
    pub(super) inertia: SymmetricMatrix,
    /// The velocities at the end of the step without efforts. Shape (freedom,).
    pub(super) free_velocities: Vec<f64>,
    pub(super) terms: Vec<EffortTerm>,
    pub(super) dt_s: f64,
}

impl EffortProblem {
    /// Returns the velocities at the end of the step. Shape (freedom,).
    pub(super) fn solve(&self) -> Vec<f64> {
        let mut velocity = self.free_velocities.clone();
        let mut buffers = GradientBuffers::of_size(velocity.len());
        let (mut way, mut curvature) = (velocity.clone(), self.inertia.clone());
        let mut factor = CholeskyFactor::of_size(curvature.size);
        let (mut falls, mut before) = (Vec::with_capacity(self.terms.len()), Vec::new());
        let mut was_whole = false;
        for _ in 0..MOST_ITERATIONS {
            curvature.values.clone_from(&self.inertia.values);
            falls.clear();
            for element in &self.terms {
                // The Hessian: H + h J^T diag(-d tau / d v) J.
                let (_, fall) = element.effort_and_slope(element.velocity(&velocity));
                let slope = self.dt_s * fall;
                curvature.add(element.index, element.index, slope);
                if let Some((k, share)) = element.opposing {
                    curvature.add(element.index, k, -share * slope);
                    curvature.add(k, k, share * share * slope);
                }
                falls.push(fall);
            }
            // A whole step along unchanged slopes is exact.
            if was_whole && before == falls {
                break;
            }
            buffers.velocity.clone_from(&velocity);
            self.gradient(&mut buffers);
            for (d, g) in way.iter_mut().zip(&buffers.gradient) {
                *d = -g;
            }
            // Newton's step: Hessian * way = -gradient.
            curvature.cholesky_into(&mut factor);
            factor.solve_in_place(&mut way);
            let stride = self.line_search_step(&velocity, &way, &mut buffers);
            for (v, d) in velocity.iter_mut().zip(&way) {
                *v += stride * d;
            }
            was_whole = stride == 1.0;
            std::mem::swap(&mut before, &mut falls);
        }
        velocity
    }

    /// Writes the efforts that lead to these velocities. Shape (freedom,).
    fn efforts_into(&self, velocity: &[f64], efforts: &mut [f64]) {
        efforts.fill(0.0);
        for element in &self.terms {
            let (effort, _) = element.effort_and_slope(element.velocity(velocity));
            element.add(effort, efforts);
        }
    }

    /// Computes the gradient at the buffers' velocity.
    fn gradient(&self, buffers: &mut GradientBuffers) {
        let GradientBuffers {
            velocity,
            off,
            efforts,
            gradient,
        } = buffers;
        for ((off, v), f) in off.iter_mut().zip(&*velocity).zip(&self.free_velocities) {
            *off = v - f;
        }
        // H (v - v_free) - h J^T tau(J v).
        self.inertia.multiply_into(off, gradient);
        self.efforts_into(velocity, efforts);
        for (g, effort) in gradient.iter_mut().zip(&*efforts) {
            *g -= self.dt_s * effort;
        }
    }

    /// Returns the step length along `way`: to the minimum, at most 1.
    fn line_search_step(&self, from: &[f64], way: &[f64], buffers: &mut GradientBuffers) -> f64 {
        // The derivative along the way.
        let mut rise = |stride: f64| -> f64 {
            for ((there, v), d) in buffers.velocity.iter_mut().zip(from).zip(way) {
                *there = v + stride * d;
            }
            self.gradient(buffers);
            let along = buffers.gradient.iter().zip(way);
            along.map(|(g, d)| g * d).sum()
        };
        // Relative to the slope at the start, the rest at the end is rounding.
        if rise(1.0) <= 1e-9 * rise(0.0).abs() {
            return 1.0;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if rise(middle) > 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        low
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_factor_solves_its_matrix() {
        let mut a = SymmetricMatrix::zero(3);
        for (i, j, value) in [
            (0, 0, 4.0),
            (1, 1, 3.0),
            (2, 2, 2.0),
            (0, 1, 1.0),
            (1, 2, -0.5),
        ] {
            a.set(i, j, value);
        }
        let x = a.cholesky().solve(&[1.0, -2.0, 3.0]);
        for (found, expected) in a.multiply(&x).iter().zip([1.0, -2.0, 3.0]) {
            assert!((found - expected).abs() < 1e-12);
        }
    }

    /// Brute force: the velocities satisfy M (v - free) = dt * efforts(v), for stiff, bounded and sliding elements at once.
    #[test]
    fn the_solution_balances_every_effort() {
        let unbounded = [f64::NEG_INFINITY, f64::INFINITY];
        let element = |index, offset, slope, bounds| EffortTerm {
            index,
            opposing: None,
            offset,
            slope,
            bounds,
            speed_limit: None,
        };
        let mut inertia = SymmetricMatrix::zero(3);
        for (i, j, value) in [
            (0, 0, 2.0),
            (1, 1, 0.9),
            (2, 2, 0.02),
            (0, 1, 0.8),
            (0, 2, 0.05),
            (1, 2, 0.04),
        ] {
            inertia.set(i, j, value);
        }
        for seed in 0..200 {
            let x = |k: u32| f64::from((seed * 7 + k * 13) % 29) / 14.0 - 1.0;
            let problem = EffortProblem {
                inertia: inertia.clone(),
                free_velocities: vec![x(1), 4.0 * x(2), 9.0 * x(3)],
                terms: vec![
                    element(0, 500.0 * x(4), 1e5, [-40.0, 40.0]),
                    element(1, 20.0 * x(5), 3.0, unbounded),
                    element(1, 0.0, 1e8, [-30.0, 30.0]),
                    element(2, 0.0, 1e6, [-0.1, 0.1]),
                    EffortTerm {
                        opposing: Some((1, 0.5)),
                        ..element(2, x(6), 1e4, unbounded)
                    },
                ],
                dt_s: 0.01,
            };
            let mut buffers = GradientBuffers::of_size(3);
            buffers.velocity = problem.solve();
            problem.gradient(&mut buffers);
            let left = buffers.gradient;
            assert!(left.iter().all(|g| g.abs() < 1e-9), "{seed}: {left:?}");
        }
    }
}
