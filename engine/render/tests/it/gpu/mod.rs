//! The two back ends against each other, on whatever adapter there is; without one the tests say so and pass.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "tests may stop at the first surprise; a skip is printed"
)]

mod agreement;
mod batches;
mod cameras;
mod compare;
mod faults;
mod houses;
mod limits;
mod optics;
