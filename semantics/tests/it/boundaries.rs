//! The thresholds of definitions, from both sides, in rooms made by hand.

use crate::common;

use common::Builder;
use dwell_scene::{
    AgentBody, AgentId, AgentState, House, MaterialId, ObjectId, Pose, RoomId, State,
};
use dwell_semantics::predicates::find;
use dwell_semantics::selections;
use dwell_semantics::{Semantics, Term, Truth, UndecidedReason, Viewer};
use glam::Vec3;
use std::sync::Arc;

/// A room of 8 m by 6 m and 2.5 m with what is put into it.
struct Stage {
    b: Builder,
    wood: MaterialId,
    room: RoomId,
}

/// A built stage, and questions about it.
struct Asked {
    house: Arc<House>,
    semantics: Semantics,
    state: State,
    viewer: Option<Viewer>,
}

impl Stage {
    fn new() -> Self {
        let mut b = Builder::new("stage");
        let room = b.room("kitchen", [0.0, 0.0], [8.0, 6.0]);
        let wood = b.material("wood", [150, 111, 72]);
        Self { b, wood, room }
    }

    /// A box by its corner at the lowest coordinates and its edges, m.
    fn block(&mut self, category: &str, at: [f32; 3], size: [f32; 3]) -> ObjectId {
        let to = std::array::from_fn(|k| at[k] + size[k]);
        self.b.thing(category, &[(at, to)], self.wood)
    }

    fn ask(self) -> Asked {
        let house = self.b.build();
        Asked {
            semantics: Semantics::new(&house),
            state: State::new(&house),
            house,
            viewer: None,
        }
    }
}

impl Asked {
    fn truth(&self, name: &str, args: &[Term]) -> Truth {
        let predicate = find(name).expect("it exists");
        let scene = self.semantics.scene(&self.state);
        predicate.holds(&scene, args, self.viewer.as_ref())
    }

    fn holds(&self, name: &str, a: ObjectId, b: ObjectId) -> bool {
        self.truth(name, &[Term::Object(a), Term::Object(b)])
            .is_true()
    }

    /// Somebody at a point who looks towards `yaw_rad`, rad to the left of -Z.
    fn look(&mut self, at: [f32; 3], yaw_rad: f32) {
        let world_from_camera = Pose::from_position_yaw(Vec3::from(at), yaw_rad);
        self.viewer = Some(Viewer { world_from_camera });
    }

    fn agent(&mut self, at: [f32; 3], yaw_rad: f32) -> Term {
        let agent = AgentState::new(AgentBody::default(), Vec3::from(at), yaw_rad);
        Term::Agent(self.state.agents.push(agent))
    }
}

/// Asks `name` of two blocks of 0.4 m, the second moved by `away` from where both would touch along X.
fn beside(name: &str, away: f32) -> bool {
    let mut stage = Stage::new();
    let a = stage.block("box", [0.5, 0.0, 2.0], [0.4, 0.4, 0.4]);
    let b = stage.block("box", [0.9 + away, 0.0, 2.0], [0.4, 0.4, 0.4]);
    stage.ask().holds(name, a, b)
}

#[test]
fn distances_count_up_to_their_thresholds() {
    assert!(beside("near", 1.19) && !beside("near", 1.21));
    assert!(beside("far", 3.71) && !beside("far", 3.69));
    assert!(beside("next_to", 0.49) && !beside("next_to", 0.51));
    assert!(beside("touching", 0.009) && !beside("touching", 0.011));
    assert!(beside("touching", -0.05), "they cut each other");
    assert!(beside("against", 0.055) && !beside("against", 0.065));
}

#[test]
fn above_and_on_part_at_three_centimetres() {
    let stacked = |gap: f32, aside: f32| {
        let mut stage = Stage::new();
        let lower = stage.block("box", [2.0, 0.0, 2.0], [0.6, 0.4, 0.6]);
        let upper = stage.block("box", [2.0 + aside, 0.4 + gap, 2.0], [0.6, 0.4, 0.6]);
        let asked = stage.ask();
        let holds = |name| asked.holds(name, upper, lower);
        let below = asked.holds("below", lower, upper);
        assert_eq!(holds("above"), below);
        assert_eq!(holds("on"), asked.holds("supports", lower, upper));
        (holds("on"), holds("above"))
    };
    assert_eq!(stacked(0.0, 0.0), (true, false));
    assert_eq!(stacked(0.028, 0.0), (true, false));
    assert_eq!(stacked(0.032, 0.0), (false, true));
    assert_eq!(
        stacked(1.0, 0.39),
        (false, true),
        "a third of the outline is shared"
    );
    assert_eq!(stacked(1.0, 0.41), (false, false));
}

