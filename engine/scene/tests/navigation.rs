//! The walkable grid against rays, distances and a plain search that share no code with it.

use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::navigation::{Cell, NavConfig, NavGrid};
use dwell_scene::random::Key;
use dwell_scene::rays::RayScene;
use dwell_scene::{
    House, LevelId, MaterialId, Mesh, ShoeboxMaterials, State, Structure, StructureKind,
};
use glam::{Vec2, Vec3};
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;

const ROOM: [f32; 3] = [5.0, 2.6, 4.0];

/// A room with boxes from one corner to the other.
fn furnished(boxes: &[[Vec3; 2]]) -> Arc<House> {
    let room = House::shoebox(ROOM, &ShoeboxMaterials::default()).expect("a valid room");
    let mut data = room.data().clone();
    for (k, [min, max]) in boxes.iter().enumerate() {
        let mesh = data.meshes.push(Arc::new(Mesh::cuboid(*min, *max)));
        data.structure.push(Structure {
            name: format!("box {k}"),
            kind: StructureKind::Other,
            room: None,
            level: LevelId(0),
            mesh,
            materials: vec![MaterialId(0)],
        });
    }
    Arc::new(House::new(data).expect("a valid house"))
}

fn grid_of(house: &House, config: &NavConfig) -> NavGrid {
    NavGrid::build(house, &State::new(house), config).expect("valid settings")
}

/// Up to seven boxes on the floor, some of them in the way, some low, some hanging.
fn scattered(key: Key) -> Vec<[Vec3; 2]> {
    let mut stream = key.stream();
    let count = stream.below(8);
    let one = |_| {
        let corner = Vec3::new(stream.range(0.2, 4.2), 0.0, stream.range(0.2, 3.2));
        let size = Vec3::new(
            stream.range(0.05, 1.5),
            stream.range(0.3, 2.0),
            stream.range(0.05, 1.5),
        );
        let base = if stream.below(4) == 0 {
            stream.range(0.3, 1.2)
        } else {
            0.0
        };
        let min = corner + Vec3::Y * base;
        let max = (min + size).min(Vec3::new(4.99, 2.59, 3.99));
        [min, max]
    };
    (0..count).map(one).collect()
}

/// Distance from a point on the floor plan to the nearest wall or box.
fn clearance(p: Vec2, boxes: &[[Vec3; 2]]) -> f32 {
    let walls = p.x.min(ROOM[0] - p.x).min(p.y).min(ROOM[2] - p.y);
    let to_box = |[min, max]: &[Vec3; 2]| {
        let nearest = p.clamp(Vec2::new(min.x, min.z), Vec2::new(max.x, max.z));
        nearest.distance(p)
    };
    boxes.iter().map(to_box).fold(walls, f32::min)
}

