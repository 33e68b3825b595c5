//! The values that a sweep gives to a parameter: `speed=5kn,15kn,25kn`, `start=40:120:40`.

use super::fault::{Fault, quoted};
use super::sample::is_range;
use super::source::{Sources, Span};
use ropewalk_quantity::Written;
use std::collections::HashSet;
use std::ops::Range;

/// A parameter and the values that it shall have, one after the other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Varied {
    /// Name of the parameter.
    pub name: String,
    /// The values as `--set` takes them, without the space around them.
    pub values: Vec<String>,
}

impl Varied {
    /// More values than this are surely a mistake.
    pub const MOST: usize = 100_000;

    /// Reads `name=value,value,…`, where a value may also be a range `from:to:step`; no value may occur twice.
    ///
    /// Commas inside brackets, braces and quotes belong to the value. The units of a range may all be left to its
    /// last number: `5:25:10 kn`.
    pub fn parse(text: &str) -> Result<Self, Fault> {
        let Some(at) = text.find('=') else {
            return Err(fault(text, "expected `name=value,value,...`", 0..text.len()));
        };
        let name = text[..at].trim().to_string();
        if name.is_empty() {
            return Err(fault(text, "there is no name before the `=`", 0..text.len()));
        }
        let mut varied = Self { name, values: Vec::new() };
        for part in parts(text, at + 1) {
            let value = text[part.clone()].trim();
            if value.is_empty() {
                let what = if text[at + 1..].trim().is_empty() { "no value" } else { "an empty value" };
                return Err(fault(text, format!("{what} for {}", quoted(&varied.name)), part)
                    .with_help(format!("separate values by commas, as in `{}=1,2,3`", varied.name)));
            }
            if is_range(value) {
                let message = format!("{} is a range to draw from, which takes `--samples`", quoted(value));
                let fault = fault(text, message, part);
                return Err(
                    fault.with_help("add `--samples 100`; all values at equal distances are `from:to:step`")
                );
            }
            match range(value)
                .map_err(|(message, help)| fault(text, message, part.clone()).with_help(help))?
            {
                Some(values) => varied.values.extend(values),
                None => varied.values.push(value.to_string()),
            }
            if varied.values.len() > Self::MOST {
                let message = format!("more than {} values for {}", Self::MOST, quoted(&varied.name));
                return Err(fault(text, message, part));
            }
        }
        match varied.twice() {
            Some(value) => {
                let message = format!("{} has the value {} twice", quoted(&varied.name), quoted(value));
                Err(fault(text, message, at + 1..text.len()))
            }
            None => Ok(varied),
        }
    }

    /// A value that stands there a second time, perhaps in another unit.
    fn twice(&self) -> Option<&str> {
        let mut seen = HashSet::new();
        // equal in all digits but those that a change of unit costs; adding 0 makes -0 the usual one
        let bare = self.values.iter().filter_map(|v| Written::parse(v)).any(|w| w.unit.is_empty());
        let plain = |value: &str| match Written::parse(value) {
            // beside a number without unit, which is in SI, units are as good as none
            Some(w) if bare => format!("{:.13e}", w.si + 0.0),
            Some(w) => format!("{:.13e} {:?}", w.si + 0.0, w.dimension),
            None => value.trim_matches('"').to_string(),
        };
        self.values.iter().map(String::as_str).find(|value| !seen.insert(plain(value)))
    }
}

/// A fault at a place in the text of the option.
pub(super) fn fault(text: &str, message: impl Into<String>, at: Range<usize>) -> Fault {
    let mut sources = Sources::default();
    let source = sources.add("--vary", text);
    Fault::at(message, Span::new(source, at), &sources)
}

/// What stands between the commas that are in no bracket and no quotes, from a byte on.
fn parts(text: &str, from: usize) -> Vec<Range<usize>> {
    let (mut parts, mut start, mut depth, mut quote) = (Vec::new(), from, 0_usize, None);
    for (i, c) in text.char_indices().skip_while(|(i, _)| *i < from) {
        match (quote, c) {
            (Some(q), c) if q == c => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(c),
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') => depth = depth.saturating_sub(1),
            (None, ',') if depth == 0 => {
                parts.push(start..i);
                start = i + 1;
            }
            _ => {}
        }
    }
    parts.push(start..text.len());
    parts
}

