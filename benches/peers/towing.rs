//! The towed hose: how it settles, and how it starts.

use crate::job::{Answer, Done, Job, in_turn};
use crate::peer::Peers;
use crate::problem::{self, Converged, Start, Steady, Tow};
use crate::report::{Report, Row, ratio, shown};
use crate::tow::Case;
use ropewalk::core::integrator::{Options, Scheme, Stepping};
use ropewalk::report::{LinePlot, Mark, Series};
use serde_json::{Map, Value};

const PEERS: [&str; 2] = ["moordyn", "cabledyn"];

/// Both tows.
pub fn run(peers: &Peers, quick: bool, report: &mut Report) -> Result<(), String> {
    let tow: Tow = problem::read("tow.json")?;
    report.say("\n## Tow\n");
    report.say(format!("{}, from its equilibrium at rest.\n", tow.title));
    steady(&tow, peers, quick, report)?;
    start(&tow, peers, quick, report)
}

fn script(peer: &str) -> &'static str {
    if peer == "moordyn" { "moordyn_tow.py" } else { "cabledyn_tow.py" }
}

/// A run that stands for the truth: finer mesh, far smaller tolerance.
fn converged(case: &Case, tow: &Tow, c: &Converged) -> Result<Vec<f64>, String> {
    eprintln!("converged tow at {} kn, EA = {:.0e} N", case.speed_kn, case.ea);
    let options = Options {
        scheme: Scheme::GeneralizedAlpha { rho_inf: 0.5 },
        stepping: Stepping::Controlled { tolerance: c.tolerance },
        newton_tolerance: 0.1,
        ..Options::default()
    };
    Ok(case.run(tow, c.elements, &options)?.reaction)
}

/// Largest deviation of a history from another, in parts of it.
fn deviation(history: &[f64], from: &[f64]) -> Option<f64> {
    if history.is_empty() || history.len() != from.len() {
        return None;
    }
    let worst = |m: f64, e: f64| if e.is_nan() { f64::INFINITY } else { m.max(e) };
    Some(history.iter().zip(from).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, worst))
}

/// The same at the last instant alone.
fn deviation_at_end(history: &[f64], from: &[f64]) -> Option<f64> {
    Some((history.last()? / from.last()? - 1.0).abs())
}

fn percent(x: Option<f64>) -> String {
    shown(x, |x| if x < 1e-4 { format!("{:.0e}", 100.0 * x) } else { format!("{:.2}", 100.0 * x) })
}

fn settings(map: &Map<String, Value>) -> String {
    map.iter()
        .filter(|(name, _)| ["step", "cfl", "coupling", "rho_inf"].contains(&name.as_str()))
        .map(|(name, value)| format!("{name} {value}"))
        .collect::<Vec<_>>()
        .join(", ")
}

fn tolerance(options: &Options) -> String {
    match options.stepping {
        Stepping::Fixed { h } => format!("h {h}"),
        Stepping::Controlled { tolerance } => format!("tolerance {tolerance:.0e}"),
    }
}

/// The least of the costs of a code's runs with an error up to a limit.
fn cheapest(rows: &[Row], code: &str, limit: f64) -> Option<f64> {
    let fine = rows.iter().filter(|r| r.code.starts_with(code) && r.error <= limit);
    fine.map(Row::load).min_by(f64::total_cmp)
}

