//! What moves and touches; rapier stays behind this wall.
