//! Roll-outs against closed forms, and the harness around them.

#![expect(
    clippy::unwrap_used,
    reason = "a test stops at the first surprise, in its helpers too"
)]

use dwell_calibration::bundle::file::BoardManifest;
use dwell_calibration::rollout::study::{
    ContactModel, ContactParameter, PeerScores, StudyOptions, run,
};
use dwell_calibration::rollout::{
    BoardRig, ContactRegime, HORIZONS, MotionState, PoseTrack, PoseTracks, RigSettings,
    TrackedBody, TrackerNoise, WindowOptions, diverges_under_noise, predict_windows, scores,
    window_scores, window_start,
};
use dwell_physics::ContactFriction;
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use glam::{DQuat, DVec3};

const HALF_M: f64 = 0.0524;
const RATE_HZ: f64 = 148.0;
const GRAVITY_M_S2: f64 = 9.81;

fn tracks(episodes: Vec<PoseTrack>) -> PoseTracks {
    let body = TrackedBody {
        name: "cube".into(),
        mass_kg: 0.37,
        half_extents_m: [HALF_M; 3],
        inertia_kg_m2: [0.37 * 2.0 * HALF_M * HALF_M / 3.0; 3],
    };
    PoseTracks {
        title: "made up".into(),
        licence: "CC0-1.0".into(),
        body,
        board: BoardManifest {
            friction: 0.3,
            restitution: 0.0,
            substances: None,
        },
        rate_hz: RATE_HZ,
        gravity_m_s2: GRAVITY_M_S2,
        noise: TrackerNoise::estimate(&episodes, 1.0 / RATE_HZ, GRAVITY_M_S2),
        episodes,
    }
}

fn rig(friction: f64) -> BoardRig {
    let rig = BoardRig::new(&tracks(Vec::new()), ContactFriction::Point).unwrap();
    let settings = RigSettings {
        friction,
        restitution: 0.0,
        laws: Vec::new(),
    };
    rig.with_settings(&settings).unwrap()
}

fn motion(height_m: f64, linear: DVec3, angular: DVec3) -> MotionState {
    MotionState {
        position: DVec3::new(0.4, height_m, -0.7),
        rotation: DQuat::IDENTITY,
        linear,
        angular,
    }
}

/// A parabola, and a spin about a principal axis: 0.2 mm and 0.05 degrees are a tenth of what is looked for at 40 samples.
#[test]
fn a_flight_is_a_parabola_and_a_steady_spin() {
    let (v, w) = (DVec3::new(1.0, 1.5, -0.4), DVec3::new(0.0, 6.0, 0.0));
    let start = motion(0.8, v, w);
    let found = rig(0.3).simulate(&start, 40).unwrap();
    for (k, there) in found.iter().enumerate() {
        let t = (k + 1) as f64 / RATE_HZ;
        let fall = DVec3::NEG_Y * (0.5 * GRAVITY_M_S2 * t * t);
        assert!((there.position - (start.position + v * t + fall)).length() < 2e-4);
        let turned = DQuat::from_rotation_y(6.0 * t);
        assert!(there.rotation.angle_between(turned) < 1e-3, "{k}");
    }
}

/// A cube that lies on the board and is given 1 m/s stops after v²/(2 μ g): within 1 % with friction by patch. Friction by
/// point loses up to 7 % of it: rapier turns each point's impulse towards the velocity that friction itself would cause,
/// so that a part of it points sideways, and points on both sides cancel.
#[test]
fn a_sliding_cube_stops_where_coulomb_says() {
    for (way, least, most) in [
        (ContactFriction::Patch, 0.99, 1.01),
        (ContactFriction::Point, 0.99, 1.08),
    ] {
        let plain = BoardRig::new(&tracks(Vec::new()), way).unwrap();
        for friction in [0.15, 0.3] {
            let settings = RigSettings {
                friction,
                restitution: 0.0,
                laws: Vec::new(),
            };
            let start = motion(HALF_M, DVec3::X, DVec3::ZERO);
            let found = plain
                .with_settings(&settings)
                .unwrap()
                .simulate(&start, 160)
                .unwrap();
            let path = found.last().unwrap().position.x - start.position.x;
            let share = path * 2.0 * friction * GRAVITY_M_S2;
            assert!((least..most).contains(&share), "{way:?}: {share}");
            assert!(found.last().unwrap().linear.length() < 1e-3);
        }
    }
}

