//! Reads a formula.

use super::functions::FUNCTIONS;
use super::{DEEPEST, ExpressionError, Node, Two};
use crate::{Dimension, number_end, unit};
use std::f64::consts::PI;
use std::ops::Range;

pub(super) struct Reader<'a> {
    pub text: &'a str,
    pub at: usize,
    pub names: Vec<String>,
    pub known: &'a dyn Fn(&str) -> bool,
}

impl<'a> Reader<'a> {
    pub fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }
    pub fn wrong(&self, message: impl Into<String>, at: Range<usize>) -> ExpressionError {
        ExpressionError { message: message.into(), at }
    }
    pub fn blank(&mut self) {
        self.at = self.text.len() - self.rest().trim_start().len();
    }
    fn eat(&mut self, c: char) -> bool {
        self.blank();
        let there = self.rest().starts_with(c);
        self.at += if there { c.len_utf8() } else { 0 };
        there
    }

    pub fn sum(&mut self, depth: usize) -> Result<Node, ExpressionError> {
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
            if !(c.is_alphanumeric()
                || matches!(c, ' ' | '/' | '^' | '%' | '°' | '·' | '-' | '²' | '³' | '(' | ')'))
            {
                break;
            }
            let part = &rest[..next];
            let word_ends =
                !rest[next..].starts_with(|c: char| c.is_alphanumeric() || matches!(c, '.' | '_' | '^'));
            // `3 N - 2` and `3 / 2` are no units
            let begins = part.trim_start().starts_with(|c: char| c.is_alphabetic() || matches!(c, '%' | '°'));
            let tight = !part.contains(" /") && !part.contains("/ ") && !part.contains(" -");
            let ends = c.is_alphanumeric() || matches!(c, '%' | '°' | '²' | '³' | ')');
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