#[test]
fn what_lies_in_a_bowl_is_in_it_and_what_lies_on_a_lid_is_on_it() {
    let mut stage = Stage::new();
    let wood = stage.wood;
    let bowl = stage
        .b
        .open_box("bowl", ([2.0, 0.0, 2.0], [2.4, 0.2, 2.4]), wood);
    let apple = stage.block("food", [2.1, 0.021, 2.1], [0.08, 0.08, 0.08]);
    let chest = stage.block("box", [4.0, 0.0, 2.0], [0.4, 0.2, 0.4]);
    let board = stage.block("cutting_board", [4.05, 0.2, 2.05], [0.3, 0.02, 0.3]);
    let asked = stage.ask();
    assert!(asked.holds("in", apple, bowl) && !asked.holds("on", apple, bowl));
    assert!(asked.holds("on", board, chest) && !asked.holds("in", board, chest));
    assert!(asked.holds("contains", bowl, apple) && !asked.holds("contains", chest, board));
    assert_eq!(asked.truth("empty", &[Term::Object(chest)]), Truth::True);
    assert_eq!(asked.truth("empty", &[Term::Object(bowl)]), Truth::False);
    assert_eq!(asked.truth("full", &[Term::Object(bowl)]), Truth::False);
}

#[test]
fn a_container_is_full_from_half_its_space() {
    let full = |edge: f32| {
        let mut stage = Stage::new();
        let wood = stage.wood;
        let bowl = stage
            .b
            .open_box("bowl", ([2.0, 0.0, 2.0], [2.4, 0.4, 2.4]), wood);
        stage.block("food", [2.03, 0.021, 2.03], [edge, edge, edge]);
        let asked = stage.ask();
        asked.truth("full", &[Term::Object(bowl)]).is_true()
    };
    // 0.4 to the power of three is 0.064 m³; the cubes have 0.0328 and 0.0314.
    assert!(full(0.32) && !full(0.3155));
}

#[test]
fn under_means_covered_by_half() {
    let under = |aside: f32| {
        let mut stage = Stage::new();
        let wood = stage.wood;
        let table = stage.b.table([2.0, 2.0], [3.4, 2.9], 0.75, wood);
        let chest = stage.block("box", [3.0 + aside, 0.0, 2.3], [0.4, 0.3, 0.3]);
        let asked = stage.ask();
        assert!(!asked.holds("under", table, chest));
        asked.holds("under", chest, table)
    };
    // 32 points stand for the sole.
    assert!(under(-0.1) && under(0.14) && !under(0.26));
}

#[test]
fn sides_of_a_wall_and_corners() {
    let mut stage = Stage::new();
    let along = stage.block("sofa", [2.0, 0.0, 0.03], [2.0, 0.8, 0.9]);
    let off = stage.block("sofa", [5.0, 0.0, 0.2], [2.0, 0.8, 0.9]);
    let corner = stage.block("floor_lamp", [0.3, 0.0, 5.2], [0.4, 1.5, 0.5]);
    let away = stage.block("floor_lamp", [0.55, 0.0, 4.5], [0.4, 1.5, 0.5]);
    let middle = stage.block("rug", [3.4, 0.0, 2.6], [1.2, 0.01, 0.8]);
    let room = stage.room;
    let asked = stage.ask();
    let wall = |thing| {
        let walls = asked.house.structure.ids().map(Term::Structure);
        walls
            .filter(|wall| {
                asked
                    .truth("against", &[Term::Object(thing), *wall])
                    .is_true()
            })
            .count()
    };
    assert_eq!((wall(along), wall(off)), (1, 0));
    let in_room = |name, thing| {
        asked
            .truth(name, &[Term::Object(thing), Term::Room(room)])
            .is_true()
    };
    assert!(in_room("in_corner_of", corner) && !in_room("in_corner_of", away));
    assert!(!in_room("in_corner_of", middle) && !in_room("in_corner_of", along));
    assert!(in_room("in_middle_of", middle) && !in_room("in_middle_of", corner));
    assert!(!in_room("in_middle_of", off));
}

