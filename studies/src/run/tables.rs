//! Some columns of the history as tables of their own.

use super::recorder::Recorder;
use ropewalk_core::Remeshed;
use ropewalk_report::{Column, RunFolder, Table};
use ropewalk_scene::{Scene, TableSpec};

/// What is wrong with the tables that the scene asks for, if anything.
pub(crate) fn check(scene: &Scene, history: &Table) -> Result<(), String> {
    for spec in &scene.run.tables {
        if let Some(name) = spec.columns.iter().find(|name| history.column(name).is_none()) {
            let names: Vec<String> = history.columns.iter().map(|c| format!("`{}`", c.name)).collect();
            return Err(format!(
                "table `{}` asks for the column `{name}`, but the history has {}",
                spec.name,
                names.join(", ")
            ));
        }
        let interval = scene.run.interval();
        let rows = spec.every / interval;
        if spec.every > 0.0 && (rows < 0.5 || (rows - rows.round()).abs() > 1e-6 * rows) {
            return Err(format!(
                "table `{}` has a row every {} s, which is no multiple of `output`, {interval} s",
                spec.name, spec.every
            ));
        }
    }
    Ok(())
}

/// Writes them, and says what was written. One that can't be written is no reason to fail.
pub(crate) fn write(folder: &RunFolder, recorder: &Recorder<'_>, warn: &mut dyn FnMut(&str)) -> Vec<String> {
    let mut written = Vec::new();
    for spec in &recorder.scene.run.tables {
        let table = table(spec, &recorder.table, recorder.scene.run.interval());
        match folder.table_file(&spec.name).and_then(|path| table.write(&path)) {
            Ok(()) => written.push(spec.name.clone()),
            Err(e) => warn(&e.to_string()),
        }
    }
    if !recorder.remeshed.is_empty() {
        match folder.table_file(REMESHING).and_then(|path| remeshing(&recorder.remeshed).write(&path)) {
            Ok(()) => written.push(REMESHING.to_string()),
            Err(e) => warn(&e.to_string()),
        }
    }
    written
}

/// The table of what changes of the mesh have done.
const REMESHING: &str = "remeshing";

fn remeshing(all: &[Remeshed]) -> Table {
    let columns = [
        ("t", "s"),
        ("kinetic", "J"),
        ("potential", "J"),
        ("momentum", "kg m/s"),
        ("tension before", "N"),
        ("tension after", "N"),
    ];
    let values = |r: &Remeshed| [r.t, r.kinetic, r.potential, r.impulse(), r.tension[0], r.tension[1]];
    let column = |(k, (name, unit)): (usize, (&str, &str))| Column {
        values: all.iter().map(|r| values(r)[k]).collect(),
        ..Column::new(name, unit)
    };
    Table { columns: columns.into_iter().enumerate().map(column).collect() }
}

fn table(spec: &TableSpec, history: &Table, interval: f64) -> Table {
    let stride = if spec.every > 0.0 { (spec.every / interval).round() as usize } else { 1 };
    let thin = |column: &Column| Column {
        values: column.values.iter().copied().step_by(stride.max(1)).collect(),
        ..Column::new(&column.name, &column.unit)
    };
    let columns =
        history.columns.first().into_iter().chain(spec.columns.iter().filter_map(|n| history.column(n)));
    Table { columns: columns.map(thin).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_holds_its_columns_at_its_times() {
        let mut history = Table::new([Column::new("a", "m"), Column::new("b", "N")]);
        for k in 0..7 {
            history.push_row(&[0.1 * f64::from(k), 1.0, f64::from(k)]).unwrap();
        }
        let mut spec = TableSpec { name: "x".into(), columns: vec!["b".into()], every: 0.3 };
        assert_eq!(table(&spec, &history, 0.1).columns[1].values, [0.0, 3.0, 6.0]);
        spec.every = 0.0;
        assert_eq!(table(&spec, &history, 0.1).rows(), 7);
        let mut scene = Scene::new();
        scene.run.output = 0.1;
        let mut told = |every: f64, column: &str| {
            scene.run.tables = vec![TableSpec { name: "x".into(), columns: vec![column.into()], every }];
            check(&scene, &history)
        };
        assert_eq!(told(0.3, "a"), Ok(()));
        assert!(told(0.25, "a").unwrap_err().contains("no multiple"));
        assert!(told(0.0, "c").unwrap_err().contains("the history has `t`, `a`, `b`"));
    }
}
