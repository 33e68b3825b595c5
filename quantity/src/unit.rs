//! Units of measure read from text: `kn`, `kg/m`, `N m^2`, `kN*s/(m rad)`.
//!
//! A unit is a product of symbols with whole powers. Each symbol is looked up as it stands and then as SI prefix plus
//! symbol, so `min`, `h` and `kn` are the minute, the hour and the knot, and `kN` is the kilonewton.

use std::f64::consts::PI;

/// Exponents of the base dimensions. The radian has an exponent of its own, so that `rad/s` is not taken for `Hz`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dimension {
    /// Exponent of the kilogram.
    pub mass: i16,
    /// Exponent of the metre.
    pub length: i16,
    /// Exponent of the second.
    pub time: i16,
    /// Exponent of the radian.
    pub angle: i16,
}

impl Dimension {
    /// The dimension kg^mass m^length s^time rad^angle.
    #[must_use]
    pub const fn new(mass: i16, length: i16, time: i16, angle: i16) -> Self {
        Self { mass, length, time, angle }
    }

    /// Reads a unit such as `N/m`; a plain number has none, or `1`.
    ///
    /// ```
    /// use ropewalk_quantity::Dimension;
    /// assert_eq!(Dimension::of("kg m/s^2"), Dimension::of("N"));
    /// assert_eq!(Dimension::of("").unwrap().unit(), "");
    /// assert!(Dimension::of("parsec").is_err());
    /// ```
    ///
    /// # Errors
    /// It is no unit; what is wrong with it.
    pub fn of(unit: &str) -> Result<Self, String> {
        let unit = unit.trim();
        if unit.is_empty() { Ok(Self::default()) } else { parse(unit).map(|u| u.dimension) }
    }

    /// Whether a unit is one of SI, in which a number means itself.
    pub fn is_coherent(unit: &str) -> bool {
        unit.trim().is_empty() || parse(unit).is_ok_and(|u| u.to_si(1.0) == 1.0)
    }

    /// Its SI unit; empty of a plain number.
    pub fn unit(&self) -> String {
        let named = super::ALL.iter().find(|k| k.dimension == *self);
        if let Some(kind) = named {
            return kind.unit.into();
        }
        let all = [("kg", self.mass), ("m", self.length), ("s", self.time), ("rad", self.angle)];
        let powers = all.iter().filter(|(_, power)| *power != 0).map(|(name, power)| match power {
            1 => (*name).to_string(),
            power => format!("{name}^{power}"),
        });
        powers.collect::<Vec<_>>().join(" ")
    }

    /// That of a quantity divided by one of another dimension.
    #[must_use]
    pub fn over(self, other: Self) -> Self {
        self.times(other, -1)
    }

    pub(super) fn root(self) -> Option<Self> {
        let all = [self.mass, self.length, self.time, self.angle];
        let even = all.iter().all(|power| power % 2 == 0);
        even.then(|| Self::new(self.mass / 2, self.length / 2, self.time / 2, self.angle / 2))
    }

    pub(super) fn times(self, o: Self, power: i16) -> Self {
        Self {
            mass: self.mass + power * o.mass,
            length: self.length + power * o.length,
            time: self.time + power * o.time,
            angle: self.angle + power * o.angle,
        }
    }
}

/// A unit as a ratio to SI: `numerator · 10^ten / denominator`.
///
/// The ratio is kept apart so that `9 mm` is 9/1000, correctly rounded, rather than 9 × 0.001.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unit {
    numerator: f64,
    denominator: f64,
    ten: i32,
    pub(super) dimension: Dimension,
}

impl Unit {
    const ONE: Self = Self::new(1.0, 1.0, 0, Dimension::new(0, 0, 0, 0));

    const fn new(numerator: f64, denominator: f64, ten: i32, dimension: Dimension) -> Self {
        Self { numerator, denominator, ten, dimension }
    }