/// Tosses made by the same engine with this friction.
fn tossed(friction: f64, count: usize) -> PoseTracks {
    let rig = rig(friction);
    let episodes = (0..count)
        .map(|k| {
            let turn = DQuat::from_rotation_x(0.4 * k as f64) * DQuat::from_rotation_z(0.3);
            let start = MotionState {
                rotation: turn,
                ..motion(
                    0.2,
                    DVec3::new(1.2, -0.4, 0.3),
                    DVec3::new(3.0, -2.0, k as f64),
                )
            };
            let mut motions = vec![start];
            motions.extend(rig.simulate(&start, 60).unwrap());
            PoseTrack {
                name: format!("toss {k}"),
                group: format!("toss {k}"),
                regimes: vec![ContactRegime::Flight; motions.len()],
                motions,
                start: 0,
                start_motion: start,
            }
        })
        .collect();
    tracks(episodes)
}

/// A roll-out of what the engine itself made has no error, another friction has one, and threads change no bit.
#[test]
fn roll_outs_meet_their_own_tosses_and_threads_change_nothing() {
    let tracks = tossed(0.25, 5);
    let all: Vec<usize> = (0..5).collect();
    let own = scores(&rig(0.25), &tracks, &all, Threads::ONE).unwrap();
    assert!(own.iter().all(|score| score.e_q < 1e-12), "{own:?}");
    let other = scores(&rig(0.4), &tracks, &all, Threads::ONE).unwrap();
    assert!(
        other.iter().all(|score| score.position_widths > 0.01),
        "{other:?}"
    );
    let rig = rig(0.4);
    let rigs = vec![&rig; 5];
    let windowing = |threads| WindowOptions {
        stride: 7,
        chaos_guard: Some(RandomKey::root(0)),
        threads,
    };
    let found = predict_windows(&tracks, &rigs, &windowing(Threads::ONE)).unwrap();
    for threads in [2, 7] {
        let threads = Threads::new(threads);
        assert_eq!(scores(&rig, &tracks, &all, threads).unwrap(), other);
        assert_eq!(
            predict_windows(&tracks, &rigs, &windowing(threads)).unwrap(),
            found
        );
    }
    let one = window_scores(&found);
    // Errors grow with the horizon, and every horizon is there.
    let total: Vec<f64> = HORIZONS
        .iter()
        .map(|h| {
            let mut all = one.iter().filter(|w| w.horizon == *h && !w.diverging);
            all.find(|w| w.regime.is_none()).unwrap().position_rms_mm
        })
        .collect();
    assert!(total.windows(2).all(|pair| pair[0] < pair[1]), "{total:?}");
}

/// The friction that was hidden in 12 tosses is found by every fold from the tosses of the other folds, within 2 % (seven
/// points a generation narrow a range of 1 to 12 to that in 16 generations), for any number of threads; a peer that is
/// the nominal engine itself loses against it on most tosses.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn hidden_friction_is_found_out_of_fold() {
    let mut tracks = tossed(0.25, 12);
    tracks.board.friction = 0.4;
    let friction = ContactParameter {
        name: "friction",
        unit: "1",
        range: [0.05, 0.6],
        is_logarithmic: true,
    };
    let model = |name, parameters| ContactModel {
        name,
        about: "",
        contact_friction: ContactFriction::Point,
        parameters,
    };
    let options = StudyOptions {
        folds: 2,
        population: 5,
        generations: [8, 8],
        first_episodes: 3,
        window_stride: 30,
        bootstrap_draws: 100,
        threads: Some(1),
        ..StudyOptions::default()
    };
    let nominal = model("nominal", Vec::new());
    let alone = run(
        &tracks,
        std::slice::from_ref(&nominal),
        &[],
        &options,
        &mut |_, _| true,
    )
    .unwrap();
    let scored = alone.models[0].episodes.iter();
    let peer = PeerScores {
        name: "nominal".into(),
        scores: scored.map(|e| (e.episode.clone(), e.score)).collect(),
    };
    let models = [nominal, model("fitted", vec![friction])];
    let report = run(
        &tracks,
        &models,
        std::slice::from_ref(&peer),
        &options,
        &mut |_, _| true,
    )
    .unwrap();
    let fitted = &report.models[1];
    for chosen in &fitted.chosen {
        assert!((chosen[0] / 0.25 - 1.0).abs() < 0.02, "{chosen:?}");
    }
    assert!(fitted.against[0].position_widths.better_share > 0.9);
    assert!(
        report
            .found
            .parameters
            .values()
            .any(|v| (v / 0.25 - 1.0).abs() < 0.02)
    );
    assert!(report.to_html().contains("fitted against nominal"));
    let threads = StudyOptions {
        threads: Some(3),
        ..options.clone()
    };
    let again = run(&tracks, &models, &[peer], &threads, &mut |_, _| true).unwrap();
    assert_eq!(again.models, report.models);
    // Too few episodes for the folds, and a caller that stops.
    tracks.episodes.truncate(3);
    assert!(run(&tracks, &models, &[], &options, &mut |_, _| true).is_err());
}