#[test]
fn between_needs_135_degrees() {
    let between = |z: f32| {
        let mut stage = Stage::new();
        let a = stage.block("box", [1.0, 0.0, 2.0], [0.1, 0.4, 0.1]);
        let b = stage.block("box", [3.0, 0.0, 2.0], [0.1, 0.4, 0.1]);
        let c = stage.block("box", [2.0, 0.0, 2.0 + z], [0.1, 0.4, 0.1]);
        let asked = stage.ask();
        let args = [c, a, b].map(Term::Object);
        assert!(
            !asked
                .truth("between", &[args[1], args[0], args[2]])
                .is_true()
        );
        asked.truth("between", &args).is_true()
    };
    // The nearest corners lie 0.95 m aside; tan 22.5 degrees is 0.414.
    assert!(between(0.0) && between(0.43) && !between(0.46));
}

#[test]
fn fronts_are_those_of_things_and_sides_those_of_viewers() {
    let mut stage = Stage::new();
    // Models look along +Z.
    let sofa = stage.block("sofa", [3.0, 0.0, 1.0], [2.0, 0.8, 0.9]);
    let before = stage.block("coffee_table", [3.5, 0.0, 2.5], [1.0, 0.4, 0.6]);
    let aside = stage.block("floor_lamp", [5.4, 0.0, 1.2], [0.3, 1.5, 0.3]);
    let back = stage.block("box", [3.8, 0.0, 0.3], [0.4, 0.4, 0.4]);
    let mut asked = stage.ask();
    assert!(asked.holds("at_front_of", before, sofa) && !asked.holds("at_back_of", before, sofa));
    assert!(asked.holds("at_back_of", back, sofa) && !asked.holds("at_front_of", back, sofa));
    assert!(!asked.holds("at_front_of", aside, sofa) && !asked.holds("at_back_of", aside, sofa));
    assert!(asked.holds("facing", sofa, before) && !asked.holds("facing", sofa, back));
    assert_eq!(
        asked.truth("facing", &[Term::Object(before), Term::Object(sofa)]),
        Truth::Undecided(UndecidedReason::NoFront)
    );
    // From behind the sofa it is the box that is in front of it.
    asked.look([4.0, 1.4, -2.0], std::f32::consts::PI);
    assert!(asked.holds("in_front_of", back, sofa) && asked.holds("behind", before, sofa));
    assert!(!asked.holds("in_front_of", aside, sofa) && !asked.holds("behind", aside, sofa));
    // It looks along +Z, so that +X is at its left.
    assert!(asked.holds("left_of", aside, sofa) && asked.holds("right_of", sofa, aside));
    asked.look([4.0, 1.4, 5.5], 0.0);
    assert!(asked.holds("in_front_of", before, sofa) && asked.holds("behind", back, sofa));
    assert!(asked.holds("right_of", aside, sofa));
}

#[test]
fn what_lies_ahead_of_a_front_is_opposite() {
    // A sofa with its face at z = 1.9 and its width from x = 3 to 5.
    let opposite = |category: &str, x: f32, z: f32| {
        let mut stage = Stage::new();
        let sofa = stage.block("sofa", [3.0, 0.0, 1.0], [2.0, 0.8, 0.9]);
        let other = stage.block(category, [x, 0.0, z], [1.0, 0.4, 0.6]);
        let asked = stage.ask();
        let holds = asked.holds("opposite", other, sofa);
        assert_eq!(holds, asked.holds("opposite", sofa, other));
        holds
    };
    // A table has no front: the gap and the common half of its width decide.
    assert!(opposite("coffee_table", 3.5, 2.41) && !opposite("coffee_table", 3.5, 2.39));
    assert!(opposite("coffee_table", 4.49, 3.0) && !opposite("coffee_table", 4.51, 3.0));
    assert!(!opposite("coffee_table", 3.5, 0.0));
    // A second sofa looks along +Z, too: away from the first.
    assert!(!opposite("sofa", 3.5, 3.0));
}