    fn times(self, o: Self, power: i16) -> Self {
        let p = i32::from(power);
        let (top, bottom) = if p < 0 { (o.denominator, o.numerator) } else { (o.numerator, o.denominator) };
        Self {
            numerator: self.numerator * top.powi(p.abs()),
            denominator: self.denominator * bottom.powi(p.abs()),
            ten: self.ten + p * o.ten,
            dimension: self.dimension.times(o.dimension, power),
        }
    }

    /// `x` of this unit, in SI.
    pub(super) fn to_si(self, x: f64) -> f64 {
        let scale = 10_f64.powi(self.ten.abs());
        if self.ten < 0 {
            x * self.numerator / (self.denominator * scale)
        } else {
            x * (self.numerator * scale) / self.denominator
        }
    }
}

const fn dim(mass: i16, length: i16, time: i16, angle: i16) -> Dimension {
    Dimension::new(mass, length, time, angle)
}

/// Symbol, unit, whether SI prefixes go with it.
const SYMBOLS: &[(&str, Unit, bool)] = &[
    ("m", Unit::new(1.0, 1.0, 0, dim(0, 1, 0, 0)), true),
    ("s", Unit::new(1.0, 1.0, 0, dim(0, 0, 1, 0)), true),
    ("g", Unit::new(1.0, 1.0, -3, dim(1, 0, 0, 0)), true),
    ("t", Unit::new(1.0, 1.0, 3, dim(1, 0, 0, 0)), false),
    ("N", Unit::new(1.0, 1.0, 0, dim(1, 1, -2, 0)), true),
    ("Pa", Unit::new(1.0, 1.0, 0, dim(1, -1, -2, 0)), true),
    ("bar", Unit::new(1.0, 1.0, 5, dim(1, -1, -2, 0)), true),
    ("J", Unit::new(1.0, 1.0, 0, dim(1, 2, -2, 0)), true),
    ("W", Unit::new(1.0, 1.0, 0, dim(1, 2, -3, 0)), true),
    ("Hz", Unit::new(1.0, 1.0, 0, dim(0, 0, -1, 0)), true),
    ("rad", Unit::new(1.0, 1.0, 0, dim(0, 0, 0, 1)), true),
    ("deg", Unit::new(PI, 180.0, 0, dim(0, 0, 0, 1)), false),
    ("°", Unit::new(PI, 180.0, 0, dim(0, 0, 0, 1)), false),
    ("rev", Unit::new(2.0 * PI, 1.0, 0, dim(0, 0, 0, 1)), false),
    ("rpm", Unit::new(2.0 * PI, 60.0, 0, dim(0, 0, -1, 1)), false),
    ("min", Unit::new(60.0, 1.0, 0, dim(0, 0, 1, 0)), false),
    ("h", Unit::new(3600.0, 1.0, 0, dim(0, 0, 1, 0)), false),
    ("kn", Unit::new(1852.0, 3600.0, 0, dim(0, 1, -1, 0)), false),
    ("kmh", Unit::new(1000.0, 3600.0, 0, dim(0, 1, -1, 0)), false),
    ("mph", Unit::new(1609.344, 3600.0, 0, dim(0, 1, -1, 0)), false),
    ("nmi", Unit::new(1852.0, 1.0, 0, dim(0, 1, 0, 0)), false),
    ("mi", Unit::new(1609.344, 1.0, 0, dim(0, 1, 0, 0)), false),
    ("yd", Unit::new(0.9144, 1.0, 0, dim(0, 1, 0, 0)), false),
    ("ft", Unit::new(0.3048, 1.0, 0, dim(0, 1, 0, 0)), false),
    ("in", Unit::new(0.0254, 1.0, 0, dim(0, 1, 0, 0)), false),
    ("lb", Unit::new(0.453_592_37, 1.0, 0, dim(1, 0, 0, 0)), false),
    ("lbf", Unit::new(4.448_221_615_260_5, 1.0, 0, dim(1, 1, -2, 0)), false),
    ("%", Unit::new(1.0, 1.0, -2, dim(0, 0, 0, 0)), false),
];

