//! Pictures of a ledger: where the time goes, and how far the record changes by each effect.

use super::ledger::{EffectTrial, Ledger, Verdict};
use crate::run::ProfileEntry;
use ropewalk_report::{Bar, BarPlot, RunFolder, rough};

/// Draws both and gives the names of those that could be. One that can't is no reason to fail.
pub(super) fn draw(
    folder: &RunFolder,
    title: &str,
    ledger: &Ledger,
    accuracy: f64,
    warn: &mut dyn FnMut(&str),
) -> Vec<String> {
    let plots = [("ledger", times(title, ledger)), ("effects", changes(title, ledger, accuracy))];
    let drawn = plots.iter().filter(|(name, plot)| folder.draw(name, |path| plot.write(path), warn));
    drawn.map(|(name, _)| name.to_string()).collect()
}

fn times(title: &str, ledger: &Ledger) -> BarPlot {
    let mut costs: Vec<_> = ledger.costs.iter().collect();
    costs.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));
    let bar = |c: &&ProfileEntry| Bar {
        label: c.label.clone(),
        value: 100.0 * c.share,
        note: match c.calls {
            1 => format!("{:.1} %", 100.0 * c.share),
            n => format!("{:.1} %, {n} calls", 100.0 * c.share),
        },
        group: 0,
    };
    BarPlot {
        title: format!("{title}: where {} s of CPU time go", rough(ledger.cpu_s)),
        axis: "share of the time [%]".into(),
        bars: costs.iter().map(bar).collect(),
        ..BarPlot::default()
    }
}

fn changes(title: &str, ledger: &Ledger, accuracy: f64) -> BarPlot {
    let bar = |t: &EffectTrial, way: &str, group| match &t.verdict {
        Verdict::Ran { change, cpu_s, .. } => {
            let ratio = cpu_s / ledger.cpu_s;
            let time = match ratio {
                r if r > 2.0 => format!("takes {} times as long", rough(r)),
                r if r > 1.0 => format!("costs {:.0} % of the time", 100.0 * (r - 1.0)),
                r => format!("saves {:.0} % of the time", 100.0 * (1.0 - r)),
            };
            let note = format!("{}, {time}", rough(*change));
            Some((*change, Bar { label: format!("{way} {}", t.name), value: *change, note, group }))
        }
        Verdict::Failed(_) => None,
    };
    let without = ledger.without.iter().filter_map(|t| bar(t, "without", 0));
    let mut all: Vec<(f64, Bar)> =
        without.chain(ledger.with.iter().filter_map(|t| bar(t, "with", 1))).collect();
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    BarPlot {
        title: format!("{title}: change of {} by each effect", ledger.record),
        axis: "change, in parts of the largest value of the record".into(),
        bars: all.into_iter().map(|(_, bar)| bar).collect(),
        groups: vec!["effect left out".into(), "effect added".into()],
        log: true,
        mark: Some((accuracy, "accuracy".into())),
    }
}