#[test]
fn without_fronts_the_halves_of_a_room_are_opposite() {
    // The middle of the room lies at z = 3.
    let opposite = |z: f32| {
        let mut stage = Stage::new();
        let a = stage.block("box", [3.5, 0.0, z - 0.2], [1.0, 0.4, 0.4]);
        let b = stage.block("box", [3.5, 0.0, 5.0], [1.0, 0.4, 0.4]);
        stage.ask().holds("opposite", a, b)
    };
    assert!(opposite(1.0) && opposite(2.99) && !opposite(3.01));
}

#[test]
fn an_agent_faces_what_is_within_30_degrees() {
    let faces = |degrees: f32| {
        let mut stage = Stage::new();
        let thing = stage.block("box", [3.9, 0.0, 1.9], [0.2, 0.4, 0.2]);
        let mut asked = stage.ask();
        let agent = asked.agent([4.0, 0.0, 5.0], degrees.to_radians());
        asked
            .truth("facing", &[agent, Term::Object(thing)])
            .is_true()
    };
    assert!(faces(29.0) && !faces(31.0) && faces(-29.0) && !faces(180.0));
}

#[test]
fn sizes_differ_from_a_tenth() {
    let compare = |name: &str, factor: f32| {
        let mut stage = Stage::new();
        let a = stage.block(
            "box",
            [1.0, 0.0, 1.0],
            [0.4 * factor, 0.4 * factor, 0.4 * factor],
        );
        let b = stage.block("box", [3.0, 0.0, 1.0], [0.4, 0.4, 0.4]);
        stage.ask().holds(name, a, b)
    };
    for name in ["larger_than", "taller_than", "wider_than"] {
        assert!(compare(name, 1.11) && !compare(name, 1.09), "{name}");
        assert!(!compare(name, 0.9), "{name}");
    }
}

#[test]
fn walls_hide_and_doors_bar_the_way() {
    let mut stage = Stage::new();
    let seen = stage.block("box", [6.0, 0.0, 0.3], [0.4, 0.4, 0.4]);
    let screen = stage.block("wardrobe_cabinet", [3.5, 0.0, 2.0], [0.3, 2.4, 2.0]);
    let hidden = stage.block("box", [6.0, 0.0, 2.9], [0.2, 0.2, 0.2]);
    let high = stage.block("box", [6.0, 2.3, 4.5], [0.1, 0.1, 0.1]);
    let mut far = stage.b;
    let other = far.room("bedroom", [0.0, 6.5], [8.0, 8.0]);
    let across = far.thing("box", &[([6.0, 0.0, 7.0], [6.4, 0.4, 7.4])], stage.wood);
    let house = far.build();
    let mut asked = Asked {
        semantics: Semantics::new(&house),
        state: State::new(&house),
        house,
        viewer: None,
    };
    let agent = asked.agent([1.0, 0.0, 3.0], -std::f32::consts::FRAC_PI_2);
    let from =
        |name: &str, thing: ObjectId| asked.truth(name, &[Term::Object(thing), agent]).is_true();
    assert!(from("visible_from", seen) && from("visible_from", screen));
    assert!(!from("visible_from", hidden) && !from("visible_from", across));
    assert!(from("reachable", seen) && from("reachable", hidden) && from("reachable", screen));
    assert!(from("reachable", high), "1.1 m above the eyes");
    assert!(!from("reachable", across));
    let room = |room| {
        asked
            .truth("reachable", &[Term::Room(room), agent])
            .is_true()
    };
    assert!(room(stage.room) && !room(other));
    let viewer = Viewer::of_agent(&asked.state, AgentId(0)).unwrap();
    let sees = |yaw_rad: f32| {
        let mut turned = viewer;
        turned.world_from_camera =
            Pose::from_position_yaw(viewer.world_from_camera.position, yaw_rad);
        let scene = asked.semantics.scene(&asked.state);
        let visible = find("visible").unwrap();
        visible
            .holds(&scene, &[Term::Object(screen)], Some(&turned))
            .is_true()
    };
    assert!(sees(-1.5) && !sees(1.5));
}

