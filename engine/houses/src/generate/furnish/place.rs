//! Candidate poses of a rule's things, the likeliest first.

use super::rules::{FurnishingRule, PlacementKind};
use super::space::{PlacedFurniture, RoomLayout, WallSpan};
use crate::building::room::CEILING_M;
use crate::building::yaw::yaw_rotation;
use dwell_furniture::model_cache::CachedModel;
use dwell_scene::random::RandomStream;
use dwell_scene::{Aabb, Pose, ReceptacleKind};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// Space left between a thing and the wall behind it, m.
const WALL_GAP_M: f32 = 0.003;
/// Space left under a thing that stands on something: below what physics counts as contact, m.
pub(crate) const REST_GAP_M: f32 = 0.0004;
/// Largest distance of the wall behind furniture for something to hang on it above that, m.
const BEHIND_M: f32 = 0.3;
/// Steps along walls, m.
const ALONG_M: f32 = 0.12;
/// Chairs are this far apart along a table, m (DIN 18022 asks for 0.6).
const SEAT_M: f32 = 0.6;

/// A pose with its cost.
type CandidatePose = (f32, Pose);

/// Half of a thing's width with its doors open, and from its origin to its back with its lid up.
fn half_and_back(stock: &CachedModel) -> (f32, f32) {
    let all = || stock.swept_boxes.iter().chain([&stock.collider_bounds]);
    let wide = |bounds: &Aabb| bounds.min.x.abs().max(bounds.max.x.abs());
    let half = all().map(wide).fold(0.0, f32::max);
    let back = all().map(|bounds| -bounds.min.z);
    (half, back.fold(f32::NEG_INFINITY, f32::max))
}

/// The places for a thing, the likeliest first.
pub(crate) fn candidate_poses(
    rule: &FurnishingRule,
    space: &RoomLayout,
    stock: &Arc<CachedModel>,
    anchor: Option<&PlacedFurniture>,
    stream: &mut RandomStream,
) -> Vec<Pose> {
    let mut ideas: Vec<CandidatePose> = match (rule.place, anchor) {
        (PlacementKind::Wall, _) => wall_poses(space, stock, None, false, stream),
        (PlacementKind::Corner, _) => wall_poses(space, stock, None, true, stream),
        (PlacementKind::Hung, None) => wall_poses(space, stock, Some(rule.height_m), false, stream),
        (PlacementKind::Hung, Some(anchor)) => near(
            wall_poses(space, stock, Some(rule.height_m), false, stream),
            anchor,
            rule.gap_m[1],
        ),
        (PlacementKind::Centre, _) => centre(space, stream),
        (PlacementKind::Ceiling, anchor) => ceiling(space, anchor),
        (PlacementKind::Beside, Some(anchor)) => beside(stock, anchor, rule.gap_m[0], stream),
        (PlacementKind::InFrontOf, Some(anchor)) => before(stock, anchor, rule.gap_m, 0.0, stream),
        (PlacementKind::Facing, Some(anchor)) => before(stock, anchor, rule.gap_m, 180.0, stream),
        (PlacementKind::Around, Some(anchor)) => around(stock, anchor),
        (PlacementKind::At, Some(anchor)) => tucked_poses(stock, anchor, stream),
        (PlacementKind::On, Some(anchor)) => on(stock, anchor, stream),
        (PlacementKind::Above, Some(anchor)) => above(space, anchor, rule.height_m),
        _ => Vec::new(),
    };
    ideas.sort_by(|a, b| a.0.total_cmp(&b.0));
    ideas.into_iter().map(|(_, pose)| pose).collect()
}

