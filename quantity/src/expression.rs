//! Arithmetic with quantities: `2 * $length / 3`, `-$load`, `max(0 N, {rope.tension} - 2 kN)`.
//!
//! Units are checked once, apart from the numbers: [`Expression::dimension`] says of what dimension the result is, and
//! [`Expression::value`] then computes in SI units.

use super::{Dimension, number_end, unit};
use std::f64::consts::PI;
use std::ops::Range;

/// What is longer, or deeper in brackets, is surely no formula that somebody wrote.
const LONGEST: usize = 2000;
const DEEPEST: usize = 50;

/// A formula.
///
/// `+ - * / ^` as usual (`-x^2` is `-(x^2)`, `a^b^c` is `a^(b^c)`), brackets, numbers with units, `pi`, and `sqrt`, `abs`,
/// `sign`, `exp`, `ln`, `sin`, `cos`, `tan`, `asin`, `acos`, `atan`, `tanh`, `floor`, `round`, `atan2(y, x)`, `min(a, b)`, `max(a, b)`,
/// `clamp(x, least, most)`. A name is `$word`, a word with dots, or anything in braces.
///
/// ```
/// use ropewalk_quantity::{Dimension, Expression};
/// let e = Expression::parse("2 * $length / 3 + 1 cm", &|_| true).unwrap();
/// assert_eq!(e.names(), ["$length"]);
/// let metre = Dimension::of("m").unwrap();
/// assert_eq!(e.dimension(&[metre]), Ok(metre));
/// assert_eq!(e.value(&[30.0]), 20.01);
/// let error = e.dimension(&[Dimension::of("kg").unwrap()]).unwrap_err();
/// assert_eq!(error.message, "`kg` and `m` can't be added or subtracted");
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    names: Vec<String>,
    root: Node,
}

/// What is wrong with an expression, and where in its text.
#[derive(Clone, Debug, PartialEq)]
pub struct ExpressionError {
    /// What is wrong.
    pub message: String,
    /// Where, in bytes.
    pub at: Range<usize>,
}

#[derive(Clone, Debug, PartialEq)]
enum Node {
    Number(f64, Dimension),
    Name(usize),
    Minus(Box<Node>),
    Two(Two, Box<[Node; 2]>, Range<usize>),
    Call(Function, Vec<Node>, Range<usize>),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Two {
    Plus,
    Minus,
    Times,
    Over,
    Power,
}

/// What a function asks of its arguments and gives.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Units {
    /// A plain number of a plain number.
    Plain,
    /// A plain number of an angle, or of a plain number.
    OfAngle,
    /// Of any, and all of the same; gives that.
    Same,
    /// The root of any.
    Root,
    /// A plain number of any, all of the same.
    Ratio,
}

#[derive(Clone, Copy, Debug)]
struct Function {
    name: &'static str,
    arguments: usize,
    units: Units,
    apply: fn(&[f64]) -> f64,
}

impl PartialEq for Function {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

const fn function(name: &'static str, arguments: usize, units: Units, apply: fn(&[f64]) -> f64) -> Function {
    Function { name, arguments, units, apply }
}

const FUNCTIONS: &[Function] = &[
    function("sqrt", 1, Units::Root, |x| x[0].sqrt()),
    function("abs", 1, Units::Same, |x| x[0].abs()),
    function("sign", 1, Units::Ratio, |x| if x[0] == 0.0 { 0.0 } else { x[0].signum() }),
    function("exp", 1, Units::Plain, |x| x[0].exp()),
    function("ln", 1, Units::Plain, |x| x[0].ln()),
    function("sin", 1, Units::OfAngle, |x| x[0].sin()),
    function("cos", 1, Units::OfAngle, |x| x[0].cos()),
    function("tan", 1, Units::OfAngle, |x| x[0].tan()),
    function("asin", 1, Units::Plain, |x| x[0].asin()),
    function("acos", 1, Units::Plain, |x| x[0].acos()),
    function("atan", 1, Units::Plain, |x| x[0].atan()),
    function("tanh", 1, Units::Plain, |x| x[0].tanh()),
    function("floor", 1, Units::Plain, |x| x[0].floor()),
    function("round", 1, Units::Plain, |x| x[0].round()),
    function("atan2", 2, Units::Ratio, |x| x[0].atan2(x[1])),
    // f64's own would hide what is no number
    function("min", 2, Units::Same, |x| if x[0] <= x[1] || x[0].is_nan() { x[0] } else { x[1] }),
    function("max", 2, Units::Same, |x| if x[0] >= x[1] || x[0].is_nan() { x[0] } else { x[1] }),
    function("clamp", 3, Units::Same, |x| {
        if x[0] < x[1] {
            x[1]
        } else if x[0] > x[2] {
            x[2]
        } else {
            x[0]
        }
    }),
];

impl Expression {
    /// Reads a formula. `known` is asked which words behind a `$` are names, since these may hold a minus.
    ///
    /// # Errors
    /// It is no formula.
    pub fn parse(text: &str, known: &dyn Fn(&str) -> bool) -> Result<Self, ExpressionError> {
        let mut reader = Reader { text, at: 0, names: Vec::new(), known };
        if text.len() > LONGEST {
            return Err(reader.wrong(format!("a formula of more than {LONGEST} characters"), 0..0));
        }
        let root = reader.sum(0)?;
        reader.blank();
        match reader.rest().chars().next() {
            None => Ok(Expression { names: reader.names, root }),
            Some(c) => Err(reader
                .wrong(format!("an operator was expected, not `{c}`"), reader.at..reader.at + c.len_utf8())),
        }
    }

