//! Only the effects that a scene calls for: what isn't there costs nothing, and the ledger says what each one costs and
//! does.

use crate::common::{everything, size};
use crate::program::run;
use ropewalk::core::integrator::{Options, Stepping};
use ropewalk::core::{
    Assembly, At, BuildError, Energy, Gives, Law, Load, Pattern, Power, Real, Station, Term,
};
use ropewalk::forces::{AddedMass, DragSpec, Spring};
use ropewalk::scene::records::PositionSpec;
use ropewalk::scene::{Builder, ForceSpec, Format, register_spec};
use ropewalk::{
    EffectWork, EffectsOptions, Ledger, Manifest, Scene, SceneFile, Simulation, Verdict, Water, bundled,
    effects, simulate,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fs;
use std::process::Command;
use std::sync::atomic::{AtomicU64, Ordering};

fn open(scene: &str, set: &[&str]) -> SceneFile {
    let set: Vec<String> = set.iter().map(|s| (*s).to_string()).collect();
    SceneFile::open(scene, &set, bundled()).unwrap_or_else(|e| panic!("{e}"))
}

/// Of every bundled scene: its terms, its constraints, the columns of its history, and the numbers of velocities,
/// multipliers and non-zeros.
const MANIFESTS: [(&str, &str, &str, &str, [usize; 3]); 8] = [
    (
        "cantilever",
        "cable L4+T3 locking-free; force at `beam.end`",
        "root clamp",
        "beam.end.x beam.end.y beam.end.z beam.start.moment beam.end.tension root.fx root.fy root.fz root.magnitude",
        [102, 5, 1303],
    ),
    (
        "catenary",
        "cable L4+T3 locking-free; cable: weight",
        "left right",
        "middle.x middle.y middle.z cable.start.tension cable.end.tension left.fx left.fy left.fz left.magnitude",
        [366, 6, 4482],
    ),
    ("hose-straight", HOSE_TERMS, "ship", HOSE_RECORDS, [126, 3, 2277]),
    ("hose-turn", HOSE_TERMS, "ship", HOSE_RECORDS, [126, 3, 2277]),
    (
        "pendulum",
        "cable L4+T3 locking-free; cable: weight",
        "hinge",
        "cable.end.x cable.end.y cable.end.z cable.end.vx cable.end.vy cable.end.vz cable.start.tension hinge.fx \
         hinge.fy hinge.fz hinge.magnitude energy.kinetic energy.potential energy.supplied energy.dissipated \
         energy.imbalance",
        [390, 3, 4707],
    ),
    (
        "shear-pin",
        "rigid bodies; hose: joints; vehicle: weight; connection: weight; hose: weight; connection: buoyancy; \
         hose: buoyancy; hose: wake of a blunt end; spool; hose: drag, added mass",
        "299 of hose drive roll yaw trim pin hinge",
        "pin.magnitude drive.imposed_x drive.actual_x drive.imposed_vx drive.actual_vx drive.difference pin.fx pin.fy \
         pin.fz pin.turning.wy hinge.turning.wz hose.centre.x hose.centre.y hose.centre.z spool.released \
         energy.kinetic energy.potential energy.supplied energy.dissipated energy.imbalance",
        [1812, 913, 73585],
    ),
    (
        "unwinding",
        "flowing cable L4+T3 locking-free; open end L4+T3; axial damping L4 lob3 of a flowing cable; eyelet.feed; cable: drag",
        "eyelet spool package",
        "eyelet.tension lift_off.tension cable.length drawn.payout drawn.payout_rate peeled.payout peeled.payout_rate peeled.pull lift_off.x \
         lift_off.y lift_off.z centre.x centre.y centre.z centre.acceleration.ax centre.acceleration.ay \
         centre.acceleration.az cable.cn@25% cable.cn@50% cable.cn@75% lift_off.curvature energy.kinetic energy.potential energy.supplied energy.dissipated \
         energy.imbalance",
        [104, 7, 3141],
    ),
    (
        "unwinding-paper",
        "",
        "",
        "cable.tension.eyelet cable.tension.lift cable.length.free cable.length.peeled cable.speed.drawn \
         cable.speed.peeled cable.lift.x cable.lift.y cable.lift.z cable.radius.radius cable.centre.x cable.centre.y \
         cable.centre.z cable.acceleration.x cable.acceleration.y cable.acceleration.z cable.drag.quarter \
         cable.drag.half cable.drag.three_quarters",
        [158, 0, 0],
    ),
];

const HOSE_TERMS: &str = "cable L4+T3 locking-free; body; hose: weight; body: weight; hose: buoyancy; hose: wake of a blunt end; hose: drag, added mass";
const HOSE_RECORDS: &str = "height.z hose.end.x hose.end.y hose.end.z hose.centre.x hose.centre.y hose.centre.z \
                            hose.length hose.start.x hose.start.y hose.start.z hose.start.tension hose.middle.tension \
                            hose.middle.curvature ship.fx ship.fy ship.fz ship.magnitude energy.kinetic \
                            energy.potential energy.supplied energy.dissipated energy.imbalance";

#[test]
fn bundled_scenes_hold_these_effects_and_no_others() {
    assert_eq!(MANIFESTS.map(|m| m.0).to_vec(), bundled().iter().map(|b| b.name).collect::<Vec<_>>());
    for (name, terms, constraints, records, numbers) in MANIFESTS {
        let file = open(name, &[]);
        let m = Manifest::new(&file, &file.build().expect(name)).expect(name);
        assert_eq!(m.terms.join("; "), terms, "{name}");
        let (links, named): (Vec<_>, Vec<_>) =
            m.constraints.iter().map(|c| &c.0).partition(|c| c.contains('/'));
        let links = (!links.is_empty()).then(|| format!("{} of hose", links.len()));
        let named = links.into_iter().chain(named.into_iter().cloned()).collect::<Vec<_>>();
        assert_eq!(named.join(" "), constraints, "{name}");
        assert_eq!(m.records.join(" "), records, "{name}");
        assert_eq!([m.unknowns, m.multipliers, m.non_zeros], numbers, "{name}");
    }
}

/// Velocities, multipliers, non-zeros, and columns of the history; records that can't be made count for nothing.
fn extent(scene: &Scene) -> Option<[usize; 4]> {
    let model = scene.build().ok()?;
    let columns = |k: &ropewalk::core::Model| -> usize {
        scene.records.iter().filter_map(|r| r.build(k).ok()).map(|r| r.columns().len()).sum()
    };
    Some([model.velocities(), model.multipliers(), model.structure().entries(), columns(&model)])
}

#[track_caller]
fn no_larger(what: &str, with: &Scene, without: &Scene) -> bool {
    let all = extent(with).unwrap_or_else(|| panic!("{what}: the whole scene"));
    let Some(less) = extent(without) else { return false };
    assert!(less.iter().zip(&all).all(|(a, b)| a <= b), "{what}: {all:?} became {less:?}");
    true
}

#[test]
fn a_scene_without_an_effect_is_never_larger() {
    let mut tried = 0;
    for b in bundled() {
        let scene = open(b.name, &[]).into_scene();
        for k in 0..scene.forces.len() {
            let mut less = scene.clone();
            let gone = less.forces.remove(k);
            tried += usize::from(no_larger(&format!("{} without {gone:?}", b.name), &scene, &less));
        }
        for k in 0..scene.constraints.len() {
            let mut less = scene.clone();
            less.constraints.remove(k);
            // a constraint may be needed by another, such as a pin by what breaks it
            tried += usize::from(no_larger(&format!("{} without constraint {k}", b.name), &scene, &less));
        }
    }
    assert!(tried >= 30, "only {tried} scenes were built");
    for (name, with, without) in [
        ("hose-turn", "winding=0.5 m/s", "winding=0 m/s"),
        ("hose-turn", "bending_retardation_time=0.1 s", "bending_retardation_time=0 s"),
        ("hose-turn", "body_drag_area=1 m^2", "body_drag_area=0 m^2"),
        ("unwinding", "axial_retardation_time=0.01 ms", "axial_retardation_time=0 ms"),
        ("shear-pin", "pin_strength=100 N", "pin_strength=1e9 N"),
        ("pendulum", "ei=1", "ei=0"),
    ] {
        let [with, without] = [with, without].map(|set| open(name, &[set]).into_scene());
        assert!(no_larger(name, &with, &without));
    }
}

static LOADED: AtomicU64 = AtomicU64::new(0);
static ADDED: AtomicU64 = AtomicU64::new(0);

/// A law that counts how often it is asked.
#[derive(Clone)]
struct CountedLaw(AddedMass);

impl Law for CountedLaw {
    const NEEDS_DIAMETER: bool = true;
    fn label(&self) -> String {
        self.0.label()
    }
    fn gives(&self) -> Gives {
        self.0.gives()
    }
    fn load<R: Real, const TANGENT: bool>(&self, t: f64, at: &Station<R>, out: &mut Load<R>) {
        LOADED.fetch_add(1, Ordering::Relaxed);
        self.0.load::<R, TANGENT>(t, at, out);
    }
    fn power<R: Real>(&self, t: f64, at: &Station<R>, load: &Load<R>) -> Power<R> {
        LOADED.fetch_add(1, Ordering::Relaxed);
        self.0.power(t, at, load)
    }
}

/// A wrapper that counts the calls of a term.
struct Counted(Box<dyn Term>);

impl Counted {
    fn inner(&self) -> &dyn Term {
        ADDED.fetch_add(1, Ordering::Relaxed);
        self.0.as_ref()
    }
}

impl Term for Counted {
    fn label(&self) -> String {
        self.inner().label()
    }
    fn pattern(&self, p: &mut Pattern) {
        self.inner().pattern(p);
    }
    fn symmetric(&self) -> bool {
        self.inner().symmetric()
    }
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        self.inner().add(at, out);
    }
    fn energy(&self, at: &At<'_>) -> Energy {
        self.inner().energy(at)
    }
    fn power(&self, at: &At<'_>) -> Power {
        self.inner().power(at)
    }
}