fn steady(tow: &Tow, peers: &Peers, quick: bool, report: &mut Report) -> Result<(), String> {
    let s: &Steady = &tow.steady;
    let options = problem::options(&s.ropewalk)?;
    report.say(format!("### Steady tow: {} s, the start included\n", s.duration));
    report.say(
        "Error of the force on the ship at the end [%]: against the closed form of the steady state, and against \
         Ropewalk's converged run at the same instant (at 5 kn the hose has not settled by then). MoorDyn's and \
         CableDyn's own output of tension differs from the force that they ask of the ship; its error against the \
         converged run is the last column.",
    );
    let (mut lines, mut summary) = (Vec::new(), Vec::new());
    let cases = s.cases.iter().filter(|c| !quick || c.speed_kn == 15.0);
    for c in cases {
        let case = Case::steady(s, c);
        let truth = converged(&case, tow, &s.converged)?;
        let exact = [case.steady_tension(tow)];
        let mut jobs = Vec::new();
        for &elements in s.elements.iter().filter(|n| !quick || **n <= 20) {
            let row = Row {
                problem: "steady tow",
                case: format!("{} kn, EA {:.0e} N", c.speed_kn, c.ea),
                elements,
                duration: s.duration,
                ..Row::default()
            };
            let own = Row { setting: tolerance(&options), ..row.clone() };
            let options = &options;
            jobs.push(Job::own(own, move || case.run(tow, elements, options)));
            for peer in PEERS.into_iter().filter(|p| peers.has(p)) {
                let how = if peer == "moordyn" { &s.moordyn } else { &s.cabledyn };
                let row = Row { setting: settings(how), ..row.clone() };
                jobs.push(Job::peer(row, peers, peer, script(peer), case.json(tow, elements, &[how])));
            }
        }
        let mut rows = Vec::new();
        for Done { row, answer } in
            in_turn(&jobs, if quick { 1 } else { tow.repeats }, report).into_iter().flatten()
        {
            let error = deviation_at_end(&answer.reaction, &truth);
            lines.push(vec![
                row.case.clone(),
                row.code.clone(),
                row.elements.to_string(),
                row.setting.clone(),
                format!("{:.2}", row.load()),
                percent(deviation_at_end(&answer.reaction, &exact)),
                percent(error),
                percent(deviation_at_end(&answer.tension, &truth)),
            ]);
            rows.push(Row { error: error.unwrap_or(f64::NAN), ..row });
        }
        summary.push(compared(format!("{} kn, EA {:.0e} N", c.speed_kn, c.ea), &rows, 1e-3));
        report.rows.extend(rows);
    }
    let head = [
        "tow",
        "code",
        "elements",
        "setting",
        "ms per s",
        "steady state",
        "converged",
        "own output of tension",
    ];
    report.table(&head, &lines);
    report.say(
        "The cheapest of these with an error below 0.1 % against the converged run [ms per simulated s]:",
    );
    report.table(&["tow", "Ropewalk", "MoorDyn", "ratio", "CableDyn", "ratio"], &summary);
    Ok(())
}

/// The cheapest run of each code up to an error, and ratios.
fn compared(case: String, rows: &[Row], limit: f64) -> Vec<String> {
    let mine = cheapest(rows, "Ropewalk", limit);
    let ms = |x: Option<f64>| shown(x, |x| format!("{x:.2}"));
    let mut line = vec![case, ms(mine)];
    for peer in ["MoorDyn", "CableDyn"] {
        let theirs = cheapest(rows, peer, limit);
        line.extend([ms(theirs), ratio(theirs, mine)]);
    }
    line
}