    /// The names that it uses, each once, in the order in which [`Expression::dimension`] and [`Expression::value`] want
    /// what they stand for.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Of what dimension it is, where its names are of these.
    ///
    /// # Errors
    /// Units that don't fit.
    pub fn dimension(&self, of_names: &[Dimension]) -> Result<Dimension, ExpressionError> {
        self.root.dimension(of_names)
    }

    /// Its value in SI units, where its names have these values; NaN where it has none.
    pub fn value(&self, of_names: &[f64]) -> f64 {
        self.root.value(of_names)
    }
}

impl Node {
    fn value(&self, names: &[f64]) -> f64 {
        match self {
            Node::Number(x, _) => *x,
            Node::Name(k) => names.get(*k).copied().unwrap_or(f64::NAN),
            Node::Minus(x) => -x.value(names),
            Node::Two(two, both, _) => {
                let [a, b] = both.each_ref().map(|x| x.value(names));
                match two {
                    Two::Plus => a + b,
                    Two::Minus => a - b,
                    Two::Times => a * b,
                    Two::Over => a / b,
                    Two::Power => a.powf(b),
                }
            }
            Node::Call(function, arguments, _) => {
                let mut values = [0.0; 3];
                for (value, x) in values.iter_mut().zip(arguments) {
                    *value = x.value(names);
                }
                (function.apply)(&values[..function.arguments])
            }
        }
    }

    fn dimension(&self, names: &[Dimension]) -> Result<Dimension, ExpressionError> {
        let plain = Dimension::default();
        let wrong = |message: String, at: &Range<usize>| Err(ExpressionError { message, at: at.clone() });
        match self {
            Node::Number(_, d) => Ok(*d),
            Node::Name(k) => Ok(names.get(*k).copied().unwrap_or_default()),
            Node::Minus(x) => x.dimension(names),
            Node::Two(two, both, at) => {
                let (a, b) = (both[0].dimension(names)?, both[1].dimension(names)?);
                match two {
                    Two::Plus | Two::Minus if a != b => {
                        wrong(format!("{} and {} can't be added or subtracted", shown(a), shown(b)), at)
                    }
                    Two::Plus | Two::Minus => Ok(a),
                    Two::Times => Ok(a.times(b, 1)),
                    Two::Over => Ok(a.times(b, -1)),
                    Two::Power if b != plain => {
                        wrong(format!("a power is a plain number, not {}", shown(b)), at)
                    }
                    Two::Power if a == plain => Ok(a),
                    Two::Power => match both[1].power() {
                        Some(n) => Ok(plain.times(a, n)),
                        None => {
                            wrong(format!("{} takes a whole number from -9 to 9 as its power", shown(a)), at)
                        }
                    },
                }
            }
            Node::Call(f, arguments, at) => {
                let all = arguments.iter().map(|x| x.dimension(names)).collect::<Result<Vec<_>, _>>()?;
                let first = all[0];
                if let Some(other) = all.iter().find(|d| **d != first) {
                    return wrong(
                        format!("`{}` can't compare {} with {}", f.name, shown(first), shown(*other)),
                        at,
                    );
                }
                let angle = Dimension::new(0, 0, 0, 1);
                match f.units {
                    Units::Same => Ok(first),
                    Units::Ratio => Ok(plain),
                    Units::Plain if first == plain => Ok(plain),
                    Units::OfAngle if first == plain || first == angle => Ok(plain),
                    Units::Root => match first.root() {
                        Some(root) => Ok(root),
                        None => wrong(format!("there is no root of {}", shown(first)), at),
                    },
                    Units::Plain => {
                        wrong(format!("`{}` takes a plain number, not {}", f.name, shown(first)), at)
                    }
                    Units::OfAngle => wrong(format!("`{}` takes an angle, not {}", f.name, shown(first)), at),
                }
            }
        }
    }

