//! Two runs on one page: histories over each other, both motions in one space, summaries side by side.

use super::page;
use super::view::Held;
use crate::error::Error;
use ropewalk_report::{
    BodyRecord, Column, Entry, Event, FieldRecord, ForceRecord, LineRecord, LineSnapshot, Page, Panel, Pose,
    Section, Table,
};
use std::path::Path;

/// The page of two runs. Records of the same name are drawn together, and those of one run alone; what moves is told apart
/// by the names of the folders.
///
/// # Errors
/// A folder doesn't exist or holds no run; a file in it that can't be read; histories over time and over a load factor.
pub fn compare(folders: [&Path; 2]) -> Result<Page, Error> {
    let [a, b] = [Held::open(folders[0])?, Held::open(folders[1])?];
    let mut labels = [a.name.clone(), b.name.clone()];
    if labels[0] == labels[1] {
        labels = [folders[0].display().to_string(), folders[1].display().to_string()];
    }
    let axes = [&a, &b].map(|run| run.history.columns.first().map(Column::heading));
    if let [Some(x), Some(y)] = &axes
        && x != y
    {
        let message = format!(
            "the history of {} goes over {x}, that of {} over {y}: they can't be laid over each other",
            labels[0], labels[1]
        );
        return Err(ropewalk_scene::Fault::new(message).into());
    }
    let panels = panels(&a, &b, &labels);
    let mut page = Page { panels, title: format!("{} and {}", labels[0], labels[1]), ..Page::default() };
    page.subtitle = format!("two runs · Ropewalk {}", env!("CARGO_PKG_VERSION"));
    let [first, second] = [a, b].map(|run| {
        let (history, field, missing) = (run.history, run.field, run.missing);
        let mut one = match &run.file {
            Some(file) => page::page(file, &run.summary, history, &run.figures, field, None),
            None => Page { status: run.summary.status.to_string(), history, field, ..Page::default() },
        };
        page::without(&mut one, &missing);
        one
    });
    page.status = match first.status == second.status {
        true => first.status.clone(),
        false => format!("{} · {}", first.status, second.status),
    };
    page.history = over_each_other([&first.history, &second.history], &labels);
    page.field = together([&first.field, &second.field], &labels);
    let titles = [("scene", [&first.title, &second.title].map(Clone::clone))];
    let entries = titles.map(|(name, [x, y])| Entry::new(name, beside(&x, &y)));
    page.summary = entries.into_iter().chain(entries_beside(&first.summary, &second.summary)).collect();
    page.sections = sections_beside(&first.sections, &second.sections);
    page.settings = entries_beside(&first.settings, &second.settings);
    page.energy = entries_beside(&first.energy, &second.energy);
    for (label, one) in labels.iter().zip([first, second]) {
        let of = |text: &String| format!("{label}: {text}");
        page.warnings.extend(one.warnings.iter().map(of));
        page.notes.extend(one.notes.iter().map(of));
        page.events.extend(one.events.iter().map(|e| Event { t: e.t, text: of(&e.text) }));
        page.scene += &format!("# {label}\n\n{}\n", one.scene);
    }
    page.events.sort_by(|x, y| x.t.total_cmp(&y.t));
    Ok(page)
}

/// The name of a column of one of the runs.
fn named(column: &str, label: &str) -> String {
    format!("{column} · {label}")
}

/// A panel for each record, with the columns of both runs; one for each column, so that two curves lie over each other.
fn panels(a: &Held, b: &Held, labels: &[String; 2]) -> Vec<Panel> {
    let mut all: Vec<Panel> = Vec::new();
    for (run, label) in [(a, &labels[0]), (b, &labels[1])] {
        for column in run.history.columns.iter().skip(1) {
            let name = named(&column.name, label);
            match all.iter_mut().find(|panel| panel.title == column.name) {
                Some(panel) => panel.columns.push(name),
                None => all.push(Panel { title: column.name.clone(), columns: vec![name] }),
            }
        }
    }
    all
}

/// Two texts side by side, or the one that both have.
fn beside(x: &str, y: &str) -> String {
    if x == y { x.to_string() } else { format!("{x}  |  {y}") }
}

fn entries_beside(a: &[Entry], b: &[Entry]) -> Vec<Entry> {
    let value = |all: &[Entry], name: &str| all.iter().find(|e| e.name == name).map(|e| e.value.clone());
    let mut names: Vec<&str> = a.iter().map(|e| e.name.as_str()).collect();
    names.extend(b.iter().map(|e| e.name.as_str()).filter(|name| value(a, name).is_none()));
    let of = |all: &[Entry], name: &str| value(all, name).unwrap_or_else(|| "–".into());
    names.into_iter().map(|name| Entry::new(name, beside(&of(a, name), &of(b, name)))).collect()
}