#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
struct CountedSpring;
register_spec!(Force, "counted_spring", CountedSpring);

#[typetag::serde(name = "counted_spring")]
impl ForceSpec for CountedSpring {
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let ends = [b.marker("marker", &"cable.end".into())?, b.marker("to", &[3.0, 0.0, 0.0].into())?];
        let spring = Spring::new("counted", b.nodes(), ends, 10.0, 1.0)?;
        b.term(Box::new(Counted(Box::new(spring))));
        Ok(())
    }
}

#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
struct CountedAddedMass;
register_spec!(Force, "counted_added_mass", CountedAddedMass);

#[typetag::serde(name = "counted_added_mass")]
impl ForceSpec for CountedAddedMass {
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let density = b.water()?.density;
        b.load(&[], CountedLaw(AddedMass::new(density, 1.0)?))
    }
}

#[test]
fn an_absent_effect_is_never_called() {
    let calls = |spring: bool, mass: bool| {
        let mut scene = everything();
        if spring {
            scene.force(CountedSpring);
        }
        if mass {
            scene.force(CountedAddedMass);
        }
        LOADED.store(0, Ordering::Relaxed);
        ADDED.store(0, Ordering::Relaxed);
        let mut s = Simulation::new(scene.build().expect("model"), &Options::default(), 1.0).expect("start");
        s.advance(0.05, 0.01, &mut ()).expect("run");
        [LOADED.load(Ordering::Relaxed), ADDED.load(Ordering::Relaxed)]
    };
    let both = calls(true, true);
    assert!(both[0] > 100 && both[1] > 10, "{both:?}");
    let [law, term] = calls(true, false);
    assert!(law == 0 && term > 10, "{law} and {term}");
    let [law, term] = calls(false, true);
    assert!(law > 100 && term == 0, "{law} and {term}");
    assert_eq!(calls(false, false), [0, 0]);
}