/// With the back to a wall; hung at a height, or standing.
fn wall_poses(
    space: &RoomLayout,
    stock: &CachedModel,
    height_m: Option<f32>,
    corners: bool,
    stream: &mut RandomStream,
) -> Vec<CandidatePose> {
    let (half, back) = half_and_back(stock);
    let mut ideas = Vec::new();
    for span in &space.wall_spans {
        let (low, high) = (
            span.from_m + half + WALL_GAP_M,
            span.to_m - half - WALL_GAP_M,
        );
        if high < low {
            continue;
        }
        let mut idea = |along: f32, penalty: f32, stream: &mut RandomStream| {
            let (y, off) = match height_m {
                Some(y) => (y, 0.0),
                None => (REST_GAP_M, back + WALL_GAP_M),
            };
            let pose = Pose::new(
                span.point(along, off) + Vec3::Y * y,
                yaw_rotation(span.yaw_deg()),
            );
            ideas.push((penalty + stream.uniform_f32(), pose));
        };
        idea(low, 0.2, stream);
        idea(high, 0.2, stream);
        if !corners {
            let count = ((high - low) / ALONG_M) as usize;
            let middle = 0.5 * (low + high);
            for k in 1..count {
                let along = low + (high - low) * k as f32 / count as f32;
                let off_middle = (along - middle).abs() / (high - low).max(0.5);
                idea(along, 0.7 * off_middle, stream);
            }
        }
    }
    ideas
}

/// Those places within a hand's reach (`reach_m`) of the middle of an anchor's front, the nearest first.
fn near(ideas: Vec<CandidatePose>, anchor: &PlacedFurniture, reach_m: f32) -> Vec<CandidatePose> {
    let front = Vec3::Z * anchor.model.collider_bounds.max.z;
    let hand = anchor.pose.transform_point(front).with_y(0.0);
    let away = |pose: &Pose| pose.position.with_y(0.0).distance(hand);
    let ideas = ideas.into_iter().map(|(_, pose)| (away(&pose), pose));
    ideas.filter(|(away, _)| *away <= reach_m).collect()
}

fn centre(space: &RoomLayout, stream: &mut RandomStream) -> Vec<CandidatePose> {
    let area = |z: &[f32; 4]| (z[2] - z[0]) * (z[3] - z[1]);
    let Some(largest) = space
        .floor
        .iter()
        .max_by(|a, b| area(a).total_cmp(&area(b)))
    else {
        return Vec::new();
    };
    let middle = Vec2::new(
        0.5 * (largest[0] + largest[2]),
        0.5 * (largest[1] + largest[3]),
    );
    let turn = 90.0 * stream.below(2) as f32;
    let mut ideas = Vec::new();
    for i in -7..=7_i32 {
        for j in -7..=7_i32 {
            let off = Vec2::new(i as f32, j as f32) * 0.25;
            for (k, yaw_deg) in [turn, turn + 90.0].into_iter().enumerate() {
                let at = middle + off;
                let pose = Pose::new(Vec3::new(at.x, REST_GAP_M, at.y), yaw_rotation(yaw_deg));
                let penalty = off.length() + 0.4 * k as f32 + 0.3 * stream.uniform_f32();
                ideas.push((penalty, pose));
            }
        }
    }
    ideas
}

fn ceiling(space: &RoomLayout, anchor: Option<&PlacedFurniture>) -> Vec<CandidatePose> {
    let at = |x: f32, z: f32| Pose::new(Vec3::new(x, CEILING_M, z), yaw_rotation(0.0));
    if let Some(anchor) = anchor {
        let middle = anchor.bounds.center();
        return vec![(0.0, at(middle.x, middle.z))];
    }
    let mut ideas = Vec::new();
    for [x0, z0, x1, z1] in &space.floor {
        let area = (x1 - x0) * (z1 - z0);
        for (i, j) in [
            (0.0, 0.0),
            (0.25, 0.0),
            (-0.25, 0.0),
            (0.0, 0.25),
            (0.0, -0.25),
        ] {
            let (x, z) = (
                0.5 * (x0 + x1) + i * (x1 - x0),
                0.5 * (z0 + z1) + j * (z1 - z0),
            );
            let aside: f32 = if i == 0.0 && j == 0.0 { 0.0 } else { 0.5 };
            ideas.push((aside - area, at(x, z)));
        }
    }
    ideas
}

