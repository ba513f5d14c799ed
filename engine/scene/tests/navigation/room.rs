//! Walkable surfaces in one room.

use crate::support::{ROOM, add_mesh, clearance, furnished, grid_of, house, room, scattered};
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::navigation::{NavCell, NavConfig};
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{House, LevelId, Mesh, StructureKind};
use glam::{Vec2, Vec3};
use proptest::prelude::*;
use std::collections::BTreeMap;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn walkable_cells_have_room_and_roomy_cells_are_walkable(seed in any::<u64>()) {
        let boxes = scattered(RandomKey::root(seed));
        let house = furnished(&boxes);
        let config = NavConfig::default();
        let grid = grid_of(&house, &config);
        let rays = RayScene::new(house.clone());
        for cell in grid.walkable() {
            let p = grid.position(cell);
            prop_assert!(p.y.abs() < 1e-4, "{p} is not on the floor");
            // Feelers all around, from just above a step to the top of the head.
            for k in 0..16 {
                let angle = k as f32 * std::f32::consts::TAU / 16.0;
                let ahead = Vec3::new(dwell_scene::math::cos(angle), 0.0, dwell_scene::math::sin(angle));
                for height in [0.21, 0.5, 0.9, 1.3, 1.49] {
                    let feeler = Ray::new(p + Vec3::Y * height, ahead).with_range(0.0, config.radius_m - 1e-3);
                    prop_assert!(!rays.occluded(&feeler, RayMask::ALL), "{p} at {height} m towards {ahead}");
                }
            }
            let up = Ray::new(p + Vec3::Y * 0.01, Vec3::Y).with_range(0.0, config.height_m - 0.02);
            prop_assert!(!rays.occluded(&up, RayMask::ALL));
        }
        let reach = config.radius_m + 1.5 * config.cell_m;
        for x in 0..50 {
            for z in 0..40 {
                let p = Vec2::new(0.1 * x as f32 + 0.05, 0.1 * z as f32 + 0.05);
                if clearance(p, &boxes) > reach {
                    let cell = grid.nearest(Vec3::new(p.x, 0.0, p.y), 0.08);
                    prop_assert!(cell.is_some(), "nobody stands at {p}");
                }
            }
        }
    }
}

#[test]
fn an_empty_room_is_walkable_up_to_the_radius_from_its_walls() {
    let grid = grid_of(&furnished(&[]), &NavConfig::default());
    for cell in grid.walkable() {
        let p = grid.position(cell);
        assert!(clearance(Vec2::new(p.x, p.z), &[]) > 0.2, "{p}");
    }
    // 46 by 36 middles lie further than the radius from the walls; a wall on a cell's border may count to either side.
    let cells = grid.walkable().count();
    assert!((44 * 34..=46 * 36).contains(&cells), "{cells} cells");
}

#[test]
fn the_picture_from_above_shows_the_walkable_cells() {
    let grid = grid_of(&furnished(&[]), &NavConfig::default());
    let map = grid.occupancy(LevelId(0)).expect("one storey");
    let mut expected = vec![0; map.width * map.depth];
    for cell in grid.walkable() {
        let p = grid.position(cell);
        let x = ((p.x - map.corner[0]) / map.cell_m) as usize;
        let z = ((p.z - map.corner[1]) / map.cell_m) as usize;
        expected[z * map.width + x] = 1;
        assert_eq!(grid.level(cell), Some(LevelId(0)));
    }
    assert_eq!(map.free, expected);
    assert_eq!(grid.occupancy(LevelId(7)), None);
}

#[test]
fn beds_and_tops_of_walls_are_not_walkable_but_stairs_are() {
    let bed = [Vec3::new(0.5, 0.0, 0.5), Vec3::new(2.0, 0.45, 2.5)];
    let wall = [Vec3::new(0.0, 0.0, 2.9), Vec3::new(2.5, 0.9, 3.1)];
    let on = |house: &House, low: f32, high: f32| {
        let grid = grid_of(house, &NavConfig::default());
        let heights = grid.walkable().map(|cell| grid.position(cell).y);
        heights.filter(|y| (low..=high).contains(y)).count()
    };
    let without = furnished(&[bed, wall]);
    assert!(on(&without, -0.01, 0.01) > 300);
    assert_eq!(on(&without, 0.1, 3.0), 0);
    let step = |k: usize| {
        let x = 2.0 + 0.4 * (1 - k) as f32;
        [
            Vec3::new(x, 0.0, 0.5),
            Vec3::new(x + 0.4, 0.15 * (k + 1) as f32, 2.5),
        ]
    };
    let with = furnished(&[bed, wall, step(0), step(1)]);
    let grid = grid_of(&with, &NavConfig::default());
    let bed_top = grid
        .nearest(Vec3::new(1.2, 0.45, 1.5), 0.1)
        .expect("reached over two steps");
    let floor = grid.nearest(Vec3::new(4.0, 0.0, 1.5), 0.1).unwrap();
    assert_eq!(grid.island(bed_top), grid.island(floor));
    assert!(
        grid.geodesic_m(grid.position(floor), grid.position(bed_top))
            .is_some()
    );
}

