//! Helpers of the tests.

use dwell_scene::House;
use std::sync::OnceLock;

/// The apartment, built once for all tests.
pub(crate) fn apartment() -> &'static House {
    static HOUSE: OnceLock<House> = OnceLock::new();
    HOUSE
        .get_or_init(|| crate::builtin::build("apartment").expect("the apartment is a valid house"))
}
