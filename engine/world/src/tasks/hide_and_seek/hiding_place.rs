//! Where the scripted hider hides.

use crate::world::World;
use dwell_scene::AgentState;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::interrupt::CancelPoller;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::random::RandomKey;
use glam::Vec3;

/// Places that are compared.
const PLACES: u64 = 64;
/// Places from which a tour of the house looks.
const VIEWS: u64 = 40;
/// How often a view from a seeker's start counts.
const START_WEIGHT: u32 = 8;
/// Rays between checks for cancellation.
const RAYS_PER_CHECK: usize = 256;

/// Returns the reachable place that is seen from the fewest places, of some that are drawn: from where the seekers stand, and from others
/// anywhere. Of equal ones the furthest from the nearest seeker.
///
/// `is_near`: whether the hider gets there in time.
pub(super) fn hiding_place(
    world: &World,
    grid: &NavGrid,
    (hider, seekers): (&AgentState, &[Vec3]),
    most_m: f32,
    is_near: impl Fn(NavCell) -> bool,
    key: RandomKey,
) -> Option<NavCell> {
    let eye = Vec3::Y * hider.eye_height_m();
    let views = (0..VIEWS).filter_map(|k| {
        let cell = grid.sample(key.child("view").child(k), |cell| {
            grid.island(cell) == Some(0)
        })?;
        Some((grid.position(cell) + eye, 1))
    });
    let starts = seekers.iter().map(|feet| (*feet + eye, START_WEIGHT));
    let views: Vec<(Vec3, u32)> = starts.chain(views).collect();
    let mut pace = CancelPoller::new(RAYS_PER_CHECK);
    let mut best: Option<(u32, f32, NavCell)> = None;
    for k in 0..PLACES {
        let place = key.child("place").child(k);
        let Some(cell) = grid.sample(place, |cell| grid.island(cell) == Some(0) && is_near(cell))
        else {
            break;
        };
        let feet = grid.position(cell);
        let seen: u32 = views
            .iter()
            .filter(|(from, _)| {
                pace.count_one();
                is_seen(world, *from, (feet, hider), most_m)
            })
            .map(|(_, weight)| weight)
            .sum();
        let apart = seekers.iter().map(|seeker| seeker.distance(feet));
        let apart_m = apart.fold(f32::INFINITY, f32::min);
        let is_better = best.is_none_or(|(least, furthest_m, _)| {
            seen < least || seen == least && apart_m > furthest_m
        });
        if is_better {
            best = Some((seen, apart_m, cell));
        }
    }
    best.map(|(.., cell)| cell)
}

/// Returns whether the head or the middle of an agent with its feet at a place is seen from a point.
fn is_seen(world: &World, from: Vec3, (feet, agent): (Vec3, &AgentState), most_m: f32) -> bool {
    [agent.eye_height_m(), 0.5 * agent.height_m()]
        .into_iter()
        .any(|height_m| {
            let way = feet + Vec3::Y * height_m - from;
            let distance_m = way.length();
            let ray = Ray::new(from, way).with_range(0.0, distance_m - agent.body.radius_m);
            distance_m <= most_m && world.rays().closest(&ray, RayMask::EYE).is_none()
        })
}
