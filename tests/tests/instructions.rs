//! Instructions for feet and hands: their words are read anew, and what became of the house is judged by them.
//!
//! The judge here knows the text and the state alone: it reads the instruction, looks up what its phrases mean in the house as it stood
//! at the start, and looks at hands, joints, switches and rooms itself.

use dwell::{DiscreteAction, Engines, Env, EnvConfig};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, ObjectId, RoomId};
use dwell_semantics::Term;
use dwell_semantics::check::{Checker, Listener};
use dwell_semantics::form::{Form, Phrase, RequestStep};
use dwell_semantics::instruct::InstructionGoal;
use glam::Vec3;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::sync::Arc;

const ME: AgentId = AgentId(0);

/// A step as its words mean it.
#[derive(Clone, Debug, PartialEq)]
enum Meant {
    GoTo(RoomId),
    Find(ObjectId),
    PickUp(ObjectId),
    Open(ObjectId),
    Close(ObjectId),
    SwitchOn(ObjectId),
    SwitchOff(ObjectId),
    Bring(ObjectId, RoomId),
}

impl Meant {
    fn thing(&self) -> Option<ObjectId> {
        match self {
            Self::GoTo(_) => None,
            Self::Find(thing)
            | Self::PickUp(thing)
            | Self::Open(thing)
            | Self::Close(thing)
            | Self::SwitchOn(thing)
            | Self::SwitchOff(thing)
            | Self::Bring(thing, _) => Some(*thing),
        }
    }

    fn is_passing(&self) -> bool {
        matches!(self, Self::GoTo(_) | Self::Find(_))
    }

    fn is_so(&self, env: &Env) -> bool {
        let (house, state) = (env.world().house(), env.world().state());
        let opening = |thing| {
            let joints = house.joints_of(thing);
            let joints = joints.filter(|joint| house.joints[*joint].is_openable());
            let open =
                joints.map(|joint| house.joints[joint].openness(state.joint_position[joint]));
            open.fold(0.0, f32::max)
        };
        match self {
            Self::GoTo(room) => {
                let feet = state.agents[ME].position;
                house.room_at(feet + Vec3::Y * 0.1) == Some(*room)
            }
            // The rule of this sight is tested by itself.
            Self::Find(thing) => InstructionGoal::objects(vec![*thing], 1.5).is_reached(
                &env.world().engines().semantics().scene(state),
                env.world().rays(),
                ME,
            ),
            Self::PickUp(thing) => state.held_by[*thing] == Some(ME),
            Self::Open(thing) => opening(*thing) > 0.5,
            Self::Close(thing) => opening(*thing) <= 0.02,
            Self::SwitchOn(thing) => state.switched_on[*thing],
            Self::SwitchOff(thing) => !state.switched_on[*thing],
            Self::Bring(thing, room) => {
                let middle = house.object_bounds(state, *thing).center();
                state.held_by[*thing].is_none() && house.room_at(middle) == Some(*room)
            }
        }
    }
}

/// The steps of the instruction of an episode that has just begun.
fn meant(env: &Env) -> Vec<Meant> {
    let text = &env.episode(0).expect("an episode has begun").instruction;
    let semantics = env.world().engines().semantics();
    let scene = semantics.scene(env.world().state());
    let checker = Checker::new(&scene, Listener::default());
    let denoted = |phrase: &Phrase| match phrase {
        Phrase::Described(description) => checker.denotes(description),
        _ => None,
    };
    let thing = |phrase: &Phrase| match denoted(phrase) {
        Some(Term::Object(object)) => object,
        other => panic!("{text:?}: {phrase:?} means {other:?}"),
    };
    let room = |phrase: &Phrase| match denoted(phrase) {
        Some(Term::Room(room)) => room,
        other => panic!("{text:?}: {phrase:?} means {other:?}"),
    };
    let read = semantics.language().read(text);
    let Form::Request(steps) = read.expect("the words can be read").forms.swap_remove(0) else {
        panic!("{text:?} is no request");
    };
    let one = |step: &RequestStep| match step {
        RequestStep::GoTo(to) => Meant::GoTo(room(to)),
        RequestStep::Bring { object, to } => Meant::Bring(thing(object), room(to)),
        RequestStep::Do { verb, object } => match verb.as_str() {
            "find" => Meant::Find(thing(object)),
            "pick_up" => Meant::PickUp(thing(object)),
            "open" => Meant::Open(thing(object)),
            "close" => Meant::Close(thing(object)),
            "switch_on" => Meant::SwitchOn(thing(object)),
            "switch_off" => Meant::SwitchOff(thing(object)),
            other => panic!("{text:?}: {other}"),
        },
        other => panic!("{text:?}: {other:?}"),
    };
    steps.iter().map(one).collect()
}

