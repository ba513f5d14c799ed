//! The mounts of hanging things: walls, ceilings, windows.

use crate::scene::{MOST_NEAR, SemanticScene, SupportShare, Term};
use dwell_scene::{Mobility, ObjectId, StructureId, StructureKind};

/// The largest gap between a thing and the wall or ceiling it hangs on, m.
const WALL_GAP_M: f32 = 0.06;
/// Smallest height above a wall's foot at which a thing hangs on it, m.
const CLEARANCE_M: f32 = 0.1;
/// The largest distance from above between a window and the cloth before it, m.
const WINDOW_GAP_M: f32 = 0.3;
/// The least vertical overlap of a window and the cloth before it, as share of the smaller height.
const WINDOW_SHARE: f32 = 0.3;
/// The gap from which a thing is above a surface without touching it, m.
const ABOVE_M: f32 = 0.01;
/// Thickness below which a thing falls over unless something holds it, m.
const FLAT_M: f32 = 0.08;
/// Height above which a thing of cloth is held from above, m.
const UPRIGHT_M: f32 = 0.3;

/// Kinds that the table marks as mounted but that can also stand: on a sink, on the floor.
const MAY_STAND: [&str; 3] = ["tap", "heater", "soap_dish"];
/// Kinds that either hang or lean.
const MAY_LEAN: [&str; 4] = ["picture_frame", "mirror", "clock", "rifle"];

fn is_cloth(scene: &SemanticScene<'_>, thing: ObjectId) -> bool {
    let row = scene.facts(thing).category;
    row.is_some_and(|row| ["curtain", "blinds"].contains(&row.name))
}

/// Returns whether a thing hangs although there are surfaces below it, which only touch it or lie close under it.
///
/// This holds for upright cloth. It also holds for things that the table marks as mounted, near a wall or a ceiling, if they end
/// a centimetre or more above the surfaces, or are fixed in place and of a kind that never stands, or are fixed and too flat to
/// stand.
pub(super) fn hangs_despite_support(
    scene: &SemanticScene<'_>,
    thing: ObjectId,
    supports: &[SupportShare],
) -> bool {
    let facts = scene.facts(thing);
    let Some(row) = facts.category.filter(|row| row.mounted) else {
        return false;
    };
    if supports.is_empty() {
        return true;
    }
    let size = scene.extent(thing).bounds.size();
    if is_cloth(scene, thing) && size.y >= UPRIGHT_M && size.y > size.x.min(size.z) {
        return true;
    }
    // A thing that stands in a shelf may be near the wall behind it.
    let (house, inner) = (scene.house(), scene.extent(thing).bounds);
    let stands_in = |support: &SupportShare| {
        let by = support.by.object();
        by.is_some_and(|by| house.encloses(scene.state, by, &scene.extent(by).bounds, &inner))
    };
    if pieces_at(scene, thing).next().is_none() || supports.iter().any(stands_in) {
        return false;
    }
    let above = supports.iter().all(|support| support.gap_m >= ABOVE_M);
    let fixed = house.objects[thing].mobility != Mobility::Movable;
    let flat = facts.extents_m.min_element() < FLAT_M;
    above || (fixed && !MAY_STAND.contains(&row.name) && (flat || !MAY_LEAN.contains(&row.name)))
}

/// The structure pieces from which a thing may hang, ascending.
fn pieces_at(scene: &SemanticScene<'_>, thing: ObjectId) -> impl Iterator<Item = StructureId> {
    let reach = scene.extent(thing).bounds.grown(WALL_GAP_M);
    let pieces = scene.semantics.structures_in_box(&reach);
    pieces.filter(move |piece| is_at(scene, thing, *piece))
}

