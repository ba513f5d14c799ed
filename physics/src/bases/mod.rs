//! Wheeled bases: motion of a body over a floor from its wheels, in closed form.
//!
//! Poses and twists are planar, in the frame of robotics: X forward, Y to the left, headings positive to the left. A
//! world's agent at yaw 0 faces -Z, so that X is -Z and Y is -X there.
//!
//! A base does not exceed its limits: wheels that push against a wall keep turning and slip on the floor, so that their
//! odometry counts a distance that was not travelled, as a real robot's does. A body that leaves the floor keeps its
//! velocity and its heading until it lands. It slides along a wall that it meets at an angle, as a walking agent does.

mod base_law;
mod differential;
mod holonomic;
mod planar;

pub(crate) use base_law::BaseLaw;
pub use differential::WheelGeometry;
pub(crate) use differential::{WheelCommand, WheelMotion, ramp};
pub(crate) use holonomic::accelerate_towards as follow_twist;
pub use planar::{PlanarPose, PlanarTwist};
