//! What a camera sees: the `cpu` back end.
