//! Houses that are made at run time by parametric code: nothing is stored but code and small tables.
//!
//! - `apartment`: a home of six rooms, furnished by hand;
//! - `studio`, `house` (with stairs), `office`: houses of the generator, each a [`HouseSpec`] with a fixed seed ([`spec`]).

mod apartment;
mod specs;

#[cfg(test)]
mod tests;

use crate::generate::HouseSpec;
use dwell_scene::House;

/// The names that [`build`] knows, as in `builtin:NAME`.
pub fn names() -> &'static [&'static str] {
    &["apartment", "studio", "house", "office"]
}

/// The seed and the spec of a built-in house of the generator; `None` for `apartment`, which is furnished by hand, and for names
/// that do not exist.
pub fn spec(name: &str) -> Option<(u64, HouseSpec)> {
    let fixed = specs::FIXED.iter().find(|fixed| fixed.name == name)?;
    Some(fixed.spec())
}

/// Makes the built-in house `name`; `None` when there is none of that name.
///
/// # Determinism
/// The same bytes every time, for any number of threads.
///
/// ```
/// let house = dwell_houses::builtin::build("apartment").ok_or("no apartment")?;
/// assert!(house.rooms.len() >= 5 && house.objects.len() >= 60);
/// # Ok::<(), &str>(())
/// ```
pub fn build(name: &str) -> Option<House> {
    if let Some(fixed) = specs::FIXED.iter().find(|fixed| fixed.name == name) {
        return fixed.build();
    }
    let data = match name {
        "apartment" => apartment::build(),
        _ => return None,
    };
    match House::new(data) {
        Ok(house) => Some(house),
        Err(error) => {
            // The tests build every house, so that nobody should ever read this.
            tracing::error!(name, %error, "a built-in house contradicts itself");
            None
        }
    }
}