/// Plays an episode to its end. Gives back the actions, whether it was called a success, and whether the judge of this file calls it one.
fn play(
    env: &mut Env,
    seed: u64,
    mut policy: impl FnMut(usize, &mut Env) -> DiscreteAction,
) -> (Vec<DiscreteAction>, bool, bool) {
    env.reset(seed).expect("the task can be played");
    let steps = meant(env);
    let (mut done, mut actions) = (0, Vec::new());
    for k in 0..1500 {
        let action = if k == 1499 {
            DiscreteAction::Stop
        } else {
            policy(k, env)
        };
        actions.push(action);
        let info = env.step(&[Some(action)]);
        let info = info.expect("the episode goes on").swap_remove(0);
        while done < steps.len() && steps[done].is_so(env) {
            done += 1;
        }
        if info.result.terminated {
            let last = steps.len() - 1;
            let still = steps.iter().enumerate().all(|(k, step)| {
                let undone = steps[k + 1..]
                    .iter()
                    .any(|later| !later.is_passing() && later.thing() == step.thing());
                let counts = k == last || !(step.is_passing() || undone);
                !counts || step.is_so(env)
            });
            return (actions, info.result.success, done == steps.len() && still);
        }
    }
    unreachable!("stop ends an episode")
}

fn env_in(house: dwell_scene::House, settings: Value) -> Env {
    let config = EnvConfig {
        task: "InstructionSteps".to_owned(),
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
fn verdicts_are_those_of_the_words() {
    let (houses, episodes) = if dwell_tests::runs_all() {
        (1000, 2)
    } else {
        (4, 5)
    };
    let mut kinds = BTreeSet::new();
    let (mut accepted, mut rejected, mut played) = (0, 0, 0);
    for house in 0..houses {
        let (house, _) = dwell_houses::open(&format!("seed:{}", 700 + house)).unwrap();
        let mut env = env_in(
            house,
            json!({"max_instruction_steps": 3, "max_distance_m": 15.0}),
        );
        for seed in 0..episodes {
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
                n => DiscreteAction::ALL[1 + n % 11],
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
    meant(env).iter().any(|step| !step.is_passing())
}

/// An episode that is restored after its first step is done knows that it is.
#[test]
fn a_restored_instruction_knows_what_is_done() {
    let (house, _) = dwell_houses::open("builtin:apartment").unwrap();
    let settings = json!({"min_instruction_steps": 2, "max_instruction_steps": 2});
    let mut env = env_in(house.clone(), settings.clone());
    let mut other = env_in(house, settings);
    let mut checked = 0;
    for seed in 0..12 {
        let (plan, success, _) = play(&mut env, seed, |_, env| env.expert_action(0).unwrap());
        assert!(success, "{seed} {}", env.episode(0).unwrap().instruction);
        env.reset(seed).unwrap();
        let steps = meant(&env);
        // Where the first step is passing, nothing but the snapshot says that it is done.
        if !steps[0].is_passing() {
            continue;
        }
        let mut saved = None;
        for action in &plan {
            env.step(&[Some(*action)]).unwrap();
            if saved.is_some() && !steps[0].is_so(&env) {
                saved = Some(env.snapshot().unwrap());
                break;
            }
            if steps[0].is_so(&env) {
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

#[test]
fn settings_out_of_range_are_refused() {
    let told = |settings: Value| {
        let config = EnvConfig {
            task: "InstructionSteps".to_owned(),
            task_settings: settings,
            ..EnvConfig::default()
        };
        let made = dwell_tests::try_env_in(dwell_tests::apartment(), config, &[]);
        made.unwrap_err().to_string()
    };
    assert!(told(json!({"kinds": []})).contains("at least one of go_to_room"));
    assert!(told(json!({"kinds": ["fly"]})).contains("fly"));
    assert!(told(json!({"max_instruction_steps": 4})).contains("1 to 3"));
    assert!(told(json!({"min_instruction_steps": 3})).contains("which is 2"));
    assert!(told(json!({"step_done_reward": 1e9})).contains("step_done_reward"));
}