fn sections_beside(a: &[Section], b: &[Section]) -> Vec<Section> {
    let entries = |all: &[Section], title: &str| {
        all.iter().find(|s| s.title == title).map_or_else(Vec::new, |s| s.entries.clone())
    };
    let mut titles: Vec<&String> = a.iter().chain(b).map(|s| &s.title).collect();
    titles.sort();
    titles.dedup();
    let both = |title: &String| Section {
        title: title.clone(),
        entries: entries_beside(&entries(a, title), &entries(b, title)),
    };
    titles.into_iter().map(both).collect()
}

/// Instants of both, in order.
fn instants(a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut all: Vec<f64> = a.iter().chain(b).copied().filter(|t| t.is_finite()).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

/// Where `t` lies among instants: the one at or before it and how far it is to the next; `None` outside.
fn between(times: &[f64], t: f64) -> Option<(usize, f64)> {
    let next = times.partition_point(|x| *x <= t);
    let k = next.checked_sub(1)?;
    match times.get(next) {
        Some(after) => Some((k, (t - times[k]) / (after - times[k]))),
        None => (times[k] == t).then_some((k, 0.0)),
    }
}

/// Both histories over the instants of both: a value between two rows is on the line between them, which is how it is
/// drawn anyway.
fn over_each_other(tables: [&Table; 2], labels: &[String; 2]) -> Table {
    let times = tables.map(|table| table.columns.first().map_or(&[][..], |c| &c.values));
    let all = instants(times[0], times[1]);
    let axis = tables.iter().find_map(|t| t.columns.first()).cloned().unwrap_or_default();
    let mut columns = vec![Column { values: all.clone(), ..axis }];
    for ((table, own), label) in tables.iter().zip(times).zip(labels) {
        for column in table.columns.iter().skip(1) {
            let value = |t: &f64| match between(own, *t) {
                Some((k, share)) if share > 0.0 => {
                    column.values[k] + share * (column.values[k + 1] - column.values[k])
                }
                Some((k, _)) => column.values[k],
                None => f64::NAN,
            };
            let values = all.iter().map(value).collect();
            columns.push(Column { name: named(&column.name, label), unit: column.unit.clone(), values });
        }
    }
    Table { columns }
}

/// Both motions over the instants of both. Shapes on the ground that both have appear once.
fn together(fields: [&FieldRecord; 2], labels: &[String; 2]) -> FieldRecord {
    let times = instants(&fields[0].times, &fields[1].times);
    let mut both = FieldRecord {
        water: fields[0].water.or(fields[1].water),
        bed: fields[0].bed.or(fields[1].bed),
        // one surface is drawn, so it must be that of both
        waves: fields[0].waves.clone().filter(|waves| fields[1].waves.as_ref() == Some(waves)),
        ..FieldRecord::default()
    };
    for (field, label) in fields.iter().zip(labels) {
        for line in &field.lines {
            let at = |t: &f64| line_at(line, &field.times, *t);
            both.lines.push(LineRecord {
                name: format!("{label}: {}", line.name),
                snapshots: times.iter().map(at).collect(),
                kind: line.kind.clone(),
                place: line.place.clone(),
                diameter: line.diameter,
                quantities: line.quantities.clone(),
            });
        }
        for body in &field.bodies {
            let at = |t: &f64| pose_at(&body.poses, &field.times, *t);
            let name = format!("{label}: {}", body.name);
            both.bodies.push(BodyRecord { name, poses: times.iter().map(at).collect(), ..body.clone() });
        }
        for force in &field.forces {
            // its kind stays, so that both are shown alike
            let name = force.name.replacen(": ", &format!(": {label}: "), 1);
            let points = times.iter().map(|t| vector_at(&force.points, &field.times, *t)).collect();
            let forces = times.iter().map(|t| vector_at(&force.forces, &field.times, *t)).collect();
            both.forces.push(ForceRecord { name, points, forces });
        }
        for shape in &field.shapes {
            if !both.shapes.contains(shape) {
                both.shapes.push(shape.clone());
            }
        }
    }
    both.times = times;
    both
}

fn mix(x: f64, y: f64, share: f64) -> f64 {
    x + share * (y - x)
}

/// A line between two snapshots of as many points; else as it was before.
fn line_at(line: &LineRecord, times: &[f64], t: f64) -> LineSnapshot {
    let Some((k, share)) = between(times, t) else {
        return LineSnapshot { values: vec![Vec::new(); line.quantities.len()], ..LineSnapshot::default() };
    };
    let now = &line.snapshots[k];
    let Some(next) = line.snapshots.get(k + 1).filter(|n| share > 0.0 && n.s.len() == now.s.len()) else {
        return now.clone();
    };
    let numbers = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| mix(*x, *y, share)).collect();
    let places = |a: &[[f64; 3]], b: &[[f64; 3]]| {
        a.iter().zip(b).map(|(x, y)| std::array::from_fn(|i| mix(x[i], y[i], share))).collect()
    };
    LineSnapshot {
        s: numbers(&now.s, &next.s),
        position: places(&now.position, &next.position),
        velocity: places(&now.velocity, &next.velocity),
        values: now.values.iter().zip(&next.values).map(|(a, b)| numbers(a, b)).collect(),
    }
}

