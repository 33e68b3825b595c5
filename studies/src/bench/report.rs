//! What was measured, as tables for people, CSV, JSON and a picture. All times are µs per element.

use ropewalk_elements::cable::CableModel;
use ropewalk_report::{Csv, LinePlot, Mark, Series, Sheet};
use serde::Serialize;

/// Everything that `ropewalk bench` measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Version of Ropewalk.
    pub ropewalk: &'static str,
    /// Processor architecture.
    pub architecture: &'static str,
    /// Elements that are evaluated at once.
    pub lanes: usize,
    /// The pendulum in air, by number of elements.
    pub dry: Vec<Cost>,
    /// The same in water.
    pub water: Vec<Cost>,
    /// A chain of rigid links, by their number.
    pub links: Vec<Cost>,
    /// The stiffness models.
    pub variants: Vec<VariantCost>,
    /// Peak memory, where it is known.
    pub memory: Option<Memory>,
}

/// What one mesh costs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// Number of elements.
    pub elements: usize,
    /// A full Newton iteration: force, exact tangent, assembly, factors, solution and its check [µs per element].
    #[serde(rename = "iteration_us")]
    pub iteration: f64,
    /// The residual alone [µs per element].
    #[serde(rename = "residual_us")]
    pub residual: f64,
    /// Where the time of the iteration goes.
    pub phases: Vec<Share>,
    /// How often LU with pivoting had to step in; not at all, if all is well.
    pub fallbacks: u64,
    /// A step of the default policy.
    pub step: StepCost,
}

/// The share of a phase in an iteration.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Share {
    /// The term or the work of the solver.
    pub label: String,
    /// Its time [µs per element].
    pub us: f64,
}

/// What a step costs on average.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StepCost {
    /// Its time [µs per element].
    pub us: f64,
    /// Newton iterations.
    pub iterations: f64,
    /// Factorisations.
    pub factorizations: f64,
}

/// What a stiffness model costs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VariantCost {
    /// What its pool is called.
    pub label: String,
    /// The models.
    pub models: CableModel,
    /// Number of elements of the mesh.
    pub elements: usize,
    /// Force and inertia, with gather and scatter [µs per element].
    #[serde(rename = "force_us")]
    pub force: f64,
    /// The same with the exact tangent and mass [µs per element].
    #[serde(rename = "tangent_us")]
    pub tangent: f64,
    /// A full Newton iteration [µs per element].
    #[serde(rename = "iteration_us")]
    pub iteration: f64,
}

/// Peak memory of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Memory {
    /// The two meshes whose peaks were compared.
    pub elements: [usize; 2],
    /// In air [bytes per element].
    pub dry: f64,
    /// In water [bytes per element].
    pub water: f64,
}

/// What a row of a table says about each mesh.
type Rows = Vec<(String, Vec<f64>)>;

fn row(costs: &[Cost], label: &str, f: impl Fn(&Cost) -> f64) -> (String, Vec<f64>) {
    (label.to_string(), costs.iter().map(f).collect())
}

/// µs per element: the phases of an iteration, then what they add up to.
fn times(costs: &[Cost]) -> Rows {
    let phases = costs.first().map_or(&[][..], |c| &c.phases).iter().enumerate();
    let mut all: Rows =
        phases.map(|(k, p)| row(costs, &format!("  {}", p.label), |c| c.phases[k].us)).collect();
    all.push(row(costs, "full Newton iteration", |c| c.iteration));
    all.push(row(costs, "residual alone", |c| c.residual));
    all.push(row(costs, "step", |c| c.step.us));
    all
}

fn counts(costs: &[Cost]) -> Rows {
    vec![
        row(costs, "  Newton iterations per step", |c| c.step.iterations),
        row(costs, "  factorisations per step", |c| c.step.factorizations),
    ]
}