/// The values of `from:to:step`, both ends included where a step ends there; none if the text is no range. The error
/// is a message with its help.
fn range(text: &str) -> Result<Option<Vec<String>>, (String, String)> {
    let numbers: Option<Vec<Written<'_>>> = text.split(':').map(Written::parse).collect();
    let Some(numbers) = numbers.filter(|n| n.len() > 1) else { return Ok(None) };
    let fail = |what: &str| {
        Err((format!("{} {what}", quoted(text)), "a range is `from:to:step`, as in `5:25:10 kn`".to_string()))
    };
    let [from, to, step] = numbers.as_slice() else {
        return fail(if numbers.len() == 2 { "is a range without step" } else { "has too many colons" });
    };
    let unit = step.unit;
    if [from, to].iter().any(|x| x.unit != unit && !x.unit.is_empty()) || from.unit != to.unit {
        return fail("is a range of different units");
    }
    let steps = (to.number - from.number) / step.number;
    if !steps.is_finite() || steps < 0.0 {
        return fail("is a range whose steps never arrive");
    }
    // an end that is missed by rounding is the end
    let last = (steps + 1e-9).floor();
    if last >= Varied::MOST as f64 {
        return fail(&format!("has more than {} values", Varied::MOST));
    }
    let value = |k: usize| {
        let x = from.number + k as f64 * step.number;
        // 0.30000000000000004 is 0.3, and what is left of 0 is 0
        let x = if x.abs() < 1e-9 * step.number.abs() { 0.0 } else { x };
        let x = format!("{x:.11e}").parse().unwrap_or(x);
        if unit.is_empty() { format!("{x}") } else { format!("{x} {unit}") }
    };
    Ok(Some((0..=last as usize).map(value).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Vec<String> {
        Varied::parse(text).unwrap_or_else(|fault| panic!("{fault}")).values
    }

    #[test]
    fn values_stand_between_commas() {
        assert_eq!(values("speed=5kn, 15 kn ,25kn"), ["5kn", "15 kn", "25kn"]);
        assert_eq!(values("a = x"), ["x"]);
        assert_eq!(values("end=[\"-30 m\", 0, 0],[1,2,[3,4]]"), ["[\"-30 m\", 0, 0]", "[1,2,[3,4]]"]);
        assert_eq!(values("a=\"x,y\",'z,',{ b = 1, c = 2 }"), ["\"x,y\"", "'z,'", "{ b = 1, c = 2 }"]);
        assert_eq!(values("law=constant,choo-casarella,a:b"), ["constant", "choo-casarella", "a:b"]);
        assert_eq!(Varied::parse(" speed = 1").unwrap().name, "speed");
    }

    #[test]
    fn ranges_include_their_ends() {
        assert_eq!(values("a=0:10:2"), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(values("a=0:10:4"), ["0", "4", "8"]);
        assert_eq!(values("a=5:25:10 kn"), ["5 kn", "15 kn", "25 kn"]);
        assert_eq!(values("a=40s:120s:40s,300s"), ["40 s", "80 s", "120 s", "300s"]);
        assert_eq!(values("a=1:-1:-1"), ["1", "0", "-1"]);
        assert_eq!(values("a=-0.2:0.3:0.1"), ["-0.2", "-0.1", "0", "0.1", "0.2", "0.3"]);
        assert_eq!(values("a=1e-3:3e-3:1e-3"), ["0.001", "0.002", "0.003"]);
        assert_eq!(values("a=3:3:1"), ["3"]);
        assert_eq!(values("a=0:1:0.001").len(), 1001);
    }

    #[test]
    fn what_is_wrong_is_shown_in_its_place() {
        for (text, message, marked) in [
            ("speed", "expected `name=value,value,...`", "speed"),
            ("=1", "there is no name before the `=`", "=1"),
            ("a=", "no value for `a`", ""),
            ("a=1,,2", "an empty value for `a`", ","),
            ("a=1,", "an empty value for `a`", ""),
            ("a=1,2,1.0", "`a` has the value `1.0` twice", "1,2,1.0"),
            ("a=1 m,2 m,100 cm", "`a` has the value `100 cm` twice", "1 m,2 m,100 cm"),
            ("a=1,2 m,100 cm", "`a` has the value `100 cm` twice", "1,2 m,100 cm"),
            ("a=0,-0.0", "`a` has the value `-0.0` twice", "0,-0.0"),
            ("a=L4,\"L4\"", "`a` has the value `\"L4\"` twice", "L4,\"L4\""),
            ("a=0:4:1,4", "`a` has the value `4` twice", "0:4:1,4"),
            ("a=0:10", "`0:10` is a range without step", "0:10"),
            ("a=0:10:2:3", "`0:10:2:3` has too many colons", "0:10:2:3"),
            ("a=1,0:10:-1", "`0:10:-1` is a range whose steps never arrive", "0:10:-1"),
            ("a=0:10:0", "`0:10:0` is a range whose steps never arrive", "0:10:0"),
            ("a=0:0:0", "`0:0:0` is a range whose steps never arrive", "0:0:0"),
            ("a=0 m:10 s:1 m", "`0 m:10 s:1 m` is a range of different units", "0 m:10 s:1 m"),
            ("a=0:10 m:1", "is a range of different units", "0:10 m:1"),
            ("a=0:1:1e-7", "has more than 100000 values", "0:1:1e-7"),
        ] {
            let fault = Varied::parse(text).unwrap_err();
            assert!(fault.message.contains(message), "{fault}");
            let place = fault.place.as_ref().unwrap();
            assert_eq!(place.file, "--vary");
            let shown: String = place.excerpt.chars().skip(place.mark).take(place.width).collect();
            assert!(marked.is_empty() || shown == marked, "{fault}");
        }
    }
}