/// A ramp up to a platform of 0.8 m, too high for a step: walked up where it is flat enough.
#[test]
fn ramps_are_walkable_up_to_the_steepest_slope() {
    let climbs = |angle_deg: f32, max_slope_deg: f32| {
        let mut data = room();
        let run = 0.8 / dwell_scene::math::tan(angle_deg.to_radians());
        let (foot, top) = (4.0, 4.0 - run);
        let corner = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
        add_mesh(
            &mut data,
            StructureKind::Other,
            Mesh::rectangle([
                corner(foot, 0.0, 1.0),
                corner(foot, 0.0, 3.0),
                corner(top, 0.8, 3.0),
                corner(top, 0.8, 1.0),
            ]),
        );
        let platform = Mesh::cuboid(corner(0.5, 0.0, 1.0), corner(top, 0.8, 3.0));
        add_mesh(&mut data, StructureKind::Other, platform);
        let config = NavConfig {
            cell_m: 0.05,
            max_slope_rad: max_slope_deg.to_radians(),
            ..NavConfig::default()
        };
        let grid = grid_of(&house(data), &config);
        let way = grid.route(corner(4.5, 0.0, 2.0), corner(1.5, 0.8, 2.0));
        way.map(|way| way.length_m)
    };
    for angle in [10.0, 25.0, 40.0] {
        let length = climbs(angle, 45.0).unwrap_or_else(|| panic!("{angle} degrees"));
        let slope = 0.8 / f64::from(angle.to_radians()).sin();
        let level = 3.0 - 0.8 / f64::from(angle.to_radians()).tan();
        let expected = slope + level;
        // A cell's edge at either end of the slope.
        assert!((length - expected).abs() < 0.1, "{length} {expected}");
        assert_eq!(climbs(angle, angle - 5.0), None, "{angle} degrees");
    }
    assert_eq!(climbs(60.0, 45.0), None);
    assert!(climbs(60.0, 65.0).is_some());
}

#[test]
fn samples_repeat_and_reach_all_cells() {
    let config = NavConfig {
        cell_m: 0.4,
        ..NavConfig::default()
    };
    let grid = grid_of(&furnished(&[]), &config);
    let cells: Vec<NavCell> = grid.walkable().collect();
    let mut seen = BTreeMap::new();
    for k in 0..4000_u64 {
        let cell = grid.sample(RandomKey::root(k), |_| true).unwrap();
        assert_eq!(grid.sample(RandomKey::root(k), |_| true), Some(cell));
        *seen.entry(cell).or_insert(0_u32) += 1;
    }
    assert_eq!(seen.len(), cells.len());
    // Uniform: chi-square within 5 standard deviations of its mean.
    let expected = 4000.0 / cells.len() as f64;
    let chi: f64 = seen
        .values()
        .map(|n| (f64::from(*n) - expected).powi(2) / expected)
        .sum();
    let freedom = cells.len() as f64 - 1.0;
    assert!(
        (chi - freedom).abs() < 5.0 * (2.0 * freedom).sqrt(),
        "{chi} for {freedom}"
    );
    assert_eq!(grid.sample(RandomKey::root(1), |_| false), None);
}

#[test]
fn a_wall_parts_the_room_into_islands_with_their_own_reachable_points() {
    let wall = [Vec3::new(2.4, 0.0, 0.0), Vec3::new(2.5, 2.0, 4.0)];
    let grid = grid_of(&furnished(&[wall]), &NavConfig::default());
    let west = grid.nearest(Vec3::new(1.0, 0.0, 2.0), 0.1).unwrap();
    let reachable: Vec<NavCell> = grid.reachable(west).collect();
    assert!(reachable.contains(&west));
    assert!(reachable.iter().all(|cell| grid.position(*cell).x < 2.2));
    let field = grid.distance_field(&[west]);
    for cell in grid.walkable() {
        assert_eq!(field.at(cell).is_some(), reachable.contains(&cell));
    }
    for k in 0..50_u64 {
        let cell = grid.sample_reachable(RandomKey::root(k), west).unwrap();
        assert!(reachable.contains(&cell));
    }
    assert_eq!(grid.reachable(NavCell(0)).count(), 0);
    assert_eq!(
        grid.sample_reachable(RandomKey::root(0), NavCell(u32::MAX)),
        None
    );
}

#[test]
fn settings_out_of_range_are_refused_by_name() {
    let house = furnished(&[]);
    let state = dwell_scene::State::new(&house);
    let build = |config: NavConfig| {
        dwell_scene::navigation::NavGrid::build(&house, &state, &config)
            .map(|_| ())
            .map_err(|error| error.to_string())
    };
    let ok = NavConfig::default();
    let refused = [
        (
            "cell_m",
            NavConfig {
                cell_m: f32::NAN,
                ..ok
            },
        ),
        (
            "radius_m",
            NavConfig {
                radius_m: -1.0,
                ..ok
            },
        ),
        (
            "height_m",
            NavConfig {
                height_m: 9.0,
                ..ok
            },
        ),
        (
            "max_slope_rad",
            NavConfig {
                max_slope_rad: 2.0,
                ..ok
            },
        ),
        (
            "door_price_m",
            NavConfig {
                door_price_m: -0.1,
                ..ok
            },
        ),
    ];
    for (field, config) in refused {
        let error = build(config).unwrap_err();
        assert!(
            error.contains(field) && error.contains("navigation"),
            "{error}"
        );
    }
    assert!(ROOM[0] > 0.0 && build(ok).is_ok());
}

#[test]
fn a_house_in_centimetres_is_refused_with_that_as_a_reason() {
    let mut data = furnished(&[]).data().clone();
    for mesh in data.meshes.as_mut_slice() {
        let mut large = Mesh::clone(mesh);
        large.positions.iter_mut().for_each(|p| *p *= 200.0);
        *mesh = std::sync::Arc::new(large);
    }
    for level in &mut data.levels {
        level.bounds.max *= 200.0;
    }
    let house = House::new(data).unwrap();
    let state = dwell_scene::State::new(&house);
    let config = NavConfig::default();
    let error = dwell_scene::navigation::NavGrid::build(&house, &state, &config).unwrap_err();
    assert!(error.to_string().contains("in centimetres"), "{error}");
}
