//! A table as CSV and as HTML.

use super::curves::reported;
use super::data::Run;
use super::known;
use super::number::printed;
use super::plan::{CASE, Plan, Use, inline, printed as printed_value};
use super::spec::{Cell, Sheet};
use ropewalk_report::{Csv, number};
use ropewalk_scene::Value;

/// A cell.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Item {
    Text(String),
    /// A number, and whether it is one of many that its record still takes in the end.
    Number(f64, bool),
}

/// A table ready to be written.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Printed {
    pub headings: Vec<String>,
    pub rows: Vec<Vec<Item>>,
}

/// Makes the table of these runs.
pub(super) fn table(sheet: &Sheet, plan: &Plan, entry: usize, runs: &[Run<'_>]) -> Printed {
    if let Some(known) = sheet.computed {
        known::table(known)
    } else if !sheet.parameters.is_empty() {
        parameters(sheet, plan, &plan.uses[entry])
    } else if let Some(every) = sheet.every {
        over_time(sheet, every, runs)
    } else {
        results(sheet, runs)
    }
}

/// A row for each parameter, a column for each run; nothing has to be computed for it.
fn parameters(sheet: &Sheet, plan: &Plan, uses: &[Use]) -> Printed {
    let of = |used: &Use, name: &str| {
        let all = plan.cases[used.case].file.document().parameters();
        all.iter().find(|p| p.name == name).cloned()
    };
    let column = |used: &Use| if used.label.is_empty() { "value".into() } else { used.label.clone() };
    let fixed = ["parameter".to_string(), "what it is".to_string()];
    let headings = fixed.into_iter().chain(uses.iter().map(column)).collect();
    let row = |name: &String| {
        let about =
            uses.first().and_then(|used| of(used, name)).and_then(|p| p.description).unwrap_or_default();
        let about = [Item::Text(name.clone()), Item::Text(printed(&about))];
        let value = |used: &Use| {
            let text = of(used, name).map_or_else(String::new, |p| value_text(&p.value));
            Item::Text(printed(&printed_value(&text)))
        };
        about.into_iter().chain(uses.iter().map(value)).collect()
    };
    Printed { headings, rows: sheet.parameters.iter().map(row).collect() }
}

/// A scene's value as it is written.
fn value_text(value: &Value) -> String {
    use ropewalk_scene::Kind;
    match &value.kind {
        Kind::Null => String::new(),
        Kind::Bool(b) => b.to_string(),
        Kind::Integer(n) => n.to_string(),
        Kind::Float(x) => number(*x),
        Kind::String(text) => text.clone(),
        Kind::Array(list) => format!("[{}]", list.iter().map(value_text).collect::<Vec<_>>().join(", ")),
        Kind::Table(table) => {
            let pair =
                |(key, value): &(ropewalk_scene::Key, Value)| format!("{} = {}", key.name, value_text(value));
            table.iter().map(pair).collect::<Vec<_>>().join(", ")
        }
    }
}

/// A row for each time, a column for each record of each run.
fn over_time(sheet: &Sheet, every: f64, runs: &[Run<'_>]) -> Printed {
    let several = runs.len() > 1;
    let mut headings =
        vec![runs.first().and_then(|r| r.history.columns.first()).map_or_else(String::new, |c| c.heading())];
    let mut columns: Vec<(&[f64], &[f64])> = Vec::new();
    for run in runs {
        for cell in &sheet.columns {
            let name = cell.record.as_deref().unwrap_or_default();
            let Some(column) = run.history.column(name) else { continue };
            let own = printed(&cell.heading.clone().unwrap_or_else(|| column.heading()));
            headings.push(if several { format!("{own}, {}", run.used.label) } else { own });
            columns.push((&run.history.columns[0].values, &column.values));
        }
    }
    let end = columns.iter().filter_map(|(t, _)| t.last()).fold(0.0_f64, |a, b| a.max(*b));
    let row = |k: usize| {
        // 0.6000000000000001 is 0.6
        let at = every * k as f64;
        let at = format!("{at:.12e}").parse().unwrap_or(at);
        let value = |(t, y): &(&[f64], &[f64])| {
            // the row of that time, or none after the end of the run
            let i = t.partition_point(|x| *x < at - 1e-9 * end);
            let found = t.get(i).filter(|x| (**x - at).abs() <= 0.5 * every);
            Item::Number(found.and_then(|_| y.get(i)).copied().unwrap_or(f64::NAN), false)
        };
        std::iter::once(Item::Number(at, false)).chain(columns.iter().map(value)).collect()
    };
    Printed { headings, rows: (0..=(end / every + 1e-9) as usize).map(row).collect() }
}

/// A row for each run, or for each but for the values of the parameter that goes across.
fn results(sheet: &Sheet, runs: &[Run<'_>]) -> Printed {
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in runs.iter().flat_map(|run| &run.used.shown) {
        if !names.contains(&name.as_str()) && Some(name) != sheet.across.as_ref() {
            names.push(name);
        }
    }
    let several = sheet.across.as_deref() != Some(CASE) && runs.iter().any(|run| run.used.own.is_some());
    let key = |run: &Run<'_>| -> Vec<String> {
        let own = several.then(|| run.used.own.clone().unwrap_or_default());
        let value = |name: &&str| run.used.value(name).map_or_else(String::new, printed_value);
        own.into_iter().chain(names.iter().map(value)).collect()
    };
    let mut keys: Vec<Vec<String>> = Vec::new();
    let mut across: Vec<String> = Vec::new();
    for run in runs {
        let value =
            sheet.across.as_ref().and_then(|name| run.used.value(name)).unwrap_or_default().to_string();
        if !keys.contains(&key(run)) {
            keys.push(key(run));
        }
        if !across.contains(&value) {
            across.push(value);
        }
    }
    let cell = |cell: &Cell, row: &[String], value: &str| {
        let of_row = runs.iter().filter(|run| key(run) == row);
        let mut there =
            of_row.filter(|run| sheet.across.as_ref().is_none_or(|name| run.used.value(name) == Some(value)));
        there.next().map_or(Item::Text(String::new()), |run| item(cell, run))
    };
    let mut headings: Vec<String> = several.then(|| CASE.to_string()).into_iter().collect();
    headings.extend(names.iter().map(|name| name.to_string()));
    let called = |cell: &Cell| {
        let record =
            cell.record.as_ref().and_then(|name| runs.first()?.history.column(name)).map(|c| c.heading());
        let quantity = cell.quantity.map(|q| q.heading().to_string());
        printed(&cell.heading.clone().or(record).or(quantity).unwrap_or_default())
    };
    for c in &sheet.columns {
        for value in &across {
            headings.push(match &sheet.across {
                Some(name) if name == CASE => format!("{}, {value}", called(c)),
                Some(name) => format!("{}, {name} {}", called(c), printed_value(value)),
                None => called(c),
            });
        }
        if sheet.ratio {
            headings.extend(
                across
                    .iter()
                    .skip(1)
                    .map(|v| format!("{} / {}", printed_value(&across[0]), printed_value(v))),
            );
        }
    }
    let row = |row: &Vec<String>| {
        let mut items: Vec<Item> = row.iter().map(|text| Item::Text(text.clone())).collect();
        for c in &sheet.columns {
            let values: Vec<Item> = across.iter().map(|value| cell(c, row, value)).collect();
            let size = |item: &Item| if let Item::Number(x, _) = item { *x } else { f64::NAN };
            let ratios: Vec<Item> =
                values.iter().skip(1).map(|v| Item::Number(size(&values[0]) / size(v), false)).collect();
            items.extend(values);
            items.extend(ratios.into_iter().filter(|_| sheet.ratio));
        }
        items
    };
    Printed { headings, rows: keys.iter().map(row).collect() }
}

fn item(cell: &Cell, run: &Run<'_>) -> Item {
    let record = cell.record.as_deref();
    match (record.and_then(|r| reported(&run.history, r, cell.value, cell.share)), cell.quantity) {
        (Some((value, unsteady)), _) => Item::Number(value, unsteady),
        (None, Some(quantity)) => Item::Number(quantity.of(run), false),
        (None, None) => Item::Number(f64::NAN, false),
    }
}

impl Printed {
    /// Whether a value is one of many.
    pub(super) fn is_unsteady(&self) -> bool {
        self.rows.iter().flatten().any(|item| matches!(item, Item::Number(_, true)))
    }

    /// Numbers with all their digits; the last column names what is unsteady, if anything is.
    pub(super) fn csv(&self) -> String {
        let marked = self.is_unsteady();
        let mut csv = Csv::new(self.headings.iter().map(String::as_str).chain(marked.then_some("unsteady")));
        for row in &self.rows {
            for item in row {
                match item {
                    Item::Text(t) => csv.cell(t),
                    Item::Number(x, _) => csv.number_or_none((!x.is_nan()).then_some(*x)),
                };
            }
            if marked {
                let unsteady =
                    self.headings.iter().zip(row).filter(|(_, i)| matches!(i, Item::Number(_, true)));
                csv.cell(unsteady.map(|(heading, _)| heading.as_str()).collect::<Vec<_>>().join("; "));
            }
            csv.end();
        }
        csv.text()
    }

    /// The table alone, to be put on a page.
    pub(super) fn html(&self) -> String {
        // what is wider than the screen is moved by keys
        let mut text = String::from("<div class=\"table\" tabindex=\"0\"><table>\n<thead><tr>");
        self.headings.iter().for_each(|h| text += &format!("<th scope=\"col\">{}</th>", escaped(h)));
        text += "</tr></thead>\n<tbody>\n";
        for row in &self.rows {
            text += "<tr>";
            for item in row {
                text += &match item {
                    Item::Text(t) => format!("<td>{}</td>", escaped(t)),
                    Item::Number(x, _) if x.is_nan() => "<td class=\"number\">–</td>".to_string(),
                    Item::Number(x, unsteady) => {
                        let mark = if *unsteady { " *" } else { "" };
                        format!("<td class=\"number\">{}{mark}</td>", readable(*x))
                    }
                };
            }
            text += "</tr>\n";
        }
        text += "</tbody></table></div>\n";
        if self.is_unsteady() {
            text += "<p class=\"note\">* not steady: the record still ranges by more than 1 % of its size in the end</p>\n";
        }
        text
    }
}

/// A number as in print: four digits, a true minus sign, powers of ten raised.
fn readable(x: f64) -> String {
    let rounded = if x == 0.0 || !x.is_finite() { x } else { format!("{x:.3e}").parse().unwrap_or(x) };
    let text = number(rounded);
    let text = text.replace('-', "−");
    match text.split_once('e') {
        Some((digits, power)) => format!("{digits}·10<sup>{power}</sup>"),
        None => text,
    }
}

/// A text that HTML takes for nothing else.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Names with values as one reads them: `speed = 5 kn, start = 40 s`.
pub(super) fn pairs(values: &super::spec::Values) -> String {
    values.iter().map(|(n, v)| format!("{n} = {}", printed_value(&inline(v)))).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_printed_as_in_a_book() {
        assert_eq!(readable(-29.98765), "−29.99");
        assert_eq!(readable(1.5e-9), "1.5·10<sup>−9</sup>");
        assert_eq!((readable(0.0), readable(2.0)), ("0".into(), "2".into()));
    }

    #[test]
    fn what_is_unsteady_is_marked_in_both_forms() {
        let table = Printed {
            headings: vec!["case".into(), "z [m]".into()],
            rows: vec![
                vec![Item::Text("a, <b>".into()), Item::Number(1.25, true)],
                vec![Item::Text("c".into()), Item::Number(f64::NAN, false)],
            ],
        };
        assert_eq!(table.csv(), "case,z [m],unsteady\n\"a, <b>\",1.25,z [m]\nc,,\n");
        let html = table.html();
        assert!(html.contains("1.25 *") && html.contains("a, &lt;b&gt;") && html.contains("not steady"));
    }
}
