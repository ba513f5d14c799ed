//! What can act on a ball: laws of bodies, of contacts where there is a board, gravity, and the tracker's faults.

use crate::bundle::file::{BoardManifest, MeasurementDescription};
use crate::experiment::{
    Cause, CauseBinding, Fault, FitParameter, air_density_kg_m3, gravity_m_s2,
};
use dwell_scene::LawInfo;
use dwell_scene::law::LawRegime;

/// The address of the acceleration of free fall.
pub(super) const GRAVITY: &str = "world/gravity_m_s2";
/// Acceleration of free fall between equator and pole at heights of up to 3 km, m/s².
const EARTH_GRAVITY_M_S2: [f64; 2] = [9.77, 9.84];
/// The precision of a local gravity that was measured, m/s².
const MEASURED_GRAVITY_M_S2: f64 = 2e-3;
/// The regimes of a ball that touches a board.
const TOUCHING: [LawRegime; 4] = [
    LawRegime::Impact,
    LawRegime::Sliding,
    LawRegime::Rolling,
    LawRegime::Resting,
];
/// The kinds of target that laws of touching bodies have.
const TOUCHED: [&str; 3] = ["object", "contact", "world"];

/// Everything that may be missing.
pub(super) fn causes(manifest: &MeasurementDescription) -> Vec<Cause> {
    let density = ("air_density_kg_m3", air_density_kg_m3(manifest));
    let targets: Vec<String> = manifest
        .scene
        .bodies
        .iter()
        .map(|body| body.name.clone())
        .collect();
    let board = manifest.scene.board.as_ref();
    let acts = |law: &&LawInfo| {
        let in_flight = law.acts_on == "object" && law.regimes.contains(&LawRegime::Flight);
        let in_touch = TOUCHED.contains(&law.acts_on)
            && law.regimes.iter().any(|regime| TOUCHING.contains(regime));
        in_flight || (board.is_some() && in_touch)
    };
    let laws = dwell_physics::laws::all().filter(acts).map(|law| {
        let targets = if law.acts_on == "world" {
            &[]
        } else {
            &targets[..]
        };
        Cause::of_law(law, targets, &[density])
    });
    let faults = [Fault::LengthScale, Fault::ClockScale, Fault::FrameTilt].map(Fault::cause);
    laws.chain([gravity(manifest)])
        .chain(board.into_iter().flat_map(pair_values))
        .chain(faults)
        .collect()
}

/// Another acceleration of free fall. Where it was measured, only that value is plausible.
fn gravity(manifest: &MeasurementDescription) -> Cause {
    let told = gravity_m_s2(manifest);
    let plausible = if manifest.scene.environment.g_m_s2.is_some() {
        [told - MEASURED_GRAVITY_M_S2, told + MEASURED_GRAVITY_M_S2]
    } else {
        EARTH_GRAVITY_M_S2
    };
    Cause {
        id: "gravity".into(),
        name: "another acceleration of free fall".into(),
        equation: "dv/dt = -g, with g in m/s2".into(),
        parameters: vec![FitParameter {
            name: "gravity_m_s2".into(),
            unit: "m/s2".into(),
            default: told,
            low: 0.0,
            high: 30.0,
            plausible,
            step: 0.2,
        }],
        probes: Vec::new(),
        separating_experiment: "throw flat and steep, slow and fast: gravity changes the vertical motion alone, by the same \
                                amount at every speed; for scales of lengths and of the clock, measure a known length and \
                                time a pendulum"
            .into(),
        binding: CauseBinding::Addresses(vec![GRAVITY.into()]),
        fixed: Vec::new(),
    }
}

/// Another friction and another restitution of ball and board than the bundle assumes.
fn pair_values(board: &BoardManifest) -> [Cause; 2] {
    let value = |name: &str, default: f64, [high, most]: [f64; 2], probe: f64| FitParameter {
        name: name.into(),
        unit: "1".into(),
        default,
        low: 0.0,
        high,
        plausible: [0.0, most],
        step: probe,
    };
    let cause = |texts: [&str; 4], parameter: FitParameter| {
        let [id, name, equation, experiment] = texts.map(str::to_owned);
        let address = board.pair_address(&id);
        Cause {
            id,
            name,
            equation,
            parameters: vec![parameter],
            probes: Vec::new(),
            separating_experiment: experiment,
            binding: CauseBinding::Addresses(vec![address]),
            fixed: Vec::new(),
        }
    };
    [
        cause(
            [
                "friction",
                "another friction of the two surfaces",
                "|F_t| <= mu N while they slide on each other",
                "let the ball slide without spin at two speeds: friction slows it by mu g at each, until it rolls",
            ],
            value("friction", board.friction, [3.0, 1.5], 0.02),
        ),
        cause(
            [
                "restitution",
                "another restitution of the two surfaces",
                "v' = -e v along the normal in an impact",
                "drop the ball from heights that differ by a factor of sixteen: one restitution leaves the same share of \
                 the speed at each",
            ],
            value("restitution", board.restitution, [0.99, 0.98], 0.01),
        ),
    ]
}
