//! Finishes of floors, walls and ceilings.

use super::rooms::GeneratedRoomKind;
use crate::building::wall::FinishBands;
use dwell_furniture::finishes::Finish;
use dwell_furniture::style::Style;
use dwell_furniture::textures::Srgb;
use dwell_scene::random::{RandomKey, RandomStream};

/// Height of skirting boards, m.
const SKIRTING_M: f32 = 0.08;
/// Height above all bands: everything below the ceiling.
pub(crate) const ABOVE_ALL_BANDS_M: f32 = 10.0;

/// The finishes of a room.
#[derive(Clone, Debug)]
pub(crate) struct RoomFinishes {
    pub(crate) floor: Finish,
    pub(crate) walls: FinishBands,
    pub(crate) ceiling: Finish,
}

/// Paint on plaster.
fn paint(name: &'static str, srgb: Srgb) -> Finish {
    Finish::tiled(
        name,
        "painted_plaster",
        "plaster",
        [srgb, [0; 3], [0; 3]],
        0.8,
    )
}

/// Returns the finish of the insides of openings.
pub(crate) fn reveal_finish() -> Finish {
    paint("reveal_white", [240, 238, 232])
}

/// The finish of the outside of the building.
pub(crate) fn facade_finish(key: RandomKey) -> FinishBands {
    let mut draw = key.stream();
    let bricks = [
        [[168, 92, 66], [196, 188, 176], [120, 62, 48]],
        [[196, 170, 138], [206, 198, 184], [160, 132, 104]],
    ];
    let paints = [
        [236, 230, 216],
        [214, 206, 190],
        [226, 210, 172],
        [200, 208, 210],
    ];
    let finish = if draw.below(2) == 0 {
        let colors = bricks[draw.below(bricks.len())];
        Finish::tiled("facade_brick", "brick", "brick", colors, 0.5)
    } else {
        paint("facade_plaster", paints[draw.below(paints.len())])
    };
    vec![(ABOVE_ALL_BANDS_M, finish)]
}

fn tiles(name: &'static str, stream: &mut RandomStream) -> Finish {
    let colors = [
        [[172, 204, 206], [236, 238, 236], [148, 186, 192]],
        [[236, 236, 232], [206, 206, 202], [226, 226, 222]],
        [[200, 196, 186], [176, 172, 162], [188, 182, 172]],
        [[120, 126, 130], [168, 170, 170], [104, 110, 116]],
        [[186, 206, 178], [236, 238, 232], [166, 190, 160]],
    ];
    Finish::tiled(
        name,
        "ceramic_tile",
        "tile",
        colors[stream.below(colors.len())],
        0.5,
    )
}

fn carpet(style: &Style, stream: &mut RandomStream) -> Finish {
    // Of the style's colours, but muted: floors are large.
    let wool = style
        .random_terry(stream)
        .srgb
        .map(|c| (0.35 * f32::from(c) + 0.65 * 178.0) as u8);
    let dark = wool.map(|c| (f32::from(c) * 0.86) as u8);
    Finish::tiled("carpet", "carpet", "carpet", [wool, dark, [0; 3]], 0.6)
}

/// The finishes of a room, by its use.
pub(crate) fn room_finishes(
    kind: GeneratedRoomKind,
    style: &Style,
    key: RandomKey,
) -> RoomFinishes {
    use GeneratedRoomKind::{
        Balcony, Bathroom, Bedroom, BoilerRoom, ChildRoom, Gym, Kitchen, Lobby, Office, Storage,
        Terrace, Toilet,
    };
    let mut draw = key.stream();
    let tone = match kind {
        Bedroom | ChildRoom => 1 + draw.below(3),
        _ if draw.below(3) == 0 => 1 + draw.below(3),
        _ => 0,
    };
    let tone = paint("wall_paint", style.walls[tone]);
    let calm = paint("wall_paint", style.walls[0]);
    let floor = match kind {
        Bathroom | Toilet | Kitchen | BoilerRoom => tiles("floor_tiles", &mut draw),
        Storage => Finish::tiled(
            "linoleum",
            "linoleum",
            "speckle",
            [[168, 166, 158], [140, 138, 132], [188, 186, 180]],
            0.5,
        ),
        Office | Gym | Lobby => carpet(style, &mut draw),
        Bedroom | ChildRoom if draw.below(3) == 0 => carpet(style, &mut draw),
        Balcony | Terrace => Finish::tiled(
            "deck_boards",
            "wood",
            "planks",
            [[164, 132, 98], [120, 92, 66], [0; 3]],
            1.2,
        ),
        _ => style.floor.clone(),
    };
    let walls = match kind {
        Bathroom | Toilet | BoilerRoom => {
            let high = if kind == Bathroom { 2.0 } else { 1.3 };
            vec![
                (high, tiles("wall_tiles", &mut draw)),
                (ABOVE_ALL_BANDS_M, calm),
            ]
        }
        Kitchen if draw.below(2) == 0 => {
            let white = [[238, 238, 234], [206, 206, 200], [228, 228, 224]];
            let metro = Finish::tiled("metro_tiles", "ceramic_tile", "metro", white, 0.3);
            vec![
                (SKIRTING_M, skirting()),
                (1.5, metro),
                (ABOVE_ALL_BANDS_M, tone),
            ]
        }
        _ => vec![(SKIRTING_M, skirting()), (ABOVE_ALL_BANDS_M, tone)],
    };
    RoomFinishes {
        floor,
        walls,
        ceiling: paint("ceiling_white", [244, 243, 238]),
    }
}

const fn skirting() -> Finish {
    Finish::plain("skirting", "wood", [238, 236, 230])
}
