//! Built-in houses: a spec and a fixed seed each.

use crate::generate::{HomeKind, HouseSpec, RoomKind, generate};
use dwell_scene::House;

/// A built-in house.
pub(super) struct Fixed {
    pub(super) name: &'static str,
    pub(super) seed: u64,
    pub(super) spec: fn() -> HouseSpec,
}

/// Built-in houses. Their seeds gave houses of which nothing had to be given up.
pub(super) const FIXED: &[Fixed] = &[
    Fixed {
        name: "apartment",
        seed: 884,
        spec: apartment,
    },
    Fixed {
        name: "studio",
        seed: 6,
        spec: || of_style(HomeKind::Studio, 1, "nordic"),
    },
    Fixed {
        name: "house",
        seed: 2,
        spec: || of_style(HomeKind::House, 2, "classic"),
    },
    Fixed {
        name: "office",
        seed: 2,
        spec: || of_style(HomeKind::Office, 1, "modern"),
    },
];

fn of_style(home: HomeKind, storeys: usize, style: &str) -> HouseSpec {
    HouseSpec {
        home: Some(home),
        storeys: Some(storeys),
        style: Some(style.to_owned()),
        ..HouseSpec::default()
    }
}

/// Six rooms with the hallway, and much in them: what examples, tests and the demo walk through.
fn apartment() -> HouseSpec {
    HouseSpec {
        area_m2: Some(96.0),
        rooms: vec![
            RoomKind::LivingRoom,
            RoomKind::Kitchen,
            RoomKind::Bathroom,
            RoomKind::Bedroom,
            RoomKind::ChildRoom,
        ],
        adjacency: vec![[RoomKind::LivingRoom, RoomKind::Kitchen]],
        furniture_density: 1.0,
        clutter: 1.0,
        ..of_style(HomeKind::Apartment, 1, "contemporary")
    }
}

impl Fixed {
    /// The house, under its own name; `None` when the generator no longer makes it, which tests would tell.
    pub(super) fn build(&self) -> Option<House> {
        let made = generate(self.seed, &(self.spec)()).and_then(|generated| {
            let mut data = generated.house.data().clone();
            self.name.clone_into(&mut data.name);
            data.source = format!("builtin:{} ({})", self.name, data.source);
            let at = crate::report::At::file(format!("builtin:{}", self.name));
            House::new(data).map_err(crate::HousesError::scene(&at))
        });
        match made {
            Ok(house) => Some(house),
            Err(error) => {
                tracing::error!(name = self.name, %error, "a built-in house cannot be made");
                None
            }
        }
    }
}
