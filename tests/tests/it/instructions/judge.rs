//! A judge of instructions that knows the text and the state alone: it reads the instruction, looks up what its phrases mean in the
//! house as it stood at the start, and looks at hands, joints, switches and rooms itself.

use super::ME;
use dwell::Env;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::{ObjectId, RoomId};
use dwell_semantics::check::{Addressee, Checker};
use dwell_semantics::form::{Clause, Description, Form, Phrase, Quality, Quantifier, RequestStep};
use dwell_semantics::instruct::InstructionGoal;
use dwell_semantics::{FieldOfView, Term, Viewer, is_in_line_of_sight};
use glam::{Vec2, Vec3};

/// What is to be so of one thing or room, as the words mean it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Meant {
    GoTo(RoomId),
    Find(ObjectId),
    Face(ObjectId),
    PointAt(ObjectId),
    PickUp(ObjectId),
    Open(ObjectId),
    Close(ObjectId),
    SwitchOn(ObjectId),
    SwitchOff(ObjectId),
    Bring(ObjectId, RoomId),
    PutOn(ObjectId, ObjectId),
    PutIn(ObjectId, ObjectId),
}

/// A step: of how many of some things it is to be so.
#[derive(Clone, Debug)]
pub(super) struct MeantStep {
    pub(super) of: Vec<Meant>,
    pub(super) needed: usize,
    pub(super) is_exact: bool,
}

/// An instruction: its steps, and what must never be so.
#[derive(Clone, Debug, Default)]
pub(super) struct MeantInstruction {
    pub(super) steps: Vec<MeantStep>,
    pub(super) forbidden: Vec<Meant>,
}

impl Meant {
    pub(super) fn of_verb(verb: &str, thing: ObjectId) -> Self {
        match verb {
            "find" => Self::Find(thing),
            "face" => Self::Face(thing),
            "point_at" => Self::PointAt(thing),
            "pick_up" => Self::PickUp(thing),
            "open" => Self::Open(thing),
            "close" => Self::Close(thing),
            "switch_on" => Self::SwitchOn(thing),
            "switch_off" => Self::SwitchOff(thing),
            other => panic!("{other}"),
        }
    }

    pub(super) fn thing(self) -> Option<ObjectId> {
        match self {
            Self::GoTo(_) => None,
            Self::Find(thing)
            | Self::Face(thing)
            | Self::PointAt(thing)
            | Self::PickUp(thing)
            | Self::Open(thing)
            | Self::Close(thing)
            | Self::SwitchOn(thing)
            | Self::SwitchOff(thing)
            | Self::Bring(thing, _)
            | Self::PutOn(thing, _)
            | Self::PutIn(thing, _) => Some(thing),
        }
    }

    pub(super) fn is_place(self) -> bool {
        matches!(self, Self::GoTo(_) | Self::Find(_) | Self::Face(_))
    }

    pub(super) fn is_passing(self) -> bool {
        self.is_place() || matches!(self, Self::PointAt(_))
    }