#[test]
fn the_nth_of_an_order_is_told_apart_or_not_at_all() {
    let mut stage = Stage::new();
    let row: Vec<ObjectId> = [1.0, 2.0, 3.0, 3.05]
        .iter()
        .map(|x| stage.block("cup", [*x, 0.0, 2.0], [0.1, 0.1, 0.1]))
        .collect();
    let large = stage.block("box", [5.0, 0.0, 2.0], [0.5, 0.5, 0.5]);
    let asked = stage.ask();
    let scene = asked.semantics.scene(&asked.state);
    let viewer = Viewer {
        world_from_camera: Pose::from_position_yaw(Vec3::new(2.0, 1.4, 5.0), 0.0),
    };
    let cups: Vec<Term> = row.iter().map(|id| Term::Object(*id)).collect();
    let nth = |name: &str, n: usize, reference: Option<Term>| {
        let selection = selections::find(name).unwrap();
        selection.select(&scene, &cups, n, reference, Some(&viewer))
    };
    assert_eq!(nth("from_left", 1, None), Ok(cups[0]));
    assert_eq!(nth("from_left", 2, None), Ok(cups[1]));
    assert_eq!(nth("from_left", 3, None), Err(UndecidedReason::TooClose));
    assert_eq!(nth("from_right", 3, None), Ok(cups[1]));
    assert_eq!(nth("from_left", 5, None), Err(UndecidedReason::TooFew));
    assert_eq!(nth("from_left", 0, None), Err(UndecidedReason::TooFew));
    let box_ = Some(Term::Object(large));
    assert_eq!(nth("farthest_from", 1, box_), Ok(cups[0]));
    assert_eq!(nth("closest_to", 1, box_), Err(UndecidedReason::TooClose));
    assert_eq!(nth("closest_to", 3, box_), Ok(cups[1]));
    assert_eq!(
        nth("closest_to", 1, None),
        Err(UndecidedReason::NoReference)
    );
    assert_eq!(nth("largest", 1, None), Err(UndecidedReason::TooClose));
    let all: Vec<Term> = cups.iter().copied().chain([Term::Object(large)]).collect();
    for name in ["largest", "tallest", "widest", "highest"] {
        let found = selections::find(name)
            .unwrap()
            .select(&scene, &all, 1, None, None);
        assert_eq!(found, Ok(Term::Object(large)), "{name}");
    }
    let blind = selections::find("nearest")
        .unwrap()
        .select(&scene, &all, 1, None, None);
    assert_eq!(blind, Err(UndecidedReason::NoViewer));
    let mut names: Vec<&str> = selections::all().iter().map(|s| s.name()).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), 12);
    assert!(
        selections::all()
            .iter()
            .all(|s| s.margin() > 0.0 && s.definition().ends_with('.'))
    );
    let unknown = selections::find("middle").err().unwrap();
    assert!(
        unknown
            .to_string()
            .starts_with("no selection \"middle\"; there are [\"from_left\"")
    );
}

#[test]
fn a_thing_hangs_on_one_mount_and_doors_and_windows_are_set_in_walls() {
    let mut stage = Stage::new();
    let picture = stage.block("picture_frame", [0.01, 1.3, 0.01], [0.03, 0.4, 0.4]);
    let glass = stage.b.material("glass", [200, 220, 225]);
    let window = stage
        .b
        .thing("window", &[([2.0, 0.9, -0.05], [3.0, 2.0, 0.0])], glass);
    let asked = stage.ask();
    let walls = |name: &str, thing: ObjectId| {
        let walls = asked.house.structure.ids().map(Term::Structure);
        walls
            .filter(|wall| asked.truth(name, &[Term::Object(thing), *wall]).is_true())
            .count()
    };
    assert_eq!(
        (walls("hangs_on", picture), walls("attached_to", picture)),
        (1, 1)
    );
    assert_eq!(
        (walls("hangs_on", window), walls("attached_to", window)),
        (0, 1)
    );
    let part = Term::Part(asked.house.objects[picture].first_part);
    assert!(
        asked
            .truth("attached_to", &[part, Term::Object(picture)])
            .is_true()
    );
    assert!(
        !asked
            .truth("attached_to", &[part, Term::Object(window)])
            .is_true()
    );
}