const PREFIXES: &[(&str, i32)] = &[
    ("p", -12),
    ("n", -9),
    ("u", -6),
    ("µ", -6), // U+00B5, micro sign
    ("μ", -6), // U+03BC, Greek mu
    ("m", -3),
    ("c", -2),
    ("d", -1),
    ("h", 2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
];

/// Words for symbols that nobody takes for anything else.
const WORDS: &[(&str, &[&str])] = &[
    ("kn", &["kt", "kts", "knot", "knots"]),
    ("kmh", &["kph"]),
    ("s", &["sec", "secs", "second", "seconds"]),
    ("min", &["mins", "minute", "minutes"]),
    ("h", &["hr", "hrs", "hour", "hours"]),
    ("m", &["meter", "meters", "metre", "metres"]),
    ("ft", &["foot", "feet"]),
    ("in", &["inch", "inches"]),
    ("kg", &["kilogram", "kilograms"]),
    ("t", &["tonne", "tonnes"]),
    ("lb", &["lbs"]),
    ("N", &["newton", "newtons"]),
    ("Pa", &["pascal", "pascals"]),
    ("deg", &["degree", "degrees"]),
    ("rad", &["radian", "radians"]),
    ("rev", &["revs"]),
    ("Hz", &["hertz"]),
];

/// Symbols and words that may mean something else, and what they probably mean.
const GUESSES: &[(&str, &[&str])] = &[
    ("m", &["mtr"]),
    ("kg", &["kgs", "kilo"]),
    ("t", &["ton", "tons", "te"]),
    ("deg", &["grad"]),
    ("rev", &["turn", "turns"]),
    ("Hz", &["cps"]),
];

fn lookup(symbol: &str) -> Option<Unit> {
    if let Some(&(_, unit, _)) = SYMBOLS.iter().find(|(s, ..)| *s == symbol) {
        return Some(unit);
    }
    let prefixed = |(prefix, ten): &(&str, i32)| {
        let base = symbol.strip_prefix(prefix)?;
        let &(_, unit, _) = SYMBOLS.iter().find(|(s, _, prefixed)| *prefixed && *s == base)?;
        Some(Unit { ten: unit.ten + ten, ..unit })
    };
    let word = || WORDS.iter().find(|(_, words)| words.contains(&symbol)).and_then(|(s, _)| lookup(s));
    PREFIXES.iter().find_map(prefixed).or_else(word)
}

fn unknown(symbol: &str) -> String {
    let lower = symbol.to_lowercase();
    let meant = |(_, words): &&(&str, &[&str])| words.contains(&lower.as_str());
    if let Some((good, _)) = WORDS.iter().chain(GUESSES).find(meant) {
        return format!("has the unknown unit `{symbol}` (did you mean `{good}`?)");
    }
    // `Nm`, `kNm`: two units that want a space
    for (i, _) in symbol.char_indices().skip(1) {
        let (a, b) = symbol.split_at(i);
        if lookup(a).is_some() && lookup(b).is_some() {
            return format!("has the unknown unit `{symbol}` (did you mean `{a} {b}`?)");
        }
    }
    let plain = SYMBOLS.iter().map(|(s, ..)| (*s).to_string());
    let prefixed = SYMBOLS.iter().filter(|(.., p)| *p);
    let prefixed = prefixed.flat_map(|(s, ..)| PREFIXES.iter().map(move |(p, _)| format!("{p}{s}")));
    let close: Vec<String> = plain.chain(prefixed).filter(|s| s.eq_ignore_ascii_case(symbol)).collect();
    match close.as_slice() {
        [] => format!("has the unknown unit `{symbol}`"),
        some => format!("has the unknown unit `{symbol}` (did you mean `{}`?)", some.join("` or `")),
    }
}

/// Reads a unit; the error continues the sentence that begins with the quantity.
pub(super) fn parse(text: &str) -> Result<Unit, String> {
    let mut reader = Reader { rest: text.trim() };
    let unit = reader.product(0)?;
    match reader.rest.chars().next() {
        None if unit.ten.abs() <= 60 && unit.numerator.is_normal() && unit.denominator.is_normal() => {
            Ok(unit)
        }
        None => Err("has a unit out of all range".to_string()),
        Some(c) => Err(format!("has an unexpected `{c}` in its unit")),
    }
}

struct Reader<'a> {
    rest: &'a str,
}

