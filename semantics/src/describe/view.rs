//! The description of a view.

use super::item::{appearance, grouped, items};
use super::options::{TextLength, TextOptions, TextStyle};
use super::room::surfaces;
use super::seen_colors;
use super::text::{GroundedText, TextWriter, claim};
use crate::check::{Addressee, Checker};
use crate::form::{Clause, Description, Form, Modifier, Noun, Phrase, Quantifier, RoomSurfaceKind};
use crate::predicates;
use crate::refer::room_phrase;
use crate::room_kind::room_kinds;
use crate::scene::{SemanticScene, Term, Viewer};
use crate::view::{ViewSurvey, refer_in_view};
use dwell_scene::{ObjectId, RoomId, StructureKind};
use std::cell::RefCell;
use std::collections::BTreeMap;

/// Share of the picture below which a thing is not told: 100 pixels of 256 by 256.
const LEAST_SHARE: f32 = 100.0 / 65536.0;
/// Share of a thing that must be in sight: less is a sliver that people do not recognize.
const LEAST_UNHIDDEN: f32 = 0.25;
/// Shares as above of what stands in another room: through a doorway less is recognized.
const LEAST_ELSEWHERE: [f32; 2] = [0.004, 0.6];
/// Share of the picture below which what is of clear glass is overlooked.
const LEAST_CLEAR: f32 = 0.005;
/// Shares as above from which a thing is counted with others that look like it: who is told of one lamp counts the second, too.
const LEAST_COUNTED: [f32; 2] = [LEAST_SHARE / 3.0, 0.1];
/// Share of the picture from which floor or walls are told.
const LEAST_SURFACE: f32 = 0.03;
/// Number of kinds of things that one sentence lists.
const MAX_LISTED: usize = 6;
/// Tangent up to which a thing on one side may reach over to the other: 6 degrees.
const MAX_OVERLAP: f32 = 0.1;

/// Tangent of the border between the middle third of a picture and the outer ones.
const THIRD: f32 = 1.0 / 3.0;
/// Tangent from which on a thing reaches the picture's left or right border: its outermost ray of 64.
pub(super) const BORDER: f32 = 0.96;
/// Share of a thing in sight from which it is seen as a whole.
const WHOLE: f32 = 0.9;
/// What hangs on both sides of a window; of what is cut by the picture's border perhaps one side is seen.
const PAIR_OF_CURTAINS: &str = "pair of curtains";
/// Distance before what fills an opening at which the room that it is seen in is looked up, m.
const BEFORE_M: f32 = 0.3;

/// The sides of a viewer.
const SIDES: [&str; 3] = ["straight_ahead", "on_left", "on_right"];

/// How much is told at each length.
pub(super) struct ViewLimits {
    kinds: usize,
    pub(super) relations: usize,
    pub(super) distances: usize,
}

impl ViewLimits {
    fn of(length: TextLength) -> Self {
        let (kinds, relations, distances) = match length {
            TextLength::Short => (3, 0, 0),
            TextLength::Normal => (usize::MAX, 2, 1),
            TextLength::Long => (usize::MAX, 6, 4),
        };
        Self {
            kinds,
            relations,
            distances,
        }
    }
}

