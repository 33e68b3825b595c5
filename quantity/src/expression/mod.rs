//! Arithmetic with quantities: `2 * $length / 3`, `-$load`, `max(0 N, {rope.tension} - 2 kN)`.
//!
//! Units are checked once, apart from the numbers: [`Expression::dimension`] says of what dimension the result is, and
//! [`Expression::value`] then computes in SI units.

mod functions;
mod reader;
#[cfg(test)]
mod tests;

use super::Dimension;
use functions::{Function, Units};
use reader::Reader;
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
