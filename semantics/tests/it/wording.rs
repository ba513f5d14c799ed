//! Wording of sentences: for each rule a house where it says its words, and one where it must not.

use crate::common;

use common::{Builder, Corners, fix};
use dwell_scene::{
    AgentBody, AgentId, AgentState, MaterialId, Mesh, ObjectId, RoomId, State, StructureKind,
};
use dwell_semantics::check::{Addressee, Checker};
use dwell_semantics::describe::{
    TextOptions, caption, describe_house, describe_room, describe_view,
};
use dwell_semantics::form::Form;
use dwell_semantics::refer::refer;
use dwell_semantics::{Semantics, Term, predicates};
use glam::Vec3;
use std::sync::Arc;

/// A house and how it starts.
struct Told {
    semantics: Semantics,
    state: State,
}

impl Told {
    fn of(builder: Builder) -> Self {
        let house = builder.build();
        Self {
            semantics: Semantics::new(&house),
            state: State::new(&house),
        }
    }

    fn caption(&self, object: ObjectId) -> String {
        caption(
            &self.semantics.scene(&self.state),
            object,
            TextOptions::default(),
        )
        .text
    }

    fn room(&self, room: RoomId) -> String {
        describe_room(
            &self.semantics.scene(&self.state),
            room,
            TextOptions::default(),
        )
        .text
    }

    fn holds(&self, name: &str, thing: ObjectId, other: Term) -> bool {
        let predicate = predicates::find(name).expect("it exists");
        let scene = self.semantics.scene(&self.state);
        predicate
            .holds(&scene, &[Term::Object(thing), other], None)
            .is_true()
    }

    /// Returns what is said to tell a thing from others means that thing alone.
    fn refers(&self, object: ObjectId) -> String {
        let scene = self.semantics.scene(&self.state);
        let expression = refer(&scene, object).expect("it can be told apart");
        let checker = Checker::new(&scene, Addressee::default());
        assert_eq!(checker.matching_terms(&expression), [Term::Object(object)]);
        let form = Form::NounPhrase(expression.into());
        let said = self.semantics.language().say(&form, None);
        said.expect("the language has words for it").text
    }
}

/// Sky, leaves and a red roof, a third each.
fn motley(_: usize, y: usize) -> [u8; 3] {
    [[150, 190, 230], [40, 110, 50], [180, 30, 30]][y / 16]
}

/// A table at the window, and a sofa before the wall across.
struct Hung {
    told: Told,
    window: ObjectId,
    table: ObjectId,
    sofa: ObjectId,
    room: RoomId,
    things: Vec<ObjectId>,
}

fn hung(things: impl Fn(&mut Builder) -> Vec<ObjectId>) -> Hung {
    let mut b = Builder::new("hung");
    let room = b.room("bedroom", [0.05, 0.05], [3.95, 3.95]);
    let wood = b.material("wood", [150, 111, 72]);
    let cloth = b.material("textile", [30, 60, 150]);
    let glass = b.material("double_glazing", [250; 3]);
    let window = b.thing("window", &[([1.0, 0.9, 0.0], [2.2, 2.1, 0.06])], glass);
    b.data.objects[window].room = Some(room);
    fix(&mut b, window);
    let table = b.table([1.0, 0.08], [2.2, 0.7], 0.74, wood);
    let sofa = b.thing("sofa", &[([1.0, 0.0, 3.0], [3.0, 0.85, 3.94])], cloth);
    let things = things(&mut b);
    Hung {
        told: Told::of(b),
        window,
        table,
        sofa,
        room,
        things,
    }
}

