//! Small things on and in larger ones.

use super::place::REST_GAP_M;
use super::rules::SmallItemRule;
use super::space::{PlacedFurniture, RoomLayout};
use crate::building::yaw::yaw_rotation;
use dwell_furniture::model_cache::{CachedModel, cached_model};
use dwell_furniture::style::Style;
use dwell_scene::random::{RandomKey, RandomStream};
use dwell_scene::{Aabb, Pose, ReceptacleKind};
use glam::Vec3;
use std::sync::Arc;

/// Number of places that are tried for one thing.
const TRIES: usize = 14;
/// Largest height of a small thing, m.
const HIGHEST_M: f32 = 2.4;
/// Clearance at the edges of surfaces, m.
const EDGE_M: f32 = 0.01;

/// Applies one rule to everything that stands in the room.
pub(crate) fn place_small_items(
    space: &mut RoomLayout,
    rule: &SmallItemRule,
    amount: f32,
    style: &Style,
    key: RandomKey,
) {
    let hosts = space.pieces.len();
    for host in 0..hosts {
        let kind = space.pieces[host].model.kind;
        if !rule.on.iter().any(|on| on == kind) {
            continue;
        }
        let spaces = space.pieces[host].model.model.spaces.len();
        for k in 0..spaces {
            let key = key.child(host as u64).child(k as u64);
            fill_receptacle(space, rule, [host, k], amount, style, key);
        }
    }
}

fn fill_receptacle(
    space: &mut RoomLayout,
    rule: &SmallItemRule,
    [host, k]: [usize; 2],
    amount: f32,
    style: &Style,
    key: RandomKey,
) {
    let top = &space.pieces[host].model.model.spaces[k];
    let wanted = if rule.inside {
        ReceptacleKind::In
    } else {
        ReceptacleKind::On
    };
    let named = rule.spaces.is_empty() || rule.spaces.iter().any(|name| name == top.name);
    let mut draw = key.stream();
    if top.kind != wanted || !named || draw.uniform_f32() >= rule.chance * amount {
        return;
    }
    let count = rule.count[0] + draw.below(rule.count[1] - rule.count[0] + 1);
    for item in 0..count {
        let key = key.child("item").child(item as u64);
        let Some(kind) = draw.choose(&rule.kinds) else {
            return;
        };
        let Some(stock) = cached_model(kind, style, key) else {
            continue;
        };
        for _ in 0..TRIES {
            let Some(pose) =
                sample_pose_on(&space.pieces[host], k, &stock, rule.turn_deg, &mut draw)
            else {
                break;
            };
            let piece = PlacedFurniture::new(&stock, pose).anchored_to(host);
            if piece.bounds.max.y < HIGHEST_M && space.can_place_on(&piece, host, rule.inside) {
                space.add_small_item(piece);
                break;
            }
        }
    }
}

/// A random place in a space of the host, randomly rotated; `None` when the thing is too large.
fn sample_pose_on(
    host: &PlacedFurniture,
    k: usize,
    stock: &Arc<CachedModel>,
    turn_deg: f32,
    draw: &mut RandomStream,
) -> Option<Pose> {
    let top = &host.model.model.spaces[k];
    let turn = yaw_rotation(draw.range(-turn_deg, turn_deg));
    let turned = stock
        .collider_bounds
        .transformed(&Pose::new(Vec3::ZERO, turn).to_affine());
    let free = Aabb {
        min: top.space.min + Vec3::new(EDGE_M, 0.0, EDGE_M),
        max: top.space.max - Vec3::new(EDGE_M, 0.0, EDGE_M),
    };
    let room = free.size() - turned.size();
    if room.min_element() < 0.0 {
        return None;
    }
    let at = Vec3::new(
        free.min.x - turned.min.x + room.x * draw.uniform_f32(),
        free.min.y - turned.min.y + REST_GAP_M,
        free.min.z - turned.min.z + room.z * draw.uniform_f32(),
    );
    let model_from_part = host.model.model.model_from_part(top.part);
    Some(host.pose * model_from_part * Pose::new(at, turn))
}
