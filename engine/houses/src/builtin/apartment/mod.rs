//! `builtin:apartment`: a home of six rooms on one storey, 11 m by 9 m inside.
//!
//! ```text
//!   x 0        4.1     6.45          11      z 0 is north
//!     +---------+-------+------------+
//!     | bedroom | bath  | kitchen    |
//!     |         |       |            |   3.7
//!     +------D--+----D--+---D--------+
//!     D hallway         D            |   5.2
//!     +-D-------+-------+   dining   |
//!     | child   | living room        |
//!     |         |                    |
//!     +---------+--------------------+   9.0
//! ```

mod bathroom;
mod bedroom;
mod child_room;
mod hallway;
mod kitchen;
mod living_room;
mod openings;
mod rooms;
mod style;
mod walls;

use crate::building::assembly::Assembly;
use crate::building::site::Site;
use dwell_scene::{Daytime, HouseData, Sky};

/// The furnished apartment.
pub(super) fn build() -> HouseData {
    let mut assembly = Assembly::new("apartment", "builtin@1");
    assembly.storey();
    rooms::build(&mut assembly);
    for wall in walls::walls() {
        wall.build(&mut assembly);
    }
    openings::build(&mut assembly);
    let furnish: [(fn(&mut Site<'_>), _); 6] = [
        (living_room::furnish, rooms::LIVING),
        (kitchen::furnish, rooms::KITCHEN),
        (bedroom::furnish, rooms::BEDROOM),
        (child_room::furnish, rooms::CHILD),
        (bathroom::furnish, rooms::BATH),
        (hallway::furnish, rooms::HALL),
    ];
    for (furnish, room) in furnish {
        furnish(&mut Site {
            assembly: &mut assembly,
            room,
        });
    }
    let sky = Sky::at(&Daytime::default()).expect("the default moment is within its ranges");
    assembly.data.sky = Some(sky);
    assembly.finish()
}

#[cfg(test)]
pub(crate) use walls::walls;