/// With a second window the curtain hangs at one of the two; "at the window" is said of any, as "on the wall" is.
#[test]
fn a_curtain_hangs_at_a_window_among_others() {
    let s = hung(|b| {
        let cloth = b.material("light_curtain", [250, 250, 250]);
        let glass = b.material("double_glazing", [250; 3]);
        let curtain = b.thing("curtain", &[([0.9, 0.75, 0.08], [2.3, 2.3, 0.2])], cloth);
        let other = b.thing("window", &[([2.8, 0.9, 0.0], [3.5, 2.1, 0.06])], glass);
        b.data.objects[other].room = Some(RoomId(0));
        fix(b, other);
        vec![curtain, other]
    });
    assert_eq!(
        s.told.caption(s.things[0]),
        "a white curtain at the window in the bedroom"
    );
    let other = Term::Object(s.things[1]);
    assert!(
        s.told
            .holds("hangs_on", s.things[0], Term::Object(s.window))
            && !s.told.holds("hangs_on", s.things[0], other)
    );
    let text = s.told.room(s.room);
    assert!(
        text.contains("There is a white curtain at the window in the bedroom."),
        "{text}"
    );
}

#[test]
fn curtains_hang_at_windows_and_pictures_on_walls() {
    let s = hung(|b| {
        let cloth = b.material("light_curtain", [250, 250, 250]);
        let paper = b.material("paper", [235, 215, 60]);
        let metal = b.material("steel", [250, 250, 250]);
        // The hem a centimetre above the table, the frame two above the sofa.
        let curtain = b.thing("curtain", &[([0.9, 0.75, 0.08], [2.3, 2.3, 0.2])], cloth);
        let picture = b.thing(
            "picture_frame",
            &[([1.5, 0.87, 3.91], [2.1, 1.4, 3.94])],
            paper,
        );
        let lamp = b.thing("wall_lamp", &[([3.0, 1.7, 3.85], [3.2, 1.9, 3.94])], metal);
        let ceiling_lamp = b.thing(
            "chandelier",
            &[([1.75, 2.15, 1.75], [2.25, 2.5, 2.25])],
            metal,
        );
        let fan = b.thing("fan", &[([2.9, 2.2, 1.5], [3.5, 2.5, 2.1])], metal);
        for thing in [picture, lamp, ceiling_lamp, fan] {
            fix(b, thing);
        }
        vec![curtain, picture, lamp, ceiling_lamp, fan]
    });
    let [curtain, picture, lamp, ceiling_lamp, fan] = s.things[..] else {
        unreachable!("five things were made");
    };
    let told = &s.told;
    assert!(!told.holds("on", curtain, Term::Object(s.table)));
    assert!(told.holds("hangs_on", curtain, Term::Object(s.window)));
    assert!(!told.holds("on", picture, Term::Object(s.sofa)));
    assert!(!told.holds("hangs_on", picture, Term::Object(s.window)));
    let captions = [
        (curtain, "a white curtain at the window in the bedroom"),
        (picture, "a yellow picture on the wall in the bedroom"),
        // The noun says it.
        (lamp, "a white steel wall lamp in the bedroom"),
        (ceiling_lamp, "a white steel ceiling lamp in the bedroom"),
        (fan, "a white steel fan on the ceiling in the bedroom"),
    ];
    for (thing, text) in captions {
        assert_eq!(told.caption(thing), text);
        told.refers(thing);
    }
    let text = told.room(s.room);
    for clause in [
        " There is a yellow picture on the wall in the bedroom.",
        " There is a white steel fan on the ceiling in the bedroom.",
        " There is a white curtain at the window in the bedroom.",
    ] {
        assert!(text.contains(clause), "{text}");
    }
    assert!(
        !text.contains("On the table") && !text.contains("On the sofa"),
        "{text}"
    );
}

