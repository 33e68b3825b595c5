//! Formulas with parameters: `"-$load"`, `"2 * $length / 3"`.
//!
//! A formula of parameters alone becomes its value. One that also holds other names, such as those of records in a
//! controller, stays a formula, with the values of the parameters in their places.

use super::fault::quoted;
use super::value::{Kind, Value};
use ropewalk_quantity::{Dimension, Expression, Written};

/// A whole number beyond this isn't exact as a float.
const EXACT: f64 = 9_007_199_254_740_992.0;

/// The formula that a text is, if it is one that holds parameters; `known` says which names are parameters.
pub(super) fn of(text: &str, known: &dyn Fn(&str) -> bool) -> Option<Expression> {
    let dollar = text
        .match_indices('$')
        .any(|(k, _)| text[k + 1..].starts_with(|c: char| c.is_ascii_alphabetic() || c == '_'));
    let found = dollar.then(|| Expression::parse(text, known).ok()).flatten()?;
    found.names().iter().any(|n| n.starts_with('$')).then_some(found)
}

/// The names of its parameters.
pub(super) fn parameters(formula: &Expression) -> impl Iterator<Item = &str> {
    formula.names().iter().filter_map(|n| n.strip_prefix('$'))
}

/// What stands in place of a formula, where its parameters have these values, in the order of [`parameters`].
///
/// # Errors
/// A parameter that isn't a number, units that don't fit, no finite number; a sentence.
pub(super) fn value(text: &str, formula: &Expression, values: &[Value]) -> Result<Kind, String> {
    let mut numbers = Vec::with_capacity(values.len());
    for (name, value) in parameters(formula).zip(values) {
        let number = match &value.kind {
            Kind::Integer(x) => Some((*x as f64, Dimension::default())),
            Kind::Float(x) => Some((*x, Dimension::default())),
            Kind::String(text) => Written::parse(text).map(|w| (w.si, w.dimension)),
            _ => None,
        };
        let what = || {
            format!("the parameter {} is {}, and no number to calculate with", quoted(name), value.describe())
        };
        numbers.push(number.ok_or_else(what)?);
    }
    if numbers.len() < formula.names().len() {
        return Ok(Kind::String(filled(text, formula, &numbers)));
    }
    let (values, dimensions): (Vec<f64>, Vec<Dimension>) = numbers.into_iter().unzip();
    let dimension =
        formula.dimension(&dimensions).map_err(|e| format!("in {}: {}", quoted(text), e.message))?;
    let x = formula.value(&values);
    if !x.is_finite() {
        return Err(format!("{} is {x}, which is no finite number", quoted(text)));
    }
    Ok(match dimension.unit() {
        unit if !unit.is_empty() => Kind::String(format!("{x:?} {unit}")),
        _ if x.fract() == 0.0 && x.abs() <= EXACT => Kind::Integer(x as i64),
        _ => Kind::Float(x),
    })
}

/// The text with the values of its parameters in brackets.
fn filled(text: &str, formula: &Expression, numbers: &[(f64, Dimension)]) -> String {
    let mut places: Vec<(&str, String)> = parameters(formula)
        .zip(numbers)
        .map(|(name, (x, of))| (name, format!("({})", format!("{x:?} {}", of.unit()).trim_end())))
        .collect();
    // the longest name first: another may begin as it does
    places.sort_by_key(|(name, _)| std::cmp::Reverse(name.len()));
    let (mut out, mut rest) = (String::new(), text);
    while let Some((before, behind)) = rest.split_once('$') {
        out += before;
        let fits = places.iter().find(|(name, _)| behind.starts_with(name));
        rest = match fits {
            Some((name, value)) => {
                out += value;
                &behind[name.len()..]
            }
            None => {
                out.push('$');
                behind
            }
        };
    }
    out + rest
}
