//! The answers of a house to the questions of episodes, from its outlines, boxes, joints and switches.

use dwell::Env;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::{Aabb, Entity, House, ObjectId, RoomId};
use dwell_semantics::Term;
use dwell_semantics::ask::answers;
use dwell_semantics::category::categories;
use dwell_semantics::check::{Addressee, Checker};
use dwell_semantics::form::{AttributeKind, Clause, Description, Form, Noun, Phrase, Question};
use glam::{Vec2, Vec3};
use std::collections::BTreeSet;

pub(super) fn text(env: &Env) -> String {
    env.episode(0).expect("an episode").instruction.clone()
}

pub(super) fn kind(env: &Env) -> &'static str {
    env.episode(0).expect("an episode").goal.kind
}

/// What the expert would answer.
pub(super) fn answer(env: &mut Env) -> &'static str {
    let number = env.expert_step(0).expect("an episode").answer[0];
    &answers()[number as usize]
}

pub(super) fn question(env: &Env) -> Question {
    let text = text(env);
    let read = env.world().engines().semantics().language().read(&text);
    match read.expect("the words can be read").forms.swap_remove(0) {
        Form::Question(question) => question,
        other => panic!("{text:?} is {other:?}"),
    }
}

/// The one thing or room that a phrase means in the house as it stands.
pub(super) fn meant(env: &Env, phrase: &Phrase) -> Term {
    let scene = env.world().engines().semantics().scene(env.world().state());
    let Phrase::Described(description) = phrase else {
        panic!("{phrase:?} is no description");
    };
    let term = Checker::new(&scene, Addressee::default()).certain_referent(description);
    term.unwrap_or_else(|| panic!("{}: {phrase:?}", text(env)))
}

pub(super) fn thing(env: &Env, phrase: &Phrase) -> ObjectId {
    meant(env, phrase).object().expect("a thing")
}

pub(super) fn bounds(env: &Env, object: ObjectId) -> Aabb {
    env.world()
        .house()
        .object_bounds(env.world().state(), object)
}

/// The room around a point: it lies in one of its outline's triangles, or on the edge between two, as the middle of a rectangle does.
pub(super) fn room_around(house: &House, point: Vec3) -> Option<RoomId> {
    let at = Vec2::new(point.x, point.z);
    let side = |a: Vec2, b: Vec2| (b - a).perp_dot(at - a);
    let inside = |room: &dwell_scene::Room| {
        let mut triangles = room.footprint.iter();
        let level = (room.floor_y - 0.3..room.ceiling_y + 0.3).contains(&point.y);
        level
            && triangles.any(|[a, b, c]| {
                let sides = [side(*a, *b), side(*b, *c), side(*c, *a)];
                sides.iter().all(|side| *side >= -1e-5) || sides.iter().all(|side| *side <= 1e-5)
            })
    };
    let mut holding = house.rooms.iter_ids().filter(|(_, room)| inside(room));
    holding.next().map(|(id, _)| id)
}

/// The things of the house's file in a room whose category has this noun.
pub(super) fn things_in(env: &Env, room: RoomId, noun: &str) -> BTreeSet<ObjectId> {
    let house = env.world().house();
    let is_called = |own: &str| own == noun || own.ends_with(&format!(" {noun}"));
    let rows = categories().rows().iter();
    let named: BTreeSet<&str> = rows
        .filter(|row| is_called(row.singular) || row.synonyms.iter().any(|own| is_called(own)))
        .map(|row| row.name)
        .collect();
    let fits = |object: &ObjectId| {
        let category = &house.objects[*object].category;
        let category = categories().of(category).map(|row| row.name);
        category.is_some_and(|name| named.contains(name))
            && room_around(house, bounds(env, *object).center()) == Some(room)
    };
    house.objects.ids().filter(fits).collect()
}

/// The noun and the room of "chairs in the kitchen"; `None` for nouns that no category has.
pub(super) fn noun_and_room(env: &Env, what: &Description) -> Option<(String, RoomId)> {
    let Noun::Object(noun) = &what.noun else {
        panic!("{what:?}");
    };
    let [place] = &what.modifiers[..] else {
        panic!("{what:?}");
    };
    let Term::Room(room) = meant(env, &place.arguments[0]) else {
        panic!("{what:?}");
    };
    let known = categories().rows().iter().any(|row| row.singular == noun);
    known.then(|| (noun.clone(), room))
}

