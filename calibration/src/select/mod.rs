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
mod split;
mod verdict;

pub use agreement::SplitHalfAgreement;
pub use gain::HeldOutGain;
pub use learnable::LearnableRemainder;
pub use residual::{ChannelResidual, ResidualNoiseTest};

pub(crate) use compare::{Estimate, ScoredModel, estimates, sd_of};
pub(crate) use residual::by_channel;
pub(crate) use verdict::{Decision, Findings, SingleCause, find_causes};
