//! Nouns of things whose size tells people another word than their category.

use crate::category::SemanticCategory;
use glam::Vec3;

/// Height below which what files call a wardrobe is a cabinet, m: nothing hangs in it.
const LEAST_WARDROBE_M: f32 = 1.3;
/// Height from which shelves are a piece of furniture rather than a board, m.
const LEAST_SHELVING_M: f32 = 0.6;
/// Width from which two people sit on an ottoman, m: they call it a bench.
const LEAST_BENCH_M: f32 = 0.9;
/// Width below which what files call an armchair is a chair with arms, m: the lounge chairs of J. Panero and M. Zelnik, *Human Dimension
/// and Interior Space*, 1979, are 0.71 m wide and more.
const LEAST_ARMCHAIR_M: f32 = 0.66;

/// Returns the noun that the size of a thing gives it, for one; `None` where its category's fits. `extents_m`: the edges of its box, Y up.
pub(crate) fn noun_by_size(category: &SemanticCategory, extents_m: Vec3) -> Option<&'static str> {
    let wide_m = extents_m.x.max(extents_m.z);
    match category.name {
        "wardrobe_cabinet" if extents_m.y < LEAST_WARDROBE_M => Some("cabinet"),
        "shelving" if extents_m.y >= LEAST_SHELVING_M => Some("shelving unit"),
        "ottoman" if wide_m >= LEAST_BENCH_M => Some("bench"),
        "armchair" if wide_m < LEAST_ARMCHAIR_M => Some("chair"),
        _ => None,
    }
}