/// The table of a pendulum in air or in water: a row for each phase, a column for each mesh.
pub fn costs(title: &str, costs: &[Cost]) -> String {
    let mut sheet = Sheet::new(format!("{title}: µs per element"));
    let headings: Vec<String> =
        std::iter::once("elements".to_string()).chain(costs.iter().map(|c| c.elements.to_string())).collect();
    let cells = |(label, values): (String, Vec<f64>)| {
        std::iter::once(label).chain(values.iter().map(|x| format!("{x:.3}"))).collect()
    };
    let rows: Vec<Vec<String>> = [times(costs), counts(costs)].concat().into_iter().map(cells).collect();
    sheet.table(&headings, &rows);
    let fine = costs.iter().filter(|c| c.elements >= 32).map(|c| c.iteration);
    let (low, high) = fine.fold((f64::INFINITY, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
    if high > low {
        let ratio = high / low;
        sheet.line(format!("  from 32 elements on, the dearest iteration is {ratio:.2} times the cheapest"));
    }
    let fallbacks: u64 = costs.iter().map(|c| c.fallbacks).sum();
    if fallbacks > 0 {
        sheet.line(format!("  note: LU with pivoting had to step in {fallbacks} times"));
    }
    sheet.to_string()
}

/// The table of the stiffness models.
pub fn variants(variants: &[VariantCost]) -> String {
    let Some(first) = variants.first() else { return String::new() };
    let mut sheet = Sheet::new(format!(
        "stiffness models, {} elements: µs per element, and relative to the default",
        first.elements
    ));
    let cell = |x: f64, of: f64| format!("{x:.3} {:5.2}x", x / of);
    let row = |v: &VariantCost| {
        let cells = [(v.force, first.force), (v.tangent, first.tangent), (v.iteration, first.iteration)];
        std::iter::once(v.label.clone()).chain(cells.map(|(x, of)| cell(x, of))).collect()
    };
    let rows: Vec<Vec<String>> = variants.iter().map(row).collect();
    sheet.table(&["", "force", "force + tangent", "full iteration"], &rows);
    sheet.to_string()
}

impl Memory {
    /// One line for people.
    pub fn line(&self) -> String {
        let [few, more] = self.elements;
        format!(
            "peak memory per element: {:.1} kB dry, {:.1} kB in water (between {few} and {more} elements)",
            self.dry / 1024.0,
            self.water / 1024.0
        )
    }
}

impl Report {
    /// One number a row: what, which mesh, how much.
    pub fn csv(&self) -> String {
        let mut csv = Csv::new(["what", "elements", "quantity", "value [us per element]"]);
        let mut row = |what: &str, elements: usize, quantity: &str, x: f64| {
            csv.cell(what).cell(elements.to_string()).cell(quantity).number(x).end();
        };
        for (what, costs) in [("dry", &self.dry), ("water", &self.water), ("links", &self.links)] {
            for (label, values) in times(costs) {
                costs.iter().zip(values).for_each(|(c, x)| row(what, c.elements, label.trim(), x));
            }
        }
        for v in &self.variants {
            for (quantity, x) in [("force", v.force), ("tangent", v.tangent), ("iteration", v.iteration)] {
                row(&v.label, v.elements, quantity, x);
            }
        }
        csv.text()
    }

    /// µs per element over the number of elements.
    pub fn plot(&self) -> LinePlot {
        let line = |label: &str, costs: &[Cost], f: fn(&Cost) -> f64| {
            let points = costs.iter().map(|c| (c.elements as f64, f(c))).collect();
            Series::new(label, points).with_mark(Mark::LineAndDots)
        };
        LinePlot {
            title: format!("Cost per element, {} at a time", self.lanes),
            x_label: "number of elements".into(),
            y_label: "time per element [µs]".into(),
            series: vec![
                line("iteration, dry", &self.dry, |c| c.iteration),
                line("iteration, in water", &self.water, |c| c.iteration),
                line("step, dry", &self.dry, |c| c.step.us),
                line("step, in water", &self.water, |c| c.step.us),
                line("step, rigid links", &self.links, |c| c.step.us),
            ],
            log_x: true,
            ..LinePlot::default()
        }
    }
}
