//! The room programme of a house: its rooms, their storeys and sizes.

use super::rooms::GeneratedRoomKind;
use super::spec::{HomeKind, HouseSpec, MAX_ROOMS};
use GeneratedRoomKind::{
    Balcony, Bathroom, Bedroom, BoilerRoom, ChildRoom, DiningRoom, GuestRoom, Gym, Kitchen,
    LivingRoom, Lobby, Office, Storage, Studio, Terrace, Toilet, Wardrobe,
};
use dwell_scene::random::{RandomKey, RandomStream};

/// A required room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RequiredRoom {
    pub(crate) kind: GeneratedRoomKind,
    pub(crate) area_m2: f32,
}

/// The rooms of a house.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RoomProgram {
    pub(crate) home: HomeKind,
    /// Rooms of the storeys from the ground up, without hallways and outdoor rooms.
    pub(crate) storeys: Vec<Vec<RequiredRoom>>,
    /// A balcony or terrace.
    pub(crate) outside: Option<GeneratedRoomKind>,
}

/// Draws the values that the spec leaves open.
pub(crate) fn draw_room_program(spec: &HouseSpec, key: RandomKey) -> RoomProgram {
    let mut draw = key.stream();
    let home = draw_home_kind(spec, &mut draw);
    let mut outside = None;
    let mut storeys = if spec.rooms.is_empty() {
        let (rooms, drawn) = sample_room_kinds(home, spec, &mut draw);
        outside = drawn;
        rooms
    } else {
        let inside: Vec<GeneratedRoomKind> = spec
            .rooms
            .iter()
            .copied()
            .filter(|kind| !kind.is_outside())
            .collect();
        outside = outside.or(spec.rooms.iter().copied().find(|kind| kind.is_outside()));
        assign_to_storeys(&inside, spec.storeys.unwrap_or(1))
    };
    for rooms in &mut storeys {
        rooms.truncate(MAX_ROOMS);
    }
    let mut key = key.child("areas").stream();
    let mut storeys: Vec<Vec<RequiredRoom>> = storeys
        .into_iter()
        .map(|rooms| {
            let wanted = |kind: GeneratedRoomKind| {
                let [low, usual, high] = kind.requirements().area_m2;
                let area_m2 = (usual * key.range(0.8, 1.35)).clamp(low, high);
                RequiredRoom { kind, area_m2 }
            };
            rooms.into_iter().map(wanted).collect()
        })
        .collect();
    if let Some(area) = spec.area_m2 {
        scale(&mut storeys, area);
    }
    RoomProgram {
        home,
        storeys,
        outside,
    }
}

fn draw_home_kind(spec: &HouseSpec, draw: &mut RandomStream) -> HomeKind {
    let drawn = match draw.below(20) {
        0..3 => HomeKind::Studio,
        3..11 => HomeKind::Apartment,
        11..18 => HomeKind::House,
        _ => HomeKind::Office,
    };
    let fitting = match (spec.storeys, spec.area_m2) {
        (Some(2..), _) => HomeKind::House,
        (_, Some(area)) if area < 34.0 => HomeKind::Studio,
        (_, Some(area)) if drawn == HomeKind::Studio && area > 50.0 => HomeKind::Apartment,
        _ => drawn,
    };
    spec.home.unwrap_or(fitting)
}

