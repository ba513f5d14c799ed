//! Houses that come with the engine: each a [`HouseSpec`] of the generator with a fixed seed ([`spec`]).

mod specs;

#[cfg(test)]
mod tests;

use crate::generate::HouseSpec;
use dwell_scene::House;

/// The names that [`build`] knows, as in `builtin:NAME`.
pub fn names() -> &'static [&'static str] {
    &["apartment", "studio", "house", "office"]
}

/// The seed and the spec of a built-in house; `None` for names that do not exist.
pub fn spec(name: &str) -> Option<(u64, HouseSpec)> {
    let fixed = specs::FIXED.iter().find(|fixed| fixed.name == name)?;
    Some((fixed.seed, (fixed.spec)()))
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
    let fixed = specs::FIXED.iter().find(|fixed| fixed.name == name)?;
    fixed.build()
}