/// What cargo says a package depends on.
fn dependencies(flags: &[&str]) -> BTreeSet<String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let tree =
        ["tree", "--offline", "--locked", "--edges", "normal", "--prefix", "none", "--format", "{lib}"];
    let out = Command::new(cargo).args(tree).args(flags).current_dir(env!("CARGO_MANIFEST_DIR")).output();
    let out = out.expect("cargo");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    String::from_utf8_lossy(&out.stdout).lines().map(|l| l.trim_end_matches(" (*)").to_string()).collect()
}

#[test]
fn without_contact_there_is_no_library_for_it() {
    let heavy = |all: &BTreeSet<String>| ["parry3d_f64", "stl_io", "tobj"].map(|name| all.contains(name));
    assert_eq!(heavy(&dependencies(&[])), [true; 3]);
    assert_eq!(heavy(&dependencies(&["--no-default-features"])), [false; 3]);
}

/// `everything` with a record and steps that take the same work whatever the machine.
fn recorded() -> Scene {
    let mut scene = everything();
    scene.record(PositionSpec::new("cable.end"));
    scene.run.duration = 0.5;
    scene.solver.stepping = Stepping::Fixed { h: 2e-3 };
    scene
}

fn ledger(scene: &Scene, record: &str) -> Ledger {
    effects(scene, record, &EffectsOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

fn work<'a>(ledger: &'a Ledger, effect: &str) -> &'a EffectWork {
    ledger.work.iter().find(|w| w.effect == effect).unwrap_or_else(|| panic!("{effect}: {:?}", ledger.work))
}

