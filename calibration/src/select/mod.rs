//! Selection: which cause the data ask for, and whether they name it.

mod agreement;
mod compare;
mod gain;
mod residual;
mod split;
mod verdict;

pub use agreement::Agreement;
pub use gain::HeldOutGain;
pub(crate) use gain::share_gained;
pub use residual::{ChannelResidual, UnexplainedResidual};

pub(crate) use compare::{Estimate, ScoredModel, estimates, sd_of};
pub(crate) use residual::by_channel;
pub(crate) use verdict::{Decision, Findings, SingleCause, explain};
