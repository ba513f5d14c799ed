//! Specs that are wrong say so; those that are right are kept.

use crate::error::HousesError;
use crate::generate::{DoorStates, GeneratedRoomKind, HomeKind, HouseSpec, generate};

fn refused(spec: &HouseSpec, wanted: &str) -> String {
    match generate(1, spec) {
        Err(HousesError::Spec {
            field,
            found,
            possible,
        }) => {
            assert_eq!(field, wanted);
            assert!(!found.is_empty() && !possible.is_empty());
            possible
        }
        other => panic!("{other:?} instead of a refused {wanted}"),
    }
}

#[test]
fn impossible_specs_name_the_field_and_what_is_possible() {
    let base = HouseSpec::default;
    for area in [0.0, -3.0, f32::NAN, f32::INFINITY, 11.0, 1e9] {
        refused(
            &HouseSpec {
                area_m2: Some(area),
                ..base()
            },
            "area_m2",
        );
    }
    for time_of_day in [-0.1, 24.5, f32::NAN] {
        let spec = HouseSpec {
            time_of_day,
            ..base()
        };
        assert!(refused(&spec, "time_of_day").contains("0 to 24"));
    }
    let crowded = HouseSpec {
        rooms: vec![GeneratedRoomKind::Bedroom; 40],
        area_m2: Some(20.0),
        ..base()
    };
    assert!(refused(&crowded, "rooms").contains("12"));
    let tight = HouseSpec {
        rooms: vec![GeneratedRoomKind::Bedroom; 10],
        area_m2: Some(20.0),
        ..base()
    };
    assert!(refused(&tight, "area_m2").contains("to"));
    refused(
        &HouseSpec {
            storeys: Some(0),
            ..base()
        },
        "storeys",
    );
    refused(
        &HouseSpec {
            storeys: Some(2),
            home: Some(HomeKind::Studio),
            ..base()
        },
        "storeys",
    );
    refused(
        &HouseSpec {
            rooms: vec![GeneratedRoomKind::Hallway],
            ..base()
        },
        "rooms",
    );
    refused(
        &HouseSpec {
            rooms: vec![GeneratedRoomKind::Balcony],
            ..base()
        },
        "rooms",
    );
    refused(
        &HouseSpec {
            clutter: 1.5,
            ..base()
        },
        "clutter",
    );
    refused(
        &HouseSpec {
            furniture_density: f32::NAN,
            ..base()
        },
        "furniture_density",
    );
    let baroque = HouseSpec {
        style: Some("baroque".to_owned()),
        ..base()
    };
    assert!(refused(&baroque, "style").contains("nordic"));
    // A look for tests is none for training.
    refused(
        &HouseSpec {
            style: Some("industrial".to_owned()),
            ..base()
        },
        "style",
    );
    refused(
        &HouseSpec {
            rooms: vec![GeneratedRoomKind::Kitchen],
            adjacency: vec![[GeneratedRoomKind::Kitchen, GeneratedRoomKind::Gym]],
            ..base()
        },
        "adjacency",
    );
    assert!(serde_json::from_str::<HouseSpec>(r#"{"roms": []}"#).is_err());
    assert!(serde_json::from_str::<HouseSpec>(r#"{"rooms": ["throne_room"]}"#).is_err());
}

#[test]
fn a_spec_is_kept() {
    for seed in 0..12 {
        let spec = HouseSpec {
            rooms: vec![
                GeneratedRoomKind::LivingRoom,
                GeneratedRoomKind::Kitchen,
                GeneratedRoomKind::Bedroom,
                GeneratedRoomKind::Bathroom,
                GeneratedRoomKind::Toilet,
            ],
            area_m2: Some(75.0),
            adjacency: vec![[GeneratedRoomKind::Kitchen, GeneratedRoomKind::LivingRoom]],
            doors: DoorStates::Closed,
            ..HouseSpec::default()
        };
        let generated = generate(seed, &spec).unwrap();
        let house = &generated.house;
        for kind in &spec.rooms {
            let word = kind.requirements().everyday_names[0];
            let count = house.rooms.iter().filter(|r| r.kinds[0] == word).count();
            assert_eq!(count, 1, "seed {seed}: {word}");
        }
        let area: f32 = house.rooms.iter().map(dwell_scene::Room::area_m2).sum();
        assert!((60.0..90.0).contains(&area), "seed {seed}: {area} m2");
        assert!(house.joints.iter().all(|joint| joint.initial == 0.0));
    }
    let studio = HouseSpec {
        rooms: vec![GeneratedRoomKind::Studio],
        ..HouseSpec::default()
    };
    assert_eq!(generate(3, &studio).unwrap().house.rooms.len(), 1);
}

#[test]
fn the_hour_moves_the_sun_and_nothing_else() {
    let at = |time_of_day| {
        let spec = HouseSpec {
            time_of_day,
            ..HouseSpec::default()
        };
        generate(5, &spec).unwrap().house
    };
    let (noon, night) = (at(12.0), at(23.0));
    assert!(noon.sky.unwrap().to_sun.y > 0.5 && night.sky.unwrap().to_sun.y < 0.0);
    let mut data = night.data().clone();
    data.sky = noon.sky;
    assert_eq!(&data, noon.data());
}