    pub(super) fn is_so(self, env: &Env, pointed_at: Option<ObjectId>) -> bool {
        let (house, state) = (env.world().house(), env.world().state());
        let semantics = env.world().engines().semantics();
        let opening = |thing| {
            let joints = house.joints_of(thing);
            let joints = joints.filter(|joint| house.joints[*joint].is_openable());
            let open =
                joints.map(|joint| house.joints[joint].openness(state.joint_position[joint]));
            open.fold(0.0, f32::max)
        };
        let bounds = |thing| house.object_bounds(state, thing);
        // The middle of the thing over or in the other, and its lower end between the other's lower and upper ends.
        let is_at = |thing, place| {
            let (own, of) = (bounds(thing), bounds(place));
            let over = of.grown(0.02).contains(own.center().with_y(of.center().y));
            state.held_by[thing].is_none()
                && over
                && (of.min.y - 0.02..=of.max.y + 0.05).contains(&own.min.y)
        };
        match self {
            Self::GoTo(room) => house.room_at(state.agents[ME].position) == Some(room),
            // The rules of these sights are tested by themselves.
            Self::Find(thing) => InstructionGoal::objects(vec![thing], 1.5).is_reached(
                &semantics.scene(state),
                env.world().rays(),
                ME,
            ),
            Self::Face(thing) => {
                let scene = semantics.scene(state);
                let (feet, rays) = (state.agents[ME].position, env.world().rays());
                let outline = &scene.extent(thing).footprint;
                let viewer = Viewer::of_agent(state, ME).expect("there is an agent");
                let cone = FieldOfView::Cone(15.0_f32.to_radians());
                outline.distance_to(Vec2::new(feet.x, feet.z)) <= 3.0
                    && is_in_line_of_sight(&scene, rays, &viewer, thing, cone)
            }
            Self::PointAt(thing) => pointed_at == Some(thing),
            Self::PickUp(thing) => state.held_by[thing] == Some(ME),
            Self::Open(thing) => opening(thing) > 0.5,
            Self::Close(thing) => opening(thing) <= 0.02,
            Self::SwitchOn(thing) => state.switched_on[thing],
            Self::SwitchOff(thing) => !state.switched_on[thing],
            Self::Bring(thing, room) => {
                let middle = bounds(thing).center();
                state.held_by[thing].is_none() && house.room_at(middle) == Some(room)
            }
            // What lies behind doors or on a board between walls is in it, not on it.
            Self::PutOn(thing, place) => is_at(thing, place) && !is_shut_in(env, thing, place),
            Self::PutIn(thing, place) => is_at(thing, place),
        }
    }
}

/// Returns whether a place covers a thing, and is around it on three sides at least.
fn is_shut_in(env: &Env, thing: ObjectId, place: ObjectId) -> bool {
    let (house, state, rays) = (env.world().house(), env.world().state(), env.world().rays());
    let own = house.object_bounds(state, thing);
    let from = own.center().with_y(own.max.y + 0.005);
    let within = house.object_bounds(state, place).grown(0.01);
    let meets = |direction: Vec3| {
        let hit = rays.closest(&Ray::new(from, direction), RayMask::EYE);
        hit.is_some_and(|hit| {
            let is_own = rays.surface(&hit).entity == house.entity_of_object(place);
            is_own && within.contains(from + direction * hit.distance_m)
        })
    };
    let sides = [Vec3::X, Vec3::NEG_X, Vec3::Z, Vec3::NEG_Z];
    meets(Vec3::Y) && sides.into_iter().filter(|side| meets(*side)).count() >= 3
}

