//! Lateral energy fraction of early sound.

use crate::bands::BAND_COUNT;
use crate::directions::{CELL_COUNT, direction_in_cell};
use crate::echogram::Echogram;
use crate::receiver::{Receiver, ReceiverKind};
use glam::Vec3;

/// Start of lateral sound, s after the first arrival: earlier is the direct sound.
const FROM_S: f64 = 0.005;
/// End of early sound, s.
const UP_TO_S: f64 = 0.08;

/// Returns the axis through the ears of a listener: that of an oriented receiver; a microphone is turned to the source, as
/// a figure-of-eight microphone in a measurement is. Unit length, world.
pub fn lateral_axis(receiver: &Receiver, source: Vec3) -> Vec3 {
    if receiver.kind != ReceiverKind::Omni {
        return receiver.pose.rotation * Vec3::X;
    }
    let ahead = source - receiver.position();
    Vec3::new(-ahead.z, 0.0, ahead.x)
        .try_normalize()
        .unwrap_or(Vec3::X)
}

/// Returns the early lateral energy fraction LF, 0 to 1: the energy in a figure of eight along `axis` between 5 and 80 ms
/// after the first arrival, over all energy of the first 80 ms. `None` where nothing is heard. Shape (band,).
///
/// A diffuse field gives 1/3. Of the tail the cells' mean squares of the cosine are taken.
///
/// # Source
/// ISO 3382-1:2009, annex A (early lateral energy).
pub fn lateral_fraction(echogram: &Echogram, axis: Vec3) -> [Option<f64>; BAND_COUNT] {
    let axis = axis.try_normalize().unwrap_or(Vec3::X);
    let squares: Vec<f64> = (0..CELL_COUNT)
        .map(|cell| mean_square(cell, axis))
        .collect();
    let tail = &echogram.tail;
    std::array::from_fn(|band| {
        let first = super::first_arrival(echogram, band)?;
        let (mut lateral, mut all) = (0.0, 0.0);
        for path in &echogram.paths {
            let since = echogram.delay_s(path) - first;
            let energy = f64::from(path.energy[band]);
            if since > UP_TO_S {
                continue;
            }
            all += energy;
            if since >= FROM_S {
                let cosine = f64::from(path.arrival.dot(axis));
                lateral += energy * cosine * cosine;
            }
        }
        for (k, bin) in tail.bins.iter().enumerate() {
            // Nothing scattered precedes the direct sound, though its bin may begin earlier.
            let start = (k as f64 * tail.bin_s - first).max(0.0);
            let end = (k + 1) as f64 * tail.bin_s - first;
            if start > UP_TO_S {
                break;
            }
            if end <= 0.0 || bin[band] <= 0.0 {
                continue;
            }
            let share = |from: f64| ((end.min(UP_TO_S) - start.max(from)) / (end - start)).max(0.0);
            all += bin[band] * share(0.0);
            lateral +=
                bin[band] * share(FROM_S) * mean_square_lateral_cosine(echogram, k, band, &squares);
        }
        (all > 0.0).then(|| lateral / all)
    })
}

/// Returns the mean square of the cosine to the axis of the energy in a bin; 1/3 where directions are unknown.
fn mean_square_lateral_cosine(
    echogram: &Echogram,
    bin: usize,
    band: usize,
    squares: &[f64],
) -> f64 {
    let Some(directions) = echogram.tail.directions_at(bin) else {
        return 1.0 / 3.0;
    };
    let cells = || directions.energy.iter().map(|cell| f64::from(cell[band]));
    let all: f64 = cells().sum();
    if all <= 0.0 {
        return 1.0 / 3.0;
    }
    cells()
        .zip(squares)
        .map(|(e, square)| e * square)
        .sum::<f64>()
        / all
}