fn start(tow: &Tow, peers: &Peers, quick: bool, report: &mut Report) -> Result<(), String> {
    let s: &Start = &tow.start;
    let case = Case {
        speed_kn: s.speed_kn,
        ea: tow.hose.get("ea").and_then(Value::as_f64).ok_or("tow.json: no ea")?,
        end_mass: s.end_mass,
        duration: s.duration,
        interval: s.interval,
    };
    report.say(format!(
        "### Start of a tow: to {} kn, {} kg at the end, {} s\n",
        s.speed_kn, s.end_mass, s.duration
    ));
    report.say(format!(
        "Largest error of the force on the ship, at {} instants over the whole time, in parts of the force then [%]: \
         against Ropewalk's converged run ({} elements, tolerance {:.0e}), and against the finest run of the same \
         code, the last of its rows. For peers the better of the force and of their own output of tension. CableDyn \
         refuses bending stiffness together with a free end, so its hose has none.",
        (s.duration / s.interval).round(),
        s.converged.elements,
        s.converged.tolerance
    ));
    let truth = converged(&case, tow, &s.converged)?;
    let own = problem::options(&s.ropewalk.options)?;
    let mut jobs = Vec::new();
    let row = Row {
        problem: "start of a tow",
        case: format!("{} kn", s.speed_kn),
        duration: s.duration,
        ..Row::default()
    };
    for r in &s.ropewalk.runs {
        let options = Options { stepping: Stepping::Controlled { tolerance: r.tolerance }, ..own.clone() };
        let row = Row { elements: r.elements, setting: tolerance(&options), ..row.clone() };
        jobs.push(Job::own(row, move || case.run(tow, r.elements, &options)));
    }
    for peer in PEERS.into_iter().filter(|p| peers.has(p)) {
        let all = if peer == "moordyn" { &s.moordyn } else { &s.cabledyn };
        for r in &all.runs {
            let elements = r.get("elements").and_then(Value::as_u64).ok_or("tow.json: no elements")? as usize;
            if quick && elements > 50 {
                continue;
            }
            let mut how = all.options.clone();
            how.extend(r.clone());
            let row = Row { elements, setting: settings(&how), ..row.clone() };
            jobs.push(Job::peer(row, peers, peer, script(peer), case.json(tow, elements, &[&how])));
        }
    }
    let done: Vec<Done> =
        in_turn(&jobs, if quick { 1 } else { tow.repeats }, report).into_iter().flatten().collect();
    let better = |a: &Answer, from: &dyn Fn(&Answer) -> [Vec<f64>; 2]| {
        let [force, tension] = from(a);
        let both = [deviation(&a.reaction, &force), deviation(&a.tension, &tension)];
        both.into_iter().flatten().min_by(f64::total_cmp)
    };
    let (mut lines, mut rows) = (Vec::new(), Vec::new());
    let mut series = vec![history(s.interval, "converged", &truth)];
    for Done { row, answer } in &done {
        let error = better(answer, &|_| [truth.clone(), truth.clone()]);
        let finest = done.iter().rfind(|d| d.row.code == row.code).map(|d| &d.answer);
        let own = finest.and_then(|f| better(answer, &|_| [f.reaction.clone(), f.tension.clone()]));
        lines.push(vec![
            row.code.clone(),
            row.elements.to_string(),
            row.setting.clone(),
            format!("{:.2}", row.load()),
            row.steps.to_string(),
            percent(error),
            if own == Some(0.0) { "–".into() } else { percent(own) },
        ]);
        if row.elements == 20 {
            let label = format!("{}, 20 elements, {}", row.code, row.setting);
            series.push(history(s.interval, &label, &answer.reaction));
        }
        rows.push(Row { error: error.unwrap_or(f64::NAN), ..row.clone() });
    }
    let head =
        ["code", "elements", "setting", "ms per s", "steps", "against converged", "against its finest"];
    report.table(&head, &lines);
    report.say("The cheapest of these up to an error [ms per simulated s]:");
    let limits = [(0.1, "10 %"), (0.02, "2 %"), (0.01, "1 %"), (5e-3, "0.5 %"), (2e-3, "0.2 %")];
    let summary: Vec<_> = limits.iter().map(|(x, name)| compared(name.to_string(), &rows, *x)).collect();
    report.table(&["error", "Ropewalk", "MoorDyn", "ratio", "CableDyn", "ratio"], &summary);
    let cost = |code: &str| {
        let these = rows.iter().filter(|r| r.code.starts_with(code) && r.error.is_finite());
        // dots: meshes and steps differ, and a line would promise what lies between
        Series::new(code, these.map(|r| (r.load(), 100.0 * r.error)).collect()).with_mark(Mark::Dots)
    };
    report.plot(
        "tow-start-cost",
        LinePlot {
            title: "Start of a tow: cost and error".into(),
            x_label: "CPU time per simulated time [ms/s]".into(),
            y_label: "largest error of the force on the ship [%]".into(),
            series: ["Ropewalk", "MoorDyn", "CableDyn"]
                .map(cost)
                .into_iter()
                .filter(|s| !s.points.is_empty())
                .collect(),
            log_x: true,
            log_y: true,
            ..LinePlot::default()
        },
    );
    report.plot(
        "tow-start",
        LinePlot {
            title: "Start of a tow".into(),
            x_label: "t [s]".into(),
            y_label: "force on the ship [N]".into(),
            series,
            ..LinePlot::default()
        },
    );
    report.rows.extend(rows);
    Ok(())
}

fn history(interval: f64, label: &str, force: &[f64]) -> Series {
    Series::new(label, force.iter().enumerate().map(|(k, f)| ((k + 1) as f64 * interval, *f)).collect())
}
