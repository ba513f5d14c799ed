//! What can be said, and whether it is true.
