//! What crosses engines.
