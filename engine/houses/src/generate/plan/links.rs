//! Connections of rooms: all with the hallway or the living room, never through a bedroom or a bathroom.

use super::{
    BoundarySegment, ConnectionKind, GeneratedRoom, GeneratedStorey, GridSteps, RoomConnection,
    StoreyCells,
};
use crate::generate::rooms::GeneratedRoomKind;

/// Smallest stretch of wall for a door with its frame and the wall beside it.
const DOOR_RUN: GridSteps = 24;
/// Smallest stretch for a wide opening.
const OPEN_RUN: GridSteps = 40;

/// The longest stretch between two rooms.
fn longest_shared_wall(runs: &[BoundarySegment], a: usize, b: Option<usize>) -> GridSteps {
    let between = runs.iter().filter(|run| run.separates(Some(a), b));
    between.map(|run| run.to - run.from).max().unwrap_or(0)
}

/// Connects the rooms of a storey; `None` when one cannot be reached.
pub(super) fn connect_rooms(
    rooms: &[GeneratedRoom],
    ground: bool,
    adjacency: &[[GeneratedRoomKind; 2]],
) -> Option<Vec<RoomConnection>> {
    use GeneratedRoomKind::{DiningRoom, Hallway, Kitchen, LivingRoom, Lobby, Studio};
    let runs = StoreyCells::new(rooms).boundaries();
    let of =
        |wanted: fn(GeneratedRoomKind) -> bool| rooms.iter().position(|room| wanted(room.kind));
    let hallway = of(|kind| kind == Hallway);
    let public = of(|kind| matches!(kind, LivingRoom | Lobby | Studio));
    // The room of the entrance, from which the others are reached.
    let hub = hallway.or(public).or((!rooms.is_empty()).then_some(0))?;
    let mut links = Vec::new();
    if ground {
        (longest_shared_wall(&runs, hub, None) >= DOOR_RUN).then_some(())?;
        links.push(RoomConnection {
            into: hub,
            from: None,
            kind: ConnectionKind::Door,
        });
    }
    for (k, room) in rooms.iter().enumerate().filter(|(k, _)| *k != hub) {
        let behind = matches!(room.kind, Kitchen | DiningRoom);
        let social = public.filter(|p| *p != k && behind);
        // Kitchens and dining rooms open wide to the living room where they touch it.
        if let Some(public) = social.filter(|p| longest_shared_wall(&runs, k, Some(*p)) >= OPEN_RUN)
        {
            links.push(RoomConnection {
                into: k,
                from: Some(public),
                kind: ConnectionKind::Open,
            });
        } else if longest_shared_wall(&runs, k, Some(hub)) >= DOOR_RUN {
            links.push(RoomConnection {
                into: k,
                from: Some(hub),
                kind: ConnectionKind::Door,
            });
        } else {
            return None;
        }
    }
    for [a, b] in adjacency {
        let pairs = (0..rooms.len()).flat_map(|p| (0..rooms.len()).map(move |q| (p, q)));
        let mut fitting = pairs.filter(|(p, q)| {
            p != q
                && rooms[*p].kind == *a
                && rooms[*q].kind == *b
                && longest_shared_wall(&runs, *p, Some(*q)) >= DOOR_RUN
        });
        let joined = |links: &[RoomConnection], p: usize, q: usize| {
            links.iter().any(|link| {
                (link.into, link.from) == (p, Some(q)) || (link.into, link.from) == (q, Some(p))
            })
        };
        if let Some((p, q)) = fitting.next()
            && !joined(&links, p, q)
        {
            links.push(RoomConnection {
                into: p,
                from: Some(q),
                kind: ConnectionKind::Door,
            });
        }
    }
    Some(links)
}

/// The pairs of kinds that should be connected and are not.
pub(super) fn missing_links(
    storeys: &[GeneratedStorey],
    adjacency: &[[GeneratedRoomKind; 2]],
) -> Vec<[GeneratedRoomKind; 2]> {
    let joined = |[a, b]: &[GeneratedRoomKind; 2]| {
        storeys.iter().any(|storey| {
            storey.connections.iter().any(|link| {
                let kinds = [
                    Some(storey.rooms[link.into].kind),
                    link.from.map(|from| storey.rooms[from].kind),
                ];
                kinds == [Some(*a), Some(*b)] || kinds == [Some(*b), Some(*a)]
            })
        })
    };
    adjacency
        .iter()
        .filter(|pair| !joined(pair))
        .copied()
        .collect()
}
