//! Mirror images in a box, where theory knows them all.

#![allow(clippy::unwrap_used, reason = "tests may stop at the first surprise")]

use crate::common;

use common::{Hall, box_sides, dry, material, pieces, rectangle};
use dwell_acoustics::AcousticConfig;
use dwell_scene::random::RandomKey;
use dwell_scene::{Bands, House, Material, ShoeboxMaterials};
use glam::Vec3;

const SIZE: [f32; 3] = [6.0, 3.0, 5.0];
const SOURCE: Vec3 = Vec3::new(1.2, 1.5, 1.4);
const EAR: Vec3 = Vec3::new(4.6, 1.2, 3.3);

fn images_only(order: usize) -> AcousticConfig {
    AcousticConfig {
        image_order: order,
        ..dry(0)
    }
}

/// V3: 1, 7, 25, 63 images up to order 0, 1, 2, 3; 129 up to order 4.
#[test]
fn a_box_has_its_number_of_images() {
    for (order, count) in [(0, 1), (1, 7), (2, 25), (3, 63), (4, 129)] {
        let hall = Hall::shoebox(SIZE, &material(0.1, 0.0), images_only(order));
        assert_eq!(
            hall.echogram(SOURCE, EAR, RandomKey::root(0)).paths.len(),
            count,
            "order {order}"
        );
    }
}

/// V3 again with every wall cut into 2 and 200 triangles, of different materials.
#[test]
fn cut_walls_have_the_same_images() {
    for squares in [1, 10] {
        let sides = box_sides(Vec3::from_array(SIZE), squares);
        let house = pieces(sides.map(|side| (side, material(0.1, 0.0))).into());
        let hall = Hall::new(house, images_only(3));
        assert_eq!(hall.scene.planes().len(), 6);
        assert_eq!(
            hall.echogram(SOURCE, EAR, RandomKey::root(0)).paths.len(),
            63
        );
    }
    // Each wall of two pieces of its own.
    let size = Vec3::from_array(SIZE);
    let halves = box_sides(size, 1).into_iter().flat_map(|side| {
        [0, 1].map(|k| {
            let mut half = side.clone();
            half.triangles = vec![side.triangles[k]];
            (half, material(0.1, 0.0))
        })
    });
    let hall = Hall::new(pieces(halves.collect()), images_only(3));
    assert_eq!(hall.scene.planes().len(), 6);
    assert_eq!(
        hall.echogram(SOURCE, EAR, RandomKey::root(0)).paths.len(),
        63
    );
}

/// Different materials on the six sides, different in every band.
fn six_materials() -> [Material; 6] {
    std::array::from_fn(|side| Material {
        absorption: Bands::octaves(std::array::from_fn(|band| {
            0.03 + 0.05 * side as f32 + 0.07 * band as f32
        })),
        scattering: Bands::octaves(std::array::from_fn(|band| 0.02 * (side + band) as f32)),
        ..material(0.0, 0.0)
    })
}

/// All images of a box up to an order: distance, and how often each of the six sides reflected.
///
/// # Source
/// J. B. Allen, D. A. Berkley, JASA 65, 943 (1979), equations (8) to (10).
fn allen_berkley(order: i32) -> Vec<(f64, [i32; 6])> {
    let mut images = Vec::new();
    let around = -order..=order;
    for n in around.clone().flat_map(|x| {
        let around = around.clone();
        around
            .clone()
            .flat_map(move |y| around.clone().map(move |z| [x, y, z]))
    }) {
        for p in 0..8 {
            let (mut square, mut hits) = (0.0, [0; 6]);
            for axis in 0..3 {
                let q = p >> axis & 1;
                let size = f64::from(SIZE[axis]);
                let place = f64::from(1 - 2 * q) * f64::from(SOURCE[axis])
                    + 2.0 * f64::from(n[axis]) * size;
                square += (place - f64::from(EAR[axis])).powi(2);
                // The wall at 0 reflects |n - q| times, the one at the far end |n| times.
                hits[2 * axis] = (n[axis] - q).abs();
                hits[2 * axis + 1] = n[axis].abs();
            }
            if hits.iter().sum::<i32>() <= order {
                images.push((square.sqrt(), hits));
            }
        }
    }
    images.sort_by(|a, b| a.0.total_cmp(&b.0));
    images
}

