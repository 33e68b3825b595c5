//! Leaves out snapshots, points and rows until a page fits its budget.

use super::{Page, block};
use crate::{FieldRecord, LineSnapshot, Solid, Table};

/// Fewer would not show the motion, the line or the history any more, whatever the budget.
const SNAPSHOTS: usize = 60;
const POINTS: usize = 40;
const ROWS: usize = 600;
const TRIANGLES: usize = 2000;

/// The data of a page in at most about `room` bytes, if that leaves enough to be seen.
pub(super) fn within(page: &Page, room: usize) -> Vec<u8> {
    // deflate makes about this much of numbers; only for the first cut, so that what is far too large isn't packed
    let rough = |page: &Page| page.scene.len() / 4 + 2 * numbers(page);
    let mut thin: Option<Page> = None;
    let mut size = rough(page).max(1);
    let mut data = Vec::new();
    for pass in 0..8 {
        if pass > 0 || size < 3 * room {
            let shown = thin.as_ref().unwrap_or(page);
            data = block::deflated(shown, &told(page, shown));
            size = data.len();
            if size <= room {
                break;
            }
        }
        let shown = thin.as_ref().unwrap_or(page);
        let Some(next) = thinner(page, shown, 0.97 * room as f64 / size as f64) else { break };
        thin = Some(next);
    }
    data
}

/// How many numbers the arrays hold.
fn numbers(page: &Page) -> usize {
    let line = |l: &crate::LineRecord| {
        l.snapshots.iter().map(|s| s.position.len()).sum::<usize>() * (3 + l.quantities.len())
    };
    let lines: usize = page.field.lines.iter().map(line).sum();
    let bodies: usize = page.field.bodies.iter().map(|b| 7 * b.poses.len()).sum();
    let forces: usize = page.field.forces.iter().map(|f| 6 * f.points.len()).sum();
    lines + bodies + forces + page.history.columns.len() * page.history.rows() + 6 * triangles(&page.field)
}

fn triangles(field: &FieldRecord) -> usize {
    let shapes = field.shapes.iter().chain(field.bodies.iter().flat_map(|b| &b.shapes));
    shapes.map(|s| if let Solid::Mesh(mesh) = &s.solid { mesh.triangles.len() } else { 0 }).sum()
}

/// The same with about `share` of what `shown` has of the page's numbers; `None` if there is nothing left to take.
fn thinner(page: &Page, shown: &Page, share: f64) -> Option<Page> {
    let fewer = |now: usize, least: usize| ((now as f64 * share) as usize).max(least).min(now);
    let snapshots = fewer(shown.field.times.len(), SNAPSHOTS);
    let rows = fewer(shown.history.rows(), ROWS);
    let meshes = fewer(triangles(&shown.field), TRIANGLES);
    // points go when snapshots can't
    let longest = |page: &Page| {
        let counts = page.field.lines.iter().flat_map(|l| &l.snapshots).map(|s| s.position.len());
        counts.max().unwrap_or(0)
    };
    let now = longest(shown);
    let points = if snapshots == shown.field.times.len() { fewer(now, POINTS) } else { now };
    let unchanged = snapshots == shown.field.times.len()
        && rows == shown.history.rows()
        && meshes == triangles(&shown.field)
        && points == now;
    (!unchanged).then(|| Page {
        history: history(&page.history, rows),
        field: field(&page.field, snapshots, points, meshes),
        ..page.clone_texts()
    })
}

impl Page {
    /// All but histories and field.
    fn clone_texts(&self) -> Page {
        Page {
            title: self.title.clone(),
            subtitle: self.subtitle.clone(),
            status: self.status.clone(),
            scene: self.scene.clone(),
            summary: self.summary.clone(),
            warnings: self.warnings.clone(),
            notes: self.notes.clone(),
            events: self.events.clone(),
            settings: self.settings.clone(),
            sections: self.sections.clone(),
            listings: self.listings.clone(),
            ranges: self.ranges.clone(),
            energy: self.energy.clone(),
            panels: self.panels.clone(),
            steps: self.steps.clone(),
            restarts: self.restarts.clone(),
            budget: self.budget,
            history: Table::default(),
            field: FieldRecord::default(),
        }
    }
}

