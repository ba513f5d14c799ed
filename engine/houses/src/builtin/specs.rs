//! Built-in houses: a spec and a fixed seed each.

use crate::generate::{GeneratedRoomKind, HomeKind, HouseSpec, generate};
use dwell_scene::House;

/// A built-in house.
pub(super) struct BuiltinHouse {
    pub(super) name: &'static str,
    pub(super) seed: u64,
    pub(super) spec: fn() -> HouseSpec,
}

/// Built-in houses. Their seeds gave houses without omissions.
pub(super) const FIXED: &[BuiltinHouse] = &[
    BuiltinHouse {
        name: "apartment",
        seed: 884,
        spec: apartment,
    },
    BuiltinHouse {
        name: "studio",
        seed: 6,
        spec: || styled_spec(HomeKind::Studio, 1, "nordic"),
    },
    BuiltinHouse {
        name: "house",
        seed: 2,
        spec: || styled_spec(HomeKind::House, 2, "classic"),
    },
    BuiltinHouse {
        name: "office",
        seed: 2,
        spec: || styled_spec(HomeKind::Office, 1, "modern"),
    },
];

fn styled_spec(home: HomeKind, storeys: usize, style: &str) -> HouseSpec {
    HouseSpec {
        home: Some(home),
        storeys: Some(storeys),
        style: Some(style.to_owned()),
        ..HouseSpec::default()
    }
}

/// Six rooms with the hallway, and much in them: the house of examples, tests and the demo.
fn apartment() -> HouseSpec {
    HouseSpec {
        area_m2: Some(96.0),
        rooms: vec![
            GeneratedRoomKind::LivingRoom,
            GeneratedRoomKind::Kitchen,
            GeneratedRoomKind::Bathroom,
            GeneratedRoomKind::Bedroom,
            GeneratedRoomKind::ChildRoom,
        ],
        adjacency: vec![[GeneratedRoomKind::LivingRoom, GeneratedRoomKind::Kitchen]],
        furniture_density: 1.0,
        clutter: 1.0,
        ..styled_spec(HomeKind::Apartment, 1, "contemporary")
    }
}

impl BuiltinHouse {
    /// The house, under its own name; `None` when the generator no longer makes it, which tests would notice.
    pub(super) fn build(&self) -> Option<House> {
        let made = generate(self.seed, &(self.spec)()).and_then(|generated| {
            let mut data = generated.house.data().clone();
            self.name.clone_into(&mut data.name);
            data.source = format!("builtin:{} ({})", self.name, data.source);
            let at = crate::report::FileLocation::file(format!("builtin:{}", self.name));
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
