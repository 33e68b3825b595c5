//! The findings as tables, for people and as CSV.

use super::scaling::{MESHES, Row, deflection_error};
use super::stiffness::{CANTILEVER, PENDULUM};
use super::{Form, Problem, Variants};
use ropewalk_report::rough;
use std::fmt::Write as _;

impl Variants {
    /// The tables as text.
    pub fn text(&self) -> String {
        let mut out = String::new();
        self.stiffness_table(&mut out);
        for problem in Problem::ALL {
            self.scaling_table(&mut out, problem);
        }
        if !self.scaling.is_empty() {
            out += EXPLANATION;
        }
        out
    }

    fn stiffness_table(&self, out: &mut String) {
        if self.stiffness.is_empty() {
            return;
        }
        let wide = self.stiffness.iter().map(|s| s.label.chars().count()).max().unwrap_or(0);
        *out += "stiffness models: µs per element; relative errors of a cantilever's deflection and of a pendulum's tip\n";
        _ = write!(out, "  {:<wide$}{:>8}{:>9}", "", "force", "tangent");
        CANTILEVER.iter().for_each(|n| _ = write!(out, "{:>9}", format!("n = {n}")));
        PENDULUM.iter().for_each(|n| _ = write!(out, "{:>9}", format!("n = {n}")));
        _ = writeln!(out, "{:>9}{:>9}{:>9}{:>9}", "locking", "energy", "asymm.", "strain");
        for s in &self.stiffness {
            _ = write!(out, "  {:<wide$}{:>8}{:>9}", s.label, timed(s.force_us), timed(s.tangent_us));
            s.cantilever.iter().chain(&s.pendulum).for_each(|e| _ = write!(out, "{:>9}", short(*e)));
            for x in [s.locking, s.energy, s.asymmetry, s.moment_strain] {
                _ = write!(out, "{:>9}", short(x));
            }
            out.push('\n');
        }
        *out += "  locking: growth of the error of 8 elements where EA L²/EI grows from 1.6e5 to 1.6e9; energy: what its \
                 balance misses;\n  asymm.: of the tangent; strain: under a pure moment of one radian, where a beam has \
                 none; fails: no equilibrium was found\n";
        for f in &self.forbidden {
            _ = writeln!(out, "  {:?}+{:?} isn't there: {}", f.longitudinal, f.transverse, f.why);
        }
        out.push('\n');
    }

    /// The rows of a problem, in one form and with one stopping test.
    pub(super) fn rows(&self, problem: Problem, form: Form, absolute: bool) -> impl Iterator<Item = &Row> {
        self.scaling.iter().filter(move |r| r.problem == problem && r.form == form && r.absolute == absolute)
    }

    fn scaling_table(&self, out: &mut String, problem: Problem) {
        if self.rows(problem, Form::Si, false).next().is_none() {
            return;
        }
        _ = write!(out, "{}\n  {:<44}", problem.title(), "elements");
        MESHES.iter().for_each(|n| _ = write!(out, "{n:>10}"));
        out.push('\n');
        let mut line = |label: String, rows: Vec<&Row>, cell: &dyn Fn(&Row) -> String| {
            _ = write!(out, "  {label:<44}");
            for n in MESHES {
                let found = rows.iter().find(|r| r.elements == n);
                _ = write!(out, "{:>10}", found.map_or("-".to_string(), |r| cell(r)));
            }
            out.push('\n');
        };
        let of = |form, absolute| self.rows(problem, form, absolute).collect::<Vec<_>>();
        for form in [Form::Bending, Form::Axial] {
            line(format!("T of {} [s]", form.label()), of(form, false), &|r| short(r.time_unit));
        }
        for form in Form::ALL {
            line(format!("condition number, {}", form.label()), of(form, false), &|r| short(r.condition));
        }
        for (test, absolute) in [("relative", false), ("absolute", true)] {
            for form in [Form::Si, Form::Bending, Form::Axial] {
                line(format!("iterations per step, {test}, {}", form.label()), of(form, absolute), &|r| {
                    let star = if r.unmet > 0 { "*" } else { "" };
                    if r.failed.is_some() { "fails".into() } else { format!("{:.2}{star}", r.iterations) }
                });
            }
        }
        for (test, absolute) in [("relative", false), ("absolute", true)] {
            let si = of(Form::Si, absolute);
            for form in [Form::Bending, Form::Axial] {
                line(format!("time SI / {}, {test}", form.label()), of(form, absolute), &|r| {
                    let other = si.iter().find(|s| s.elements == r.elements).map_or(f64::NAN, |s| s.cpu_s);
                    format!("{:.2}", other / r.cpu_s)
                });
            }
        }
        line("CPU time, relative, SI [s]".into(), of(Form::Si, false), &|r| short(r.cpu_s));
        line("end apart from SI, relative, bending".into(), of(Form::Bending, false), &|r| short(r.apart));
        if problem == Problem::Cantilever {
            line("error of the mean deflection".into(), of(Form::Si, false), &|r| short(deflection_error(r)));
        }
        if self.scaling.iter().any(|r| r.problem == problem && r.unmet > 0) {
            *out += "  *: in some steps the test was never met, since rounding leaves more than it allows\n";
        }
        out.push('\n');
    }