/// A vector between two snapshots.
fn vector_at(all: &[[f64; 3]], times: &[f64], t: f64) -> [f64; 3] {
    let Some((k, share)) = between(times, t) else { return [f64::NAN; 3] };
    let next = all.get(k + 1).filter(|_| share > 0.0).unwrap_or(&all[k]);
    std::array::from_fn(|i| mix(all[k][i], next[i], share))
}

/// A pose between two snapshots.
fn pose_at(poses: &[Pose], times: &[f64], t: f64) -> Pose {
    let Some((k, share)) = between(times, t) else {
        return Pose { position: [f64::NAN; 3], ..Pose::default() };
    };
    let now = poses[k];
    let Some(next) = poses.get(k + 1).filter(|_| share > 0.0) else { return now };
    // q and -q are the same turn
    let near: f64 = (0..4).map(|i| now.orientation[i] * next.orientation[i]).sum();
    let turn: [f64; 4] =
        std::array::from_fn(|i| mix(now.orientation[i], near.signum() * next.orientation[i], share));
    let size = turn.iter().map(|x| x * x).sum::<f64>().sqrt();
    Pose {
        position: std::array::from_fn(|i| mix(now.position[i], next.position[i], share)),
        orientation: turn.map(|x| x / size),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn histories_of_different_instants_lie_over_each_other() {
        let table = |times: &[f64], values: &[f64]| Table {
            columns: vec![
                Column { values: times.to_vec(), ..Column::new("t", "s") },
                Column { values: values.to_vec(), ..Column::new("end.x", "m") },
            ],
        };
        let labels = ["a", "b"].map(String::from);
        let (x, y) = (table(&[0.0, 1.0, 2.0], &[0.0, 10.0, 20.0]), table(&[0.0, 0.5], &[3.0, 4.0]));
        let both = over_each_other([&x, &y], &labels);
        assert_eq!(both.columns[0].values, [0.0, 0.5, 1.0, 2.0]);
        assert_eq!(both.column("end.x · a").unwrap().values, [0.0, 5.0, 10.0, 20.0]);
        let second = &both.column("end.x · b").unwrap().values;
        assert_eq!(second[..2], [3.0, 4.0]);
        assert!(second[2..].iter().all(|x| x.is_nan()), "a run that ended has no values any more");
    }

    #[test]
    fn turns_are_mixed_the_short_way() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let pose = |orientation| Pose { orientation, ..Pose::default() };
        let poses = [pose([1.0, 0.0, 0.0, 0.0]), pose([-half, 0.0, 0.0, -half])];
        let middle = pose_at(&poses, &[0.0, 1.0], 0.5).orientation;
        let angle = 2.0 * middle[3].atan2(middle[0]);
        assert!((angle - std::f64::consts::FRAC_PI_4).abs() < 1e-12, "{middle:?}");
        assert!(pose_at(&poses, &[0.0, 1.0], 1.5).position[0].is_nan());
    }

    #[test]
    fn entries_that_differ_stand_side_by_side() {
        let [a, b] = [
            vec![Entry::new("x", "1"), Entry::new("y", "2")],
            vec![Entry::new("x", "1"), Entry::new("z", "3")],
        ];
        let told: Vec<String> =
            entries_beside(&a, &b).into_iter().map(|e| format!("{} {}", e.name, e.value)).collect();
        assert_eq!(told, ["x 1", "y 2  |  –", "z –  |  3"]);
    }
}