/// What the instruction of an episode that has just begun means.
pub(super) fn meant(env: &Env) -> MeantInstruction {
    let text = &env.episode(0).expect("an episode has begun").instruction;
    let semantics = env.world().engines().semantics();
    let scene = semantics.scene(env.world().state());
    let checker = Checker::new(&scene, Addressee::default());
    let described = |phrase: &Phrase| -> Description {
        match phrase {
            Phrase::Described(description) => (**description).clone(),
            other => panic!("{text:?}: {other:?}"),
        }
    };
    let room = |phrase: &Phrase| match checker.certain_referent(&described(phrase)) {
        Some(Term::Room(room)) => room,
        other => panic!("{text:?}: {phrase:?} means {other:?}"),
    };
    let thing = |phrase: &Phrase| match checker.certain_referent(&described(phrase)) {
        Some(Term::Object(object)) => object,
        other => panic!("{text:?}: {phrase:?} means {other:?}"),
    };
    // One thing, or those that words with a number fit, of which it is not so yet where a number is asked.
    let several = |phrase: &Phrase, of: &dyn Fn(ObjectId) -> Meant| {
        let words = described(phrase);
        let fitting = || {
            let fitting = checker.matching_terms(&words).into_iter();
            fitting.map(|term| of(term.object().expect("a thing")))
        };
        match words.quantifier {
            Quantifier::Every => {
                let of: Vec<Meant> = fitting().collect();
                let needed = of.len();
                MeantStep {
                    of,
                    needed,
                    is_exact: false,
                }
            }
            Quantifier::Exactly(number) => MeantStep {
                of: fitting().filter(|own| !own.is_so(env, None)).collect(),
                needed: number as usize,
                is_exact: true,
            },
            _ => MeantStep {
                of: vec![of(thing(phrase))],
                needed: 1,
                is_exact: false,
            },
        }
    };
    let one = |step: &RequestStep| -> MeantStep {
        match step {
            RequestStep::GoTo(to) => MeantStep {
                of: vec![Meant::GoTo(room(to))],
                needed: 1,
                is_exact: false,
            },
            RequestStep::Bring { object, to } => {
                let to = room(to);
                several(object, &|thing| Meant::Bring(thing, to))
            }
            RequestStep::Put {
                object,
                predicate,
                to,
            } => {
                let place = thing(to);
                match predicate.as_str() {
                    "on" => several(object, &|thing| Meant::PutOn(thing, place)),
                    "inside" => several(object, &|thing| Meant::PutIn(thing, place)),
                    other => panic!("{text:?}: {other}"),
                }
            }
            RequestStep::Do { verb, object } => {
                several(object, &|thing| Meant::of_verb(verb, thing))
            }
            other => panic!("{text:?}: {other:?}"),
        }
    };
    let is_true = |clause: &Clause| match clause {
        Clause::Is {
            subject,
            quality: Quality::State(state),
        } => {
            let thing = thing(subject);
            let so = match state.as_str() {
                "open" => Meant::Open(thing),
                "closed" => Meant::Close(thing),
                "switched_on" => Meant::SwitchOn(thing),
                "switched_off" => Meant::SwitchOff(thing),
                other => panic!("{text:?}: {other}"),
            };
            so.is_so(env, None)
        }
        other => panic!("{text:?}: {other:?}"),
    };
    let read = semantics.language().read(text);
    let Form::Request(steps) = read.expect("the words can be read").forms.swap_remove(0) else {
        panic!("{text:?} is no request");
    };
    let mut all = MeantInstruction::default();
    for step in &steps {
        match step {
            RequestStep::If {
                condition,
                then,
                otherwise,
            } => {
                let branch = if is_true(condition) { then } else { otherwise };
                all.steps.extend(branch.iter().map(one));
            }
            RequestStep::DoNot { verb, object } => {
                all.forbidden.push(Meant::of_verb(verb, thing(object)));
            }
            step => all.steps.push(one(step)),
        }
    }
    all
}

/// What has come about of an instruction.
pub(super) struct Judge {
    meant: MeantInstruction,
    done: usize,
    met: Vec<bool>,
    is_broken: bool,
}

impl Judge {
    pub(super) fn new(meant: MeantInstruction) -> Self {
        Self {
            meant,
            done: 0,
            met: Vec::new(),
            is_broken: false,
        }
    }

    pub(super) fn look(&mut self, env: &Env, mut pointed_at: Option<ObjectId>) {
        let forbidden = &self.meant.forbidden;
        self.is_broken |= forbidden.iter().any(|own| own.is_so(env, pointed_at));
        while let Some(step) = self.meant.steps.get(self.done) {
            self.met.resize(step.of.len(), false);
            for (own, met) in step.of.iter().zip(&mut self.met) {
                *met = own.is_so(env, pointed_at) || (*met && own.is_passing());
            }
            if self.met.iter().filter(|met| **met).count() < step.needed {
                return;
            }
            self.done += 1;
            self.met.clear();
            pointed_at = None;
        }
    }

    pub(super) fn is_fulfilled(&self, env: &Env) -> bool {
        let steps = &self.meant.steps;
        let last = steps.len() - 1;
        let still = steps.iter().enumerate().all(|(k, step)| {
            if step.of[0].is_passing() {
                let counts = k == last && step.of.len() == 1 && step.of[0].is_place();
                return !counts || step.of[0].is_so(env, None);
            }
            let later = steps[k + 1..].iter().flat_map(|step| &step.of);
            let undone: Vec<ObjectId> = later
                .filter(|own| !own.is_passing())
                .filter_map(|own| own.thing())
                .collect();
            let counts = |own: &&Meant| !own.thing().is_some_and(|own| undone.contains(&own));
            let kept: Vec<&Meant> = step.of.iter().filter(counts).collect();
            let so = kept.iter().filter(|own| own.is_so(env, None)).count();
            let free = step.of.len() - kept.len();
            so + free >= step.needed && (!step.is_exact || so <= step.needed)
        });
        self.done == steps.len() && still && !self.is_broken
    }
}
