//! Floors above each other, and stairs between them.

use crate::support::{grid_of, two_storeys};
use dwell_scene::LevelId;
use dwell_scene::navigation::NavConfig;
use glam::Vec3;

const LOW: Vec3 = Vec3::new(3.0, 0.0, 1.0);
const HIGH: Vec3 = Vec3::new(3.0, 2.88, 1.0);

#[test]
fn stairs_join_two_floors_in_one_column() {
    let grid = grid_of(&two_storeys(true), &NavConfig::default());
    let (low, high) = (
        grid.nearest(LOW, 0.1).expect("the lower floor"),
        grid.nearest(HIGH, 0.1).expect("the upper floor"),
    );
    assert_ne!(low, high);
    assert_eq!(
        (grid.island(low), grid.island(high)),
        (Some(0), Some(0)),
        "the stairs lead up"
    );
    assert_eq!(
        (grid.level(low), grid.level(high)),
        (Some(LevelId(0)), Some(LevelId(1)))
    );
    let free = |level| {
        grid.occupancy(level)
            .map(|map| map.free.iter().map(|x| u32::from(*x)).sum())
    };
    let [lower, upper]: [u32; 2] = [LevelId(0), LevelId(1)].map(|level| free(level).unwrap());
    // 50 by 80 cells each, and one more all around, as walls are missing; less the hole of 12 by 45 above, and what is too
    // near to the wall of 45 cells.
    assert!((3600..=52 * 82).contains(&lower), "{lower}");
    assert!((3600 - 540..=52 * 82).contains(&upper), "{upper}");
}

/// From below the hole's edge over the stairs to above: to their foot, up their slope, and back above.
#[test]
fn a_way_over_stairs_is_as_long_as_floor_and_slope() {
    let grid = grid_of(&two_storeys(true), &NavConfig::default());
    let way = grid.route(LOW, HIGH).expect("a way up");
    // Around the ends of the wall beside the stairs in the distance of the radius.
    let corners = [
        LOW,
        Vec3::new(1.2, 0.0, 1.8),
        Vec3::new(0.95, 0.0, 2.0),
        Vec3::new(0.95, 2.88, 6.48),
        Vec3::new(1.2, 2.88, 6.68),
        HIGH,
    ];
    let pieces = corners
        .windows(2)
        .map(|ends| f64::from(ends[0].distance(ends[1])));
    let (found, expected) = (way.length_m, pieces.sum::<f64>());
    println!("{found:.2} m, by hand {expected:.2} m");
    // Cells of 0.1 m keep up to 0.2 m more off the four corners.
    assert!(
        found > expected && found < expected + 0.8,
        "{found} {expected}"
    );
    let heights: Vec<f32> = way.points.iter().map(|p| p.y).collect();
    assert!(
        heights.windows(2).all(|pair| pair[1] >= pair[0] - 1e-3),
        "{heights:?}"
    );
}

/// Straight up: the floor, the slope of 2.88 m over 4.48 m, the floor.
#[test]
fn stairs_are_as_long_as_their_slope() {
    let grid = grid_of(&two_storeys(true), &NavConfig::default());
    let [foot, head] = [Vec3::new(0.65, 0.0, 1.55), Vec3::new(0.65, 2.88, 6.95)];
    let [start, goal] = [foot, head].map(|point| grid.nearest(point, 0.1).unwrap());
    let expected = 0.45 + 2.88_f64.hypot(4.48) + 0.47;
    let route = grid.route(foot, head).unwrap().length_m;
    let rough = grid.distance_field(&[goal]).at(start).unwrap();
    println!("route {route:.3} m, field {rough:.3} m, by hand {expected:.3} m");
    assert!(
        (route - expected).abs() < 0.03 * expected,
        "{route} {expected}"
    );
    assert!(
        (rough - expected).abs() < 0.03 * expected,
        "{rough} {expected}"
    );
}

#[test]
fn floors_without_stairs_are_islands() {
    let grid = grid_of(&two_storeys(false), &NavConfig::default());
    let (low, high) = (
        grid.nearest(LOW, 0.1).unwrap(),
        grid.nearest(HIGH, 0.1).unwrap(),
    );
    assert_ne!(grid.island(low), grid.island(high));
    assert_eq!(grid.geodesic_m(LOW, HIGH), None);
}

#[test]
fn who_climbs_no_step_stays_below() {
    let config = NavConfig {
        step_m: 0.15,
        ..NavConfig::default()
    };
    let grid = grid_of(&two_storeys(true), &config);
    assert_eq!(grid.geodesic_m(LOW, HIGH), None);
}