/// The gap between two boxes, m.
pub(super) fn gap_m(a: &Aabb, b: &Aabb) -> f32 {
    (a.min - b.max).max(b.min - a.max).max(Vec3::ZERO).length()
}

/// Returns whether a thing has room below it for nothing but another: a line straight down from its foot meets that.
pub(super) fn rests_on(env: &Env, thing: ObjectId, carrier: ObjectId) -> bool {
    let own = bounds(env, thing);
    let house = env.world().house();
    (0..81).any(|k| {
        let share = Vec3::new((k % 9) as f32 + 0.5, 0.0, (k / 9) as f32 + 0.5) / 9.0;
        let foot = own.min + own.size() * share.with_y(0.0) + Vec3::Y * 0.05;
        let ray = Ray::new(foot, Vec3::NEG_Y).with_range(0.0, 0.1);
        let mut ray = ray;
        // Through its own sole.
        for _ in 0..8 {
            let Some(hit) = env.world().rays().closest(&ray, RayMask::EYE) else {
                return false;
            };
            match house.entity(env.world().rays().surface(&hit).entity) {
                Some(Entity::Object(object)) if object == carrier => return true,
                Some(Entity::Object(object)) if object == thing => {
                    ray = ray.with_range(hit.distance_m + 1e-4, ray.far_m);
                }
                _ => return false,
            }
        }
        false
    })
}

/// What the house says: `None` where this oracle has no opinion.
pub(super) fn answer_of_house(env: &Env) -> Option<String> {
    let house = env.world().house();
    let yes_no = |is: bool| Some(if is { "yes" } else { "no" }.to_owned());
    match question(env) {
        Question::Attribute {
            kind: AttributeKind::Room,
            of,
        } => {
            let middle = bounds(env, thing(env, &of)).center();
            let room = room_around(house, middle).expect("it is in a room");
            let label = house.rooms[room].kinds.first().cloned().unwrap_or_default();
            // As people call what files call otherwise.
            Some(match label.to_lowercase().as_str() {
                "toilet" => "restroom".to_owned(),
                "child_room" | "child room" => "children's room".to_owned(),
                "entryway" => "entrance hall".to_owned(),
                "wardrobe" => "dressing room".to_owned(),
                "storage" => "storage room".to_owned(),
                other => other.replace('_', " "),
            })
        }
        Question::HowMany(what) => {
            let (noun, room) = noun_and_room(env, &what)?;
            Some(things_in(env, room, &noun).len().to_string())
        }
        Question::Whether(Clause::Exists(Phrase::Described(what))) => {
            let (noun, room) = noun_and_room(env, &what)?;
            yes_no(!things_in(env, room, &noun).is_empty())
        }
        Question::Whether(Clause::Holds { arguments, .. }) => {
            let [first, near, far] = [0, 1, 2].map(|k| bounds(env, thing(env, &arguments[k])));
            let (near_m, far_m) = (gap_m(&first, &near), gap_m(&first, &far));
            // Boxes of things that are turned are larger than these.
            let is_clear = near_m.max(far_m) > 1.3 * near_m.min(far_m) + 0.2;
            is_clear.then(|| yes_no(near_m < far_m)).flatten()
        }
        Question::Whether(Clause::Is { subject, quality }) => {
            let object = thing(env, &subject);
            let state = env.world().state();
            if format!("{quality:?}").contains("switched_on") {
                return yes_no(state.switched_on[object]);
            }
            let joints = house.joints_of(object).map(|joint| {
                let own = &house.joints[joint];
                (state.joint_position[joint] - own.closed) / (own.open - own.closed)
            });
            yes_no(
                joints
                    .filter(|share| share.is_finite())
                    .any(|share| share > 0.5),
            )
        }
        Question::Which { .. } | Question::Attribute { .. } => None,
        other => panic!("{other:?}"),
    }
}