    /// The whole number that it is written as.
    fn power(&self) -> Option<i16> {
        match self {
            Node::Number(x, _) if x.fract() == 0.0 && x.abs() <= 9.0 => Some(*x as i16),
            Node::Minus(x) => x.power().map(|n| -n),
            _ => None,
        }
    }
}

fn shown(d: Dimension) -> String {
    match d.unit() {
        unit if unit.is_empty() => "a plain number".into(),
        unit => format!("`{unit}`"),
    }
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    names: Vec<String>,
    known: &'a dyn Fn(&str) -> bool,
}

impl<'a> Reader<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }
    fn wrong(&self, message: impl Into<String>, at: Range<usize>) -> ExpressionError {
        ExpressionError { message: message.into(), at }
    }
    fn blank(&mut self) {
        self.at = self.text.len() - self.rest().trim_start().len();
    }
    fn eat(&mut self, c: char) -> bool {
        self.blank();
        let there = self.rest().starts_with(c);
        self.at += if there { c.len_utf8() } else { 0 };
        there
    }

    fn sum(&mut self, depth: usize) -> Result<Node, ExpressionError> {
        let start = self.at;
        let mut sum = self.product(depth)?;
        loop {
            let two = match (self.eat('+'), self.eat('-')) {
                (true, _) => Two::Plus,
                (_, true) => Two::Minus,
                _ => return Ok(sum),
            };
            let next = self.product(depth)?;
            sum = Node::Two(two, Box::new([sum, next]), start..self.at);
        }
    }

    fn product(&mut self, depth: usize) -> Result<Node, ExpressionError> {
        let start = self.at;
        let mut product = self.signed(depth)?;
        loop {
            let two = match (self.eat('*'), self.eat('/')) {
                (true, _) => Two::Times,
                (_, true) => Two::Over,
                _ => return Ok(product),
            };
            let next = self.signed(depth)?;
            product = Node::Two(two, Box::new([product, next]), start..self.at);
        }
    }

    fn signed(&mut self, depth: usize) -> Result<Node, ExpressionError> {
        if depth > DEEPEST {
            return Err(self.wrong("a formula with too many brackets or signs", self.at..self.at));
        }
        if self.eat('-') {
            return Ok(Node::Minus(Box::new(self.signed(depth + 1)?)));
        }
        if self.eat('+') {
            return self.signed(depth + 1);
        }
        let start = self.at;
        let base = self.operand(depth)?;
        if !self.eat('^') {
            return Ok(base);
        }
        let power = self.signed(depth + 1)?;
        Ok(Node::Two(Two::Power, Box::new([base, power]), start..self.at))
    }

