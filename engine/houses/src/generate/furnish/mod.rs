//! Furniture by the rules of `assets/furnishing.toml`.

mod clutter;
mod fit_to_window;
mod place;
mod rules;
mod space;

pub(crate) use space::{PlacedFurniture, is_walking_obstacle, zone_of_box};

use super::openings::{HoleContents, WallHole};
use super::plan::{GeneratedPlan, StoreyCells, metres};
use super::rooms::GeneratedRoomKind;
use super::spec::HouseSpec;
use crate::building::yaw::yaw_rotation;
use dwell_furniture::model_cache::{CachedModel, cached_model};
use dwell_furniture::style::Style;
use dwell_scene::Pose;
use dwell_scene::random::{RandomKey, RandomStream};
use glam::Vec3;
use rules::{FittedRunRule, FurnishingRule, PlacementKind, rules};
use space::RoomLayout;
use std::sync::Arc;

/// Half-widths of the paths that are kept, m: the first that a room allows, then narrower ones for needed furniture.
const PATHS_M: [f32; 3] = [0.4, 0.35, 0.3];
/// Number of places that are tried for one thing.
const TRIES: usize = 160;
/// Number of looks that are tried for one thing.
const LOOKS: u64 = 3;
/// Number of looks that are tried for one that must differ from others.
const UNLIKE_LOOKS: u64 = 24;

/// The furniture of one room, heights above its floor.
pub(crate) struct RoomFurniture {
    pub(crate) pieces: Vec<PlacedFurniture>,
    /// Kinds that a room of its kind has and this one has not.
    pub(crate) missing_items: Vec<String>,
}

/// The inputs from which rooms are furnished.
pub(crate) struct HouseFurnisher<'a> {
    pub(crate) plan: &'a GeneratedPlan,
    pub(crate) wall_holes: &'a [Vec<WallHole>],
    pub(crate) style: &'a Style,
    pub(crate) spec: &'a HouseSpec,
    pub(crate) key: RandomKey,
}

impl HouseFurnisher<'_> {
    /// Furnishes every room, by storey.
    pub(crate) fn furnish(&self) -> Vec<Vec<RoomFurniture>> {
        let storeys = self.plan.storeys.iter().enumerate();
        storeys
            .map(|(level, storey)| {
                let cells = StoreyCells::new(&storey.rooms);
                (0..storey.rooms.len())
                    .map(|room| self.furnish_room(level, &cells, room, 1.0, self.key))
                    .collect()
            })
            .collect()
    }

    /// Furnishes a room of a storey with a share of the furniture that it can do without.
    pub(crate) fn furnish_room(
        &self,
        level: usize,
        cells: &StoreyCells,
        room: usize,
        share: f32,
        key: RandomKey,
    ) -> RoomFurniture {
        let storey = &self.plan.storeys[level];
        let kind = storey.rooms[room].kind;
        let stairs = self
            .plan
            .stairs
            .filter(|_| kind == GeneratedRoomKind::Hallway);
        let mut space = RoomLayout::new(
            storey,
            cells,
            room,
            &self.wall_holes[level],
            stairs.map(|stairs| stairs.area.map(metres)),
            PATHS_M[0],
        );
        let mut path = 0;
        while !space.are_doors_connected() && path + 1 < PATHS_M.len() {
            path += 1;
            space.compute_walkable(room, storey, PATHS_M[path]);
        }
        let key = key.child(level as u64).child(room as u64);
        let mut furnishing = RoomFurnisher {
            area_m2: space
                .floor
                .iter()
                .map(|z| (z[2] - z[0]) * (z[3] - z[1]))
                .sum(),
            space,
            style: self.style,
            density: self.spec.furniture_density * share,
        };
        let mut missing = Vec::new();
        let rules = rules();
        for (k, run) in rules.run.iter().enumerate() {
            if run.rooms.contains(&kind)
                && !furnishing.place_fitted_run(run, key.child("run").child(k as u64))
            {
                let name = kind.requirements().name;
                missing.push(format!("{name}: no wall for fitted units ({})", run.reason));
            }
        }
        for (k, rule) in rules.rule.iter().enumerate() {
            if !rule.rooms.contains(&kind) {
                continue;
            }
            // Rules are distinguished by their content, so that a new rule reshuffles no other.
            let key = key.child(rule.kinds[0].as_str()).child(k as u64);
            let mut done = furnishing.apply_rule(rule, key);
            // Needed furniture may narrow the paths.
            while !done && rule.required && path + 1 < PATHS_M.len() {
                path += 1;
                furnishing
                    .space
                    .compute_walkable(room, storey, PATHS_M[path]);
                done = furnishing.apply_rule(rule, key.child(path as u64));
            }
            if !done && rule.required {
                let (name, what) = (kind.requirements().name, &rule.kinds[0]);
                missing.push(format!("{name}: no {what} ({})", rule.reason));
            }
        }
        for (k, rule) in rules.clutter.iter().enumerate() {
            if rule.rooms.is_empty() || rule.rooms.contains(&kind) {
                let key = key.child("clutter").child(k as u64);
                let amount = self.spec.clutter / 0.6;
                clutter::place_small_items(&mut furnishing.space, rule, amount, self.style, key);
            }
        }
        RoomFurniture {
            pieces: furnishing.space.pieces,
            missing_items: missing,
        }
    }
}

/// A room while rules are applied.
struct RoomFurnisher<'a> {
    area_m2: f32,
    space: RoomLayout,
    style: &'a Style,
    density: f32,
}

