//! What is found: rows for machines, a page with pictures for people.

use ropewalk::report::LinePlot;
use serde::Serialize;
use std::fmt::Display;
use std::path::Path;

/// One code on one case with one setting.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Row {
    pub problem: &'static str,
    pub case: String,
    pub code: String,
    pub setting: String,
    pub elements: usize,
    /// Time simulated [s].
    pub duration: f64,
    /// CPU time of the steps, median and least of the repeats [s].
    pub cpu: f64,
    pub cpu_least: f64,
    pub steps: u64,
    pub iterations: u64,
    pub factorizations: u64,
    /// As the page defines it for the problem.
    pub error: f64,
}

impl Row {
    /// CPU time per simulated second [ms/s].
    pub fn load(&self) -> f64 {
        1e3 * self.cpu / self.duration
    }
    /// [µs]
    pub fn per_element_and_iteration(&self) -> f64 {
        1e6 * self.cpu / (self.elements as f64 * self.iterations as f64)
    }
    /// [µs]
    pub fn per_element_and_step(&self) -> f64 {
        1e6 * self.cpu / (self.elements as f64 * self.steps as f64)
    }
}

/// The page, printed as it grows.
#[derive(Default)]
pub struct Report {
    pub rows: Vec<Row>,
    page: String,
    plots: Vec<(&'static str, LinePlot)>,
}

impl Report {
    /// A line of the page.
    pub fn say(&mut self, line: impl Display) {
        println!("{line}");
        self.page += &format!("{line}\n");
    }
    /// A table of the page.
    pub fn table(&mut self, head: &[&str], rows: &[Vec<String>]) {
        self.say("");
        self.say(format!("| {} |", head.join(" | ")));
        self.say(format!("|{}", " --- |".repeat(head.len())));
        for row in rows {
            self.say(format!("| {} |", row.join(" | ")));
        }
        self.say("");
    }
    /// A picture of the page.
    pub fn plot(&mut self, name: &'static str, plot: LinePlot) {
        self.page += &format!("\n![{}]({name}.svg)\n", plot.title);
        self.plots.push((name, plot));
    }
    /// Writes page, pictures and rows into a folder.
    pub fn write(&self, folder: &Path) -> Result<(), String> {
        let fail = |path: &Path, e: &dyn Display| format!("{}: {e}", path.display());
        std::fs::create_dir_all(folder).map_err(|e| fail(folder, &e))?;
        for (name, plot) in &self.plots {
            let path = folder.join(format!("{name}.svg"));
            plot.write(&path).map_err(|e| fail(&path, &e))?;
        }
        let rows = serde_json::to_string_pretty(&self.rows).map_err(|e| e.to_string())?;
        for (name, text) in [("README.md", &self.page), ("results.json", &rows), ("results.csv", &self.csv())]
        {
            let path = folder.join(name);
            std::fs::write(&path, text).map_err(|e| fail(&path, &e))?;
        }
        println!("written to {}", folder.display());
        Ok(())
    }
    fn csv(&self) -> String {
        let mut text =
            "problem,case,code,setting,elements,duration [s],cpu [s],least cpu [s],steps,iterations,\
                        factorizations,error\n"
                .to_string();
        for r in &self.rows {
            let texts = [r.problem, &r.case, &r.code, &r.setting].map(|t| t.replace(',', ";")).join(",");
            text += &format!(
                "{texts},{},{},{:.6},{:.6},{},{},{},{:.3e}\n",
                r.elements, r.duration, r.cpu, r.cpu_least, r.steps, r.iterations, r.factorizations, r.error
            );
        }
        text
    }
}

/// `a / b` to two digits, or a dash where either is missing.
pub fn ratio(a: Option<f64>, b: Option<f64>) -> String {
    match (a, b) {
        (Some(a), Some(b)) => match a / b {
            r if r >= 10.0 => format!("{r:.0}"),
            r => format!("{r:.1}"),
        },
        _ => "–".into(),
    }
}

/// A number with a format, or a dash.
pub fn shown(x: Option<f64>, format: impl Fn(f64) -> String) -> String {
    x.map_or("–".into(), format)
}

/// CPU time at which an error is reached, between the best of the runs `(cpu, error)` in powers; none if it isn't.
pub fn cost_at(runs: &[(f64, f64)], error: f64) -> Option<f64> {
    let mut runs: Vec<_> = runs.iter().copied().filter(|(cpu, e)| *cpu > 0.0 && *e > 0.0).collect();
    runs.sort_by(|a, b| a.0.total_cmp(&b.0));
    // those that nothing cheaper beats
    let mut best: Vec<(f64, f64)> = Vec::new();
    for run in runs {
        if best.last().is_none_or(|last| run.1 < last.1) {
            best.push(run);
        }
    }
    let k = best.iter().position(|run| run.1 <= error)?;
    let (cpu, e) = best[k];
    if k == 0 {
        return Some(cpu);
    }
    let (cheaper, worse) = best[k - 1];
    let s = (worse / error).ln() / (worse / e).ln();
    Some(cheaper * (cpu / cheaper).powf(s))
}