/// Shortest ways on an occupancy picture by relaxing every step until nothing changes.
fn plain_distances(width: usize, free: &[u8], start: usize, edge: f64) -> BTreeMap<usize, f64> {
    let depth = free.len() / width;
    let is_free = |x: isize, z: isize| {
        let inside = x >= 0 && z >= 0 && (x as usize) < width && (z as usize) < depth;
        inside && free[z as usize * width + x as usize] == 1
    };
    let mut distances = BTreeMap::from([(start, 0.0)]);
    loop {
        let mut next = distances.clone();
        for (&cell, &here) in &distances {
            let (x, z) = ((cell % width) as isize, (cell / width) as isize);
            for dz in -1..=1 {
                for dx in -1..=1 {
                    let corners = is_free(x + dx, z) && is_free(x, z + dz);
                    if !is_free(x + dx, z + dz) || !corners {
                        continue;
                    }
                    let there = here + edge * f64::from((dx * dx + dz * dz) as i32).sqrt();
                    let to = (z + dz) as usize * width + (x + dx) as usize;
                    let known = next.entry(to).or_insert(f64::INFINITY);
                    *known = known.min(there);
                }
            }
        }
        if next == distances {
            return distances;
        }
        distances = next;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn walkable_cells_have_room_and_roomy_cells_are_walkable(seed in any::<u64>()) {
        let boxes = scattered(Key::root(seed));
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
                    let feeler = Ray::new(p + Vec3::Y * height, ahead).between(0.0, config.radius_m - 1e-3);
                    prop_assert!(!rays.occluded(&feeler, RayMask::ALL), "{p} at {height} m towards {ahead}");
                }
            }
            let up = Ray::new(p + Vec3::Y * 0.01, Vec3::Y).between(0.0, config.height_m - 0.02);
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

    #[test]
    fn distances_equal_those_of_a_plain_search(seed in any::<u64>()) {
        let key = Key::root(seed);
        let grid = grid_of(&furnished(&scattered(key)), &NavConfig::default());
        let Some(start) = grid.sample(key.child("start"), |_| true) else { return Ok(()) };
        let (width, _, _, free) = grid.occupancy(LevelId(0)).unwrap();
        let expected = plain_distances(width, &free, start.0 as usize, f64::from(0.1_f32));
        let field = grid.distance_field(&[start]);
        for cell in grid.walkable() {
            let found = field.at(cell);
            prop_assert_eq!(found.is_some(), expected.contains_key(&(cell.0 as usize)));
            prop_assert_eq!(found.is_some(), grid.island(cell) == grid.island(start));
            if let Some(found) = found {
                prop_assert!((found - expected[&(cell.0 as usize)]).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn paths_are_as_long_as_promised_and_tight_ones_no_longer(seed in any::<u64>()) {
        let key = Key::root(seed);
        let grid = grid_of(&furnished(&scattered(key)), &NavConfig::default());
        let ends = [0_u64, 1].map(|k| grid.sample(key.child(k), |cell| grid.island(cell) == Some(0)));
        let [Some(from), Some(to)] = ends else { return Ok(()) };
        let path = grid.path(from, to).unwrap();
        let length = |cells: &[Cell]| -> f64 {
            cells.windows(2).map(|w| f64::from(grid.position(w[0]).distance(grid.position(w[1])))).sum()
        };
        let geodesic = grid.geodesic_m(grid.position(from), grid.position(to)).unwrap();
        prop_assert!((length(&path) - geodesic).abs() < 1e-3);
        let corners = grid.corners(&path);
        prop_assert_eq!((corners.first(), corners.last()), (Some(&from), Some(&to)));
        prop_assert!(length(&corners) <= geodesic + 1e-3);
        // A straight way, or one step of the grid itself.
        let free = |w: &[Cell]| {
            let apart = grid.position(w[0]).distance(grid.position(w[1]));
            apart < 0.15 || grid.is_straight_free(w[0], w[1])
        };
        prop_assert!(corners.windows(2).all(free));
    }
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

#[test]
fn a_wall_across_the_room_leaves_no_way() {
    let wall = |end: f32| [Vec3::new(2.4, 0.0, 0.0), Vec3::new(2.5, 2.0, end)];
    let (west, east) = (Vec3::new(1.0, 0.0, 2.0), Vec3::new(4.0, 0.0, 2.0));
    let cut = grid_of(&furnished(&[wall(4.0)]), &NavConfig::default());
    assert_eq!(cut.geodesic_m(west, east), None);
    let (a, b) = (
        cut.nearest(west, 0.1).unwrap(),
        cut.nearest(east, 0.1).unwrap(),
    );
    assert_eq!(
        (cut.path(a, b), cut.island(a) == cut.island(b)),
        (None, false)
    );
    let gap = grid_of(&furnished(&[wall(3.2)]), &NavConfig::default());
    let around = gap.geodesic_m(west, east).unwrap();
    // Around the end of the wall: at least as long as at the walker's radius, at most as long as steps in eight directions
    // (8.24 % longer) make it one and a half cells further off.
    let straight = |z: f32| {
        let corner = Vec3::new(2.45, 0.0, z);
        f64::from(west.distance(corner) + corner.distance(east))
    };
    assert!(around > straight(3.4) - 0.15, "{around}");
    assert!(around < straight(3.55) * 1.0824 + 0.15, "{around}");
}

#[test]
fn samples_repeat_and_reach_all_cells() {
    let grid = grid_of(
        &furnished(&[]),
        &NavConfig {
            cell_m: 0.4,
            ..NavConfig::default()
        },
    );
    let cells: Vec<Cell> = grid.walkable().collect();
    let mut seen = BTreeMap::new();
    for k in 0..4000_u64 {
        let cell = grid.sample(Key::root(k), |_| true).unwrap();
        assert_eq!(grid.sample(Key::root(k), |_| true), Some(cell));
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
    assert_eq!(grid.sample(Key::root(1), |_| false), None);
}
