//! A varied parameter in the table and along the axis of a plot.

use ropewalk_scene::quantity::Written;
use ropewalk_scene::{Value, Varied};

/// A varied parameter: its values as they are shown, and as numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Name and, if it is known, unit: `speed [kn]`.
    pub heading: String,
    /// The values as text, without unit.
    pub cells: Vec<String>,
    /// The values as numbers; of words, their places from 1.
    pub numbers: Vec<f64>,
    /// Whether the values are words.
    pub words: bool,
}

impl Axis {
    /// The values in the unit that they are written in, or in SI if they are written in several. A bare number is in
    /// SI too, and which unit that is can be told from the default value of the parameter.
    pub(crate) fn new(varied: &Varied, default: Option<&Value>) -> Self {
        let all: Option<Vec<Written<'_>>> = varied.values.iter().map(|v| Written::parse(v)).collect();
        let (numbers, unit) = match all.as_deref().map(|all| (all, in_one_unit(all, default))) {
            Some((_, Some(found))) => found,
            _ => return Self::of_words(varied),
        };
        let heading = match unit {
            Some(unit) => format!("{} [{}]", varied.name, if unit.is_empty() { "-" } else { &unit }),
            None => varied.name.clone(),
        };
        let cells = numbers.iter().map(|x| {
            let mut cell = String::new();
            ropewalk_report::push_number(&mut cell, *x);
            cell
        });
        Self { heading, cells: cells.collect(), numbers, words: false }
    }

    /// Values such as the names of models, and lists.
    pub(crate) fn of_words(varied: &Varied) -> Self {
        let cells = varied.values.iter().map(|v| unquoted(v).to_string()).collect();
        let numbers = (1..=varied.values.len()).map(|k| k as f64).collect();
        Self { heading: varied.name.clone(), cells, numbers, words: true }
    }

    /// What stands under the axis of a plot.
    pub(crate) fn label(&self) -> String {
        if !self.words {
            return self.heading.clone();
        }
        let words: Vec<String> = self.cells.iter().zip(1..).map(|(word, k)| format!("{k} {word}")).collect();
        format!("{}: {}", self.heading, words.join(", "))
    }
}

/// The numbers and their unit, if it is known; none if the quantities are of different kinds.
fn in_one_unit(all: &[Written<'_>], default: Option<&Value>) -> Option<(Vec<f64>, Option<String>)> {
    let first = all.first()?;
    if !first.unit.is_empty() && all.iter().all(|w| w.unit == first.unit) {
        return Some((all.iter().map(|w| w.number).collect(), Some(first.unit.to_string())));
    }
    let default = default.and_then(Value::as_str).and_then(Written::parse);
    let with_unit = all.iter().chain(&default).filter(|w| !w.unit.is_empty());
    let dimensions: Vec<_> = with_unit.clone().map(|w| w.dimension).collect();
    if dimensions.windows(2).any(|w| w[0] != w[1]) {
        return None;
    }
    let unit = with_unit.clone().next().map(|w| w.si_unit().unwrap_or("SI").to_string());
    Some((all.iter().map(|w| w.si).collect(), unit))
}

/// A text without its quotes.
pub(super) fn unquoted(text: &str) -> &str {
    let inner = |q: char| text.strip_prefix(q).and_then(|t| t.strip_suffix(q)).filter(|t| !t.contains(q));
    inner('"').or_else(|| inner('\'')).unwrap_or(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ropewalk_scene::{Document, Format};

    fn axis(text: &str, default: &str) -> Axis {
        let scene = format!("x = {default}\n");
        let document = Document::parse(&scene, "x", Format::Toml, &[]).unwrap();
        Axis::new(&Varied::parse(text).unwrap(), document.get("x"))
    }

    #[test]
    fn quantities_are_shown_in_one_unit() {
        for (text, default, heading, cells) in [
            ("v=5kn,15 kn", "\"25 kn\"", "v [kn]", &["5", "15"][..]),
            ("v=36 km/h,5 m/s", "\"25 kn\"", "v [m/s]", &["10", "5"]),
            ("t=40,80.5", "\"40 s\"", "t [s]", &["40", "80.5"]),
            ("t=40,2 min", "40", "t [s]", &["40", "120"]),
            ("n=10,20", "5", "n", &["10", "20"]),
            ("p=5 %,10 %", "0.1", "p [%]", &["5", "10"]),
        ] {
            let a = axis(text, default);
            assert_eq!((a.heading.as_str(), a.words), (heading, false), "{text}");
            assert_eq!(a.cells, cells);
        }
    }

    #[test]
    fn words_are_numbered_for_plots() {
        let a = axis("law=constant,\"choo-casarella\"", "\"constant\"");
        assert_eq!((a.heading.as_str(), a.words, a.numbers.as_slice()), ("law", true, &[1.0, 2.0][..]));
        assert_eq!(a.label(), "law: 1 constant, 2 choo-casarella");
        assert!(axis("a=[1, 2],[3, 4]", "[1, 2]").words);
    }
}