/// Things that stand in view, by how they are told.
pub(super) struct ViewContents {
    /// Things of the viewer's room by their side; those that reach over several sides have none. The largest group first.
    pub(super) sides: Vec<(Option<&'static str>, Vec<ObjectId>)>,
    /// Things in and on others that are told, too.
    carried: BTreeMap<(ObjectId, &'static str), Vec<ObjectId>>,
    /// Things in other rooms.
    elsewhere: BTreeMap<RoomId, Vec<ObjectId>>,
}

/// How things in view are referred to, of those that were looked up so far.
type ThingNames = RefCell<BTreeMap<ObjectId, Option<Description>>>;

pub(super) struct ViewTeller<'a, 'b> {
    pub(super) writer: TextWriter<'b>,
    pub(super) checker: &'b Checker<'a>,
    pub(super) viewer: Viewer,
    pub(super) survey: &'b ViewSurvey,
    style: TextStyle,
    room: Option<RoomId>,
    /// The things worth telling, ascending.
    told: Vec<ObjectId>,
    /// How things are referred to.
    names: &'b ThingNames,
}

impl ViewTeller<'_, '_> {
    pub(super) fn scene(&self) -> &SemanticScene<'_> {
        self.checker.scene()
    }

    fn holds(&self, name: &str, object: ObjectId) -> bool {
        let terms = [Term::Object(object)];
        predicates::is_true(self.scene(), name, &terms, Some(&self.viewer))
    }

    /// The description that fits a thing alone.
    pub(super) fn name(&self, object: ObjectId) -> Option<Description> {
        if let Some(known) = self.names.borrow().get(&object) {
            return known.clone();
        }
        // A place in an order, or beside something small, is a clumsy name for what the text tells of anyway.
        let name = refer_in_view(self.checker, self.survey, object);
        let is_carried = |own: &Modifier| ["in", "on"].contains(&own.predicate.as_str());
        let name = name
            .filter(|own| own.selection.is_none() && own.modifiers.iter().all(is_carried))
            .filter(|own| seen_colors::thing_shows(self.scene(), self.survey, object, &own.colors));
        self.names.borrow_mut().insert(object, name.clone());
        name
    }

    pub(super) fn share(&self, object: ObjectId) -> f32 {
        self.survey
            .objects
            .get(&object)
            .map_or(0.0, |own| own.share)
    }

    /// Returns whether a thing reaches over more than half of the picture.
    pub(super) fn is_wide(&self, object: ObjectId) -> bool {
        let seen = self.survey.objects.get(&object);
        seen.is_some_and(|own| own.span[1] - own.span[0] > 1.0)
    }

    /// Returns whether a thing reaches out of the picture at a side, or is hidden in part.
    fn is_cut(&self, object: ObjectId) -> bool {
        let seen = self.survey.objects.get(&object);
        let to_camera = self.viewer.world_from_camera.inverse();
        // Of a pair of curtains one side may be out of the picture, and the other wholly in it.
        let mut corners = self.scene().extent(object).bounds.corners().into_iter();
        corners.any(|corner| {
            let corner = to_camera.transform_point(corner);
            corner.x.abs() > -corner.z
        }) || seen.is_some_and(|own| own.unhidden < WHOLE)
    }

    /// Returns whether something that moves is seen of a door: without its leaf people see an opening.
    fn shows_leaf(&self, object: ObjectId) -> bool {
        let scene = self.scene();
        if scene.semantics.doorway(object).is_none() {
            return true;
        }
        let joints = scene.house().joints.iter();
        let mut leaves = joints.filter(|joint| joint.object == object).peekable();
        leaves.peek().is_none() || leaves.any(|joint| self.survey.is_part_seen(joint.child))
    }

    /// Returns whether neither of two things lies with its middle before or behind the other in the picture.
    pub(super) fn is_beside_in_picture(&self, one: ObjectId, other: ObjectId) -> bool {
        let span = |object| self.survey.objects.get(&object).map(|own| own.span);
        let (Some(one), Some(other)) = (span(one), span(other)) else {
            return false;
        };
        let apart = |[left, right]: [f32; 2], [from, to]: [f32; 2]| {
            let middle = 0.5 * (left + right);
            middle < from || middle > to
        };
        apart(one, other) && apart(other, one)
    }

    /// The side on which a thing is told: that of its middle, if it does not reach over to another.
    fn side(&self, object: ObjectId) -> Option<&'static str> {
        let side = SIDES.into_iter().find(|side| self.holds(side, object))?;
        let [left, right] = self.survey.objects.get(&object)?.span;
        // What is seen of it must lie there, too: of a door that stands open to the right people see the leaf.
        let middle = 0.5 * (left + right);
        let clear = match side {
            "on_left" => right <= MAX_OVERLAP && middle <= -THIRD,
            "on_right" => left >= -MAX_OVERLAP && middle >= THIRD,
            _ => middle.abs() <= THIRD,
        };
        clear.then_some(side)
    }

    /// What a thing lies in or on, if that is told, too, and has a name of its own.
    fn carrier(&self, object: ObjectId) -> Option<(ObjectId, &'static str)> {
        ["in", "on"].into_iter().find_map(|name| {
            let predicate = predicates::find(name).ok()?;
            let others = predicates::related_objects(self.scene(), predicate, object);
            let carrier = others.into_iter().find(|other| {
                self.told.binary_search(other).is_ok()
                    && !self.scene().facts(*other).is_rug()
                    && self.name(*other).is_some()
            })?;
            Some((carrier, name))
        })
    }

