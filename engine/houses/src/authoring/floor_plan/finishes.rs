//! Finishes of floors, walls and ceilings that a plan states.

use dwell_furniture::finishes::Finish;
use dwell_furniture::textures::Srgb;

use super::super::edit_errors::{find_substance, prefix_field};
use super::data::{RoomPlan, SurfaceFinish};
use crate::error::HousesError;
use crate::generate::room_finishes::{ABOVE_ALL_BANDS_M, RoomFinishes};

/// Substances with an image: its recipe and the edge of one repeat, m.
const IMAGES: [(&str, &str, f32); 21] = [
    ("parquet", "herringbone", 1.2),
    ("laminate", "planks", 1.2),
    ("wood", "planks", 1.2),
    ("oak", "planks", 1.2),
    ("pine", "planks", 1.2),
    ("wood_panelling", "planks", 1.2),
    ("ceramic_tile", "tile", 0.5),
    ("brick", "brick", 0.5),
    ("painted_brick", "brick", 0.5),
    ("carpet", "carpet", 0.6),
    ("thin_carpet", "carpet", 0.6),
    ("thick_carpet", "carpet", 0.6),
    ("plaster", "plaster", 0.8),
    ("painted_plaster", "plaster", 0.8),
    ("gypsum_board", "plaster", 0.8),
    ("marble", "marble", 1.0),
    ("stone", "speckle", 0.5),
    ("concrete", "speckle", 0.8),
    ("linoleum", "speckle", 0.5),
    ("cork", "speckle", 0.4),
    ("wallpaper", "stripes", 0.4),
];

/// A covering's finish.
pub(super) fn finish(covering: &SurfaceFinish) -> Result<Finish, HousesError> {
    let row = find_substance("substance", &covering.substance)?;
    let base = covering.srgb.unwrap_or(row.default_color);
    let shade = |share: f32| -> Srgb { base.map(|c| (f32::from(c) * share) as u8) };
    let name = row.name.as_str();
    let image = IMAGES.iter().find(|(substance, _, _)| *substance == name);
    let Some((_, recipe, tile_m)) = image else {
        return Ok(Finish::plain(name, name, base));
    };
    let colors = match *recipe {
        "plaster" => [base, [0; 3], [0; 3]],
        _ => [base, shade(0.82), shade(0.92)],
    };
    Ok(Finish::tiled(name, name, recipe, colors, *tile_m))
}

/// Returns a room's finishes with those that the plan states.
pub(super) fn with_plan_finishes(
    room: &RoomPlan,
    usual: RoomFinishes,
) -> Result<RoomFinishes, HousesError> {
    let RoomFinishes {
        mut floor,
        mut walls,
        mut ceiling,
    } = usual;
    if let Some(covering) = &room.floor {
        floor = finish(covering).map_err(prefix_field("floor"))?;
    }
    if let Some(covering) = &room.walls {
        walls = vec![(
            ABOVE_ALL_BANDS_M,
            finish(covering).map_err(prefix_field("walls"))?,
        )];
    }
    if let Some(covering) = &room.ceiling {
        ceiling = finish(covering).map_err(prefix_field("ceiling"))?;
    }
    Ok(RoomFinishes {
        floor,
        walls,
        ceiling,
    })
}