/// `count` indices, evenly from the first to the last.
fn picks(all: usize, count: usize) -> Vec<usize> {
    if count >= all {
        return (0..all).collect();
    }
    (0..count).map(|k| (k * (all - 1) + (count - 1) / 2) / (count - 1).max(1)).collect()
}

fn field(record: &FieldRecord, snapshots: usize, points: usize, meshes: usize) -> FieldRecord {
    let kept = picks(record.times.len(), snapshots);
    let longest =
        record.lines.iter().flat_map(|l| &l.snapshots).map(|s| s.position.len()).max().unwrap_or(0).max(1);
    let along = |s: &LineSnapshot| {
        let share = s.position.len() * points / longest;
        let kept = picks(s.position.len(), share.max(2));
        LineSnapshot {
            s: kept.iter().map(|k| s.s[*k]).collect(),
            position: kept.iter().map(|k| s.position[*k]).collect(),
            velocity: Vec::new(),
            values: s.values.iter().map(|v| kept.iter().map(|k| v[*k]).collect()).collect(),
        }
    };
    let mut thin = FieldRecord {
        times: kept.iter().map(|k| record.times[*k]).collect(),
        shapes: record.shapes.clone(),
        water: record.water,
        waves: record.waves.clone(),
        bed: record.bed,
        ..FieldRecord::default()
    };
    for line in &record.lines {
        let snapshots = kept.iter().map(|k| along(&line.snapshots[*k])).collect();
        let (name, kind, place) = (line.name.clone(), line.kind.clone(), line.place.clone());
        let quantities = line.quantities.clone();
        thin.lines.push(crate::LineRecord {
            name,
            kind,
            place,
            diameter: line.diameter,
            quantities,
            snapshots,
        });
    }
    for body in &record.bodies {
        let poses = kept.iter().map(|k| body.poses[*k]).collect();
        let (name, kind, place) = (body.name.clone(), body.kind.clone(), body.place.clone());
        thin.bodies.push(crate::BodyRecord { name, kind, place, shapes: body.shapes.clone(), poses });
    }
    for force in &record.forces {
        let pick = |all: &[[f64; 3]]| kept.iter().map(|k| all[*k]).collect();
        let (points, forces) = (pick(&force.points), pick(&force.forces));
        thin.forces.push(crate::ForceRecord { name: force.name.clone(), points, forces });
    }
    let all = triangles(record);
    for shape in thin.shapes.iter_mut().chain(thin.bodies.iter_mut().flat_map(|b| &mut b.shapes)) {
        if let Solid::Mesh(mesh) = &mut shape.solid
            && meshes < all
        {
            *mesh = mesh.coarser((mesh.triangles.len() * meshes / all).max(100));
        }
    }
    thin
}

/// The least and the greatest value of each column in each of `rows / 2` intervals, so that no peak is lost;
/// first and last row stay as they are.
fn history(table: &Table, rows: usize) -> Table {
    let all = table.rows();
    if rows >= all {
        return table.clone();
    }
    let intervals = (rows.saturating_sub(2) / 2).max(1);
    let inner = all.saturating_sub(2);
    let bounds: Vec<usize> = (0..=intervals).map(|k| 1 + k * inner / intervals).collect();
    let mut thin = table.clone();
    for (number, column) in thin.columns.iter_mut().enumerate() {
        let values = &table.columns[number].values;
        let mut kept = vec![values[0]];
        for pair in bounds.windows(2) {
            let part = &values[pair[0]..pair[1]];
            if number == 0 {
                kept.extend([part[0], part[part.len() / 2]]);
                continue;
            }
            let extreme = |sign: f64| {
                let finite = part.iter().enumerate().filter(|(_, x)| x.is_finite());
                finite.fold(None, |best: Option<(usize, f64)>, (k, x)| match best {
                    Some((_, y)) if sign * y <= sign * x => best,
                    _ => Some((k, *x)),
                })
            };
            match (extreme(1.0), extreme(-1.0)) {
                (Some(low), Some(high)) if low.0 <= high.0 => kept.extend([low.1, high.1]),
                (Some(low), Some(high)) => kept.extend([high.1, low.1]),
                _ => kept.extend([f64::NAN; 2]),
            }
        }
        kept.push(values[all - 1]);
        column.values = kept;
    }
    thin
}

