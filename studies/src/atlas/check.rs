//! What can be wrong with an entry, found before anything is computed.

use super::curves::MOST_CURVES;
use super::frame::{columns, component};
use super::plan::{Case, Plan, Use};
use super::read::AtlasFile;
use super::spec::{Cell, Entry, Figure, Panel, Sheet};
use ropewalk_scene::{Fault, did_you_mean, quoted};

impl AtlasFile {
    /// Looks whether an entry goes with its runs.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub(super) fn check(&self, entry: usize, plan: &Plan) -> Result<(), Fault> {
        let check = Check { file: self, path: format!("entries[{entry}]"), plan, uses: &plan.uses[entry] };
        match &self.atlas.entries[entry] {
            Entry::Figure(figure) => check.figure(entry, figure),
            Entry::Table(sheet) => check.sheet(sheet),
            Entry::Other(_) => Ok(()),
        }
    }
}

struct Check<'a> {
    file: &'a AtlasFile,
    path: String,
    plan: &'a Plan,
    uses: &'a [Use],
}

impl Check<'_> {
    fn cases(&self) -> impl Iterator<Item = (&Use, &Case)> {
        self.uses.iter().map(|u| (u, &self.plan.cases[u.case]))
    }

    fn fault(&self, path: &str, message: impl Into<String>, help: impl Into<String>) -> Fault {
        self.file.fault(path, message).with_help(help)
    }

    fn figure(&self, entry: usize, figure: &Figure) -> Result<(), Fault> {
        if let Some(name) = figure.layout.as_ref().filter(|name| !self.file.atlas.layouts.contains_key(*name))
        {
            let names: Vec<&String> = self.file.atlas.layouts.keys().collect();
            let guess = did_you_mean(name, &names).unwrap_or_else(|| "add it as `[layouts.NAME]`".into());
            let path = format!("{}.layout", self.path);
            return Err(self.fault(&path, format!("there is no layout {}", quoted(name)), guess));
        }
        let panels = self.file.panels(entry, figure);
        if panels.is_empty() {
            return Err(self.fault(&self.path, "the figure has no panels", "add `panels` or a `layout`"));
        }
        if self.file.columns(figure) == Some(0) {
            let path = format!("{}.columns", self.path);
            return Err(self.fault(
                &path,
                "`columns` must be at least 1",
                "leave it away for one below the other",
            ));
        }
        panels.iter().try_for_each(|(path, panel)| {
            // a layout may be wrong for one of its figures only
            self.panel(path, panel).map_err(|fault| match path.starts_with(&self.path) {
                true => fault,
                false => fault.with_note(format!("in {}", self.file.atlas.entries[entry].caption())),
            })
        })
    }

    fn panel(&self, path: &str, panel: &Panel) -> Result<(), Fault> {
        let records = !panel.y.is_empty() || panel.quantity.is_some();
        let kinds = [records, panel.shapes.is_some(), !panel.functions.is_empty()];
        if kinds.iter().filter(|k| **k).count() != 1 {
            let help = "give one of `y` (records), `quantity` with `over`, `shapes` and `functions`";
            return Err(self.fault(path, "a panel shows either records or shapes or functions", help));
        }
        if panel.functions.is_empty() && self.uses.is_empty() {
            return Err(self.fault(
                &self.path,
                "the figure has no runs",
                "add `runs = [{ scene = \"...\" }]`",
            ));
        }
        if panel.labels.len() > panel.y.len() {
            let message = format!("{} labels for {} records", panel.labels.len(), panel.y.len());
            return Err(self.fault(
                &format!("{path}.labels"),
                message,
                "give a label for each record, in their order",
            ));
        }
        if panel.y.len() > MOST_CURVES {
            let message = format!("{} records are more than {MOST_CURVES} curves", panel.y.len());
            return Err(self.fault(&format!("{path}.y"), message, "make several panels of them"));
        }
        if panel.quantity.is_some() && (panel.over.is_none() || !panel.y.is_empty()) {
            let message = "a quantity is a number of a run and drawn over a parameter";
            return Err(self.fault(&format!("{path}.quantity"), message, "add `over` and leave `y` away"));
        }
        self.axes(path, panel)?;
        self.window(path, panel)?;
        for (i, name) in panel.y.iter().enumerate() {
            self.column(&format!("{path}.y[{i}]"), name)?;
        }
        self.one_unit(path, panel)?;
        if let Some(x) = &panel.x {
            self.column(&format!("{path}.x"), x)?;
        }
        if let Some(name) = &panel.over {
            self.parameter(&format!("{path}.over"), name)?;
        }
        self.frame(path, panel)?;
        self.shapes(path, panel)
    }

    fn axes(&self, path: &str, panel: &Panel) -> Result<(), Fault> {
        let rises = |[a, b]: [f64; 2]| a < b && a.is_finite() && b.is_finite();
        for (name, range, log) in
            [("y_range", panel.y_range, panel.log_y), ("range", panel.range, panel.log_x)]
        {
            if let Some(range) = range.filter(|r| !rises(*r) || log && r[0] <= 0.0) {
                let message =
                    format!("`{name}` must rise, and be above 0 on a logarithmic axis, but is {range:?}");
                return Err(self.fault(&format!("{path}.{name}"), message, "write the smaller number first"));
            }
        }
        if !panel.functions.is_empty() && panel.range.is_none() {
            return Err(self.fault(path, "functions need a `range`", "add `range = [0.1, 1e5]`, say"));
        }
        if let Some(share) = panel.share.filter(|s| !(*s > 0.0 && *s <= 1.0)) {
            return Err(self.share(&format!("{path}.share"), share));
        }
        for (i, g) in panel.guides.iter().enumerate() {
            let kinds = [!g.points.is_empty(), !g.centre.is_empty(), g.level.is_some()];
            let flat = g.points.iter().chain(Some(&g.centre)).any(|p| p.len() == 1);
            if kinds.iter().filter(|k| **k).count() != 1 || flat || !g.centre.is_empty() && !(g.radius > 0.0)
            {
                let help =
                    "write `points = [[0, 1], [2, 3]]`, or `centre` and a positive `radius`, or `level`";
                return Err(self.fault(&format!("{path}.guides[{i}]"), "this is no line", help));
            }
        }
        Ok(())
    }

    fn share(&self, path: &str, share: f64) -> Fault {
        let message = format!("`share` must be above 0 and at most 1, not {share}");
        self.fault(path, message, "write the last part of the run as a share of it, like `10 %`")
    }

    fn window(&self, path: &str, panel: &Panel) -> Result<(), Fault> {
        if panel.window.is_none() && panel.after.is_none() {
            return Ok(());
        }
        for (used, case) in self.cases() {
            let run = &case.file.scene().run;
            let end = run.duration * (1.0 + 1e-9);
            let of = if used.label.is_empty() { String::new() } else { format!(" ({})", used.label) };
            if let Some([from, to]) = panel.window
                && !(from.0 >= 0.0 && from.0 < to.0 && to.0 <= end)
            {
                let message = format!(
                    "the window from {} to {} s is not inside the run, which ends at {} s{of}",
                    from.0, to.0, run.duration
                );
                let help = format!("choose two times between 0 and {} s, the earlier first", run.duration);
                return Err(self.fault(&format!("{path}.window"), message, help));
            }
            if let Some(after) = panel.after.filter(|t| !(*t >= 0.0 && *t < run.duration)) {
                let message =
                    format!("{after} s is not inside the run, which ends at {} s{of}", run.duration);
                let help = format!("choose a time below {} s", run.duration);
                return Err(self.fault(&format!("{path}.after"), message, help));
            }
        }
        Ok(())
    }

    /// Every run has a column of this name.
    fn column(&self, path: &str, name: &str) -> Result<(), Fault> {
        for (_, case) in self.cases() {
            if case.columns.iter().all(|c| c.name != name) {
                let names: Vec<&str> = case.columns.iter().map(|c| c.name.as_str()).collect();
                let message =
                    format!("the scene {} has no column {}", quoted(case.file.name()), quoted(name));
                let fault = self.file.fault(path, message);
                return Err(match did_you_mean(name, &names) {
                    Some(guess) => fault.with_note(format!("it has {}", names.join(", "))).with_help(guess),
                    None => fault.with_help(format!("choose one of {}", names.join(", "))),
                });
            }
        }
        Ok(())
    }

    fn one_unit(&self, path: &str, panel: &Panel) -> Result<(), Fault> {
        let mut units: Vec<&str> = Vec::new();
        for (_, case) in self.cases() {
            let of = |name: &String| case.columns.iter().find(|c| c.name == *name).map(|c| c.unit.as_str());
            units.extend(panel.y.iter().filter_map(of));
        }
        match units.iter().find(|u| **u != units[0]) {
            Some(other) => {
                let message = format!("one axis can't show both [{}] and [{other}]", units[0]);
                Err(self.fault(&format!("{path}.y"), message, "make a panel for each unit"))
            }
            None => Ok(()),
        }
    }

    /// Every run has a value of this parameter of its own.
    fn parameter(&self, path: &str, name: &str) -> Result<(), Fault> {
        match self.uses.iter().find(|u| u.value(name).is_none()) {
            Some(_) => {
                let message = format!("{} is neither set nor varied in all runs", quoted(name));
                Err(self.fault(path, message, format!("add `vary = {{ {name} = [...] }}` to the runs")))
            }
            None => Ok(()),
        }
    }

    fn frame(&self, path: &str, panel: &Panel) -> Result<(), Fault> {
        let Some(point) = &panel.relative_to else {
            return match panel.along_course {
                true => Err(self.fault(
                    &format!("{path}.along_course"),
                    "there is no point whose course it could be",
                    "add `relative_to = \"hose.start\"`, say",
                )),
                false => Ok(()),
            };
        };
        let at = format!("{path}.relative_to");
        for name in columns(point) {
            self.column(&at, &name)?;
        }
        for (i, name) in panel.y.iter().enumerate() {
            match component(name) {
                Some((of, _)) => {
                    columns(of).iter().try_for_each(|c| self.column(&format!("{path}.y[{i}]"), c))?
                }
                None => {
                    let message = format!("{} is no coordinate of a point", quoted(name));
                    let help = "only positions are seen from a point: leave `relative_to` away";
                    return Err(self.fault(&format!("{path}.y[{i}]"), message, help));
                }
            }
        }
        Ok(())
    }

    fn shapes(&self, path: &str, panel: &Panel) -> Result<(), Fault> {
        if panel.shapes.is_none() {
            return Ok(());
        }
        if let Some(count) = panel.count.filter(|n| !(1..=MOST_CURVES).contains(n)) {
            let message = format!("{count} shapes in a panel");
            return Err(self.fault(&format!("{path}.count"), message, format!("choose 1 to {MOST_CURVES}")));
        }
        for (_, case) in self.cases() {
            let scene = case.file.scene();
            if scene.run.snapshots == 0 {
                let message = format!("the scene {} keeps no shapes", quoted(case.file.name()));
                return Err(self.fault(&format!("{path}.shapes"), message, "set `snapshots` in its [run]"));
            }
            let parts =
                || scene.elements.iter().map(|e| e.name()).chain(scene.processes.iter().map(|p| p.name()));
            if let Some(part) = panel.parts.iter().find(|p| !parts().any(|name| name == p.as_str())) {
                let message = format!("the scene {} has no part {}", quoted(case.file.name()), quoted(part));
                let help = format!("choose from {}", parts().collect::<Vec<_>>().join(", "));
                return Err(self.fault(&format!("{path}.parts"), message, help));
            }
        }
        Ok(())
    }

    fn sheet(&self, sheet: &Sheet) -> Result<(), Fault> {
        let kinds = [!sheet.columns.is_empty(), !sheet.parameters.is_empty(), sheet.computed.is_some()];
        if kinds.iter().filter(|k| **k).count() != 1 {
            let help = "give one of `columns` (results), `parameters` and `computed`";
            return Err(self.fault(&self.path, "a table shows either results or parameters", help));
        }
        if sheet.computed.is_some() {
            return Ok(());
        }
        if self.uses.is_empty() {
            return Err(self.fault(
                &self.path,
                "the table has no runs",
                "add `runs = [{ scene = \"...\" }]`",
            ));
        }
        for (i, name) in sheet.parameters.iter().enumerate() {
            for (_, case) in self.cases() {
                let parameters = case.file.document().parameters();
                if parameters.iter().all(|p| p.name != *name) {
                    let names: Vec<&str> = parameters.iter().map(|p| p.name.as_str()).collect();
                    let scene = quoted(case.file.name());
                    let message = format!("the scene {scene} has no parameter {}", quoted(name));
                    let help = did_you_mean(name, &names)
                        .unwrap_or_else(|| format!("choose one of {}", names.join(", ")));
                    return Err(self.fault(&format!("{}.parameters[{i}]", self.path), message, help));
                }
            }
        }
        if let Some(name) = &sheet.across {
            self.parameter(&format!("{}.across", self.path), name)?;
        }
        if let Some(every) = sheet.every.filter(|t| !(*t > 0.0)) {
            let path = format!("{}.every", self.path);
            return Err(self.fault(
                &path,
                format!("`every` must be positive, but is {every}"),
                "give a time",
            ));
        }
        sheet.columns.iter().enumerate().try_for_each(|(i, cell)| self.cell(i, cell, sheet.every.is_some()))
    }

    fn cell(&self, i: usize, cell: &Cell, over_time: bool) -> Result<(), Fault> {
        let path = format!("{}.columns[{i}]", self.path);
        match (&cell.record, cell.quantity) {
            (Some(record), None) => self.column(&format!("{path}.record"), record)?,
            (None, Some(_)) if !over_time => {}
            (None, Some(_)) => {
                let help = "leave `every` away, or make it a record";
                return Err(self.fault(&path, "a number of a run has no course in time", help));
            }
            _ => {
                let help = "write `record = \"hose.end.z\"` or `quantity = \"cpu\"`";
                return Err(self.fault(&path, "a column is either a record or a quantity", help));
            }
        }
        match cell.share.filter(|s| !(*s > 0.0 && *s <= 1.0)) {
            Some(share) => Err(self.share(&format!("{path}.share"), share)),
            None => Ok(()),
        }
    }
}
