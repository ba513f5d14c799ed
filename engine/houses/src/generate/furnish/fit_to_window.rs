//! Furniture that is made to measure for a window.

use crate::generate::openings::WallHole;
use dwell_furniture::finishes::Finish;
use dwell_furniture::model::Model;
use dwell_furniture::model_cache::{CachedModel, cached_custom_model};
use dwell_furniture::models::curtains_and_blinds::Curtains;
use dwell_furniture::models::heating_and_cooling::radiator;
use dwell_furniture::style::Style;
use dwell_scene::random::RandomKey;
use std::sync::Arc;

/// Kinds of furniture that are made to measure.
#[cfg(test)]
pub(crate) const WINDOW_SIZED_KINDS: [&str; 2] = ["curtains", "radiator"];

/// A thing for a window, and the height of its origin; `None` when it is none of these or has no place there.
pub(crate) fn window_sized_model(
    kind: &str,
    hole: &WallHole,
    style: &Style,
    key: RandomKey,
) -> Option<(Arc<CachedModel>, f32)> {
    let mut draw = key.stream();
    let width_m = hole.to_m - hole.from_m;
    match kind {
        "curtains" if width_m > 0.8 => {
            // Down to below the sill.
            let rod_m = hole.high_m + 0.1;
            let cloth = Finish {
                substance: "light_curtain",
                ..style.random_cloth(&mut draw).clone()
            };
            let plain = Finish::plain("curtain_cloth", "light_curtain", [240; 3]);
            let curtains = Curtains {
                width_m: width_m + 0.5,
                height_m: rod_m - hole.low_m + 0.14,
                drawn: [0.14, 0.17, 0.2][draw.below(3)],
                cloth: Finish {
                    tile_m: cloth.tile_m,
                    ..plain
                },
            };
            // One cut for all cloths.
            let cut = cached_custom_model(format!("{curtains:?}"), || curtains.build());
            let sewn = Model::clone(&cut).with_finish_replaced("curtain_cloth", &cloth);
            Some((Arc::new(CachedModel::new("curtains", sewn)), rod_m))
        }
        "radiator" if hole.low_m > 0.45 && width_m > 0.5 => {
            let height_m = (hole.low_m - 0.3).min(0.5);
            let width_m = (0.8 * width_m).clamp(0.5, 1.4);
            let model = cached_custom_model(format!("radiator {width_m} {height_m}"), || {
                radiator(width_m, height_m)
            });
            Some((Arc::new(CachedModel::new("radiator", model)), 0.12))
        }
        _ => None,
    }
}
