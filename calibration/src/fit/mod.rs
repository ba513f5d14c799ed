//! Fitting: damped Gauss-Newton over shared parameters and each episode's own nuisances; evolution where there are no
//! derivatives.

mod cma_es;
mod gauss_newton;
mod normal;
mod robust;

pub(crate) use cma_es::CmaEs;
pub(crate) use gauss_newton::{CauseSet, FitResult, FitTask};
pub(crate) use robust::HuberLoss;
