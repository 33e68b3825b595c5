//! The figures: errors of stiffness models over their cost, times and iterations over elements, histories.

use super::scaling::{DRAWN, Histories, deflection_error};
use super::stiffness::CANTILEVER;
use super::{Form, Problem, Variants};
use ropewalk_report::{LinePlot, Mark, Series};

/// Numbers of the figures in the thesis whose cases these are, for each problem: time over elements, position,
/// acceleration.
fn figures(problem: Problem) -> [&'static str; 3] {
    match problem {
        Problem::Cantilever => ["Figure L.2", "Figure L.3", ""],
        Problem::Revolute => ["", "Figure L.7", "Figure L.8"],
        Problem::Spherical => ["Figure L.10", "Figure L.11", "Figure L.12"],
        Problem::Straight => ["Figure 4.5", "Figure 4.7", "Figure 4.8"],
        Problem::Turn => ["Figure 4.6", "Figure 4.9", "Figure 4.10"],
    }
}

fn titled(figure: &str, title: String) -> String {
    if figure.is_empty() { title } else { format!("{figure}: {title}") }
}

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
        let title = titled(
            figures(problem)[0],
            format!("time, dimensional and non-dimensional: {}", problem.title()),
        );
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
        let title = "Figure L.4: mean deflection of the cantilever by number of elements".to_string();
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

/// Newton's iterations over the steps of a run, of each form: figure L.6 for the pendulum on a revolute joint.
pub fn iterations(problem: Problem, all: &[(Form, Vec<(f64, f64)>)]) -> LinePlot {
    let figure = if problem == Problem::Revolute { "Figure L.6" } else { "" };
    LinePlot {
        title: titled(figure, format!("Newton's iterations with an absolute test: {}", problem.title())),
        x_label: "t [s]".into(),
        y_label: "iterations".into(),
        series: all.iter().map(|(form, points)| Series::new(form.label(), points.clone())).collect(),
        ..LinePlot::default()
    }
}

/// Histories of the end: its height, its acceleration, and what the joint bears, where it is recorded.
pub fn histories(h: &Histories) -> Vec<(String, LinePlot)> {
    let [_, position, acceleration] = figures(h.problem);
    let cable = h.problem.cable();
    let mut all = vec![
        (
            format!("{}-position", h.problem.name()),
            position,
            "height of the end",
            "z [m]",
            format!("{cable}.end.z"),
        ),
        (
            format!("{}-acceleration", h.problem.name()),
            acceleration,
            "vertical acceleration of the end",
            "acceleration [m/s²]",
            format!("{cable}.end.az"),
        ),
    ];
    if h.problem == Problem::Spherical {
        let name = "spherical-reaction".to_string();
        all.push((name, "Figure L.12", "reaction of the joint", "force [N]", "joint.magnitude".to_string()));
    }
    let plot = |figure: &str, what: &str, label: &str, column: &str| LinePlot {
        title: titled(figure, format!("{what}, {DRAWN} elements: {}", h.problem.title())),
        x_label: "t [s]".into(),
        y_label: label.into(),
        series: h
            .all
            .iter()
            .filter_map(|(label, history)| Some(Series::new(label, history.table.points(column)?)))
            .collect(),
        ..LinePlot::default()
    };
    all.into_iter()
        .map(|(name, figure, what, label, column)| (name, plot(figure, what, label, &column)))
        .collect()
}