impl RoomFurnisher<'_> {
    /// Applies a rule; false when a wanted thing found no place.
    fn apply_rule(&mut self, rule: &FurnishingRule, key: RandomKey) -> bool {
        let mut draw = key.stream();
        let chance = rule.chance * (self.density / 0.8);
        if self.area_m2 < rule.from_m2 || (!rule.required && draw.uniform_f32() >= chance) {
            return true;
        }
        let has = |piece: &PlacedFurniture| rule.kinds.iter().any(|kind| kind == piece.model.kind);
        if rule.once && self.space.pieces.iter().any(has) {
            return true;
        }
        if rule.place == PlacementKind::Window {
            return self.furnish_windows(rule, key);
        }
        let mut anchors: Vec<Option<usize>> = (0..self.space.pieces.len())
            .filter(|k| {
                let kind = self.space.pieces[*k].model.kind;
                rule.of.iter().any(|of| of == kind)
            })
            .map(Some)
            .collect();
        if rule.of.is_empty() {
            anchors.push(None);
        }
        let mut placed = 0;
        for (k, anchor) in anchors.iter().enumerate() {
            let count = rule.count[0] + draw.below(rule.count[1] - rule.count[0] + 1);
            // Several things of one rule look alike.
            let look = key.child("look").child(k as u64);
            for _ in 0..count {
                placed += usize::from(self.put(rule, *anchor, look, &mut draw));
            }
        }
        placed > 0 || (anchors.is_empty() && !rule.required)
    }

    /// Puts one thing of a rule: the first of its kinds for which there is a place.
    fn put(
        &mut self,
        rule: &FurnishingRule,
        anchor: Option<usize>,
        look: RandomKey,
        draw: &mut RandomStream,
    ) -> bool {
        for kind in &rule.kinds {
            let looks = if rule.differ { UNLIKE_LOOKS } else { LOOKS };
            for attempt in 0..looks {
                let key = look.child(kind.as_str()).child(attempt);
                let Some(stock) = cached_model(kind, self.style, key) else {
                    break;
                };
                if rule.differ && self.has_picture(stock.picture_id) {
                    continue;
                }
                let host = anchor.map(|k| &self.space.pieces[k]);
                let ideas = place::candidate_poses(rule, &self.space, &stock, host, draw);
                for pose in ideas.into_iter().take(TRIES) {
                    let mut piece =
                        PlacedFurniture::new(&stock, pose).with_front_clearance(rule.front_m);
                    piece.anchor = anchor;
                    let fits = match (rule.place, anchor) {
                        (PlacementKind::On, Some(host)) => {
                            self.space.can_place_on(&piece, host, false)
                        }
                        _ => self.space.can_place(&piece),
                    };
                    if fits {
                        self.space.add(piece);
                        return true;
                    }
                }
            }
        }
        false
    }

    /// Returns whether a picture in the room shows this already.
    fn has_picture(&self, picture_id: Option<&'static str>) -> bool {
        let mut pieces = self.space.pieces.iter();
        picture_id.is_some() && pieces.any(|piece| piece.model.picture_id == picture_id)
    }

    fn furnish_windows(&mut self, rule: &FurnishingRule, key: RandomKey) -> bool {
        let holes = self.space.holes.clone();
        let windows = holes
            .iter()
            .filter(|hole| matches!(hole.contents, HoleContents::Window { .. }));
        for hole in windows {
            for kind in &rule.kinds {
                let Some((stock, height_m)) =
                    fit_to_window::window_sized_model(kind, hole, self.style, key)
                else {
                    continue;
                };
                let Some(place) = self.space.inner_face_point(hole) else {
                    continue;
                };
                let pose = Pose::new(place + Vec3::Y * height_m, yaw_rotation(hole.yaw_deg()));
                let piece = PlacedFurniture::new(&stock, pose).for_window();
                if self.space.can_place(&piece) {
                    self.space.add(piece);
                }
            }
        }
        true
    }

    /// Fitted units along the wall that holds the first row; false without a place.
    fn place_fitted_run(&mut self, run: &FittedRunRule, key: RandomKey) -> bool {
        let mut draw = key.stream();
        for row in &run.rows {
            let units: Vec<Option<Arc<CachedModel>>> = row
                .iter()
                .map(|kind| cached_model(kind, self.style, key.child(kind.as_str())))
                .collect();
            let mut spans: Vec<usize> = (0..self.space.wall_spans.len()).collect();
            draw.shuffle(&mut spans);
            for span in spans {
                let span = self.space.wall_spans[span];
                let spare = span.to_m - span.from_m - place::row_length(&units);
                // From either end, and in steps between.
                let steps = (spare / 0.1).max(0.0) as usize;
                let mut starts: Vec<f32> = (0..=steps).map(|k| 0.1 * k as f32).collect();
                starts.push((spare - 0.01).max(0.0));
                if draw.below(2) == 0 {
                    starts.reverse();
                }
                for start in starts {
                    if let Some(poses) = place::row_poses(&span, &units, start)
                        && self.try_add_row(&units, &poses, run.front_m)
                    {
                        return true;
                    }
                }
            }
        }
        false
    }

    /// Adds the whole row, or nothing.
    fn try_add_row(
        &mut self,
        row: &[Option<Arc<CachedModel>>],
        poses: &[Pose],
        front_m: f32,
    ) -> bool {
        let before = self.space.clone();
        for (stock, pose) in row.iter().flatten().zip(poses) {
            let piece = PlacedFurniture::new(stock, *pose).with_front_clearance(front_m);
            if !self.space.can_place(&piece) {
                self.space = before;
                return false;
            }
            self.space.add(piece);
        }
        true
    }
}

/// Returns the needed kinds of rooms that found no place in any form.
pub(crate) fn missing_items(rooms: &[Vec<RoomFurniture>]) -> Vec<String> {
    rooms
        .iter()
        .flatten()
        .flat_map(|room| room.missing_items.iter().cloned())
        .collect()
}