#[test]
fn what_lies_or_leans_does_not_hang() {
    let s = hung(|b| {
        let cloth = b.material("light_curtain", [250, 250, 250]);
        let paper = b.material("paper", [235, 215, 60]);
        // A folded curtain, a loose picture that stands on the sofa's back, a mirror on the floor, a tap that stands.
        let metal = b.material("steel", [250, 250, 250]);
        let curtain = b.thing("curtain", &[([1.2, 0.74, 0.2], [1.6, 0.8, 0.6])], cloth);
        let picture = b.thing(
            "picture_frame",
            &[([1.5, 0.85, 3.9], [2.1, 1.3, 3.94])],
            paper,
        );
        let mirror = b.thing("mirror", &[([3.3, 0.0, 3.91], [3.8, 1.6, 3.94])], paper);
        let tap = b.thing("tap", &[([2.0, 0.74, 0.1], [2.06, 0.9, 0.2])], metal);
        fix(b, mirror);
        fix(b, tap);
        vec![curtain, picture, mirror, tap]
    });
    let [curtain, picture, mirror, tap] = s.things[..] else {
        unreachable!("four things were made");
    };
    assert!(s.told.holds("on", curtain, Term::Object(s.table)));
    assert!(!s.told.holds("hangs_on", curtain, Term::Object(s.window)));
    assert!(s.told.holds("on", picture, Term::Object(s.sofa)));
    assert!(s.told.holds("on", tap, Term::Object(s.table)));
    assert!(!s.told.caption(mirror).contains("on the wall"));
    let text = s.told.room(s.room);
    assert!(
        text.contains(" There is a yellow picture on the sofa."),
        "{text}"
    );
    for wrong in [
        "hang",
        "on the wall",
        "On the wall",
        "at the window",
        "ceiling",
    ] {
        assert!(!text.contains(wrong), "{text}");
    }
}

#[test]
fn things_on_several_walls_are_on_the_wall() {
    let s = hung(|b| {
        let paper = b.material("paper", [235, 215, 60]);
        let one = b.thing(
            "picture_frame",
            &[([3.2, 1.4, 0.06], [3.6, 1.9, 0.09])],
            paper,
        );
        let other = b.thing(
            "picture_frame",
            &[([1.5, 1.4, 3.91], [2.1, 1.9, 3.94])],
            paper,
        );
        fix(b, one);
        fix(b, other);
        vec![one, other]
    });
    let text = s.told.room(s.room);
    assert!(
        text.contains("There are two yellow pictures on the wall in the bedroom."),
        "{text}"
    );
}

#[test]
fn one_is_on_a_balcony_and_in_a_kitchen() {
    let mut b = Builder::new("places");
    let places = [
        ("balcony", 0.0, 0.0),
        ("kitchen", 4.0, 0.0),
        ("roof", 0.0, 4.0),
        ("observatory", 4.0, 4.0),
    ];
    let leaves = b.material("leaves", [40, 110, 50]);
    let plants = places.map(|(kind, x, z)| {
        b.room(kind, [x + 0.05, z + 0.05], [x + 3.95, z + 3.95]);
        b.thing(
            "plant",
            &[([x + 1.0, 0.0, z + 1.0], [x + 1.4, 0.8, z + 1.4])],
            leaves,
        )
    });
    let told = Told::of(b);
    let expected = [
        "on the balcony",
        "in the kitchen",
        "on the roof terrace",
        "in the observatory",
    ];
    for (plant, place) in plants.into_iter().zip(expected) {
        assert_eq!(told.caption(plant), format!("a green plant {place}"));
        assert_eq!(told.refers(plant), format!("the plant {place}"));
    }
    let view = |x: f32| {
        let mut state = told.state.clone();
        let feet = Vec3::new(x, 0.0, 3.0);
        let agent = AgentState::new(AgentBody::default(), feet, 0.0);
        state.agents.push(agent);
        let scene = told.semantics.scene(&state);
        describe_view(
            &scene,
            Addressee::agent(&scene, AgentId(0)),
            TextOptions::default(),
        )
        .text
    };
    assert!(view(2.0).starts_with("You are on the balcony."));
    assert!(view(6.0).starts_with("You are in the kitchen."));
}