    /// The room that a thing is seen in: for what fills an opening in a wall, the viewer's own if a door leads from there, else the one
    /// before it.
    fn seen_in(&self, object: ObjectId) -> Option<RoomId> {
        let scene = self.scene();
        if !scene.facts(object).belongs_to_opening() {
            return scene.room_of(object).or(self.room);
        }
        let doorway = scene.semantics.doorway(object);
        let leads_from = |room: &RoomId| doorway.is_some_and(|own| own.rooms.contains(room));
        self.room.filter(leads_from).or_else(|| {
            let eye = self.viewer.world_from_camera.position;
            let sighting = self.survey.objects.get(&object)?;
            let share = 1.0 - BEFORE_M / sighting.distance_m.max(BEFORE_M);
            scene.house().room_at(eye.lerp(sighting.nearest, share))
        })
    }

    /// Returns whether people recognize a thing through a doorway.
    fn is_made_out_elsewhere(&self, object: ObjectId) -> bool {
        let [least_share, least_unhidden] = LEAST_ELSEWHERE;
        let seen = self.survey.objects.get(&object);
        seen.is_some_and(|own| own.share >= least_share && own.unhidden >= least_unhidden)
    }

    /// Returns whether people overlook a thing of clear glass, or take it for something else: a glazed partition for a door.
    fn is_overlooked(&self, object: ObjectId) -> bool {
        let facts = self.scene().facts(object);
        facts.is_mostly_clear && !facts.belongs_to_opening() && self.share(object) < LEAST_CLEAR
            || facts.is_glazed_partition()
    }