    fn operand(&mut self, depth: usize) -> Result<Node, ExpressionError> {
        self.blank();
        let (start, rest) = (self.at, self.rest());
        let Some(c) = rest.chars().next() else {
            return Err(self.wrong("the formula ends where a number or a name was expected", start..start));
        };
        if self.eat('(') {
            let inside = self.sum(depth + 1)?;
            return if self.eat(')') {
                Ok(inside)
            } else {
                Err(self.wrong("a bracket that isn't closed", start..start + 1))
            };
        }
        if c.is_ascii_digit() || c == '.' {
            return self.number();
        }
        if c == '{' {
            let Some(end) = rest.find('}') else {
                return Err(self.wrong("a brace that isn't closed", start..start + 1));
            };
            self.at += end + 1;
            return Ok(self.name(rest[1..end].trim().to_string()));
        }
        if c == '$' {
            let word = &rest[1..];
            let end = word.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '-'));
            let word = &word[..end.unwrap_or(word.len())];
            // a name may hold a minus: the longest one that there is
            let ends = std::iter::once(word.len()).chain(word.rmatch_indices('-').map(|(k, _)| k));
            let end = ends.clone().find(|&k| (self.known)(&word[..k])).or(ends.last()).unwrap_or(0);
            if end == 0 {
                return Err(self.wrong("a name was expected behind `$`", start..start + 1));
            }
            self.at += 1 + end;
            return Ok(self.name(format!("${}", &word[..end])));
        }
        let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == '.')).unwrap_or(rest.len());
        let word = &rest[..end];
        if word.is_empty() {
            return Err(self
                .wrong(format!("a number or a name was expected, not `{c}`"), start..start + c.len_utf8()));
        }
        self.at += end;
        if rest[end..].trim_start().starts_with('(') {
            return self.call(word, start, depth);
        }
        Ok(if word == "pi" { Node::Number(PI, Dimension::default()) } else { self.name(word.to_string()) })
    }

    fn name(&mut self, name: String) -> Node {
        Node::Name(self.names.iter().position(|n| *n == name).unwrap_or_else(|| {
            self.names.push(name);
            self.names.len() - 1
        }))
    }

    fn call(&mut self, word: &str, start: usize, depth: usize) -> Result<Node, ExpressionError> {
        let whole = start..start + word.len();
        let Some(function) = FUNCTIONS.iter().find(|f| f.name == word) else {
            let names: Vec<&str> = FUNCTIONS.iter().map(|f| f.name).collect();
            return Err(
                self.wrong(format!("there is no function `{word}`; there are {}", names.join(", ")), whole)
            );
        };
        self.eat('(');
        let mut arguments = vec![self.sum(depth + 1)?];
        while self.eat(',') {
            arguments.push(self.sum(depth + 1)?);
        }
        if !self.eat(')') {
            return Err(self.wrong("a bracket that isn't closed", whole));
        }
        if arguments.len() != function.arguments {
            let n = function.arguments;
            let message = format!("`{word}` takes {n} argument{}", if n == 1 { "" } else { "s" });
            return Err(self.wrong(message, start..self.at));
        }
        Ok(Node::Call(*function, arguments, start..self.at))
    }

    /// A number with the unit right behind it: symbols with powers, and one `/` without spaces.
    fn number(&mut self) -> Result<Node, ExpressionError> {
        let start = self.at;
        let end = number_end(self.rest());
        let Ok(x) = self.rest()[..end].parse::<f64>() else {
            return Err(self.wrong("a number was expected", start..start + 1));
        };
        self.at += end;
        let rest = self.rest();
        let mut best = None;
        for (k, c) in rest.char_indices() {
            let next = k + c.len_utf8();
            if !(c.is_alphanumeric() || matches!(c, ' ' | '/' | '^' | '%' | '°' | '·' | '-' | '²' | '³'))
            {
                break;
            }
            let part = &rest[..next];
            let word_ends =
                !rest[next..].starts_with(|c: char| c.is_alphanumeric() || matches!(c, '.' | '_' | '^'));
            // `3 N - 2` and `3 / 2` are no units
            let begins = part.trim_start().starts_with(|c: char| c.is_alphabetic() || matches!(c, '%' | '°'));
            let tight = !part.contains(" /") && !part.contains("/ ") && !part.contains(" -");
            let ends = c.is_alphanumeric() || matches!(c, '%' | '°' | '²' | '³');
            if word_ends
                && begins
                && tight
                && ends
                && let Ok(unit) = unit::parse(part)
            {
                best = Some((next, unit));
            }
        }
        let (value, dimension) = match best {
            Some((end, unit)) => {
                self.at += end;
                (unit.to_si(x), unit.dimension)
            }
            None => (x, Dimension::default()),
        };
        // a word behind a number is a unit, or nothing
        self.blank();
        if let Some(c) = self.rest().chars().next().filter(|c| c.is_alphabetic()) {
            let word: String = self.rest().chars().take_while(|c| c.is_alphanumeric()).collect();
            let message = format!("`{word}` behind a number is no unit");
            return Err(self.wrong(message, self.at..self.at + c.len_utf8()));
        }
        if !value.is_finite() {
            return Err(self.wrong("a number out of all range", start..self.at));
        }
        Ok(Node::Number(value, dimension))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        let e = Expression::parse(text, &|_| true).unwrap_or_else(|e| panic!("{text}: {}", e.message));
        e.value(&vec![2.0; e.names().len()])
    }

    fn unit(text: &str) -> Result<String, String> {
        let e = Expression::parse(text, &|_| true).map_err(|e| e.message)?;
        e.dimension(&vec![Dimension::of("m").unwrap(); e.names().len()])
            .map(|d| d.unit())
            .map_err(|e| e.message)
    }

    #[test]
    fn formulas_are_read_as_on_paper() {
        for (text, expected) in [
            ("1 + 2 * 3", 7.0),
            ("(1 + 2) * 3", 9.0),
            ("-2^2", -4.0),
            ("2^3^2", 512.0),
            ("2^-1", 0.5),
            ("8 / 2 / 2", 2.0),
            ("1 - 2 - 3", -4.0),
            ("--3", 3.0),
            ("-$load", -2.0),
            ("2 * $length / 3", 4.0 / 3.0),
            ("$a-1", 1.0),
            ("3 kN - 2 N", 2998.0),
            ("3 kN -2 N", 2998.0),
            ("1.5e2 cm", 1.5),
            ("36 km/h * 2 s", 20.0),
            ("10 m / 4 s", 2.5),
            ("2 N m^2", 2.0),
            ("50 %", 0.5),
            ("{rope@50 %.tension} + rope.end.x", 4.0),
            ("max(1, min(5, 3)) + clamp(7, 0, 2)", 5.0),
            ("sin(90 deg) + cos(0) + sqrt(16 m^2) / 1 m", 6.0),
            ("atan2(1 m, 1 m) * 4 - pi", 0.0),
        ] {
            assert!((value(text) - expected).abs() <= 1e-12 * expected.abs(), "{text}: {}", value(text));
        }
        assert!(value("sqrt(-1)").is_nan() && value("max(1, 0/0)").is_nan() && value("min(0/0, 1)").is_nan());
    }

    #[test]
    fn names_behind_a_dollar_are_the_longest_that_are_known() {
        let known = |name: &str| ["wet-mass", "a"].contains(&name);
        let names = |text: &str| Expression::parse(text, &known).unwrap().names().to_vec();
        assert_eq!(names("$wet-mass - $a-1"), ["$wet-mass", "$a"]);
        assert_eq!(names("$b-c"), ["$b"]);
    }

    #[test]
    fn units_are_checked() {
        for (text, expected) in [
            ("$a * 3 N", "N m"),
            ("$a^2", "m^2"),
            ("sqrt($a^2 + 1 cm^2)", "m"),
            ("$a / 2 s", "m/s"),
            ("$a^3 / (1 s)^3", "m^3 s^-3"),
            ("1 / (2 s)", "Hz"),
            ("$a / 1 m", ""),
        ] {
            assert_eq!(unit(text).as_deref(), Ok(expected), "{text}");
        }
        for text in ["$a + 1", "$a + 1 s", "sin($a)", "2^$a", "$a^0.5", "sqrt($a)", "max($a, 1)", "exp(1 m)"]
        {
            assert!(unit(text).is_err(), "{text}");
        }
    }

    #[test]
    fn what_is_no_formula_is_refused_and_nothing_panics() {
        let deep = "(".repeat(1000) + "1";
        let minus = "-".repeat(1000) + "1";
        let long = "1+".repeat(2000) + "1";
        for text in [
            "",
            " ",
            "1 +",
            "* 2",
            "(1",
            "1)",
            "2 3",
            "foo(1)",
            "max(1)",
            "sin(1, 2)",
            "$",
            "$ a",
            "{a",
            "1 parsec",
            "3 N m.x",
            "é",
            "1 é",
            "a b",
            "1..2",
            "1e999",
            ".",
            "a(",
            "max(1,",
            "${a}",
            "2 m/s/s x",
            &deep,
            &minus,
            &long,
        ] {
            assert!(Expression::parse(text, &|_| true).is_err(), "{text:.40}");
        }
    }
}