#[test]
fn pairs_are_counted_as_pairs() {
    let mut b = Builder::new("pairs");
    let hall = b.room("hallway", [0.05, 0.05], [3.95, 3.95]);
    let kitchen = b.room("kitchen", [4.05, 0.05], [7.95, 3.95]);
    let leather = b.material("leather", [20, 20, 22]);
    let steel = b.material("steel", [190, 190, 190]);
    let glass = b.material("glass", [250; 3]);
    let cube = |x: f32| -> Corners { ([x, 0.0, 1.0], [x + 0.3, 0.12, 1.25]) };
    let shoes = b.thing("shoes", &[cube(1.0)], leather);
    b.thing("shoes", &[cube(2.0)], leather);
    let scissors = b.thing("scissors", &[cube(4.5)], steel);
    let tumbler = b.thing(
        "drinking_glass",
        &[([6.0, 0.0, 1.0], [6.08, 0.13, 1.08])],
        glass,
    );
    let compass = b.thing("compass", &[cube(7.0)], steel);
    let told = Told::of(b);
    assert_eq!(
        told.caption(shoes),
        "a pair of black leather shoes in the hallway"
    );
    assert!(
        told.room(hall)
            .ends_with(". There are two pairs of black leather shoes in the hallway.")
    );
    assert_eq!(
        told.caption(scissors),
        "a pair of light gray steel scissors in the kitchen"
    );
    assert_eq!(told.refers(scissors), "the pair of scissors");
    // Neither is a pair, though their names end in s.
    assert_eq!(told.caption(tumbler), "a glass in the kitchen");
    assert_eq!(
        told.caption(compass),
        "a light gray steel compass in the kitchen"
    );
    let text = told.room(kitchen);
    for wrong in ["a scissors", "pair of glass", "set of compass"] {
        assert!(!text.contains(wrong), "{text}");
    }
}

/// A box of `body` with a face of `front` before its side towards +Z.
fn with_front(
    b: &mut Builder,
    category: &str,
    (min, max): Corners,
    body: MaterialId,
    front: MaterialId,
) -> ObjectId {
    let thing = b.thing(category, &[(min, max)], body);
    let part = &mut b.data.parts[dwell_scene::PartId(thing.0)];
    part.materials.push(front);
    let (low, high, middle) = (
        Vec3::from(min),
        Vec3::from(max),
        part.world_from_part.position,
    );
    let face = Mesh::cuboid(
        Vec3::new(low.x, low.y, high.z) - middle,
        Vec3::new(high.x, high.y, high.z + 0.005) - middle,
    );
    let mut whole = (*b.data.meshes[part.mesh]).clone();
    whole.append(&face, 1);
    b.data.meshes[part.mesh] = Arc::new(whole);
    thing
}

#[test]
fn pictures_have_no_colour_and_televisions_that_of_their_frame() {
    let mut b = Builder::new("images");
    let room = b.room("living_room", [0.05, 0.05], [7.95, 7.95]);
    let black = b.material("electronics", [20, 20, 22]);
    let image = b.textured("paper", motley);
    let screen = b.textured("glass", |_, _| [110, 40, 140]);
    let tv: Corners = ([1.0, 0.0, 1.0], [2.1, 0.7, 1.08]);
    let television = with_front(&mut b, "television", tv, black, screen);
    let all_picture = b.textured("electronics", motley);
    let other: Corners = ([4.0, 0.0, 1.0], [5.1, 0.7, 1.08]);
    let flat = b.thing("television", &[other], all_picture);
    let picture = b.thing(
        "picture_frame",
        &[([1.5, 1.4, 0.06], [2.1, 1.9, 0.09])],
        image,
    );
    fix(&mut b, picture);
    // One sort of colour in many shades, and spots on a ground: these have their word.
    let grain = b.textured("wood", |x, y| {
        let shade = ((x * 7 + y) % 5) as u8 * 6;
        [140 + shade, 102 + shade, 66 + shade]
    });
    let table = b.table([3.0, 4.0], [4.4, 4.9], 0.75, grain);
    let spots = b.textured("textile", |x, y| {
        if x.is_multiple_of(6) && y.is_multiple_of(2) {
            [180, 20, 25]
        } else {
            [250; 3]
        }
    });
    let rug = b.thing("rug", &[([5.0, 0.0, 5.0], [7.0, 0.02, 7.0])], spots);
    let motley_rug = b.thing("rug", &[([1.0, 0.0, 5.6], [3.0, 0.02, 7.6])], image);
    let told = Told::of(b);
    let captions = [
        (television, "a black television in the living room"),
        (flat, "a television in the living room"),
        (picture, "a picture on the wall in the living room"),
        (table, "a brown wooden table in the living room"),
        (rug, "a white rug in the living room"),
        (motley_rug, "a patterned rug in the living room"),
    ];
    for (thing, text) in captions {
        assert_eq!(told.caption(thing), text);
    }
    assert!(!told.room(room).contains("purple"));
    assert_eq!(told.refers(television), "the black television");
    assert_eq!(told.refers(rug), "the white rug");
}

