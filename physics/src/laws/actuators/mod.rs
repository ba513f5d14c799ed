//! Laws of servos and joints.

pub(super) mod backlash;