/// Returns whether a thing is so near to a wall, at its height, or so close under a ceiling, that it may hang there.
fn is_at(scene: &SemanticScene<'_>, thing: ObjectId, piece: StructureId) -> bool {
    let extent = scene.extent(thing);
    let bounds = scene.semantics.structure_bounds(piece);
    if !extent.bounds.grown(WALL_GAP_M).intersects(bounds) {
        return false;
    }
    let outline = scene.semantics.structure_outline(piece);
    match scene.house().structure[piece].kind {
        StructureKind::Wall => {
            // Curtains reach the floor.
            let foot = bounds.min.y + CLEARANCE_M;
            let at_height = (extent.bottom_m() >= foot || is_cloth(scene, thing))
                && extent.bottom_m() < bounds.max.y;
            at_height && extent.footprint.distance(outline) <= WALL_GAP_M
        }
        StructureKind::Ceiling => {
            (extent.bounds.max.y - bounds.min.y).abs() <= WALL_GAP_M
                && extent.footprint.overlap_m2(outline) >= 0.5 * extent.footprint.area_m2()
        }
        _ => false,
    }
}

/// Returns whether cloth hangs before a window: in its room, at its height, at most 0.3 m away from above.
fn is_before(scene: &SemanticScene<'_>, cloth: ObjectId, window: ObjectId) -> bool {
    let is_window = |row: &crate::category::SemanticCategory| row.name == "window";
    if cloth == window
        || !is_cloth(scene, cloth)
        || !scene.facts(window).category.is_some_and(is_window)
    {
        return false;
    }
    let (p, q) = (scene.extent(cloth), scene.extent(window));
    let shared = p.bounds.max.y.min(q.bounds.max.y) - p.bounds.min.y.max(q.bounds.min.y);
    let lower = p.bounds.size().y.min(q.bounds.size().y);
    let room = scene.room_of(window);
    shared >= WINDOW_SHARE * lower
        && p.footprint.distance(&q.footprint) <= WINDOW_GAP_M
        && (room.is_none() || room == scene.room_of(cloth))
}

/// The candidate mounts of `thing`: windows, then structure pieces, each ascending.
fn candidate_mounts(scene: &SemanticScene<'_>, thing: ObjectId) -> Vec<Term> {
    if scene.holder(thing).is_some() || !scene.supporting_surfaces(thing).is_empty() {
        return Vec::new();
    }
    let windows = if is_cloth(scene, thing) {
        let reach = scene.extent(thing).bounds.grown(WINDOW_GAP_M + 0.01);
        scene.objects_near(&reach, MOST_NEAR, |window| is_before(scene, thing, window))
    } else {
        Vec::new()
    };
    let windows = windows.into_iter().map(Term::Object);
    windows
        .chain(pieces_at(scene, thing).map(Term::Structure))
        .collect()
}

/// Returns the mount of `thing`: the nearest window for cloth, else the nearest wall, else a ceiling; the first where several are
/// equally near. Doors and windows are part of their walls and have no mount.
pub(crate) fn mount_of(scene: &SemanticScene<'_>, thing: ObjectId) -> Option<Term> {
    let mount = &scene.cache(thing).mount;
    *mount.get_or_init(|| find_mount(scene, thing))
}

fn find_mount(scene: &SemanticScene<'_>, thing: ObjectId) -> Option<Term> {
    if scene.facts(thing).belongs_to_opening() && !is_cloth(scene, thing) {
        return None;
    }
    let here = &scene.extent(thing).footprint;
    let away_m = |mount: &Term| match *mount {
        Term::Object(window) => here.distance(&scene.extent(window).footprint),
        Term::Structure(piece) => here.distance(scene.semantics.structure_outline(piece)),
        _ => f32::MAX,
    };
    let rank = |mount: &Term| match *mount {
        Term::Structure(piece) => match scene.house().structure[piece].kind {
            StructureKind::Ceiling => 2,
            _ => 1,
        },
        _ => 0,
    };
    candidate_mounts(scene, thing).into_iter().min_by(|p, q| {
        let by_rank = rank(p).cmp(&rank(q));
        by_rank.then_with(|| away_m(p).total_cmp(&away_m(q)))
    })
}
