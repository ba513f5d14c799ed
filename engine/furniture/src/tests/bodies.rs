//! Meshes and collision pieces.

use super::cases::{Case, Summary, every_draw, every_draw_in_every_style};
use crate::catalogue::entries;
use crate::style::STYLES;
use crate::testing::meshes::open_edges;
use crate::testing::overlap::{ConvexPiece, max_depth};
use dwell_scene::random::RandomKey;
use dwell_scene::{Collider, Mobility, Pose};
use glam::Vec3;
use std::f32::consts::TAU;

/// Kinds whose visual mesh sticks out of their collision geometry: stalks, antennas, stems, hoses.
const STALKS: [&str; 11] = [
    "vase",
    "radio",
    "fruit",
    "pencil_cup",
    "toothbrushes",
    "utensils",
    "knife_block",
    "handbag",
    "flowers",
    "umbrella_stand",
    "vacuum_cleaner",
];

#[test]
fn meshes_are_closed_and_every_part_is_felt() {
    every_draw(|case: &Case| {
        let mut faults = Vec::new();
        for part in &case.model.parts {
            let at = format!("{} {}", case.entry.kind, part.name);
            part.mesh.check(&at).unwrap();
            let open = open_edges(&part.mesh);
            if open > 0 {
                faults.push(format!("{}: {open} open edges", part.name));
            }
            assert_eq!(part.mesh.slot_count(), part.finishes.len(), "{at}");
            if part.colliders.is_empty() {
                faults.push(format!("nothing touches {}", part.name));
            }
        }
        faults
    });
}

#[test]
fn what_is_seen_is_as_large_as_what_is_felt() {
    every_draw_in_every_style(|draw: &Summary| {
        let mut faults = Vec::new();
        for (name, seen, felt) in &draw.parts {
            let Some(felt) = felt else { continue };
            let largest = seen.size().max_element();
            let near = seen.grown(0.004 + 0.02 * largest);
            if !near.contains(felt.min) || !near.contains(felt.max) {
                faults.push(format!("{name}: felt {felt:?}, seen {seen:?}"));
            }
            let cover = felt.grown(0.02 + 0.12 * largest);
            let sticks_out = !cover.contains(seen.min) || !cover.contains(seen.max);
            if sticks_out && !STALKS.contains(&draw.entry.kind) {
                faults.push(format!("{name}: seen {seen:?}, felt {felt:?}"));
            }
        }
        faults
    });
}

#[test]
fn models_are_light_to_draw() {
    every_draw_in_every_style(|draw: &Summary| {
        (draw.triangles >= 3000)
            .then(|| format!("{} triangles", draw.triangles))
            .into_iter()
            .collect()
    });
    let mut counts: Vec<usize> = entries()
        .iter()
        .map(|entry| {
            let model = (entry.build)(&STYLES[0], RandomKey::root(0));
            model
                .parts
                .iter()
                .map(|part| part.mesh.triangles.len())
                .sum()
        })
        .collect();
    counts.sort_unstable();
    let upper = counts[counts.len() * 3 / 4];
    assert!(
        upper < 800,
        "a quarter of all models have {upper} triangles or more"
    );
}

/// Volume and centre of a collision piece.
fn content(collider: &Collider) -> (f32, Vec3) {
    let bounds = collider.bounds().expect("built-in pieces have bounds");
    let middle = match collider {
        Collider::Hull { points } => points.iter().sum::<Vec3>() / points.len() as f32,
        _ => bounds.center(),
    };
    let volume = collider.volume_m3().unwrap_or(0.6 * bounds.volume());
    (volume, middle)
}

/// The centre of mass of what stands loose is above the hull of what it stands on, at least 3 mm inside.
#[test]
fn what_stands_loose_stands_firm() {
    const INSIDE_M: f32 = 0.003;
    // Along directions this steep only what is within a fraction of a millimetre of the ground is farthest.
    const STEEP: f32 = 200.0;
    every_draw(|case: &Case| {
        // Balls roll; what is fixed or built in needs no foot.
        if case.model.mobility != Mobility::Movable || case.entry.category == "ball" {
            return Vec::new();
        }
        let (mut mass, mut moment) = (0.0, Vec3::ZERO);
        let mut pieces = Vec::new();
        for part in &case.model.parts {
            for collider in &part.colliders {
                let (volume, middle) = content(collider);
                mass += volume * part.density_kg_m3;
                moment += middle * volume * part.density_kg_m3;
                pieces.push(ConvexPiece::new(collider, &Pose::IDENTITY));
            }
        }
        let center = moment / mass;
        let low = pieces
            .iter()
            .map(|p| p.bounds.min.y)
            .fold(f32::MAX, f32::min);
        let mut faults = Vec::new();
        if low.abs() > 1e-3 || case.model.bounds().min.y < -2e-3 {
            faults.push(format!("its lowest point is at {low} m"));
        }
        for k in 0..32 {
            let (sin, cos) = dwell_scene::math::sin_cos(TAU * k as f32 / 32.0);
            let direction = Vec3::new(sin, -STEEP, cos);
            let reach = pieces
                .iter()
                .map(|piece| {
                    piece.support(direction.normalize_or_zero()) * direction.length() + STEEP * low
                })
                .fold(f32::MIN, f32::max);
            let out = center.dot(Vec3::new(sin, 0.0, cos)) - reach;
            if out > -INSIDE_M {
                faults.push(format!("tips towards ({sin:.2}, {cos:.2}): {out} m"));
                break;
            }
        }
        faults
    });
}

/// Nothing of a thing itself stands where other things may be put, 4 mm at the rim apart.
#[test]
fn places_for_things_are_free() {
    every_draw(|case: &Case| {
        let pieces: Vec<ConvexPiece> = case
            .model
            .parts
            .iter()
            .flat_map(|part| &part.colliders)
            .map(|collider| ConvexPiece::new(collider, &Pose::IDENTITY))
            .collect();
        let mut faults = Vec::new();
        for space in &case.model.spaces {
            let size = space.space.size();
            if size.min_element() < 0.02 {
                faults.push(format!("{} is {size} m", space.name));
                continue;
            }
            let free = ConvexPiece::cuboid(&space.space.grown(-0.004));
            let into = max_depth(std::slice::from_ref(&free), &pieces, 0.001);
            if into > 0.001 {
                faults.push(format!("{} is taken by {into} m", space.name));
            }
        }
        faults
    });
}
