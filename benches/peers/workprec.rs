//! What an error costs: the pendulum with many steps and tolerances.

use crate::job::{Job, in_turn};
use crate::peer::Peers;
use crate::pendulum::{distance, exudyn, own, scene};
use crate::problem::{self, Pendulum, WorkPrecision};
use crate::report::{Report, Row, cost_at, ratio, shown};
use ropewalk::core::integrator::Stepping;
use ropewalk::report::{LinePlot, Mark, Series};
use serde_json::json;

/// All curves; without Exudyn's longest runs if it has to be quick.
pub fn run(peers: &Peers, quick: bool, report: &mut Report) -> Result<(), String> {
    let w: WorkPrecision = problem::read("workprec.json")?;
    let p: Pendulum = problem::read("pendulum.json")?;
    report.say("## Work and precision\n");
    report.say(format!(
        "{} The error is the distance to where that element without any error in time has it. CPU times between the \
         runs are interpolated in powers, along those that nothing cheaper beats.\n",
        w.title
    ));
    let row = Row { problem: "work-precision", elements: w.elements, duration: w.duration, ..Row::default() };
    // the curve and the tip that a job belongs to
    let (mut jobs, mut belongs) = (Vec::new(), Vec::new());
    for scheme in w.exudyn.schemes.iter().filter(|_| peers.has("exudyn")) {
        for &h in w.exudyn.h.iter().filter(|h| !quick || **h >= 1e-4) {
            let more = json!({
                "scheme": scheme, "rho_inf": w.exudyn.rho_inf, "initial_accelerations": true,
                "relative_tolerance": w.exudyn.relative_tolerance, "absolute_tolerance": w.exudyn.absolute_tolerance,
            });
            let case = exudyn(&p.cable, w.elements, h, (w.duration / h).round() as usize, &[&more]);
            let setting = format!("{scheme}, h = {h} s");
            let row = Row { case: "full quadrature".into(), setting, ..row.clone() };
            jobs.push(Job::peer(row, peers, "exudyn", "exudyn_pendulum.py", case));
            belongs.push((format!("Exudyn, {scheme}"), "full"));
        }
    }
    let mut curves = Vec::new();
    for curve in &w.ropewalk {
        match curve.runs() {
            Ok(runs) => curves.push((&curve.label, runs)),
            Err(why) => report.say(format!("{} is left out: {why}\n", curve.label)),
        }
    }
    for rule in w.tips.keys() {
        let scene = std::rc::Rc::new(scene(&p.cable, w.elements, problem::integration(rule)?));
        for (label, runs) in &curves {
            for options in runs.clone() {
                let what = match options.stepping {
                    Stepping::Fixed { h } => format!("h = {h} s"),
                    Stepping::Controlled { tolerance } => format!("tolerance {tolerance:.0e}"),
                };
                let setting = format!("{label}, {what}");
                let row = Row { case: format!("{rule} quadrature"), setting, ..row.clone() };
                let (scene, length, duration) = (scene.clone(), p.cable.length, w.duration);
                jobs.push(Job::own(row, move || own(&scene, length, &options, duration)));
                belongs.push((format!("Ropewalk, {label}"), rule));
            }
        }
    }
    let done = in_turn(&jobs, if quick { 1 } else { w.repeats }, report);
    let done: Vec<(&str, &str, Row)> = done
        .into_iter()
        .zip(&belongs)
        .filter_map(|(done, (curve, rule))| {
            let done = done?;
            let error = distance(done.answer.tip.get(..2)?, &w.tips[*rule]);
            Some((curve.as_str(), *rule, Row { error, ..done.row }))
        })
        .collect();
    let runs = |code: &str, rule: &str| -> Vec<(f64, f64)> {
        let these = done.iter().filter(|(curve, r, _)| curve.starts_with(code) && *r == rule);
        these.map(|(_, _, row)| (row.cpu, row.error)).collect()
    };

    let mut head = vec!["error [m]".to_string(), "Exudyn [ms]".into()];
    for rule in w.tips.keys() {
        head.extend([format!("Ropewalk, {rule} quadrature [ms]"), "ratio".into()]);
    }
    let mut lines = Vec::new();
    for &error in &w.errors {
        let ms = |t: Option<f64>| shown(t, |t| format!("{:.2}", 1e3 * t));
        let theirs = cost_at(&runs("Exudyn", "full"), error);
        let mut line = vec![format!("{error:.0e}"), ms(theirs)];
        for rule in w.tips.keys() {
            let mine = cost_at(&runs("Ropewalk", rule), error);
            line.extend([ms(mine), ratio(theirs, mine)]);
        }
        lines.push(line);
    }
    report.table(&head.iter().map(String::as_str).collect::<Vec<_>>(), &lines);

    for (rule, name) in [("full", "work-precision-full"), ("locking-free", "work-precision-default")] {
        let mut series: Vec<Series> = Vec::new();
        for (curve, r, row) in &done {
            if *r == rule || curve.starts_with("Exudyn") {
                match series.iter_mut().find(|s| s.label == *curve) {
                    Some(s) => s.points.push((row.cpu, row.error)),
                    None => series
                        .push(Series::new(*curve, vec![(row.cpu, row.error)]).with_mark(Mark::LineAndDots)),
                }
            }
        }
        let title = format!("Pendulum of {} elements; Ropewalk with {rule} quadrature", w.elements);
        report.plot(
            name,
            LinePlot {
                title,
                x_label: "CPU time [s]".into(),
                y_label: "error of the tip at 1 s [m]".into(),
                series,
                log_x: true,
                log_y: true,
                ..LinePlot::default()
            },
        );
    }
    report.rows.extend(done.into_iter().map(|(_, _, row)| row));
    Ok(())
}