#[test]
fn doors_are_named_by_where_they_lead() {
    let mut b = Builder::new("doors");
    let kitchen = b.room("kitchen", [0.05, 0.05], [3.95, 3.95]);
    let hall = b.room("hallway", [0.05, 4.05], [3.95, 7.95]);
    let bedroom = b.room("bedroom", [4.05, 4.05], [7.95, 7.95]);
    let wood = b.material("wood", [150, 111, 72]);
    let wall = b.material("painted_plaster", [245, 245, 242]);
    let mut door = |min: [f32; 2], max: [f32; 2]| {
        b.thing(
            "door",
            &[([min[0], 0.0, min[1]], [max[0], 2.05, max[1]])],
            wood,
        )
    };
    let inner = door([1.0, 3.98], [1.9, 4.02]);
    let entrance = door([0.0, 1.0], [0.05, 1.9]);
    // Two from the hall to the bedroom.
    door([3.98, 5.0], [4.02, 5.9]);
    door([3.98, 6.5], [4.02, 7.4]);
    // To a shaft without a room, walled in and covered.
    let shaft = door([3.95, 1.0], [4.0, 1.9]);
    for corners in [
        ([5.2, 0.0, 0.0], [5.25, 2.5, 4.0]),
        ([4.0, 0.0, 0.0], [5.25, 2.5, 0.05]),
        ([4.0, 0.0, 3.95], [5.25, 2.5, 4.0]),
    ] {
        b.piece(StructureKind::Wall, None, corners, wall);
    }
    b.piece(
        StructureKind::Ceiling,
        None,
        ([4.0, 2.5, 0.0], [5.25, 2.55, 4.0]),
        wall,
    );
    let told = Told::of(b);
    let doors = |room| {
        let text = told.room(room);
        let sentence = text
            .split(". ")
            .find(|sentence| sentence.starts_with("From "));
        sentence.map(str::to_owned).expect("it has doors")
    };
    assert_eq!(
        doors(kitchen),
        "From the kitchen there is a door to the hallway, a door to the outside and a door"
    );
    assert_eq!(
        doors(hall),
        "From the hallway there is a door to the kitchen and two doors to the bedroom"
    );
    assert_eq!(
        doors(bedroom),
        "From the bedroom there are two doors to the hallway"
    );
    assert!(
        !describe_house(&told.semantics.scene(&told.state), TextOptions::default())
            .text
            .contains("further")
    );
    assert_eq!(
        told.caption(inner),
        "a brown wooden door from the kitchen to the hallway"
    );
    assert_eq!(
        told.caption(entrance),
        "a brown wooden door from the kitchen to the outside"
    );
    assert!(!told.caption(shaft).contains("outside"));
}

