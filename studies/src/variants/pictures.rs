//! The figures: errors of stiffness models over their cost, times and iterations over elements, histories.

use super::scaling::{DRAWN, Histories, deflection_error};
use super::stiffness::CANTILEVER;
use super::{Form, Problem, Variants};
use ropewalk_report::{LinePlot, Mark, Series};

impl Variants {
    /// Pictures that need no histories, each with the name of its file.
    pub fn pictures(&self) -> Vec<(String, LinePlot)> {
        let mut all = Vec::new();
        if !self.stiffness.is_empty() {
            all.push(("stiffness".to_string(), self.errors()));
        }
        for problem in Problem::ALL {
            if self.rows(problem, Form::Si, false).next().is_some() {
                all.push((format!("{}-time", problem.name()), self.times(problem)));
                all.push((format!("{}-iterations", problem.name()), self.iterations(problem)));
                all.push((format!("{}-condition", problem.name()), self.conditions(problem)));
            }
        }
        if self.rows(Problem::Cantilever, Form::Si, false).next().is_some() {
            all.push(("cantilever-mean".to_string(), self.deflections()));
        }
        all
    }

    /// Error of the cantilever over the cost of its tangent, by mesh.
    fn errors(&self) -> LinePlot {
        let series = self.stiffness.iter().map(|s| {
            let cost = |n: &usize| *n as f64 * s.tangent_us;
            let points = CANTILEVER.iter().zip(&s.cantilever).map(|(n, e)| (cost(n), e.abs())).collect();
            Series::new(&s.label, points).with_mark(Mark::LineAndDots)
        });
        LinePlot {
            title: "Stiffness models: deflection of a cantilever, 1 to 32 elements".into(),
            x_label: "force and tangent [µs]".into(),
            y_label: "relative error [1]".into(),
            series: series.collect(),
            log_x: true,
            log_y: true,
            ..LinePlot::default()
        }
    }

    fn over_elements(
        &self,
        problem: Problem,
        title: String,
        y_label: &str,
        of: &dyn Fn(&super::Row) -> f64,
        which: &[(Form, bool)],
    ) -> LinePlot {
        let series = which.iter().map(|&(form, absolute)| {
            let test = if absolute { "absolute" } else { "relative" };
            let points = self.rows(problem, form, absolute).map(|r| (r.elements as f64, of(r))).collect();
            Series::new(format!("{}, {test}", form.label()), points).with_mark(Mark::LineAndDots)
        });
        LinePlot {
            title,
            x_label: "number of elements".into(),
            y_label: y_label.into(),
            series: series.collect(),
            log_x: true,
            log_y: true,
            ..LinePlot::default()
        }
    }

    fn times(&self, problem: Problem) -> LinePlot {
        let title = format!("Time, dimensional and non-dimensional: {}", problem.title());
        self.over_elements(problem, title, "CPU time [s]", &|r| r.cpu_s, &COMPARED)
    }

    fn iterations(&self, problem: Problem) -> LinePlot {
        let title = format!("Newton's iterations per step: {}", problem.title());
        self.over_elements(problem, title, "iterations per step", &|r| r.iterations, &COMPARED)
    }

    fn conditions(&self, problem: Problem) -> LinePlot {
        let title = format!("Condition number of the matrix: {}", problem.title());
        self.over_elements(
            problem,
            title,
            "condition number [1]",
            &|r| r.condition,
            &Form::ALL.map(|f| (f, false)),
        )
    }

    fn deflections(&self) -> LinePlot {
        let title = "Mean deflection of the cantilever by number of elements".to_string();
        self.over_elements(
            Problem::Cantilever,
            title,
            "relative error of the mean [1]",
            &|r| deflection_error(r).abs(),
            &[(Form::Si, false), (Form::Bending, false)],
        )
    }
}

const COMPARED: [(Form, bool); 6] = [
    (Form::Si, false),
    (Form::Bending, false),
    (Form::Axial, false),
    (Form::Si, true),
    (Form::Bending, true),
    (Form::Axial, true),
];

/// Newton's iterations over the steps of a run, of each form.
pub fn iterations(problem: Problem, all: &[(Form, Vec<(f64, f64)>)]) -> LinePlot {
    LinePlot {
        title: format!("Newton's iterations with an absolute test: {}", problem.title()),
        x_label: "t [s]".into(),
        y_label: "iterations".into(),
        series: all.iter().map(|(form, points)| Series::new(form.label(), points.clone())).collect(),
        ..LinePlot::default()
    }
}

/// Histories of the end: its height, its acceleration, and what the joint bears, where it is recorded.
pub fn histories(h: &Histories) -> Vec<(String, LinePlot)> {
    let cable = h.problem.cable();
    let mut all = vec![
        ("position", "Height of the end", "z [m]", format!("{cable}.end.z")),
        (
            "acceleration",
            "Vertical acceleration of the end",
            "acceleration [m/s²]",
            format!("{cable}.end.az"),
        ),
    ];
    if h.problem == Problem::Spherical {
        all.push(("reaction", "Reaction of the joint", "force [N]", "joint.magnitude".to_string()));
    }
    let plot = |what: &str, label: &str, column: &str| LinePlot {
        title: format!("{what}, {DRAWN} elements: {}", h.problem.title()),
        x_label: "t [s]".into(),
        y_label: label.into(),
        series: h
            .all
            .iter()
            .filter_map(|(label, history)| Some(Series::new(label, history.table.points(column)?)))
            .collect(),
        ..LinePlot::default()
    };
    let named = |name: &str| format!("{}-{name}", h.problem.name());
    all.into_iter().map(|(name, what, label, column)| (named(name), plot(what, label, &column))).collect()
}