fn beside(
    stock: &CachedModel,
    anchor: &PlacedFurniture,
    gap_m: f32,
    stream: &mut RandomStream,
) -> Vec<CandidatePose> {
    let (half, back) = half_and_back(stock);
    let host = anchor.model.collider_bounds;
    let z = host.min.z + back;
    let mut ideas = Vec::new();
    for extra in [0.0, 0.1, 0.25] {
        let gap = gap_m.max(WALL_GAP_M) + extra;
        for x in [host.max.x + gap + half, host.min.x - gap - half] {
            let pose = anchor.pose * Pose::new(Vec3::new(x, 0.0, z), yaw_rotation(0.0));
            ideas.push((extra + 0.05 * stream.uniform_f32(), pose));
        }
    }
    ideas
}

fn before(
    stock: &CachedModel,
    anchor: &PlacedFurniture,
    gap_m: [f32; 2],
    turn_deg: f32,
    stream: &mut RandomStream,
) -> Vec<CandidatePose> {
    let depth = if turn_deg == 0.0 {
        -stock.collider_bounds.min.z
    } else {
        stock.collider_bounds.max.z
    };
    let liked = stream.range(gap_m[0], gap_m[1].max(gap_m[0] + 0.01));
    let count = ((gap_m[1] - gap_m[0]) / 0.1).max(0.0) as usize;
    let mut ideas = Vec::new();
    for k in 0..=count {
        let gap = gap_m[0] + 0.1 * k as f32;
        for x in [0.0, 0.2, -0.2, 0.45, -0.45] {
            let z = anchor.model.collider_bounds.max.z + gap + depth;
            let pose = anchor.pose * Pose::new(Vec3::new(x, 0.0, z), yaw_rotation(turn_deg));
            ideas.push(((gap - liked).abs() + x.abs(), pose));
        }
    }
    ideas
}

fn around(stock: &CachedModel, anchor: &PlacedFurniture) -> Vec<CandidatePose> {
    let host = anchor.model.collider_bounds;
    let size = host.size();
    let depth = stock.collider_bounds.max.z;
    let along = ((size.x - 0.1) / SEAT_M).max(1.0) as usize;
    let heads = ((size.z - 0.1) / SEAT_M).max(1.0) as usize;
    let mut ideas = Vec::new();
    // Tucked under the top as far as legs and rails allow.
    for (k, tuck) in [0.2, 0.1, 0.0, -0.08].into_iter().enumerate() {
        let penalty = 0.1 * k as f32;
        let mut seat = |x: f32, z: f32, turn_deg: f32, penalty: f32| {
            let pose = anchor.pose * Pose::new(Vec3::new(x, 0.0, z), yaw_rotation(turn_deg));
            ideas.push((penalty, pose));
        };
        for slot in 0..along {
            let x = size.x * ((slot as f32 + 0.5) / along as f32 - 0.5);
            let z = host.max.z + depth - tuck;
            seat(x, z, 180.0, penalty + slot as f32);
            seat(x, -z, 0.0, penalty + slot as f32 + 0.5);
        }
        for slot in 0..heads.min(1) {
            let z = size.z * ((slot as f32 + 0.5) / heads.min(1) as f32 - 0.5);
            let x = host.max.x + depth - tuck;
            seat(x, z, -90.0, penalty + 10.0);
            seat(-x, z, 90.0, penalty + 10.5);
        }
    }
    ideas
}

fn tucked_poses(
    stock: &CachedModel,
    anchor: &PlacedFurniture,
    stream: &mut RandomStream,
) -> Vec<CandidatePose> {
    let mut ideas = Vec::new();
    for (k, tuck) in [0.25, 0.15, 0.05, -0.06, -0.15].into_iter().enumerate() {
        for x in [-0.2, 0.0, 0.2, -0.35] {
            let z = anchor.model.collider_bounds.max.z + stock.collider_bounds.max.z - tuck;
            let aside = stream.range(-12.0, 12.0);
            let pose = anchor.pose * Pose::new(Vec3::new(x, 0.0, z), yaw_rotation(180.0 + aside));
            ideas.push((0.3 * k as f32 + (x + 0.2_f32).abs(), pose));
        }
    }
    ideas
}

