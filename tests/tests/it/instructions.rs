//! Instructions for feet and hands: their words are read anew, and what became of the house is judged by them.
//!
//! The judge here knows the text and the state alone: it reads the instruction, looks up what its phrases mean in the house as it stood
//! at the start, and looks at hands, joints, switches and rooms itself.

use dwell::{DiscreteAction, Engines, Env, EnvConfig};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, ObjectId, RoomId};
use dwell_semantics::check::{Addressee, Checker};
use dwell_semantics::form::{Clause, Description, Form, Phrase, Quality, Quantifier, RequestStep};
use dwell_semantics::instruct::InstructionGoal;
use dwell_semantics::{FieldOfView, Term, Viewer, is_in_line_of_sight};
use glam::{Vec2, Vec3};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::sync::Arc;

const ME: AgentId = AgentId(0);

/// What is to be so of one thing or room, as the words mean it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Meant {
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
struct MeantStep {
    of: Vec<Meant>,
    needed: usize,
    is_exact: bool,
}

/// An instruction: its steps, and what must never be so.
#[derive(Clone, Debug, Default)]
struct MeantInstruction {
    steps: Vec<MeantStep>,
    forbidden: Vec<Meant>,
}

impl Meant {
    fn of_verb(verb: &str, thing: ObjectId) -> Self {
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

    fn thing(self) -> Option<ObjectId> {
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

    fn is_place(self) -> bool {
        matches!(self, Self::GoTo(_) | Self::Find(_) | Self::Face(_))
    }

    fn is_passing(self) -> bool {
        self.is_place() || matches!(self, Self::PointAt(_))
    }

    fn is_so(self, env: &Env, pointed_at: Option<ObjectId>) -> bool {
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
            Self::GoTo(room) => {
                let feet = state.agents[ME].position;
                house.room_at(feet + Vec3::Y * 0.1) == Some(room)
            }
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
            Self::PutOn(thing, place) | Self::PutIn(thing, place) => is_at(thing, place),
        }
    }
}

/// What the instruction of an episode that has just begun means.
fn meant(env: &Env) -> MeantInstruction {
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
struct Judge {
    meant: MeantInstruction,
    done: usize,
    met: Vec<bool>,
    is_broken: bool,
}

impl Judge {
    fn new(meant: MeantInstruction) -> Self {
        Self {
            meant,
            done: 0,
            met: Vec::new(),
            is_broken: false,
        }
    }

    fn look(&mut self, env: &Env, mut pointed_at: Option<ObjectId>) {
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

    fn is_fulfilled(&self, env: &Env) -> bool {
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

/// Plays an episode to its end. Gives back the actions, whether it was called a success, and whether the judge of this file calls it one.
fn play(
    env: &mut Env,
    seed: u64,
    mut policy: impl FnMut(usize, &mut Env) -> DiscreteAction,
) -> (Vec<DiscreteAction>, bool, bool) {
    env.reset(seed).expect("the task can be played");
    let mut judge = Judge::new(meant(env));
    let mut actions = Vec::new();
    for k in 0..1500 {
        let action = if k == 1499 {
            DiscreteAction::Stop
        } else {
            policy(k, env)
        };
        actions.push(action);
        let looked_at = env.world().object_in_view_centre(ME);
        let info = env.step(&[Some(action)]);
        let info = info.expect("the episode goes on").swap_remove(0);
        let points = action == DiscreteAction::Point && info.action_success;
        judge.look(env, looked_at.filter(|_| points));
        let whole = info.measures[0];
        assert!((0.0..=1.0).contains(&whole));
        assert!(!info.result.success || whole == 1.0, "{seed}: {whole}");
        if info.result.terminated {
            return (actions, info.result.success, judge.is_fulfilled(env));
        }
    }
    unreachable!("stop ends an episode")
}

fn env_in(house: dwell_scene::House, settings: Value) -> Env {
    let config = EnvConfig {
        task: "InstructionFollowing-v1".to_owned(),
        task_settings: settings,
        ..EnvConfig::default()
    };
    dwell_tests::env_in(Engines::new(Arc::new(house)), config, &[])
}

fn is_hand(action: DiscreteAction) -> bool {
    action.kind().is_hand_action()
}

/// Every plan of the expert is accepted, and what breaks it is rejected: to stop in between, to keep the hands still, to walk at random.
/// The task's verdict is that of the words in every case.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn verdicts_are_those_of_the_words() {
    let (houses, episodes) = if dwell_tests::runs_all() {
        (1000, 2)
    } else {
        (4, 5)
    };
    let mut kinds = BTreeSet::new();
    let (mut accepted, mut rejected, mut played) = (0, 0, 0);
    for number in 0..houses {
        let (house, _) = dwell_houses::open(&format!("seed:{}", 700 + number)).unwrap();
        let mut env = env_in(
            house,
            json!({"max_sequence_steps": 3, "max_distance_m": 15.0}),
        );
        // Others in each house: the form of an instruction is drawn by the seed.
        for seed in number * episodes..(number + 1) * episodes {
            let key = RandomKey::root(seed).child("perturbed");
            let (plan, success, judged) =
                play(&mut env, seed, |_, env| env.expert_action(0).unwrap());
            let text = env.episode(0).unwrap().instruction.clone();
            kinds.insert(env.episode(0).unwrap().goal.kind);
            assert_eq!(success, judged, "{text:?}");
            played += 1;
            accepted += usize::from(success);
            // To stop before the end.
            let end = key.child("end").stream().below(plan.len());
            let (_, success, judged) = play(&mut env, seed, |k, _| {
                if k < end {
                    plan[k]
                } else {
                    DiscreteAction::Stop
                }
            });
            assert_eq!(success, judged, "{text:?} until {end}");
            // To go, and do nothing.
            let (_, success, judged) =
                play(&mut env, seed, |k, _| match plan[k.min(plan.len() - 1)] {
                    action if is_hand(action) => DiscreteAction::Wait,
                    action => action,
                });
            assert_eq!(success, judged, "{text:?} without hands");
            if meant_hands(&mut env, seed) {
                assert!(!success, "{text:?} without hands");
                rejected += 1;
            }
            let mut stream = key.child("walk").stream();
            let (_, success, judged) = play(&mut env, seed, |k, _| match stream.below(40) {
                0 if k > 20 => DiscreteAction::Stop,
                n => DiscreteAction::ALL[1 + n % 17],
            });
            assert_eq!(success, judged, "{text:?} at random");
        }
    }
    // How often the expert succeeds is measured elsewhere, over more episodes.
    assert!(
        accepted * 10 >= 9 * played,
        "the expert did {accepted} of {played}"
    );
    assert!(
        rejected * 3 > played && kinds.len() > 4,
        "{rejected} {kinds:?}"
    );
}

/// Whether the instruction of a seed asks for something of the hands.
fn meant_hands(env: &mut Env, seed: u64) -> bool {
    env.reset(seed).expect("the task can be played");
    meant(env).steps.iter().any(|step| !step.of[0].is_passing())
}

/// An episode that is restored after its first step is done knows that it is.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn a_restored_instruction_knows_what_is_done() {
    let (house, _) = dwell_houses::open("builtin:apartment").unwrap();
    let settings = json!({
        "forms": ["sequence"],
        "kinds": ["go_to_room", "find_object", "pick_up", "open", "close", "switch_on", "switch_off", "bring"],
    });
    let mut env = env_in(house.clone(), settings.clone());
    let mut other = env_in(house, settings);
    let mut checked = 0;
    for seed in 0..12 {
        let (plan, success, _) = play(&mut env, seed, |_, env| env.expert_action(0).unwrap());
        // How often the expert succeeds is tested above.
        if !success {
            continue;
        }
        env.reset(seed).unwrap();
        let first = meant(&env).steps[0].of[0];
        // Where the first step is passing, nothing but the snapshot says that it is done.
        if !first.is_place() {
            continue;
        }
        let mut saved = None;
        for action in &plan {
            env.step(&[Some(*action)]).unwrap();
            if saved.is_some() && !first.is_so(&env, None) {
                saved = Some(env.snapshot().unwrap());
                break;
            }
            if first.is_so(&env, None) {
                saved = Some(Vec::new());
            }
        }
        let Some(saved) = saved.filter(|saved| !saved.is_empty()) else {
            continue;
        };
        let after = env.steps() as usize;
        other.reset(100 + seed).unwrap();
        other.restore(&saved).unwrap();
        let mut last = None;
        for action in &plan[after..] {
            last = Some(other.step(&[Some(*action)]).unwrap().swap_remove(0));
        }
        assert!(last.is_some_and(|info| info.result.success), "{seed}");
        checked += 1;
    }
    assert!(checked >= 1);
}

/// What falls on the way is fetched from where it lies, also by an episode that is restored there: it is rewarded as the one that goes on.
#[test]
fn what_was_let_go_on_the_way_is_fetched_from_there() {
    let (house, _) = dwell_houses::open("builtin:apartment").unwrap();
    let settings = json!({"forms": ["single"], "kinds": ["bring"]});
    let mut env = env_in(house.clone(), settings.clone());
    let mut other = env_in(house, settings);
    let (mut played, mut fetched) = (0, 0);
    for seed in 0..6 {
        env.reset(seed).unwrap();
        let mut held = 0;
        let mut is_over = false;
        while held < 12 && !is_over {
            let action = env.expert_action(0).unwrap();
            is_over = env.step(&[Some(action)]).unwrap()[0].result.terminated;
            held += u32::from(env.world().state().agents[ME].holding.is_some());
        }
        if is_over {
            continue;
        }
        // Far enough from where it lay that the way to there is another one.
        let action = |action: DiscreteAction| [Some(action)];
        env.step(&action(DiscreteAction::Drop)).unwrap();
        for _ in 0..30 {
            env.step(&action(DiscreteAction::Wait)).unwrap();
        }
        let saved = env.snapshot().unwrap();
        other.reset(100 + seed).unwrap();
        other.restore(&saved).unwrap();
        played += 1;
        loop {
            let next = env.expert_action(0).unwrap();
            let info = env.step(&[Some(next)]).unwrap().swap_remove(0);
            let again = other.step(&[Some(next)]).unwrap().swap_remove(0);
            assert_eq!(
                (info.result.reward.to_bits(), env.world().hash()),
                (again.result.reward.to_bits(), other.world().hash()),
                "{seed}"
            );
            if info.result.terminated {
                fetched += u32::from(info.result.success);
                break;
            }
        }
    }
    assert!(
        played >= 4 && fetched + 1 >= played,
        "{fetched} of {played}"
    );
}

#[test]
fn settings_out_of_range_are_refused() {
    let told = |settings: Value| {
        let config = EnvConfig {
            task: "InstructionFollowing-v1".to_owned(),
            task_settings: settings,
            ..EnvConfig::default()
        };
        let made = dwell_tests::try_env_in(dwell_tests::apartment(), config, &[]);
        made.unwrap_err().to_string()
    };
    assert!(told(json!({"kinds": []})).contains("at least one of go_to_room"));
    assert!(told(json!({"kinds": ["fly"]})).contains("fly"));
    assert!(told(json!({"forms": []})).contains("at least one of single"));
    assert!(told(json!({"max_sequence_steps": 4})).contains("2 or 3"));
    assert!(
        told(json!({"words": "some"})).contains("held")
            || told(json!({"words": "some"})).contains("train")
    );
    assert!(told(json!({"step_done_reward": 1e9})).contains("step_done_reward"));
}