    /// One number a row: which stiffness model, what, which mesh, how much.
    pub fn stiffness_csv(&self) -> String {
        let mut out = String::from("models,quantity,elements,value\n");
        for s in &self.stiffness {
            let label = s.label.replace(',', ";");
            for (quantity, meshes, errors) in
                [("cantilever", &CANTILEVER[..], &s.cantilever), ("pendulum", &PENDULUM[..], &s.pendulum)]
            {
                meshes
                    .iter()
                    .zip(errors)
                    .for_each(|(n, e)| _ = writeln!(out, "{label},error of the {quantity},{n},{e}"));
            }
            for (quantity, x) in [
                ("force [us per element]", s.force_us),
                ("tangent [us per element]", s.tangent_us),
                ("locking", s.locking),
                ("energy", s.energy),
                ("asymmetry", s.asymmetry),
                ("strain under a pure moment", s.moment_strain),
            ] {
                _ = writeln!(out, "{label},{quantity},,{x}");
            }
        }
        out
    }

    /// One run a row.
    pub fn scaling_csv(&self) -> String {
        let mut out = String::from(
            "problem,elements,form,stopping test,time unit [s],steps,rejected,iterations per step,steps unmet,cpu [s],\
             condition number,mean height [m],apart from SI,failed\n",
        );
        for r in &self.scaling {
            _ = writeln!(
                out,
                "{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
                r.problem.name(),
                r.elements,
                r.form.label(),
                if r.absolute { "absolute" } else { "relative" },
                r.time_unit,
                r.steps,
                r.rejected,
                r.iterations,
                r.unmet,
                r.cpu_s,
                r.condition,
                r.mean,
                r.apart,
                if r.failed.is_some() { "yes" } else { "no" }
            );
        }
        out
    }
}

const EXPLANATION: &str = "\
What equations without dimensions gain: nothing, where the stopping test is relative. Newton's method is invariant under
a scaling of unknowns and equations, so the iterations are the same and only rounding differs. An absolute test of the
residual, however, means another accuracy in every system of units. In SI units rounding leaves a residual of about
1e-16 EA, which on a stiff rod is more than the test allows: such a step iterates in vain. Divided by a large unit of
force the same number is a looser test, which is all that was gained; divided by a small one, as that of bending is for a
hose that hardly bends, it is a tighter test, and more is lost. The condition number of the plain matrix falls by many
decades for the same reason, and as far by the factor β h² that Ropewalk's equations carry anyway (see `SI, scaled`).
";

/// A time in µs; a dash where Ctrl-C came before.
fn timed(us: f64) -> String {
    if us.is_nan() { "-".into() } else { format!("{us:.3}") }
}

/// A number in nine characters.
fn short(x: f64) -> String {
    match x {
        x if x.is_nan() => "fails".into(),
        0.0 => "0".into(),
        x if (0.01..1000.0).contains(&x.abs()) => rough(x),
        x => format!("{x:.1e}"),
    }
}
