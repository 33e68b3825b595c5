//! The findings as tables, for people and as CSV.

use super::scaling::{MESHES, Row, deflection_error};
use super::stiffness::{CANTILEVER, HELIX, PENDULUM};
use super::{Form, Problem, Variants};
use ropewalk_report::{Csv, Sheet, rough};

impl Variants {
    /// The tables as text.
    pub fn text(&self) -> String {
        let mut sheet = Sheet::default();
        if !self.stiffness.is_empty() {
            self.stiffness_table(&mut sheet);
        }
        for problem in Problem::ALL {
            if self.rows(problem, Form::Si, false).next().is_some() {
                self.scaling_table(&mut sheet, problem);
            }
        }
        if !self.scaling.is_empty() {
            sheet.line(EXPLANATION.trim_end());
        }
        sheet.to_string()
    }

    fn stiffness_table(&self, sheet: &mut Sheet) {
        sheet.line(
            "stiffness models: µs per element; relative errors of a cantilever's deflection, of a pendulum's tip, and of the \
             tip of a rod that is wound to a helix",
        );
        let mut headings = ["", "force", "tangent"].map(String::from).to_vec();
        headings.extend(CANTILEVER.iter().chain(&PENDULUM).chain(&HELIX).map(|n| format!("n = {n}")));
        headings.extend(["locking", "energy", "asymm.", "strain"].map(String::from));
        let row = |s: &super::Stiffness| {
            let errors = s.cantilever.iter().chain(&s.pendulum).chain(&s.helix);
            let others = [s.locking, s.energy, s.asymmetry, s.moment_strain];
            let mut row = vec![s.label.clone(), timed(s.force_us), timed(s.tangent_us)];
            row.extend(errors.chain(&others).map(|x| short(*x)));
            row
        };
        sheet.table(&headings, &self.stiffness.iter().map(row).collect::<Vec<_>>());
        sheet.line(
            "  locking: growth of the error of 8 elements where EA L²/EI grows from 1.6e5 to 1.6e9; energy: what its \
             balance misses;\n  asymm.: of the tangent; strain: under a pure moment of one radian, where a beam has \
             none; fails: no equilibrium was found",
        );
        for f in &self.forbidden {
            sheet.line(format!("  {:?}+{:?} is not available: {}", f.longitudinal, f.transverse, f.why));
        }
        sheet.line("");
    }

    /// The rows of a problem, in one form and with one stopping test.
    pub(super) fn rows(&self, problem: Problem, form: Form, absolute: bool) -> impl Iterator<Item = &Row> {
        self.scaling.iter().filter(move |r| r.problem == problem && r.form == form && r.absolute == absolute)
    }

    fn scaling_table(&self, sheet: &mut Sheet, problem: Problem) {
        let mut table: Vec<Vec<String>> = Vec::new();
        let mut line = |label: String, rows: &[&Row], cell: &dyn Fn(&Row) -> String| {
            let of = |n: usize| rows.iter().find(|r| r.elements == n).map_or("-".into(), |r| cell(r));
            table.push(std::iter::once(label).chain(MESHES.map(of)).collect());
        };
        let of = |form, absolute| self.rows(problem, form, absolute).collect::<Vec<_>>();
        let si = of(Form::Si, false);
        for form in [Form::Bending, Form::Axial] {
            line(format!("T of {} [s]", form.label()), &of(form, false), &|r| short(r.time_unit));
        }
        for form in Form::ALL {
            line(format!("condition number, {}", form.label()), &of(form, false), &|r| short(r.condition));
        }
        for (test, absolute) in [("relative", false), ("absolute", true)] {
            for form in [Form::Si, Form::Bending, Form::Axial] {
                line(format!("iterations per step, {test}, {}", form.label()), &of(form, absolute), &|r| {
                    let star = if r.unmet > 0 { "*" } else { "" };
                    if r.failed.is_some() { "fails".into() } else { format!("{:.2}{star}", r.iterations) }
                });
            }
        }
        for (test, absolute) in [("relative", false), ("absolute", true)] {
            let si = of(Form::Si, absolute);
            for form in [Form::Bending, Form::Axial] {
                line(format!("time SI / {}, {test}", form.label()), &of(form, absolute), &|r| {
                    let other = si.iter().find(|s| s.elements == r.elements).map_or(f64::NAN, |s| s.cpu_s);
                    format!("{:.2}", other / r.cpu_s)
                });
            }
        }
        line("CPU time, relative, SI [s]".into(), &si, &|r| short(r.cpu_s));
        line("end apart from SI, relative, bending".into(), &of(Form::Bending, false), &|r| short(r.apart));
        if problem == Problem::Cantilever {
            line("error of the mean deflection".into(), &si, &|r| short(deflection_error(r)));
        }
        sheet.line(problem.title());
        let headings = std::iter::once("elements".to_string()).chain(MESHES.map(|n| n.to_string()));
        sheet.table(&headings.collect::<Vec<_>>(), &table);
        if self.scaling.iter().any(|r| r.problem == problem && r.unmet > 0) {
            sheet
                .line("  *: in some steps the test was never met, since rounding leaves more than it allows");
        }
        sheet.line("");
    }

    /// One number a row: which stiffness model, what, which mesh, how much.
    pub fn stiffness_csv(&self) -> String {
        let mut csv = Csv::new(["models", "quantity", "elements", "value"]);
        for s in &self.stiffness {
            let label = s.label.replace(',', ";");
            let errors = [
                ("cantilever", &CANTILEVER[..], &s.cantilever),
                ("pendulum", &PENDULUM[..], &s.pendulum),
                ("helix", &HELIX[..], &s.helix),
            ];
            for (quantity, meshes, errors) in errors {
                for (n, e) in meshes.iter().zip(errors) {
                    csv.cell(&label).cell(format!("error of the {quantity}")).cell(n.to_string());
                    csv.number(*e).end();
                }
            }
            for (quantity, x) in [
                ("force [us per element]", s.force_us),
                ("tangent [us per element]", s.tangent_us),
                ("locking", s.locking),
                ("energy", s.energy),
                ("asymmetry", s.asymmetry),
                ("strain under a pure moment", s.moment_strain),
            ] {
                csv.cell(&label).cell(quantity).cell("").number(x).end();
            }
        }
        csv.text()
    }

    /// One run a row.
    pub fn scaling_csv(&self) -> String {
        let mut csv = Csv::new([
            "problem",
            "elements",
            "form",
            "stopping test",
            "time unit [s]",
            "steps",
            "rejected",
            "iterations per step",
            "steps unmet",
            "cpu [s]",
            "condition number",
            "mean height [m]",
            "apart from SI",
            "failed",
        ]);
        for r in &self.scaling {
            csv.cell(r.problem.name()).cell(r.elements.to_string()).cell(r.form.label());
            csv.cell(if r.absolute { "absolute" } else { "relative" }).number(r.time_unit);
            csv.cell(r.steps.to_string()).cell(r.rejected.to_string()).number(r.iterations);
            csv.cell(r.unmet.to_string()).number(r.cpu_s).number(r.condition).number(r.mean);
            csv.number(r.apart).cell(if r.failed.is_some() { "yes" } else { "no" }).end();
        }
        csv.text()
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
