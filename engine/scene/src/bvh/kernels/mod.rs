pub(super) mod nearest;
pub(super) mod packet;
pub(super) mod single;
pub(super) mod slab;
pub(super) mod triangle;
