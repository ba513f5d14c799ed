//! `docs/laws.md` lists the laws that there are.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use dwell_scene::LawInfo;
use dwell_scene::law::EngineKind;
use std::fmt::Write as _;
use std::path::Path;

const HEAD: &str = "# Laws

Physical effects that the basic model lacks. A law at its default is not installed and changes no bit. This page is
written by the test `laws_page` (`UPDATE_GOLDEN=1 cargo test --workspace --test it laws_page`) from what the engines say.

Worlds, environments and acoustic scenes take laws as a name, a list or a mapping:

```python
import dwell

kitchen = dwell.House.open(\"builtin:studio\")
world = dwell.World(kitchen, laws=\"drag\")  # with its usual numbers
world = dwell.World(kitchen, laws={\"drag\": {\"c_d\": 1.0}, \"wind\": {\"x_m_s\": 0.5}})
rolling = {\"id\": \"rolling_resistance\", \"target\": \"bowl_1\", \"params\": {\"c_rr\": 0.02}}
world = dwell.World(kitchen, laws=[\"drag\", rolling])
world.set_parameter(\"law/drag/c_d\", 0.8)
print(world.parameters(\"law/drag/\"))
```

In full a law is `{id, version, target, params}`. Without a version it is this build's, without a target it acts on all it can.
Parameters that are left out have their defaults, values out of bounds are refused. A law that is given no numbers has its *usual*
ones, stated below; one that has none, since all would be arbitrary (the direction of a wind), is refused with a list of what it takes.

What a target names: a law on an *object* takes an object's name (all of its bodies, free or moved by joints) or `OBJECT/PART`,
one on a *joint* a joint's name, `OBJECT/JOINT` or a number, one on an *agent* its number (laws of cameras act on what it carries), one on *contacts* `NAME` (all contacts
of it) or `NAME~NAME` (those between the two, in either order; the surface is the first), where a name is that of an object, of a
piece of the structure or of a substance of the materials library. No target means everything that they can act on: agents on
legs have neither wheels nor gyro, and are refused by laws of these. Agents that come later are among everything, and not among
those that a target names. Laws on the *world* take none. A target is kept in one spelling (a joint as `OBJECT/JOINT`), so that a
law set under a joint's number and under its name is one law; a list that names one thing in two spellings is refused (a name that
several joints have, beside another name of one of them, too), and one that has the same words twice is two laws one after the other.

Every parameter has an address, under which it is read and set while the world runs: `law/ID/PARAM` for the law without target,
`law/ID@TARGET/PARAM` for the one on a target (`law/latency@arm/elbow/delay_s`), `law/N/PARAM` for the law in place N of those
installed. The first number that differs from its default installs a law, behind the others; one whose numbers are all default
acts no more, and what it remembered is lost. Otherwise a law keeps its memory when its numbers change: a delay that grows holds
the oldest command it knows until newer ones are that late, one that shrinks skips some; play, lags and limits of rates go on
from where their output is. Values stand in the state's list of laws, so that they are in snapshot, hash and replay.

What sleeps: laws that come, go or change wake everything once. After that laws of air and of contact act on what moves and leave
asleep what sleeps; only wind wakes what it pushes by more than a thousandth of its weight, and keeps it awake as long as it does.

Laws of sound take no targets and act alike in streams and in impulse responses. Those of air and sources change the energies
between a source and a microphone, and so echograms and room measures, too. Those of where microphones are and how they face change
what receivers hear; echograms and measures stay those of the place that is asked for. `background_noise` acts on the pressure at microphones,
laws of microphones on what they give out of it, in the order in which they were installed. A law of microphones that has no impulse
response (clipping, automatic gain, noise, a clock) does to a response what it does to a recording of the impulse of 1 Pa at 1 m. What
comes, changes or goes while a stream runs is crossfaded over one block.
";

fn heading(engine: EngineKind) -> &'static str {
    match engine {
        EngineKind::Physics => "Physics",
        EngineKind::Acoustics => "Sound",
        EngineKind::Render => "Cameras and depth sensors",
    }
}

fn entry(law: &LawInfo, page: &mut String) {
    let LawInfo {
        id,
        version,
        name,
        equation,
        source,
        acts_on,
        regimes,
        rivals,
        separating_experiment,
        ..
    } = law;
    let rivals = rivals.join("`, `");
    let row = |page: &mut String, text: String| writeln!(page, "{text}").unwrap();
    row(
        page,
        format!("\n### `{id}`\n\n{name}; version {version}, acts on: {acts_on}.\n"),
    );
    row(
        page,
        format!("{}\n", equation.replace('*', "\\*").replace('|', "\\|")),
    );
    row(
        page,
        "| parameter | unit | default | bounds | plausible |\n| --- | --- | --- | --- | --- |"
            .into(),
    );
    for param in law.params {
        let [low, high] = param.plausible;
        row(
            page,
            format!(
                "| `{}` | {} | {} | {} to {} | {low} to {high} |",
                param.name, param.unit, param.default, param.low, param.high
            ),
        );
    }
    if let Some(usual) = dwell::laws::DEFAULT_VALUES
        .iter()
        .find(|usual| usual.id == *id)
    {
        let numbers = usual
            .params
            .iter()
            .map(|(name, value)| format!("`{name}` {value}"));
        let numbers = numbers.collect::<Vec<_>>().join(", ");
        row(page, format!("\nUsual: {numbers} ({}).", usual.about));
    }
    let regimes = regimes
        .iter()
        .map(|regime| serde_json::to_string(regime).unwrap().replace('"', "`"))
        .collect::<Vec<_>>()
        .join(", ");
    row(page, format!("\nActs in: {regimes}."));
    row(
        page,
        format!(
            "\nLooks like: `{rivals}`. Apart from them: {separating_experiment}.\n\nSource: {source}."
        ),
    );
}

#[test]
fn the_page_lists_every_law() {
    let mut page = HEAD.to_owned();
    for engine in [
        EngineKind::Physics,
        EngineKind::Acoustics,
        EngineKind::Render,
    ] {
        let laws: Vec<&LawInfo> = dwell::laws::all()
            .filter(|law| law.engine == engine)
            .collect();
        if !laws.is_empty() {
            write!(page, "\n## {}\n", heading(engine)).unwrap();
        }
        for law in laws {
            entry(law, &mut page);
        }
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/laws.md");
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    let differs = found
        .lines()
        .zip(page.lines())
        .find(|(old, new)| old != new);
    assert!(
        found == page,
        "docs/laws.md is not what the laws say (first difference: {differs:?}); \
         write it anew with UPDATE_GOLDEN=1 cargo test --workspace --test it laws_page"
    );
}

/// Calibration finds laws by their probes: each law has a point at which it acts, in its bounds, and says where it acts.
#[test]
fn every_law_says_where_it_acts_and_where_a_search_begins() {
    for law in dwell::laws::all() {
        let id = law.id;
        assert!(!law.regimes.is_empty(), "{id} acts in no regime");
        assert!(!law.probes.is_empty(), "{id} has no probe");
        let names = |probe: &[(&'static str, f64)]| probe.iter().map(|p| p.0).collect::<Vec<_>>();
        for probe in law.probes {
            assert_eq!(names(probe), names(law.probes[0]), "{id}");
            let mut acts = false;
            for (name, value) in *probe {
                let param = law
                    .param(name)
                    .unwrap_or_else(|| panic!("{id} has no {name}"));
                assert!((param.low..=param.high).contains(value), "{id} {name}");
                acts |= (value - param.default).abs() > 0.0;
            }
            assert!(acts, "{id}: a probe is the default");
        }
    }
}
