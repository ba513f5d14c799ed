//! Selection: the cause that the data support, and whether they identify it.

mod agreement;
mod compare;
mod gain;
mod learnable;
mod plausibility;
mod quantum;
mod reasons;
mod residual;
mod screen;
mod spectrum;
mod split;
mod verdict;

pub use agreement::RegimeAgreement;
pub use gain::HeldOutGain;
pub use learnable::LearnableResidual;
pub use residual::{ChannelResidual, ResidualNoiseTest};
pub use spectrum::SlowResidual;

pub(crate) use compare::{Estimate, ScoredModel, estimates, parameter_sd};
pub(crate) use residual::channel_residuals;
pub(crate) use verdict::{Decision, Findings, SingleCause, find_causes};