/// Returns the mean over a cell of the squared cosine to an axis, by Gauss's rule of three points each way.
fn mean_square(cell: usize, axis: Vec3) -> f64 {
    const PLACES: [(f32, f64); 3] = [
        (0.112_701_66, 5.0 / 18.0),
        (0.5, 8.0 / 18.0),
        (0.887_298_3, 5.0 / 18.0),
    ];
    let mut sum = 0.0;
    for (u, in_u) in PLACES {
        for (v, in_v) in PLACES {
            let cosine = f64::from(direction_in_cell(cell, u, v).dot(axis));
            sum += in_u * in_v * cosine * cosine;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::directions::{DirectionalEnergy, direction_cell};
    use crate::echogram::{EnergyHistogram, PropagationPath};

    fn path(length_m: f64, energy: f32, arrival: Vec3) -> PropagationPath {
        PropagationPath {
            planes: Vec::new(),
            diffraction_points: Vec::new(),
            length_m,
            energy: [energy; BAND_COUNT],
            arrival,
            departure: -arrival,
            walls: 0,
            inverted: false,
        }
    }

    fn echogram(paths: Vec<PropagationPath>, tail: EnergyHistogram) -> Echogram {
        Echogram {
            paths,
            tail,
            speed_m_s: 340.0,
            ..Echogram::default()
        }
    }

    #[test]
    fn a_lateral_path_after_a_faint_direct_sound_is_all() {
        let found = echogram(
            vec![path(3.4, 1e-9, Vec3::NEG_Z), path(10.2, 1.0, Vec3::X)],
            EnergyHistogram::default(),
        );
        for lf in lateral_fraction(&found, Vec3::X) {
            assert!((lf.unwrap() - 1.0).abs() < 1e-8);
        }
        assert!(lateral_fraction(&found, Vec3::Y)[3].unwrap() < 1e-8);
    }

    /// Direct sound of 1, then 0.5 at 20 ms from 60 degrees off the axis; energy within 5 ms or after 80 ms does not count.
    #[test]
    fn paths_count_by_the_square_of_their_cosine_and_by_time() {
        let slanted = Vec3::new(0.5, 0.0, -(0.75_f32).sqrt());
        let paths = vec![
            path(3.4, 1.0, Vec3::NEG_Z),
            path(3.4 + 340.0 * 0.004, 0.25, Vec3::X),
            path(3.4 + 340.0 * 0.020, 0.5, slanted),
            path(3.4 + 340.0 * 0.090, 7.0, Vec3::X),
        ];
        let found = lateral_fraction(&echogram(paths, EnergyHistogram::default()), Vec3::X);
        for lf in found {
            assert!((lf.unwrap() - 0.5 * 0.25 / 1.75).abs() < 1e-6, "{lf:?}");
        }
    }

    /// A tail of constant power in a diffuse field: 75 of 80 ms count, a third of each.
    #[test]
    fn sound_from_all_sides_gives_a_third() {
        let even = DirectionalEnergy {
            energy: vec![[1.0; BAND_COUNT]; CELL_COUNT],
        };
        let one_sided = {
            let mut directions = DirectionalEnergy::default();
            directions.energy[direction_cell(Vec3::new(1.0, 0.1, 0.1).normalize())] =
                [1.0; BAND_COUNT];
            directions
        };
        let lf = |directions: Vec<DirectionalEnergy>| {
            let tail = EnergyHistogram {
                bin_s: 0.004,
                bins: vec![[1.0; BAND_COUNT]; 100],
                bins_per_direction: 100,
                directions,
            };
            lateral_fraction(&echogram(Vec::new(), tail), Vec3::X)[4].unwrap()
        };
        for found in [
            lf(vec![even]),
            lf(vec![DirectionalEnergy::default()]),
            lf(Vec::new()),
        ] {
            assert!((found - 75.0 / 80.0 / 3.0).abs() < 1e-4, "{found}");
        }
        // The cell reaches 45 degrees to the side and a third up: (1 - 1/27) times the mean of cos² over 45 degrees.
        let expected = 75.0 / 80.0 * (1.0 - 1.0 / 27.0) * (0.5 + 1.0 / std::f64::consts::PI);
        assert!((lf(vec![one_sided]) - expected).abs() < 1e-3);
    }

    #[test]
    fn a_microphone_is_turned_to_the_source_and_a_head_is_not() {
        let source = Vec3::new(3.0, 2.0, 4.0);
        let axis = lateral_axis(&Receiver::omni(Vec3::ZERO), source);
        assert!(axis.y == 0.0 && axis.dot(source).abs() < 1e-5);
        let head = Receiver::binaural(dwell_scene::Pose::IDENTITY);
        assert_eq!(lateral_axis(&head, source), Vec3::X);
        assert_eq!(
            lateral_fraction(&Echogram::default(), Vec3::X),
            [None; BAND_COUNT]
        );
    }
}