    fn contents(&self) -> ViewContents {
        let mut sides: BTreeMap<Option<&'static str>, (f32, Vec<ObjectId>)> = BTreeMap::new();
        let mut carried: BTreeMap<(ObjectId, &'static str), Vec<ObjectId>> = BTreeMap::new();
        let mut elsewhere: BTreeMap<RoomId, Vec<ObjectId>> = BTreeMap::new();
        for object in self.told.iter().copied() {
            let seen_in = self.seen_in(object);
            if self.room.is_some() && seen_in != self.room {
                // What belongs to no room, or to another than it is seen in, cannot be told truly.
                let own = seen_in.filter(|_| seen_in == self.scene().room_of(object));
                if let Some(other) = own.filter(|_| self.is_made_out_elsewhere(object)) {
                    elsewhere.entry(other).or_default().push(object);
                }
                continue;
            }
            if let Some(carrier) = self.carrier(object) {
                carried.entry(carrier).or_default().push(object);
                continue;
            }
            let (share, objects) = sides.entry(self.side(object)).or_default();
            *share = share.max(self.share(object));
            objects.push(object);
        }
        let mut sides: Vec<_> = sides.into_iter().collect();
        sides.sort_by(|(_, (p, _)), (_, (q, _))| q.total_cmp(p));
        ViewContents {
            sides: sides
                .into_iter()
                .map(|(side, (_, objects))| (side, objects))
                .collect(),
            carried,
            elsewhere,
        }
    }

    /// The items of a list of things in view: a number is exact only where no others that fit are seen in the same place.
    fn items(&self, objects: &[ObjectId], in_place: impl Fn(ObjectId) -> bool) -> Vec<Description> {
        let visible = self.survey.objects.keys().copied();
        let visible: Vec<ObjectId> = visible
            .filter(|object| self.holds("visible", *object) && in_place(*object))
            .collect();
        let groups = grouped(self.scene(), objects);
        let mut found = items(self.scene(), objects, &visible, self.style);
        for (item, group) in found.iter_mut().zip(groups) {
            let number = group.objects.len() as u32;
            let looks = |object: &ObjectId| {
                seen_colors::thing_shows(self.scene(), self.survey, *object, &item.colors)
            };
            if item.noun == Noun::Object(PAIR_OF_CURTAINS.to_owned())
                && group.objects.iter().any(|object| self.is_cut(*object))
            {
                item.noun = Noun::Object("curtain".to_owned());
            }
            let is_as_seen = group.objects.iter().all(looks);
            if !is_as_seen {
                item.colors.clear();
            }
            item.quantifier = match item.quantifier {
                _ if !is_as_seen && number > 1 => Quantifier::AtLeast(number),
                _ if number == 1 => Quantifier::Some,
                Quantifier::Exactly(all) if all == number => item.quantifier,
                _ => Quantifier::AtLeast(number),
            };
        }
        found
    }

    /// `objects` with the things in the same place that a reader would count with one of them, since they look like it: those that
    /// are told with what they stand on, and those that are too small to be told on their own; not `others`, which are counted in
    /// another place.
    fn with_look_alikes(
        &self,
        objects: &[ObjectId],
        others: &[ObjectId],
        in_place: impl Fn(ObjectId) -> bool,
    ) -> Vec<ObjectId> {
        let [least_share, least_unhidden] = LEAST_COUNTED;
        let look = |object: ObjectId| appearance(self.scene(), object, self.style);
        let told: Vec<Description> = objects.iter().map(|object| look(*object)).collect();
        let seen = self.survey.objects.iter();
        let counted = seen.filter(|(object, own)| {
            own.share >= least_share
                && own.unhidden >= least_unhidden
                && !objects.contains(object)
                && !others.contains(object)
                && self.holds("visible", **object)
                && in_place(**object)
                && objects
                    .first()
                    .is_some_and(|one| self.seen_in(*one) == self.seen_in(**object))
                && told.contains(&look(**object))
        });
        let counted = counted.map(|(object, _)| *object);
        objects.iter().copied().chain(counted).collect()
    }

    /// Returns whether a thing is in or on another.
    fn is_carried_by(&self, object: ObjectId, carrier: ObjectId, name: &str) -> bool {
        predicates::find(name).is_ok_and(|predicate| {
            predicates::related_objects(self.scene(), predicate, object).contains(&carrier)
        })
    }

    /// "The bedroom" that the listener is in.
    fn own_room(&self, room: RoomId) -> Phrase {
        let noun = Noun::Room(self.scene().semantics.room(room).noun.clone());
        let plain = Description::new(Quantifier::The, noun);
        match self.checker.certain_referent(&plain) {
            Some(Term::Room(found)) if found == room => plain.into(),
            _ => room_phrase(self.scene(), room),
        }
    }

    /// "The kitchen", or of several kitchens "a kitchen": nobody sees its number in the house's list.
    fn other_room(&self, room: RoomId) -> Phrase {
        let facts = self.scene().semantics.room(room);
        match facts.number {
            None => room_phrase(self.scene(), room),
            Some(_) => Description::new(Quantifier::Some, Noun::Room(facts.noun.clone())).into(),
        }
    }

    fn say_surfaces(&mut self) {
        let Some(room) = self.room else {
            return;
        };
        let scene = self.checker.scene();
        let kinds = [
            (StructureKind::Floor, RoomSurfaceKind::Floor),
            (StructureKind::Wall, RoomSurfaceKind::Walls),
        ];
        // Of this room: through a doorway another floor is seen.
        let share = |kind| self.survey.structure_share(scene.house(), room, kind);
        let seen = kinds
            .into_iter()
            .filter(|(kind, _)| share(*kind) >= LEAST_SURFACE);
        let seen: Vec<RoomSurfaceKind> = seen.map(|(_, surface)| surface).collect();
        let mut surfaces = surfaces(scene, room);
        surfaces.retain(|surface| seen.contains(&surface.kind));
        // In the sun dark boards look light.
        let kind = room_kinds().get(&scene.semantics.room(room).noun);
        let in_the_open = kind.is_some_and(|kind| !kind.indoor);
        for surface in &mut surfaces {
            let shows = |word: &mut String| {
                !seen_colors::surface_shows(scene, self.survey, (room, surface.kind), word)
            };
            surface.color.take_if(shows);
            if in_the_open {
                surface.color = None;
            }
        }
        surfaces.retain(|surface| surface.color.is_some() || surface.material.is_some());
        if !surfaces.is_empty() {
            let room = self.own_room(room);
            self.writer
                .say(Form::Claim(Clause::HasSurfaces { room, surfaces }));
        }
    }

    fn say(&mut self, limits: &ViewLimits) {
        if let Some(room) = self
            .room
            .filter(|_| self.checker.listener().agent.is_some())
        {
            let room = room_phrase(self.checker.scene(), room);
            self.writer
                .say(claim("in_room", vec![Phrase::Listener, room]));
        }
        if limits.relations > 0 && self.style == TextStyle::Rich {
            self.say_surfaces();
        }
        let contents = self.contents();
        let seen = Modifier::new("visible", []);
        let mut kinds = limits.kinds;
        for (side, objects) in &contents.sides {
            let others = contents.sides.iter();
            let others = others.filter(|(other, _)| other != side);
            let beside: Vec<ObjectId> = others.flat_map(|(_, own)| own.iter().copied()).collect();
            let mut items = match *side {
                Some(side) => {
                    let there = |other| self.holds(side, other);
                    self.items(&self.with_look_alikes(objects, &beside, there), there)
                }
                None => self.items(objects, |_| true),
            };
            items.truncate(kinds.min(MAX_LISTED));
            kinds -= items.len();
            let side = side.map(|side| Modifier::new(side, []));
            let place: Vec<Modifier> = side.into_iter().chain([seen.clone()]).collect();
            self.writer.there_are(&items, &place);
        }
        if self.told.is_empty() {
            // Specks and slivers are not told, and not denied.
            let mut objects = self.scene().house().objects.ids();
            if !objects.any(|object| self.holds("visible", object)) {
                let nothing = Noun::Object(Noun::ANY_OBJECT.to_owned());
                self.writer
                    .there_are(&[Description::new(Quantifier::No, nothing)], &[seen]);
            }
            return;
        }
        if limits.relations == 0 {
            return;
        }
        self.say_places(&contents, limits);
        for ((carrier, name), objects) in &contents.carried {
            let there = |other| self.is_carried_by(other, *carrier, name);
            let items = self.items(&self.with_look_alikes(objects, &[], there), there);
            let Some(carrier) = self.name(*carrier) else {
                continue;
            };
            let place = [Modifier::new(name, [carrier.into()]), seen.clone()];
            self.writer.there_are(&items, &place);
        }
        for (room, objects) in &contents.elsewhere {
            let there = |other| self.scene().room_of(other) == Some(*room);
            let items = self.items(&self.with_look_alikes(objects, &[], there), there);
            let place = [
                Modifier::new("in_room", [self.other_room(*room)]),
                seen.clone(),
            ];
            self.writer.there_are(&items, &place);
        }
    }
}

/// The description of what a listener sees, as a person would tell it: the room with its floor and walls as far as they are in the
/// picture, the things by side with the largest first, six kinds at most, how far the largest are and where they are to each other, what lies on them,
/// and what is seen in other rooms. What covers less than 100 pixels of 256 by 256 (in other rooms 262), or is hidden to more than three
/// quarters (in other rooms two fifths), is left out; so are small things of clear glass, glazed partitions, the colour of floors in the
/// open, and how far what runs out of the picture below is. Without a viewer nothing is seen.
pub fn describe_view(
    scene: &SemanticScene<'_>,
    listener: Addressee,
    options: TextOptions,
) -> GroundedText {
    let Some(viewer) = listener.viewer else {
        return GroundedText::default();
    };
    let checker = Checker::new(scene, listener);
    let survey = ViewSurvey::of(scene, &viewer);
    let mut texts = describe_views(&checker, &survey, &[options]);
    texts.pop().unwrap_or_default()
}

/// As [`describe_view`], of what a checker's listener sees in `survey`: a text for each of `options`.
pub fn describe_views(
    checker: &Checker<'_>,
    survey: &ViewSurvey,
    options: &[TextOptions],
) -> Vec<GroundedText> {
    let (scene, listener) = (checker.scene(), checker.listener());
    let Some(viewer) = listener.viewer else {
        return vec![GroundedText::default(); options.len()];
    };
    let room = match listener.agent {
        Some(agent) => scene.room_of_agent(agent),
        None => scene.house().room_at(viewer.world_from_camera.position),
    };
    let names = ThingNames::default();
    let texts = options.iter().map(|options| {
        let mut teller = ViewTeller {
            writer: TextWriter::new(checker, options.wording),
            checker,
            viewer,
            style: options.style,
            room,
            told: Vec::new(),
            names: &names,
            survey,
        };
        let told = survey.objects.iter().filter(|(object, own)| {
            own.share >= LEAST_SHARE
                && own.unhidden >= LEAST_UNHIDDEN
                && scene.holder(**object).is_none()
                && teller.holds("visible", **object)
                && teller.shows_leaf(**object)
                && !teller.is_overlooked(**object)
        });
        teller.told = told.map(|(object, _)| *object).collect();
        teller.say(&ViewLimits::of(options.length));
        teller.writer.finish()
    });
    texts.collect()
}
