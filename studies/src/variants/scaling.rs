//! Equations in SI units and without dimensions: time, Newton's iterations, condition numbers.

use super::condition::{Form, condition};
use super::problem::{DEFLECTION, Problem};
use crate::error::Error;
use crate::simulate::simulate;
use ropewalk_core::integrator::{Options, StepReport, Stopping, Units};
use ropewalk_core::{Model, Observer, Simulation, State};
use ropewalk_report::Stopwatch;
use serde::Serialize;
use std::ops::ControlFlow;

/// Meshes that are compared.
pub const MESHES: [usize; 7] = [1, 2, 4, 8, 16, 32, 64];
/// The mesh of the histories that are drawn.
pub const DRAWN: usize = 16;

/// A problem on a mesh, in one form and with one stopping test.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The problem.
    pub problem: Problem,
    /// Number of elements.
    pub elements: usize,
    /// The form of the equations.
    pub form: Form,
    /// Whether the stopping test was absolute.
    pub absolute: bool,
    /// The time that stands for one without dimensions [s].
    pub time_unit: f64,
    /// Steps that were taken.
    pub steps: u64,
    /// Mean Newton iterations of a step.
    pub iterations: f64,
    /// Steps that never met their stopping test.
    pub unmet: u64,
    /// Steps that had to be repeated smaller.
    pub rejected: u64,
    /// CPU time [s]; NaN where the run failed.
    pub cpu_s: f64,
    /// Condition number of the matrix at the end; NaN where it wasn't computed.
    pub condition: f64,
    /// Mean height of the end over the run [m].
    pub mean: f64,
    /// Distance of the end's last position from that in SI units with the relative test, in parts of the length.
    pub apart: f64,
    /// Why the run ended early, if it did.
    pub failed: Option<String>,
}

/// Counts iterations step by step, and adds up the end's height.
struct EndObserver {
    end: usize,
    last: f64,
    area: f64,
    iterations: Vec<(f64, f64)>,
}

impl Observer for EndObserver {
    fn step(&mut self, _: &Model, state: &State, report: &StepReport) -> ControlFlow<()> {
        let z = state.q[self.end + 2];
        self.area += 0.5 * report.h * (z + self.last);
        self.last = z;
        self.iterations.push((state.t, f64::from(report.iterations)));
        ControlFlow::Continue(())
    }
}

/// What a run found, besides its row.
pub struct Run {
    /// Its row.
    pub row: Row,
    /// Newton iterations of each step, by time.
    pub iterations: Vec<(f64, f64)>,
    /// Where the end came to [m].
    end: [f64; 3],
}

/// Runs a problem. `reference` is the same in SI units with the relative test, if it isn't that itself.
///
/// # Errors
/// A scene that can't be built. A run that fails is told in its row.
pub fn run(
    problem: Problem,
    elements: usize,
    form: Form,
    absolute: Option<f64>,
    reference: Option<&Run>,
) -> Result<Run, Error> {
    let scene = problem.scene(elements)?;
    let stopping = match absolute {
        Some(residual) => Stopping::Absolute { residual: Some(residual), increment: None },
        None => Stopping::Relative,
    };
    let options = Options { scales: form.scales(), stopping, ..scene.solver.clone() };
    let model = scene.build()?;
    let units = form.scales().map_or(Ok(Units::SI), |s| Units::of(s, &model));
    let time_unit = units.map_or(f64::NAN, |u| u.time);
    let end = model.part(problem.cable()).map_or(0, |p| p.seats().last().map_or(0, |s| s.0));
    let mut s = Simulation::new(model, &options, problem.duration())?;
    s.keep_audit(false);
    let last = s.state.q[end + 2];
    let mut observer = EndObserver { end, last, area: 0.0, iterations: Vec::new() };
    let clock = Stopwatch::start();
    let failed = s.advance(problem.duration(), f64::INFINITY, &mut observer).err().map(|e| e.to_string());
    let cpu = clock.elapsed().cpu_s;
    let counts = s.work.counts;
    let at = [0, 1, 2].map(|i| s.state.q[end + i]);
    let apart = reference.map_or(0.0, |r| {
        let d = [0, 1, 2].map(|i| at[i] - r.end[i]);
        d.iter().map(|x| x * x).sum::<f64>().sqrt() / s.model.length()
    });
    let row = Row {
        problem,
        elements,
        form,
        absolute: absolute.is_some(),
        time_unit,
        steps: counts.steps,
        iterations: counts.newton_iterations as f64 / counts.steps.max(1) as f64,
        unmet: counts.unmet,
        rejected: counts.rejected,
        cpu_s: if failed.is_some() { f64::NAN } else { cpu },
        condition: match absolute {
            None => condition(&s.model, &s.state, &options, problem.step(), form)?,
            Some(_) => f64::NAN,
        },
        mean: observer.area / s.state.t.max(f64::MIN_POSITIVE),
        apart,
        failed,
    };
    Ok(Run { row, iterations: observer.iterations, end: at })
}

/// The error of the cantilever's mean deflection against linear theory.
pub fn deflection_error(row: &Row) -> f64 {
    row.mean / DEFLECTION - 1.0
}

/// Histories of a problem's end, of the mesh that is drawn: in SI units, without dimensions, and as a rigid body.
pub struct Histories {
    /// The problem.
    pub problem: Problem,
    /// Label and history of each.
    pub all: Vec<(String, crate::simulate::History)>,
}

/// Runs a problem for its pictures.
///
/// # Errors
/// A scene that can't be built, or a run that fails.
pub fn histories(problem: Problem) -> Result<Histories, Error> {
    let mut all = Vec::new();
    for form in [Form::Si, Form::Bending] {
        let mut scene = problem.scene(DRAWN)?;
        scene.solver.scales = form.scales();
        let label = if form == Form::Si { "dimensional" } else { "non-dimensional" };
        all.push((label.to_string(), simulate(&scene)?));
    }
    if let Some(rigid) = problem.rigid() {
        all.push(("rigid body".to_string(), simulate(&rigid)?));
    }
    Ok(Histories { problem, all })
}