/// What was left out, in words.
fn told(page: &Page, shown: &Page) -> Vec<String> {
    let mut told = Vec::new();
    let points = |page: &Page| {
        page.field.lines.iter().flat_map(|l| &l.snapshots).map(|s| s.position.len()).max().unwrap_or(0)
    };
    let mut say = |all: usize, kept: usize, what: &str, how: &str| {
        if kept < all {
            told.push(format!("{kept} of {all} {what}{how}"));
        }
    };
    say(page.field.times.len(), shown.field.times.len(), "snapshots", ", evenly in time");
    say(points(page), points(shown), "points along the longest line", "");
    let how =
        ", with the least and greatest value of each interval: peaks are whole, their times to an interval";
    say(page.history.rows(), shown.history.rows(), "rows of the history", how);
    say(triangles(&page.field), triangles(&shown.field), "triangles of shapes", ", the rest merged");
    told
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Column, LineRecord, Quantity};

    /// A page that deflate can't make small: numbers without pattern.
    fn noisy(rows: usize, snapshots: usize, points: usize) -> Page {
        let mut seed = 1_u64;
        let mut noise = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut history = Table::new([Column::new("a", "m"), Column::new("b", "N")]);
        for k in 0..rows {
            let row = [k as f64, noise(), noise()];
            history.push_row(&row).unwrap();
        }
        let mut line = LineRecord::new("hose", "cable", 0.1);
        line.quantities.push(Quantity::new("tension", "N"));
        line.snapshots = (0..snapshots)
            .map(|_| LineSnapshot {
                s: (0..points).map(|k| k as f64).collect(),
                position: (0..points).map(|_| [noise(), noise(), noise()]).collect(),
                values: vec![(0..points).map(|_| noise()).collect()],
                ..LineSnapshot::default()
            })
            .collect();
        let times = (0..snapshots).map(|k| k as f64).collect();
        Page {
            history,
            field: FieldRecord { times, lines: vec![line], ..FieldRecord::default() },
            ..Page::default()
        }
    }

    #[test]
    fn a_page_that_fits_is_left_alone() {
        let page = noisy(100, 10, 10);
        assert_eq!(within(&page, 1_000_000), block::deflated(&page, &[]));
    }

    #[test]
    fn a_large_page_is_thinned_to_its_budget_and_says_so() {
        let page = noisy(20_000, 400, 100);
        for room in [400_000, 100_000] {
            let data = within(&page, room);
            assert!(data.len() <= room && data.len() > room / 2, "{} for {room}", data.len());
            let (text, arrays) = block::tests::open(&super::super::pack::base64(&data));
            let told = text["thinned"].to_string();
            assert!(told.contains("of 400 snapshots") && told.contains("of 20000 rows"), "{told}");
            let t = block::tests::array(&arrays, &text["field"]["times"]);
            assert_eq!((t[0], t[t.len() - 1]), (0.0, 399.0));
        }
        // with too little room the least remains that shows anything
        let data = within(&page, 10);
        let (text, arrays) = block::tests::open(&super::super::pack::base64(&data));
        assert_eq!(block::tests::array(&arrays, &text["field"]["times"]).len(), SNAPSHOTS);
        assert_eq!(text["field"]["lines"][0]["counts"], POINTS);
        assert_eq!(text["thinned"].as_array().unwrap().len(), 3);
    }

    #[test]
    fn a_thinned_history_keeps_every_peak() {
        let mut page = noisy(5000, 0, 0);
        page.history.columns[1].values[1234] = 99.0;
        page.history.columns[2].values[1234] = -99.0;
        let thin = history(&page.history, 600);
        assert!(thin.rows() <= 600 && thin.rows() > 590);
        assert!(thin.columns[1].values.contains(&99.0) && thin.columns[2].values.contains(&-99.0));
        assert!(thin.columns[0].values.windows(2).all(|w| w[0] < w[1]));
        assert_eq!(thin.columns[1].values.last(), page.history.columns[1].values.last());
    }

    #[test]
    fn picks_hold_both_ends() {
        assert_eq!(picks(5, 9), [0, 1, 2, 3, 4]);
        assert_eq!(picks(9, 3), [0, 4, 8]);
        assert_eq!(picks(0, 3), [0_usize; 0]);
        let many = picks(1000, 77);
        assert!(many.len() == 77 && many[76] == 999 && many.windows(2).all(|w| w[0] < w[1]));
    }
}
