//! The border to Python: conversions only.