fn on(
    stock: &CachedModel,
    anchor: &PlacedFurniture,
    stream: &mut RandomStream,
) -> Vec<CandidatePose> {
    let tops = anchor.model.model.spaces.iter();
    let area = |space: &Aabb| space.size().x * space.size().z;
    let largest = tops
        .filter(|space| space.kind == ReceptacleKind::On)
        .max_by(|a, b| area(&a.space).total_cmp(&area(&b.space)));
    let Some(top) = largest else {
        return Vec::new();
    };
    let mut ideas = Vec::new();
    for share in [0.0, 0.25, -0.25, 0.45, -0.45] {
        for deep in [0.0, -0.3, 0.3] {
            let middle = top.space.center();
            let room = (top.space.size() - stock.collider_bounds.size()).max(Vec3::ZERO);
            let own = stock.collider_bounds.center();
            let place = Vec3::new(
                middle.x + share * room.x - own.x,
                top.space.min.y - stock.collider_bounds.min.y + REST_GAP_M,
                middle.z + deep * room.z - own.z,
            );
            let fits = stock
                .collider_bounds
                .size()
                .cmple(top.space.size() + 0.06)
                .all();
            if fits {
                let part = anchor.model.model.model_from_part(top.part);
                let pose = anchor.pose * part * Pose::from_position(place);
                ideas.push((share.abs() + deep.abs() + 0.1 * stream.uniform_f32(), pose));
            }
        }
    }
    ideas
}

/// On the wall behind the anchor; none where the anchor stands away from walls.
fn above(space: &RoomLayout, anchor: &PlacedFurniture, height_m: f32) -> Vec<CandidatePose> {
    let mut ideas = Vec::new();
    for x in [0.0, 0.2, -0.2] {
        let behind = Vec3::new(x, height_m - REST_GAP_M, anchor.model.collider_bounds.min.z);
        let at = anchor.pose.transform_point(behind);
        let facing = anchor.pose.rotation * Vec3::Z;
        for span in &space.wall_spans {
            let (along, across) = if span.along_x {
                (at.x, at.z)
            } else {
                (at.z, at.x)
            };
            let off = (across - span.face_m) * span.inward_sign;
            let turn = yaw_rotation(span.yaw_deg());
            let backs_it = facing.dot(turn * Vec3::Z) > 0.99
                && (-0.01..BEHIND_M).contains(&off)
                && (span.from_m..span.to_m).contains(&along);
            if backs_it {
                let pose = Pose::new(span.point(along, 0.0) + Vec3::Y * at.y, turn);
                ideas.push((f32::abs(x) + off, pose));
            }
        }
    }
    ideas
}

/// The gap that a row leaves where its rule says so, m.
const ROW_GAP_M: f32 = 0.09;

/// Returns the length of a row of fitted units, gaps (`None`) among them, m.
pub(crate) fn row_length(row: &[Option<Arc<CachedModel>>]) -> f32 {
    let length = |stock: &Option<Arc<CachedModel>>| {
        stock.as_ref().map_or(ROW_GAP_M, |stock| {
            stock.collider_bounds.size().x + WALL_GAP_M
        })
    };
    row.iter().map(length).sum()
}

/// The poses of a row of fitted units along a span, from left to right seen from the room, starting `start_m` from
/// the left end; `None` when the row is longer than the span.
pub(crate) fn row_poses(
    span: &WallSpan,
    row: &[Option<Arc<CachedModel>>],
    start_m: f32,
) -> Option<Vec<Pose>> {
    if start_m + row_length(row) + WALL_GAP_M > span.to_m - span.from_m {
        return None;
    }
    // Left, as one looks at the wall, is the larger coordinate of half of the walls.
    let turn = yaw_rotation(span.yaw_deg());
    let right = turn * Vec3::X;
    let rightward = if span.along_x { right.x } else { right.z };
    let mut at = start_m + WALL_GAP_M;
    let mut poses = Vec::new();
    for stock in row {
        let Some(stock) = stock else {
            at += ROW_GAP_M;
            continue;
        };
        let left = at - stock.collider_bounds.min.x;
        let along = if rightward > 0.0 {
            span.from_m + left
        } else {
            span.to_m - left
        };
        let off = WALL_GAP_M - stock.collider_bounds.min.z;
        let place = span.point(along, off) + Vec3::Y * REST_GAP_M;
        poses.push(Pose::new(place, turn));
        at += stock.collider_bounds.size().x + WALL_GAP_M;
    }
    Some(poses)
}
