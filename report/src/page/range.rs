//! Range graphs, as a page takes them.

use crate::{Column, Table};

/// Between what a quantity was along a line, over all steps of a time. All arrays are as long as `s`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RangeGraph {
    /// Name of the range graph, such as `chain`.
    pub name: String,
    /// What it is of, such as `tension`.
    pub quantity: String,
    /// Its unit.
    pub unit: String,
    /// From when to when [s]; NaN where it isn't known.
    pub window: [f64; 2],
    /// Unstretched arc lengths [m].
    pub s: Vec<f64>,
    /// What it was at the start.
    pub start: Vec<f64>,
    /// The least.
    pub least: Vec<f64>,
    /// The mean over time.
    pub mean: Vec<f64>,
    /// The greatest.
    pub greatest: Vec<f64>,
    /// The standard deviation.
    pub deviation: Vec<f64>,
    /// When it was least [s].
    pub t_least: Vec<f64>,
    /// When it was greatest [s].
    pub t_greatest: Vec<f64>,
}

impl RangeGraph {
    /// All graphs of a table with a column `s` and columns such as `tension.least`, as a run writes it.
    pub fn of_table(name: &str, window: [f64; 2], table: &Table) -> Vec<Self> {
        let Some(s) = table.column("s") else { return Vec::new() };
        let firsts = table.columns.iter().filter_map(|c| Some((c.name.strip_suffix(".start")?, c)));
        let graph = |(quantity, start): (&str, &Column)| {
            let of = |what: &str| {
                let column = table.column(&format!("{quantity}.{what}"));
                column.map_or_else(|| vec![f64::NAN; s.values.len()], |c| c.values.clone())
            };
            RangeGraph {
                name: name.into(),
                quantity: quantity.into(),
                unit: start.unit.clone(),
                window,
                s: s.values.clone(),
                start: start.values.clone(),
                least: of("least"),
                mean: of("mean"),
                greatest: of("largest"),
                deviation: of("deviation"),
                t_least: of("t_least"),
                t_greatest: of("t_largest"),
            }
        };
        firsts.map(graph).collect()
    }
}