#[test]
fn closer_differs_from_a_tenth() {
    let closer = |near: f32, far: f32| {
        let mut stage = Stage::new();
        let thing = stage.block("box", [3.0, 0.0, 2.0], [0.4, 0.4, 0.4]);
        let left = stage.block("box", [2.6 - near, 0.0, 2.0], [0.4, 0.4, 0.4]);
        let right = stage.block("box", [3.4 + far, 0.0, 2.0], [0.4, 0.4, 0.4]);
        let terms = [thing, left, right].map(Term::Object);
        let asked = stage.ask();
        let [a, b, c] = terms;
        assert!(!asked.truth("closer_to", &[a, c, b]).is_true());
        assert!(!asked.truth("closer_to", &[a, a, b]).is_true());
        asked.truth("closer_to", &[a, b, c]).is_true()
    };
    assert!(closer(1.0, 1.11) && !closer(1.0, 1.09));
    assert!(closer(0.0, 0.1) && !closer(0.0, 0.0), "contact");
}

#[test]
fn the_end_of_a_room_is_the_quarter_far_from_the_viewer() {
    let mut stage = Stage::new();
    let room = Term::Room(stage.room);
    // The room is 8 m long; its last quarters begin at 2 m and 6 m.
    let ids = [1.95, 2.05, 5.95, 6.05].map(|x| {
        let id = stage.block("box", [x - 0.1, 0.0, 3.0], [0.2, 0.4, 0.2]);
        Term::Object(id)
    });
    let mut asked = stage.ask();
    let ends = |asked: &Asked| ids.map(|id| asked.truth("at_end_of", &[id, room]).is_true());
    assert_eq!(ends(&asked), [true, false, false, true]);
    asked.look([1.0, 1.5, 3.0], 0.0);
    assert_eq!(ends(&asked), [false, false, false, true]);
    asked.look([7.0, 1.5, 3.0], 0.0);
    assert_eq!(ends(&asked), [true, false, false, false]);
}

#[test]
fn a_thing_has_what_is_on_it_and_in_it() {
    let mut stage = Stage::new();
    let table = stage.block("table", [2.0, 0.0, 2.0], [1.0, 0.7, 1.0]);
    let cup = stage.block("cup", [2.4, 0.7, 2.4], [0.1, 0.1, 0.1]);
    let chair = stage.block("chair", [3.2, 0.0, 2.2], [0.5, 0.9, 0.5]);
    let asked = stage.ask();
    assert!(asked.holds("has", table, cup) && asked.holds("belongs_to", cup, table));
    assert!(!asked.holds("has", cup, table) && !asked.holds("belongs_to", table, cup));
    assert!(!asked.holds("has", table, chair) && !asked.holds("belongs_to", chair, table));
}

#[test]
fn walls_hide_a_room_from_another() {
    let house = common::small_house().house;
    let (semantics, state) = (Semantics::new(&house), State::new(&house));
    let scene = semantics.scene(&state);
    let predicate = find("visible_from_room").expect("it exists");
    let mut both = [0, 0];
    for room in house.rooms.ids() {
        for id in house.objects.ids() {
            let seen = predicate.holds(&scene, &[Term::Object(id), Term::Room(room)], None);
            let own = scene.room_of(id) == Some(room);
            // What stands in the open is seen from its own room.
            if own && !semantics.facts(id).noun.contains("cup") {
                both[usize::from(seen.is_true())] += 1;
            }
        }
        let itself = predicate.holds(&scene, &[Term::Room(room), Term::Room(room)], None);
        assert!(itself.is_true());
    }
    assert!(both[1] > 5 * both[0], "{both:?}");
    let rooms: Vec<Term> = house.rooms.ids().map(Term::Room).collect();
    for a in &rooms {
        for b in &rooms {
            let [to, back] = [[*a, *b], [*b, *a]].map(|pair| predicate.holds(&scene, &pair, None));
            assert_eq!(to, back, "{a:?} {b:?}");
        }
    }
}
