//! Built-in houses of the generator: a spec and a fixed seed each.

use crate::generate::{HomeKind, HouseSpec, generate};
use dwell_scene::House;

/// A built-in house of the generator.
pub(super) struct Fixed {
    pub(super) name: &'static str,
    seed: u64,
    home: HomeKind,
    storeys: usize,
    style: &'static str,
}

/// Built-in houses of the generator. Their seeds gave houses of which nothing had to be given up.
pub(super) const FIXED: &[Fixed] = &[
    Fixed {
        name: "studio",
        seed: 6,
        home: HomeKind::Studio,
        storeys: 1,
        style: "nordic",
    },
    Fixed {
        name: "house",
        seed: 2,
        home: HomeKind::House,
        storeys: 2,
        style: "classic",
    },
    Fixed {
        name: "office",
        seed: 2,
        home: HomeKind::Office,
        storeys: 1,
        style: "modern",
    },
];

impl Fixed {
    /// The seed and the spec.
    pub(super) fn spec(&self) -> (u64, HouseSpec) {
        let spec = HouseSpec {
            home: Some(self.home),
            storeys: Some(self.storeys),
            style: Some(self.style.to_owned()),
            ..HouseSpec::default()
        };
        (self.seed, spec)
    }

    /// The house, under its own name; `None` when the generator no longer makes it, which tests would tell.
    pub(super) fn build(&self) -> Option<House> {
        let (seed, spec) = self.spec();
        let made = generate(seed, &spec).and_then(|generated| {
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