/// A window in flight starts with velocities from the past poses: recorded ones that lag by two samples, as filtered
/// differences do, change nothing.
#[test]
fn window_starts_in_flight_do_not_lag() {
    let rig = rig(0.3);
    let start = motion(0.9, DVec3::new(1.0, 0.5, 0.0), DVec3::new(2.0, 0.0, 0.0));
    let mut motions = vec![start];
    motions.extend(rig.simulate(&start, 40).unwrap());
    let honest = motions.clone();
    for k in (2..motions.len()).rev() {
        motions[k].linear = honest[k - 2].linear;
    }
    let track = PoseTrack {
        name: "flight".into(),
        group: "flight".into(),
        regimes: vec![ContactRegime::Flight; motions.len()],
        motions,
        start: 0,
        start_motion: start,
    };
    let noise = TrackerNoise {
        position_m: 2e-5,
        rotation_rad: 2e-4,
    };
    let found = window_start(&track, 20, 1.0 / RATE_HZ, GRAVITY_M_S2, &noise, None);
    assert!((found.linear - honest[20].linear).length() < 5e-3);
    assert!((track.motions[20].linear - honest[20].linear).length() > 0.1);
    assert!((found.angular - honest[20].angular).length() < 1e-2);
    assert!((found.position - honest[20].position).length() < 1e-4);
}

/// A cube on its edge, upright to 0.02 degrees, falls to a side that noise of a tenth of a degree decides: the guard
/// marks it; one that lies flat is not marked.
#[test]
fn a_cube_on_its_edge_is_chance_and_a_flat_one_is_not() {
    let balanced = |degrees: f64, height_m: f64| {
        let turn = DQuat::from_rotation_z(degrees.to_radians());
        let start = MotionState {
            rotation: turn,
            ..motion(height_m, DVec3::ZERO, DVec3::ZERO)
        };
        let mut motions = vec![start];
        motions.extend(rig(0.3).simulate(&start, 80).unwrap());
        PoseTrack {
            name: format!("{degrees}"),
            group: format!("{degrees}"),
            regimes: vec![ContactRegime::Contact; motions.len()],
            motions,
            start: 0,
            start_motion: start,
        }
    };
    let mut tracks = tracks(vec![
        balanced(45.02, HALF_M * 2.0_f64.sqrt()),
        balanced(0.0, HALF_M),
    ]);
    tracks.noise = TrackerNoise {
        position_m: 1e-5,
        rotation_rad: 2e-3,
    };
    let found = diverges_under_noise(
        &rig(0.3),
        &tracks,
        &[0, 1],
        RandomKey::root(2),
        Threads::ONE,
    )
    .unwrap();
    assert_eq!(found, [true, false]);
}

#[test]
fn a_table_of_scores_names_the_columns_that_it_wants() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("peer.csv");
    let read = |text: &str| {
        std::fs::write(&path, text).unwrap();
        PeerScores::read(&path).map_err(|error| error.to_string())
    };
    let whole = read("episode,position_widths,rotation_deg,e_q\na,0.5,10,0.1\n").unwrap();
    assert_eq!(
        (whole.name.as_str(), whole.scores["a"].rotation_deg),
        ("peer", 10.0)
    );
    let told = read("episode,rotation_deg,e_q\na,10,0.1\n").unwrap_err();
    for word in ["peer.csv line 2", "position_widths", "columns are episode"] {
        assert!(told.contains(word), "{told}");
    }
}
