//! A figure as a picture, and its curves as CSV.

use super::curves::plots;
use super::data::Run;
use super::overlay::Measured;
use super::plan::Plan;
use super::read::AtlasFile;
use super::spec::{Figure, Panel};
use ropewalk_report::{Csv, LinePlot, Mark, Panels, Series};

impl AtlasFile {
    /// The panels of a figure, each with its path in the file.
    pub(super) fn panels<'a>(&'a self, entry: usize, figure: &'a Figure) -> Vec<(String, &'a Panel)> {
        let layout = figure.layout.as_ref().and_then(|name| Some((name, self.atlas.layouts.get(name)?)));
        let shared = layout.into_iter().flat_map(|(name, layout)| {
            let path = move |i| format!("layouts.{name}.panels[{i}]");
            layout.panels.iter().enumerate().map(move |(i, p)| (path(i), p))
        });
        let own = figure.panels.iter().enumerate().map(|(i, p)| (format!("entries[{entry}].panels[{i}]"), p));
        shared.chain(own).collect()
    }

    /// Panels side by side: as the figure says, or its layout.
    pub(super) fn columns(&self, figure: &Figure) -> Option<usize> {
        let layout = figure.layout.as_ref().and_then(|name| self.atlas.layouts.get(name));
        figure.columns.or_else(|| layout?.columns)
    }
}

/// A figure ready to be written.
pub(super) struct Drawn {
    pub picture: Panels,
    /// What is to be said below it.
    pub notes: Vec<String>,
}

/// Draws a figure.
pub(super) fn draw(
    file: &AtlasFile,
    plan: &Plan,
    entry: usize,
    figure: &Figure,
    runs: &[Run<'_>],
    overlays: &[Measured],
) -> Drawn {
    let mut notes = Vec::new();
    let mut panels: Vec<LinePlot> = Vec::new();
    for (_, panel) in file.panels(entry, figure) {
        let mut plots = plots(panel, plan, entry, runs, &mut notes);
        for measured in overlays {
            plots.iter_mut().for_each(|plot| plot.series.extend(measured.curves(panel)));
        }
        panels.extend(plots);
    }
    notes.dedup();
    let beside = if panels.len() > 3 { 2 } else { 1 };
    let columns = file.columns(figure).unwrap_or(beside);
    let title = file.atlas.entries[entry].caption() + ". " + &figure.title;
    Drawn { picture: Panels { title, columns, panels }, notes }
}

/// Curves over the same values.
struct Block {
    x_label: String,
    x: Vec<f64>,
    /// Heading and values of each.
    curves: Vec<(String, Vec<f64>)>,
}

/// All curves as CSV: those over the same values share their first column.
pub(super) fn csv(picture: &Panels) -> String {
    let mut blocks: Vec<Block> = Vec::new();
    for plot in &picture.panels {
        for curve in plot.series.iter().filter(|s| s.mark != Mark::Guide) {
            let (x, y): (Vec<f64>, Vec<f64>) = curve.points.iter().copied().unzip();
            let named = (heading(plot, curve), y);
            match blocks.iter_mut().find(|b| b.x_label == plot.x_label && b.x == x) {
                Some(block) => block.curves.push(named),
                None => blocks.push(Block { x_label: plot.x_label.clone(), x, curves: vec![named] }),
            }
        }
    }
    let columns: Vec<(&str, &[f64])> = blocks
        .iter()
        .flat_map(|b| {
            let curves = b.curves.iter().map(|(name, y)| (name.as_str(), y.as_slice()));
            std::iter::once((b.x_label.as_str(), b.x.as_slice())).chain(curves)
        })
        .collect();
    let mut csv = Csv::new(columns.iter().map(|(name, _)| name));
    let rows = columns.iter().map(|(_, values)| values.len()).max().unwrap_or(0);
    for row in 0..rows {
        // curves of other lengths end earlier
        columns.iter().for_each(|(_, values)| _ = csv.number_or_none(values.get(row).copied()));
        csv.end();
    }
    csv.text()
}

/// `z [m]: end, start 40 s`
fn heading(plot: &LinePlot, curve: &Series) -> String {
    let which: Vec<&str> =
        [plot.title.as_str(), curve.label.as_str()].into_iter().filter(|s| !s.is_empty()).collect();
    match which.is_empty() || which == [plot.y_label.as_str()] {
        true => plot.y_label.clone(),
        false => format!("{}: {}", plot.y_label, which.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_over_the_same_values_share_a_column() {
        let curve =
            |label: &str, n: usize| Series::new(label, (0..n).map(|k| (k as f64, 10.0 * k as f64)).collect());
        let plot = |y: &str, series| LinePlot {
            x_label: "t [s]".into(),
            y_label: y.into(),
            series,
            ..LinePlot::default()
        };
        let drum = curve("drum", 9).with_mark(Mark::Guide);
        let panels =
            vec![plot("x [m]", vec![drum, curve("a", 3), curve("b", 2)]), plot("z [m]", vec![curve("a", 3)])];
        let text = csv(&Panels { panels, ..Panels::default() });
        assert_eq!(text, "t [s],x [m]: a,z [m]: a,t [s],x [m]: b\n0,0,0,0,0\n1,10,10,1,10\n2,20,20,,\n");
    }
}