#[test]
fn the_ledger_adds_up_and_knows_what_effects_do() {
    let scene = recorded();
    let found = ledger(&scene, "cable.end");
    let history = simulate(&scene).expect("run");
    let audit = history.audit;

    let shares: f64 = found.costs.iter().map(|c| c.share).sum();
    assert!((shares - 1.0).abs() < 1e-9, "{shares}");
    let all: Vec<&str> = found.costs.iter().map(|c| c.label.as_str()).collect();
    let terms = history.model.terms().iter().map(|t| t.label()).chain(
        ["constraints", "factorisation", "solution and its check", "audit of energy", "recording"]
            .map(String::from),
    );
    for label in terms {
        assert!(all.contains(&label.as_str()), "{label} in {all:?}");
    }
    let calls = |label: &str| found.costs.iter().find(|c| c.label == label).expect(label).calls;
    assert_eq!(calls("audit of energy"), found.counts.steps);
    assert_eq!(calls("recording") as usize, history.table.rows());
    // the start, before the clocks run, takes a few
    let factored = found.counts.factorizations - calls("factorisation");
    assert!(factored <= 4, "{factored}");
    assert!(calls("cable: weight") >= found.counts.newton_iterations);
    assert_eq!(calls("cable: weight"), calls("constraints"));

    // the work of all effects is nothing but the error of the balance
    let sum: f64 = found.work.iter().map(|w| w.work).sum();
    assert!((sum + audit.imbalance()).abs() < 1e-9 * audit.scale, "{sum} and {}", audit.imbalance());
    // and that of weight, height by mass
    let fallen = |name: &str| {
        let z = history.column("cable.end.z").expect("z");
        (z[0] - z[z.len() - 1]) * if name == "bob" { 9.81 } else { f64::NAN }
    };
    let weight = work(&found, "bob: weight");
    assert!(
        (weight.work - fallen("bob")).abs() < 1e-9 * weight.work.abs(),
        "{} and {}",
        weight.work,
        fallen("bob")
    );
    assert!((weight.peak - 9.81).abs() < 1e-12, "{}", weight.peak);
    assert!((work(&found, "cable: weight").peak - 2.0 * 2.0 * 9.81).abs() < 1e-9);
    assert!(work(&found, "cable: drag").work < 0.0 && work(&found, "cable: drag").peak > 0.0);
}

