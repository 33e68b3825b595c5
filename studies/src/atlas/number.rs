//! Numbers of runs beside their records, functions, and units as in print.

use super::data::Run;
use super::plan::Use;
use super::spec::{Function, Quantity};
use ropewalk_forces::{choo_casarella_cn, choo_casarella_ct_over_mu};
use ropewalk_scene::quantity::kind;

impl Quantity {
    /// Name and unit.
    pub(super) fn heading(self) -> &'static str {
        match self {
            Quantity::Cpu => "CPU time [s]",
            Quantity::Steps => "steps",
            Quantity::Rejected => "repeated steps",
            Quantity::Iterations => "Newton iterations",
            Quantity::IterationsPerStep => "Newton iterations per step",
            Quantity::BendingTime => "T = l² √(ρA/EI) [s]",
            Quantity::WindingCoefficient => "v = V T / l",
        }
    }

    /// The number of a run; NaN where it has none.
    pub(super) fn of(self, run: &Run<'_>) -> f64 {
        let counts = run.summary.counts;
        let (element, time) = run.bending.unwrap_or((f64::NAN, f64::NAN));
        match self {
            Quantity::Cpu => run.summary.cpu_s,
            Quantity::Steps => counts.steps as f64,
            Quantity::Rejected => counts.rejected as f64,
            Quantity::Iterations => counts.newton_iterations as f64,
            Quantity::IterationsPerStep => counts.newton_iterations as f64 / counts.steps as f64,
            Quantity::BendingTime => time,
            Quantity::WindingCoefficient => winding(run.used) * time / element,
        }
    }
}

/// The speed of winding of a run [m/s].
fn winding(used: &Use) -> f64 {
    let text = used.value("winding").unwrap_or("0").trim_matches('"');
    text.parse().or_else(|_| kind::SPEED.parse(text)).unwrap_or(f64::NAN)
}

impl Function {
    pub(super) fn label(self) -> &'static str {
        match self {
            Function::ChooCasarellaCn => "Cn of Choo and Casarella",
            Function::ChooCasarellaCt => "tangential coefficient of Choo and Casarella",
        }
    }

    pub(super) fn at(self, x: f64) -> f64 {
        match self {
            Function::ChooCasarellaCn => choo_casarella_cn(x),
            Function::ChooCasarellaCt => choo_casarella_ct_over_mu(x),
        }
    }
}

/// A heading such as `a [m/s^2]` as it is printed.
pub(super) fn printed(heading: &str) -> String {
    let raised = [("^-1", "⁻¹"), ("^-2", "⁻²"), ("^2", "²"), ("^3", "³"), ("^4", "⁴")];
    raised.iter().fold(heading.to_string(), |text, (plain, print)| text.replace(plain, print))
}

#[cfg(test)]
mod tests {
    #[test]
    fn units_are_raised_as_in_print() {
        assert_eq!(super::printed("a [m/s^2]"), "a [m/s²]");
        assert_eq!(super::printed("EI [N m^2]"), "EI [N m²]");
    }
}