/// The rooms that such a home usually has, and the outdoor one.
fn sample_room_kinds(
    home: HomeKind,
    spec: &HouseSpec,
    draw: &mut RandomStream,
) -> (Vec<Vec<GeneratedRoomKind>>, Option<GeneratedRoomKind>) {
    let mut maybe = |chance: f32| draw.uniform_f32() < chance;
    // A small area leaves out optional rooms.
    let area = spec.area_m2.unwrap_or(match home {
        HomeKind::Studio => 34.0,
        HomeKind::Apartment => 85.0,
        HomeKind::House => 130.0,
        HomeKind::Office => 120.0,
    });
    let roomy = |from: f32| area >= from;
    let balcony = maybe(0.5).then_some(Balcony);
    match home {
        HomeKind::Studio => {
            let mut rooms = vec![Studio, Bathroom];
            if roomy(30.0) && maybe(0.3) {
                rooms.push(Storage);
            }
            (vec![rooms], balcony)
        }
        HomeKind::Apartment => {
            let mut rooms = vec![LivingRoom, Kitchen, Bathroom, Bedroom];
            for (kind, from, chance) in [
                (ChildRoom, 62.0, 0.65),
                (Toilet, 75.0, 0.35),
                (Storage, 55.0, 0.4),
                (Office, 80.0, 0.3),
                (DiningRoom, 85.0, 0.3),
                (GuestRoom, 95.0, 0.2),
                (ChildRoom, 100.0, 0.3),
                (Wardrobe, 90.0, 0.2),
            ] {
                if roomy(from) && maybe(chance) {
                    rooms.push(kind);
                }
            }
            (vec![rooms], balcony)
        }
        HomeKind::House => {
            let count = spec.storeys.unwrap_or(1 + usize::from(maybe(0.75)));
            let mut rooms = vec![LivingRoom, Kitchen, Bathroom, Bedroom, Toilet];
            for (kind, from, chance) in [
                (ChildRoom, 80.0, 0.9),
                (DiningRoom, 100.0, 0.6),
                (BoilerRoom, 95.0, 0.6),
                (ChildRoom, 115.0, 0.5),
                (Office, 110.0, 0.45),
                (GuestRoom, 120.0, 0.35),
                (Wardrobe, 125.0, 0.3),
                (Gym, 150.0, 0.2),
            ] {
                if roomy(from) && maybe(chance) {
                    rooms.push(kind);
                }
            }
            let mut storeys = assign_to_storeys(&rooms, count);
            fill_small_storeys(&mut storeys);
            (storeys, maybe(0.6).then_some(Terrace))
        }
        HomeKind::Office => {
            let mut rooms = vec![Lobby, Office, Office, Kitchen, Toilet];
            for (kind, from, chance) in [
                (Office, 90.0, 0.8),
                (Office, 105.0, 0.6),
                (Toilet, 100.0, 0.5),
                (Storage, 80.0, 0.6),
                (Office, 125.0, 0.4),
            ] {
                if roomy(from) && maybe(chance) {
                    rooms.push(kind);
                }
            }
            (vec![rooms], None)
        }
    }
}

/// Rooms to storeys: each to its usual one, then from fuller storeys to those without a room.
fn assign_to_storeys(rooms: &[GeneratedRoomKind], count: usize) -> Vec<Vec<GeneratedRoomKind>> {
    let mut storeys = vec![Vec::new(); count.max(1)];
    let mut above = 0;
    for kind in rooms {
        let storey = if kind.requirements().storey == 0 || count < 2 {
            0
        } else {
            // Private rooms fill the upper storeys in turn.
            above += 1;
            1 + (above - 1) % (count - 1)
        };
        storeys[storey].push(*kind);
    }
    while let Some(empty) = storeys.iter().position(Vec::is_empty) {
        let fullest = (0..storeys.len())
            .max_by_key(|k| storeys[*k].len())
            .unwrap_or(0);
        if storeys[fullest].len() < 2 {
            break;
        }
        if let Some(kind) = storeys[fullest].pop() {
            storeys[empty].push(kind);
        }
    }
    storeys
}

/// Adds rooms to storeys that are much smaller than the largest: they all stand on one another.
fn fill_small_storeys(storeys: &mut [Vec<GeneratedRoomKind>]) {
    let usual = |rooms: &[GeneratedRoomKind]| -> f32 {
        rooms
            .iter()
            .map(|kind| kind.requirements().area_m2[1])
            .sum()
    };
    let largest = storeys.iter().map(|rooms| usual(rooms)).fold(0.0, f32::max);
    let mut spare = [GuestRoom, Office, Bathroom, Wardrobe, Gym, Storage]
        .into_iter()
        .cycle();
    for k in 0..storeys.len() {
        while usual(&storeys[k]) < 0.8 * largest
            && storeys.iter().map(Vec::len).sum::<usize>() < MAX_ROOMS
        {
            storeys[k].extend(spare.next());
        }
    }
}

/// Scales areas towards a total, each within what its kind allows.
fn scale(storeys: &mut [Vec<RequiredRoom>], area_m2: f32) {
    let hallways = if storeys.iter().map(Vec::len).sum::<usize>() > 1 {
        1.12
    } else {
        1.0
    };
    for _ in 0..4 {
        let total: f32 = storeys.iter().flatten().map(|room| room.area_m2).sum();
        let factor = area_m2 / (total * hallways).max(1.0);
        for room in storeys.iter_mut().flatten() {
            let [low, _, high] = room.kind.requirements().area_m2;
            room.area_m2 = (room.area_m2 * factor).clamp(low, high * 1.3);
        }
    }
}
