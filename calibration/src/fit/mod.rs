//! Fitting: damped Gauss-Newton over shared parameters and each episode's own nuisances; evolution where there are no
//! derivatives.

mod cma_es;
mod gauss_newton;
mod least_squares;
mod normal;
mod robust;

pub(crate) use cma_es::CmaEs;
pub(crate) use gauss_newton::{CauseSet, FitResult, FitTask};
pub(crate) use least_squares::{Variable, least_squares};
pub(crate) use robust::{HuberLoss, median};