impl<'a> Reader<'a> {
    fn eat(&mut self, start: &str) -> bool {
        let rest = self.rest.strip_prefix(start);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }

    fn take(&mut self, keep: impl Fn(char) -> bool) -> &'a str {
        let end = self.rest.find(|c| !keep(c)).unwrap_or(self.rest.len());
        let (taken, rest) = self.rest.split_at(end);
        self.rest = rest;
        taken
    }

    fn product(&mut self, depth: usize) -> Result<Unit, String> {
        let (mut unit, mut divided) = (Unit::ONE, false);
        self.take(char::is_whitespace);
        // `/s` means `1/s`
        if !self.rest.starts_with('/') {
            unit = self.factor(depth)?;
        }
        loop {
            self.take(char::is_whitespace);
            if self.rest.is_empty() || self.rest.starts_with(')') {
                return Ok(unit);
            }
            let over = self.eat("/");
            let _ = over || self.eat("*") || self.eat("·") || self.eat("⋅");
            if divided && !over {
                return Err(
                    "has an ambiguous unit: after `/` put what divides in brackets, as in `kg/(m s)`".into(),
                );
            }
            divided |= over;
            self.take(char::is_whitespace);
            unit = unit.times(self.factor(depth)?, if over { -1 } else { 1 });
        }
    }

    fn factor(&mut self, depth: usize) -> Result<Unit, String> {
        if depth > 8 {
            return Err("has too many brackets in its unit".into());
        }
        if self.eat("(") {
            let inner = self.product(depth + 1)?;
            if !self.eat(")") {
                return Err("has a bracket in its unit that is not closed".into());
            }
            return Ok(Unit::ONE.times(inner, self.power()?));
        }
        if self.rest.starts_with(|c: char| c.is_ascii_digit()) {
            return match self.take(|c| c.is_ascii_digit() || c == '.') {
                "1" => Ok(Unit::ONE),
                n => Err(format!("has a second number, `{n}`, where a unit was expected")),
            };
        }
        let symbol = self.take(|c| c.is_alphabetic() || c == '°' || c == '%');
        if symbol.is_empty() {
            return Err(match self.rest.chars().next() {
                Some(',') => "has a comma: write a decimal point".into(),
                Some(c) => format!("has an unexpected `{c}` in its unit"),
                None => "has an unfinished unit".into(),
            });
        }
        if symbol == "nm" {
            // off by a factor of 10^12 one way or the other, so nobody's guess is taken
            return Err("has the unit `nm`: write `nmi` for nautical miles, `e-9 m` for nanometres".into());
        }
        let unit = lookup(symbol).ok_or_else(|| unknown(symbol))?;
        Ok(Unit::ONE.times(unit, self.power()?))
    }

    /// `^2`, `**2`, `2`, `^-1`, `-1`, `²`, `⁻¹` or nothing.
    fn power(&mut self) -> Result<i16, String> {
        const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
        let marked = self.eat("^") || self.eat("**");
        let negative = self.eat("-") || self.eat("⁻");
        let _ = marked && !negative && self.eat("+");
        let digits = self.take(|c| c.is_ascii_digit() || RAISED.contains(&c));
        if digits.is_empty() && !marked && !negative {
            return Ok(1);
        }
        let mut plain = digits
            .chars()
            .map(|c| RAISED.iter().position(|r| *r == c).map_or(c.to_digit(10), |d| u32::try_from(d).ok()));
        match (plain.next().flatten(), plain.next(), self.rest.chars().next()) {
            (Some(d @ 1..=9), None, next) if next != Some('.') => {
                let d = i16::try_from(d).unwrap_or(1);
                Ok(if negative { -d } else { d })
            }
            _ => Err("has a power in its unit that is not a whole number from 1 to 9, or -1 to -9".into()),
        }
    }
}