#[test]
fn surfaces_are_told_where_one_prevails() {
    let mut b = Builder::new("surfaces");
    let plain = b.room("kitchen", [0.05, 0.05], [3.95, 3.95]);
    let before = b.data.structure.len();
    let motley_room = b.room("bedroom", [4.05, 0.05], [7.95, 3.95]);
    let image = b.textured("parquet", motley);
    let paints = [[180, 20, 25], [30, 60, 150], [40, 110, 50], [240, 220, 60]];
    let paints = paints.map(|srgb| b.material("painted_plaster", srgb));
    let mut walls = paints.into_iter();
    for piece in &mut b.data.structure.as_mut_slice()[before..] {
        match piece.kind {
            StructureKind::Floor => piece.materials = vec![image],
            StructureKind::Wall => piece.materials = vec![walls.next().expect("four walls")],
            _ => {}
        }
    }
    let glass = b.material("glass", [250; 3]);
    let wood = b.material("wood", [250; 3]);
    let table = b.table([1.0, 1.0], [2.4, 1.9], 0.75, glass);
    let chair = b.thing("chair", &[([2.6, 0.0, 1.1], [3.05, 0.9, 1.55])], wood);
    let tumbler = b.thing(
        "drinking_glass",
        &[([1.2, 0.75, 1.2], [1.28, 0.88, 1.28])],
        glass,
    );
    let told = Told::of(b);
    let text = told.room(plain);
    let opening =
        "The kitchen is about 15 square metres. It has a brown parquet floor and white walls.";
    assert!(text.starts_with(opening), "{text}");
    // Once a room.
    assert_eq!(
        text.matches("walls").count() + text.matches("floor").count(),
        2,
        "{text}"
    );
    let text = told.room(motley_room);
    let opening = "The bedroom is about 15 square metres. It has a parquet floor. There is nothing in the bedroom.";
    assert_eq!(text, opening);
    assert_eq!(told.caption(table), "a glass table in the kitchen");
    assert_eq!(
        told.caption(chair),
        "a white wooden chair next to the table in the kitchen"
    );
    // No glass glass.
    assert_eq!(told.caption(tumbler), "a glass on the table in the kitchen");
}

#[test]
fn things_of_one_sort_are_told_together() {
    let mut b = Builder::new("lists");
    let kitchen = b.room("kitchen", [0.05, 0.05], [3.95, 3.95]);
    let bedroom = b.room("bedroom", [4.05, 0.05], [7.95, 3.95]);
    let wood = b.material("wood", [150, 111, 72]);
    let red = b.material("plastic", [180, 20, 25]);
    let blue = b.material("plastic", [30, 60, 150]);
    let white = b.material("porcelain", [250; 3]);
    for (k, material) in [red, blue, red].into_iter().enumerate() {
        let x = 0.5 + k as f32;
        b.thing("chair", &[([x, 0.0, 3.0], [x + 0.45, 0.9, 3.45])], material);
    }
    for x in [0.5, 2.5] {
        b.table([x, 1.0], [x + 1.2, 1.8], 0.75, wood);
        b.thing(
            "cup",
            &[([x + 0.5, 0.75, 1.4], [x + 0.58, 0.85, 1.48])],
            white,
        );
    }
    b.table([5.0, 1.0], [6.2, 1.8], 0.75, wood);
    b.thing("cup", &[([5.5, 0.75, 1.4], [5.58, 0.85, 1.48])], white);
    b.thing("stool", &[([7.0, 0.0, 1.0], [7.4, 0.6, 1.4])], wood);
    let told = Told::of(b);
    let text = told.room(kitchen);
    assert!(
        text.ends_with(
            "In the kitchen there are two brown wooden tables and three plastic chairs. On a table in the kitchen there \
             is a white porcelain cup. On a table in the kitchen there is a white porcelain cup."
        ),
        "{text}"
    );
    assert!(!text.contains(", and "), "{text}");
    // Things of two sorts stay two.
    let text = told.room(bedroom);
    assert!(
        text.ends_with(
            "In the bedroom there is a brown wooden table and a brown wooden stool. On the table in the bedroom there is \
             a white porcelain cup."
        ),
        "{text}"
    );
}