#[test]
fn removing_an_effect_saves_the_work_that_the_ledger_says() {
    let scene = recorded();
    let found = ledger(&scene, "cable.end");
    let history = simulate(&scene).expect("run");
    let whole = |k: usize, h: &ropewalk::History| -> [f64; 3] {
        ["x", "y", "z"].map(|c| h.column(&format!("cable.end.{c}")).expect(c)[k])
    };
    let kinds: Vec<&str> = scene.forces.iter().map(|f| f.typetag_name()).collect();
    let mut tried = 0;
    for (k, kind) in kinds.iter().enumerate() {
        let named =
            found.without.iter().find(|t| t.name.starts_with(kind)).unwrap_or_else(|| panic!("{kind}"));
        let Verdict::Ran { change, counts, .. } = &named.verdict else { panic!("{named:?}") };
        let mut less = scene.clone();
        less.forces.remove(k);
        let again = simulate(&less).expect(kind);
        assert_eq!(*counts, again.counts, "{kind}");
        let off = (0..history.table.rows()).map(|k| {
            let (a, b) = (whole(k, &history), whole(k, &again));
            size(std::array::from_fn(|i| a[i] - b[i]))
        });
        let off = off.fold(0.0, f64::max) / found.scale;
        assert!((change - off).abs() <= 1e-9 * off && off > 0.0, "{kind}: {change} and {off}");
        tried += 1;
    }
    assert_eq!(tried, 3);
    let names: Vec<&str> = found.without.iter().map(|t| t.name.as_str()).collect();
    for name in [
        "bending of cable",
        "damping of stretching of cable",
        "damping of bending of cable",
        "audit of energy",
    ] {
        assert!(names.contains(&name), "{name} in {names:?}");
    }
    let Some(advice) = &found.advice else { panic!("the audit can be left out") };
    assert!(advice.names.contains(&"audit of energy".to_string()), "{advice:?}");
    let added: Vec<&str> = found.with.iter().map(|t| t.name.as_str()).collect();
    for name in ["buoyancy", "added mass", "drag by Reynolds number"] {
        assert!(added.contains(&name), "{name} in {added:?}");
    }
    let hints: Vec<&str> = found.hints.iter().map(|h| h.0.as_str()).collect();
    assert_eq!(hints[..2], ["material flow", "current"]);
}