/// V4: distances within 1e-6, energies within 1e-5 in every band.
#[test]
fn images_lie_where_allen_and_berkley_have_them() {
    let [floor, ceiling, west, east, north, south] = six_materials();
    let materials = ShoeboxMaterials {
        floor,
        ceiling,
        west,
        east,
        north,
        south,
    };
    let hall = Hall::new(House::shoebox(SIZE, &materials).unwrap(), images_only(3));
    let found = hall.echogram(SOURCE, EAR, RandomKey::root(0)).paths;
    let wanted = allen_berkley(3);
    assert_eq!(found.len(), wanted.len());
    for (printed, path) in [3.906, 4.739, 5.105, 5.809].into_iter().zip(&found) {
        assert!((path.length_m - printed).abs() < 1e-3, "{}", path.length_m);
    }
    // x: west, east; y: floor, ceiling; z: north, south.
    let sides = [
        &materials.west,
        &materials.east,
        &materials.floor,
        &materials.ceiling,
        &materials.north,
        &materials.south,
    ];
    for (path, (distance, hits)) in found.iter().zip(&wanted) {
        assert!(
            (path.length_m / distance - 1.0).abs() < 1e-6,
            "{} {distance}",
            path.length_m
        );
        assert_eq!(path.order() as i32, hits.iter().sum::<i32>());
        for (band, centre) in dwell_acoustics::bands::NOMINAL_CENTRES_HZ
            .into_iter()
            .enumerate()
        {
            let mut energy = 1.0 / (distance * distance);
            for (side, count) in sides.iter().zip(hits) {
                let kept = f64::from(
                    (1.0 - side.absorption.at(centre)) * (1.0 - side.scattering.at(centre)),
                );
                energy *= kept.powi(*count);
            }
            assert!((f64::from(path.energy[band]) / energy - 1.0).abs() < 1e-5);
        }
    }
}

/// V5: one wall, heights 1 and 1, distance 2: energy (1 - alpha)/8.
#[test]
fn one_wall_mirrors_once() {
    let floor = rectangle(
        Vec3::new(-50.0, 0.0, -50.0),
        Vec3::Z * 100.0,
        Vec3::X * 100.0,
        1,
    );
    let hall = Hall::new(pieces(vec![(floor, material(0.3, 0.0))]), images_only(2));
    let paths = hall
        .echogram(Vec3::Y, Vec3::new(2.0, 1.0, 0.0), RandomKey::root(0))
        .paths;
    assert_eq!(paths.len(), 2);
    assert!((f64::from(paths[1].energy[4]) - 0.7 / 8.0).abs() < 1e-6);
    // It comes from below, and left downwards.
    let slant = 0.5_f32.sqrt();
    assert!((paths[1].arrival - Vec3::new(-slant, -slant, 0.0)).length() < 1e-6);
    assert!((paths[1].departure - Vec3::new(slant, -slant, 0.0)).length() < 1e-6);
}

#[test]
fn a_screen_hides_what_lies_behind_it() {
    let floor = rectangle(
        Vec3::new(-50.0, 0.0, -50.0),
        Vec3::Z * 100.0,
        Vec3::X * 100.0,
        1,
    );
    let screen = rectangle(Vec3::new(1.0, 0.2, -1.0), Vec3::Y * 3.0, Vec3::Z * 2.0, 1);
    let house = |screen_too: bool| {
        let mut items = vec![(floor.clone(), material(0.3, 0.0))];
        items.extend(screen_too.then(|| (screen.clone(), material(0.3, 0.0))));
        pieces(items)
    };
    let (source, ear) = (Vec3::Y, Vec3::new(2.0, 1.0, 0.0));
    let open = Hall::new(house(false), images_only(2)).echogram(source, ear, RandomKey::root(0));
    let hidden = Hall::new(house(true), images_only(2)).echogram(source, ear, RandomKey::root(0));
    assert_eq!(open.paths.len(), 2);
    // Over the floor the way is free below the screen; the straight one is not.
    assert!(hidden.direct().is_none() && hidden.paths.len() == 1 && hidden.paths[0].order() == 1);
}

#[test]
fn both_ways_have_the_same_paths() {
    let hall = Hall::shoebox(SIZE, &material(0.2, 0.1), images_only(3));
    let there = hall.echogram(SOURCE, EAR, RandomKey::root(0)).paths;
    let back = hall.echogram(EAR, SOURCE, RandomKey::root(0)).paths;
    assert_eq!(there.len(), back.len());
    for (a, b) in there.iter().zip(&back) {
        assert!(
            (a.length_m - b.length_m).abs() < 1e-6
                && (a.energy[4] / b.energy[4] - 1.0).abs() < 1e-6
        );
    }
}
