//! The cost of an iteration and of a step, for coarse and fine meshes.

use crate::job::{Answer, Done, Job, in_turn};
use crate::own;
use crate::peer::Peers;
use crate::problem::{self, Cable, Mesh, Pendulum};
use crate::report::{Report, Row, ratio, shown};
use ropewalk::Scene;
use ropewalk::constraints::SphericalSpec;
use ropewalk::core::integrator::{NewtonPolicy, Options, Scheme, Stepping};
use ropewalk::elements::cable::Integration;
use ropewalk::elements::{CableSpec, Section};
use ropewalk::forces::GravitySpec;
use serde_json::{Value, json};

/// The pendulum as a scene.
pub fn scene(c: &Cable, elements: usize, integration: Integration) -> Scene {
    let section = Section::new(c.mass, c.ea, c.ei);
    let cable = CableSpec::straight("cable", [0.0; 3], [c.length, 0.0, 0.0], elements, section);
    let mut scene = Scene::new();
    scene
        .element(CableSpec { integration, ..cable })
        .constraint(SphericalSpec::pin("pin", "cable.start"))
        .set_gravity([0.0, -c.g, 0.0])
        .force(GravitySpec::default());
    scene
}

/// A run of Ropewalk, with the tip at its end.
pub fn own(scene: &Scene, length: f64, options: &Options, duration: f64) -> Result<Answer, String> {
    let run = own::run(scene, options, duration, false, &mut ())?;
    Ok(Answer { tip: run.place("cable", length)?.to_vec(), ..Answer::of(&run) })
}

/// The pendulum as Exudyn's script wants it.
pub fn exudyn(c: &Cable, elements: usize, h: f64, steps: usize, more: &[&Value]) -> Value {
    let mut case = json!({
        "length": c.length, "mass": c.mass, "ea": c.ea, "ei": c.ei, "g": c.g,
        "elements": elements, "h": h, "steps": steps, "newton": "modified", "scheme": "generalized-alpha",
    });
    for (name, value) in more.iter().filter_map(|m| m.as_object()).flatten() {
        case[name] = value.clone();
    }
    case
}

/// Between two places; not a number where one is missing.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    if a.len() != b.len() || a.is_empty() {
        return f64::NAN;
    }
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// Both sides on one mesh with one policy of Newton's method: Ropewalk, Exudyn.
fn compare(
    p: &Pendulum,
    mesh: &Mesh,
    peers: &Peers,
    policy: NewtonPolicy,
    quick: bool,
    report: &mut Report,
) -> Result<[Option<Row>; 2], String> {
    let (n, duration, finer) = (mesh.elements, p.h * mesh.steps as f64, p.h / mesh.finer as f64);
    let newton = if policy == NewtonPolicy::Full { "full" } else { "modified" };
    let scene = scene(&p.cable, n, Integration::default());
    let options = |h: f64, newton: NewtonPolicy, newton_tolerance: f64| Options {
        scheme: Scheme::GeneralizedAlpha { rho_inf: p.rho_inf },
        stepping: Stepping::Fixed { h },
        newton,
        newton_tolerance,
        ..Options::default()
    };
    let (usual, fine) =
        (options(p.h, policy, p.newton_tolerance), options(finer, NewtonPolicy::Modified, 1e-3));
    let (scene, length) = (&scene, p.cable.length);
    let row = Row {
        problem: "pendulum",
        case: format!("pendulum, h = {} s", p.h),
        setting: format!("{newton} Newton"),
        elements: n,
        duration,
        ..Row::default()
    };
    let rho = json!({ "rho_inf": p.rho_inf, "newton": newton });
    let case = exudyn(&p.cable, n, p.h, mesh.steps, &[&rho, &mesh.exudyn]);
    let mut jobs = vec![Job::own(row.clone(), || own(scene, length, &usual, duration))];
    if peers.has("exudyn") {
        jobs.push(Job::peer(row, peers, "exudyn", "exudyn_pendulum.py", case));
    }
    let mut done = in_turn(&jobs, if quick { 1 } else { mesh.repeats }, report).into_iter();
    let against = |done: Option<Done>, converged: &dyn Fn() -> Result<Answer, String>| {
        done.map(|d| {
            let error = converged().map_or(f64::NAN, |c| distance(&d.answer.tip, &c.tip));
            Row { error, ..d.row }
        })
    };
    let mine = against(done.next().flatten(), &|| own(scene, length, &fine, duration));
    let theirs = against(done.next().flatten(), &|| {
        let rho = json!({ "rho_inf": p.rho_inf });
        let case = exudyn(&p.cable, n, finer, mesh.steps * mesh.finer, &[&rho, &mesh.exudyn]);
        peers.run_once("exudyn", "exudyn_pendulum.py", &case)
    });
    Ok([mine, theirs])
}

/// All meshes; the three coarsest if it has to be quick.
pub fn run(peers: &Peers, quick: bool, report: &mut Report) -> Result<(), String> {
    let p: Pendulum = problem::read("pendulum.json")?;
    report.say("## Pendulum\n");
    report.say(format!(
        "{}. Generalized-α with ρ∞ = {} and steps of {} s on both sides. The error is that of the tip at the end of \
         the run, against the same code on the same mesh with a step that is 4 to 16 times smaller.",
        p.title, p.rho_inf, p.h
    ));
    let take = if quick { 3 } else { p.meshes.len() };
    for (policy, title) in [
        (NewtonPolicy::Full, "A new matrix at every iteration; µs per element and iteration:"),
        (NewtonPolicy::Modified, "The matrix kept while it serves; µs per element and step:"),
    ] {
        let per: fn(&Row) -> f64 = match policy {
            NewtonPolicy::Full => Row::per_element_and_iteration,
            NewtonPolicy::Modified => Row::per_element_and_step,
        };
        let mut lines = Vec::new();
        for mesh in p.meshes.iter().take(take) {
            let both = compare(&p, mesh, peers, policy, quick, report)?;
            let [a, b] = [0, 1].map(|k| both[k].as_ref().map(per));
            let mut line = vec![mesh.elements.to_string()];
            line.extend([a, b].map(|x| shown(x, |x| format!("{x:.2}"))));
            line.push(ratio(b, a));
            for row in &both {
                let row = row.as_ref();
                line.push(shown(row.map(|r| r.iterations as f64 / r.steps as f64), |x| format!("{x:.2}")));
                line.push(shown(row.map(|r| r.error), |e| format!("{e:.1e}")));
            }
            lines.push(line);
            report.rows.extend(both.into_iter().flatten());
        }
        report.say(format!("\n{title}"));
        let head = [
            "elements",
            "Ropewalk",
            "Exudyn",
            "ratio",
            "Ropewalk: iterations per step",
            "error [m]",
            "Exudyn: iterations per step",
            "error [m]",
        ];
        report.table(&head, &lines);
    }
    Ok(())
}