#[test]
fn equilibria_and_growing_meshes_have_a_ledger_too() {
    let scene = open("cantilever", &[]).into_scene();
    let found = ledger(&scene, "beam.end.z");
    let done = |effect: &str| work(&found, effect).work;
    // what the force does, by the trapezoidal rule over ten steps, is stored
    let (force, cable) = (done("force at `beam.end`"), done("cable L4+T3 locking-free"));
    assert!((force + cable).abs() < 0.01 * force && force > 0.5, "{force} and {cable}");
    assert!((work(&found, "force at `beam.end`").peak - 3.0).abs() < 1e-12);
    assert!(found.own_error.is_none());

    // elements are born while the clocks run
    let file = SceneFile::parse(REEL, "reel", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    let scene = file.scene();
    let mut s = Simulation::new(scene.build().expect("model"), &scene.solver, 4.0).expect("start");
    let (before, elements) = (s.work.counts.factorizations, s.model.finest());
    s.work.profile();
    s.advance(4.0, 1.0, &mut ()).expect("run");
    assert!(s.model.finest() > elements, "no element was born");
    let times = s.work.times(&s.model);
    let calls = |label: &str| times.iter().find(|t| t.0 == label).map_or(0, |t| t.1);
    assert_eq!(calls("factorisation"), s.work.counts.factorizations - before);
    assert_eq!(calls("audit of energy"), s.work.counts.steps);
    let found = ledger(scene, "rope.end.z");
    assert!(found.without.iter().any(|t| t.name == "material flow at rope.start"), "{:?}", found.without);
}

const REEL: &str = r#"
[run]
duration = 4
output = 0.5
[[elements]]
type = "cable"
name = "rope"
points = [[0, 0, 0], [0, 0, -4]]
elements = 4
section = { mass = "1 kg/m", ea = "1e5 N", ei = "0.1 N m^2", axial_retardation_time = "0.01 s" }
[[constraints]]
type = "spherical"
name = "eyelet"
marker = "rope.start"
[[constraints]]
type = "winch"
name = "winch"
marker = "rope.start"
speed = "1 m/s"
element_length = "1 m"
[[forces]]
type = "gravity"
[[records]]
type = "position"
of = "rope.end"
"#;

const SWING: &str = r#"
title = "A swing"
[run]
duration = 0.3
output = 0.02
[[elements]]
type = "cable"
name = "rope"
points = [[0, 0, 0], [1, 0, 0]]
elements = 4
section = { mass = "1 kg/m", ea = "1e4 N", ei = "0.1 N m^2" }
[[constraints]]
type = "spherical"
name = "hook"
marker = "rope.start"
[[forces]]
type = "gravity"
[[records]]
type = "position"
of = "rope.end"
"#;

#[test]
fn the_command_leaves_tables_and_pictures() {
    let folder = tempfile::tempdir().expect("folder");
    fs::write(folder.path().join("swing.toml"), SWING).expect("scene");
    let said = run(folder.path(), &["effects", "swing.toml", "--of", "rope.end.z@0.2s", "--out", "out"]);
    assert_eq!(said.code, Some(0), "{}", said.stderr);
    for text in
        ["rope.end.z@0.2s", "together", "without", "bending of rope", "finer time steps", "write", "contact"]
    {
        assert!(said.stdout.contains(text), "no {text} in\n{}", said.stdout);
    }
    let text = |name: &str| fs::read_to_string(folder.path().join("out").join(name)).expect(name);
    for (table, lines) in [("ledger", 9), ("effects", 4)] {
        let csv = text(&format!("tables/{table}.csv"));
        let commas = |l: &str| l.split('"').step_by(2).map(|s| s.matches(',').count()).sum::<usize>();
        let head = commas(csv.lines().next().expect("head"));
        assert!(csv.lines().count() >= lines && csv.lines().all(|l| commas(l) == head), "{csv}");
    }
    for plot in ["ledger", "effects"] {
        let svg = text(&format!("plots/{plot}.svg"));
        assert!(svg.starts_with("<svg") && svg.contains("A swing"), "{plot}");
    }
    assert!(text("plots/effects.svg").contains("without bending of rope"));
    assert!(text("manifest.json").contains("rope: weight") && text("scene.toml").contains("A swing"));
}

#[test]
fn what_is_wrong_with_a_ledger_is_said_in_one_message() {
    let folder = tempfile::tempdir().expect("folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("scene");
    write("swing.toml", SWING);
    write("blind.toml", SWING.split_once("[[records]]").expect("records").0);
    write("still.toml", &SWING.replace("of = \"rope.end\"", "of = \"rope.start\""));
    let refused = |scene: &str, more: &[&str], holds: &[&str]| {
        run(folder.path(), &[&["effects", scene], more].concat()).refused(holds);
    };
    refused("swing.toml", &["--of", "rope.ende"], &["no record `rope.ende`", "did you mean `rope.end`"]);
    refused("swing.toml", &["--of", "rope.end@2s"], &["time 2 s", "outside the run, which ends at 0.3 s"]);
    refused("swing.toml", &["--of", "rope.end@soon"], &["is no time"]);
    refused("swing.toml", &["--of", "rope.end", "--accuracy", "0"], &["`--accuracy` must be positive"]);
    refused("swing.toml", &["--of", "rope.end", "--accuracy", "NaN"], &["`--accuracy` must be positive"]);
    refused("blind.toml", &["--of", "rope.end"], &["no record", "[[records]]"]);
    refused(
        "still.toml",
        &["--of", "rope.start"],
        &["is 0 throughout the run, but for rounding", "another record"],
    );
    refused("unwinding-paper", &["--of", "cable.tension"], &["has no terms"]);
    refused("swing.toml", &[], &["--of"]);
    // nothing of this has left a folder behind
    assert!(
        !folder.path().join("runs").exists()
            || fs::read_dir(folder.path().join("runs")).expect("runs").count() == 0
    );
}

#[test]
fn drag_and_water_of_a_ledger_are_those_of_the_scene() {
    let mut scene = recorded();
    scene.water = Some(Water { current: [0.5, 0.0, 0.0].map(Into::into), ..Water::default() });
    scene.forces.retain(|f| f.typetag_name() != "drag");
    scene.force(DragSpec { cn: 1.5, ..DragSpec::default() });
    let found = ledger(&scene, "cable.end@0.4");
    let change = |name: &str| match &found.without.iter().find(|t| t.name == name).expect(name).verdict {
        Verdict::Ran { change, .. } => *change,
        other => panic!("{name}: {other:?}"),
    };
    assert!(change("current") > 1e-4 && change("drag") > 1e-4 && change("audit of energy") == 0.0);
}
