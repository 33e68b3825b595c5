//! Numbers with or without units: `25`, `"25 kn"`, `"1.2 MN"`, `"2 N m^2"`.
//!
//! Everything inside is a plain `f64` in SI units. A struct that is read from a file says at each field what kind of
//! quantity stands there, and the file may then give a bare number in SI or a string with any fitting unit:
//!
//! ```
//! # use ropewalk_quantity as quantity;
//! #[derive(serde::Deserialize)]
//! struct Tow {
//!     #[serde(deserialize_with = "quantity::speed")]
//!     speed: f64,
//!     #[serde(default, deserialize_with = "quantity::optional::length")]
//!     depth: Option<f64>,
//!     #[serde(deserialize_with = "quantity::vec3::length")]
//!     from: [f64; 3],
//! }
//! let tow: Tow = serde_json::from_str(r#"{ "speed": "36 km/h", "from": [0, "20 cm", 1.5] }"#).unwrap();
//! assert_eq!((tow.speed, tow.depth, tow.from), (10.0, None, [0.0, 0.2, 1.5]));
//! ```
//!
//! Five families take the same names: the functions of this module read an `f64`, those of [`optional`] an
//! `Option<f64>` (add `#[serde(default)]` so that the field may be left out), those of [`vec3`] a `[f64; 3]` and those
//! of [`list`] a `Vec<f64>`, whose entries each are a number or a string; those of [`setting`] read a [`Setting`], which may
//! be an input instead; [`points`] reads a list of points. Not-a-number and infinities are refused.
//! Writing stays plain: the `f64` in SI.

mod expression;
mod given;
mod schema;
mod unit;
mod written;

pub use expression::{Expression, ExpressionError};
pub use given::{Formula, Setting};
use given::{MaybeSet, Set, ThreeSets};
pub use schema::{TextsWithUnits, unit_of};
use serde::de::{DeserializeSeed, Deserializer, Error, IgnoredAny, SeqAccess, Visitor};
use std::fmt;
pub use unit::Dimension;
pub use written::Written;

/// A kind of quantity: what it is called, its SI unit, and the dimension that a unit has to have to fit.
#[derive(Debug)]
pub struct Kind {
    /// Name with article, as messages say it: `a speed`.
    pub name: &'static str,
    /// SI unit that a bare number is in; empty for a plain number.
    pub unit: &'static str,
    /// A quantity of this kind as one would write it in a scene: `25 kn`.
    pub example: &'static str,
    /// Dimension of the unit.
    pub dimension: Dimension,
    /// Whether the exponent of the radian has to fit as well; a moment per angle may be `N m` or `N m/rad`.
    pub strict_angle: bool,
}

impl Kind {
    /// Reads `"<number> <unit>"` into SI; the error is one sentence for the user.
    ///
    /// ```
    /// use ropewalk_quantity::kind;
    /// assert_eq!(kind::SPEED.parse("36 km/h"), Ok(10.0));
    /// let error = kind::SPEED.parse("25 kg").unwrap_err();
    /// assert_eq!(error, r#""25 kg" is a mass, expected a speed like "25 kn" or a number in m/s"#);
    /// ```
    ///
    /// # Errors
    /// If the text is no number with a unit of this kind, or not finite.
    pub fn parse(&self, text: &str) -> Result<f64, String> {
        let fail = |what: &str| Err(format!("\"{}\" {what}, expected {self}", shortened(text)));
        let trimmed = text.trim();
        let end = number_end(trimmed);
        let (Ok(x), rest) = (trimmed[..end].parse::<f64>(), trimmed[end..].trim()) else {
            return fail("does not begin with a number");
        };
        if text.len() > 200 {
            return fail("is too long for a quantity");
        }
        if rest.is_empty() {
            return if self.unit.is_empty() { self.finite(x) } else { fail("has no unit") };
        }
        let unit = match unit::parse(rest) {
            Ok(unit) => unit,
            Err(what) => return fail(&what),
        };
        if !self.fits(unit.dimension) {
            // the one pair of symbols that differ by case and are both at home here
            let knots = rest == "kn" && self.dimension.mass == 1;
            let hint = if knots { " (`kn` is the knot, `kN` the kilonewton)" } else { "" };
            return match ALL
                .iter()
                .find(|k| k.fits(unit.dimension) && (k.strict_angle || unit.dimension.angle == 0))
            {
                Some(kind) if kind.unit.is_empty() => fail("has no dimension"),
                Some(kind) => fail(&format!("is {}{hint}", kind.name)),
                None => fail(&format!("is in {}", shortened(rest))),
            };
        }
        self.finite(unit.to_si(x))
    }

    /// Whether a dimension is one of this kind.
    pub fn fits(&self, d: Dimension) -> bool {
        let angle = if self.strict_angle { d.angle } else { self.dimension.angle };
        self.dimension == Dimension { angle, ..d }
    }

    fn finite(&self, x: f64) -> Result<f64, String> {
        if x.is_finite() { Ok(x) } else { Err(format!("{x} is not a finite number, expected {self}")) }
    }
}

/// What is expected: `a speed like "25 kn" or a number in m/s`.
impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.unit.is_empty() {
            write!(f, "{} like {}", self.name, self.example)
        } else {
            write!(f, "{} like \"{}\" or a number in {}", self.name, self.example, self.unit)
        }
    }
}

fn shortened(text: &str) -> String {
    match text.char_indices().nth(60) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_string(),
    }
}

/// Where the number at the beginning of `s` ends; an `e` counts only if digits follow it.
fn number_end(s: &str) -> usize {
    let b = s.as_bytes();
    let digits = |from: usize| from + b[from..].iter().take_while(|c| c.is_ascii_digit()).count();
    let sign = |at: usize| at + usize::from(matches!(b.get(at), Some(b'+' | b'-')));
    let mut end = digits(sign(0));
    if b.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if matches!(b.get(end), Some(b'e' | b'E')) {
        let from = sign(end + 1);
        end = if digits(from) > from { digits(from) } else { end };
    }
    end
}

/// Reads one `f64` of a kind.
#[derive(Clone, Copy)]
struct One(&'static Kind);

impl<'de> DeserializeSeed<'de> for One {
    type Value = f64;
    fn deserialize<D: Deserializer<'de>>(self, d: D) -> Result<f64, D::Error> {
        // binary formats cannot say what comes next, and hold what we wrote: the plain number
        if d.is_human_readable() { d.deserialize_any(self) } else { d.deserialize_f64(self) }
    }
}

impl Visitor<'_> for One {
    type Value = f64;
    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)
    }
    fn visit_f64<E: Error>(self, x: f64) -> Result<f64, E> {
        self.0.finite(x).map_err(E::custom)
    }
    fn visit_i64<E: Error>(self, x: i64) -> Result<f64, E> {
        Ok(x as f64)
    }
    fn visit_u64<E: Error>(self, x: u64) -> Result<f64, E> {
        Ok(x as f64)
    }
    fn visit_str<E: Error>(self, x: &str) -> Result<f64, E> {
        self.0.parse(x).map_err(E::custom)
    }
}

struct Maybe(One);

impl<'de> Visitor<'de> for Maybe {
    type Value = Option<f64>;
    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.expecting(f)
    }
    fn visit_none<E: Error>(self) -> Result<Self::Value, E> {
        Ok(None)
    }
    fn visit_unit<E: Error>(self) -> Result<Self::Value, E> {
        Ok(None)
    }
    fn visit_some<D: Deserializer<'de>>(self, d: D) -> Result<Self::Value, D::Error> {
        self.0.deserialize(d).map(Some)
    }
}

struct Three(One);

impl<'de> Visitor<'de> for Three {
    type Value = [f64; 3];
    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "three entries, each {}", self.0.0)
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
        let mut v = [0.0; 3];
        for (i, x) in v.iter_mut().enumerate() {
            *x = seq.next_element_seed(self.0)?.ok_or_else(|| A::Error::invalid_length(i, &self))?;
        }
        let mut n = 3;
        while seq.size_hint() != Some(0) && seq.next_element::<IgnoredAny>()?.is_some() {
            n += 1;
        }
        if n == 3 { Ok(v) } else { Err(A::Error::invalid_length(n, &self)) }
    }
}

/// Reads a list of points, each of three entries that are lengths like `30 m` or plain numbers in `m`.
///
/// # Errors
/// If what stands there is no such list.
pub fn points<'de, D: Deserializer<'de>>(d: D) -> Result<Vec<[f64; 3]>, D::Error> {
    #[derive(serde::Deserialize)]
    struct Point(#[serde(deserialize_with = "vec3::length")] [f64; 3]);
    Ok(<Vec<Point> as serde::Deserialize>::deserialize(d)?.into_iter().map(|p| p.0).collect())
}

struct Many(One);

impl<'de> Visitor<'de> for Many {
    type Value = Vec<f64>;
    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a list with entries that each are {}", self.0.0)
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
        let mut v = Vec::new();
        while let Some(x) = seq.next_element_seed(self.0)? {
            v.push(x);
        }
        Ok(v)
    }
}

/// `NAME function: name, (mass, length, time, angle), SI unit, example`; `!` if the radian has to fit too.
macro_rules! kinds {
    ($($upper:ident $lower:ident: $name:literal, ($m:literal, $l:literal, $t:literal, $a:literal) $(! $strict:tt)?, $unit:literal, $example:literal;)*) => {
        /// The kinds of quantity, one constant each; use them to read a quantity outside of serde.
        pub mod kind {
            use super::{Dimension, Kind};
            $(
                #[doc = concat!("Describes ", $name, ", like `", $example, "`. SI unit: `", $unit, "`.")]
                pub const $upper: Kind = Kind {
                    name: $name,
                    unit: $unit,
                    example: $example,
                    dimension: Dimension::new($m, $l, $t, $a),
                    strict_angle: false $(|| $strict)?,
                };
            )*
        }

        const ALL: &[Kind] = &[$(kind::$upper),*];

        kinds!(@functions f64, One, "Reads ", |d, k| One(k).deserialize(d); $($upper $lower $name $unit $example;)*);

        /// The same kinds for fields of type `Option<f64>`; pair with `#[serde(default)]`.
        pub mod optional {
            use super::{Deserializer, Maybe, One, kind};
            kinds!(@functions Option<f64>, Maybe, "If there, reads ", |d, k| d.deserialize_option(Maybe(One(k))); $($upper $lower $name $unit $example;)*);
        }

        /// The same kinds for fields of type `[f64; 3]`: three entries, each a number or a string with unit.
        pub mod vec3 {
            use super::{Deserializer, One, Three, kind};
            kinds!(@functions [f64; 3], Three, "Reads three entries, each ", |d, k| d.deserialize_tuple(3, Three(One(k))); $($upper $lower $name $unit $example;)*);
        }

        /// The same kinds for fields of type `Vec<f64>`: entries that each are a number or a string with unit.
        pub mod list {
            use super::{Deserializer, Many, One, kind};
            kinds!(@functions Vec<f64>, Many, "Reads a list with entries that each are ", |d, k| d.deserialize_seq(Many(One(k))); $($upper $lower $name $unit $example;)*);
        }

        /// The same kinds for fields of type [`Setting`]: a number, or the input that it is read from.
        pub mod setting {
            use super::{DeserializeSeed, Deserializer, Set, Setting, kind};
            kinds!(@functions Setting, Set, "Reads, from the scene or from an input, ", |d, k| Set(k).deserialize(d); $($upper $lower $name $unit $example;)*);

            /// The same for fields of type `Option<Setting>`; pair with `#[serde(default)]`.
            pub mod optional {
                use super::super::{Deserializer, MaybeSet, Set, Setting, kind};
                kinds!(@functions Option<Setting>, MaybeSet, "If there, reads, from the scene or from an input, ", |d, k| d.deserialize_option(MaybeSet(Set(k))); $($upper $lower $name $unit $example;)*);
            }

            /// The same for fields of type `[Setting; 3]`.
            pub mod vec3 {
                use super::super::{Deserializer, Set, Setting, ThreeSets, kind};
                kinds!(@functions [Setting; 3], ThreeSets, "Reads three entries, from the scene or from an input, each ", |d, k| d.deserialize_tuple(3, ThreeSets(Set(k))); $($upper $lower $name $unit $example;)*);
            }
        }
    };
    (@functions $out:ty, $visitor:ident, $does:literal, |$d:ident, $k:ident| $read:expr; $($upper:ident $lower:ident $name:literal $unit:literal $example:literal;)*) => {
        $(
            #[doc = concat!($does, $name, " like `", $example, "`, or as plain number in `", $unit, "`.")]
            ///
            /// # Errors
            /// If what stands there is no finite quantity of this kind.
            pub fn $lower<'de, D: Deserializer<'de>>($d: D) -> Result<$out, D::Error> {
                let $k = &kind::$upper;
                $read
            }
        )*
    };
}

// when a dimension has several kinds, the first one gives it its name in messages
kinds! {
    NUMBER number: "a plain number", (0, 0, 0, 0) !true, "", "0.5";
    LENGTH length: "a length", (0, 1, 0, 0), "m", "30 m";
    AREA area: "an area", (0, 2, 0, 0), "m^2", "5 cm^2";
    VOLUME volume: "a volume", (0, 3, 0, 0), "m^3", "2 m^3";
    TIME time: "a time", (0, 0, 1, 0), "s", "2 min";
    FREQUENCY frequency: "a frequency", (0, 0, -1, 0) !true, "Hz", "0.1 Hz";
    ANGLE angle: "an angle", (0, 0, 0, 1) !true, "rad", "30 deg";
    ANGULAR_VELOCITY angular_velocity: "an angular velocity", (0, 0, -1, 1) !true, "rad/s", "5 rpm";
    ANGULAR_ACCELERATION angular_acceleration: "an angular acceleration", (0, 0, -2, 1) !true, "rad/s^2", "2 deg/s^2";
    CURVATURE curvature: "a curvature", (0, -1, 0, 0), "1/m", "0.5 rad/m";
    SPEED speed: "a speed", (0, 1, -1, 0), "m/s", "25 kn";
    TIME_PER_LENGTH time_per_length: "a time per length", (0, -1, 1, 0), "s/m", "0.3 s/m";
    ACCELERATION acceleration: "an acceleration", (0, 1, -2, 0), "m/s^2", "9.81 m/s^2";
    MASS mass: "a mass", (1, 0, 0, 0), "kg", "1.5 t";
    MASS_PER_LENGTH mass_per_length: "a mass per length", (1, -1, 0, 0), "kg/m", "0.5 kg/m";
    DENSITY density: "a density", (1, -3, 0, 0), "kg/m^3", "1025 kg/m^3";
    INERTIA inertia: "a moment of inertia", (1, 2, 0, 0), "kg m^2", "3 kg m^2";
    INERTIA_PER_LENGTH inertia_per_length: "a moment of inertia per length", (1, 1, 0, 0), "kg m", "1e-4 kg m";
    FORCE force: "a force", (1, 1, -2, 0), "N", "1.2 kN";
    FORCE_PER_LENGTH force_per_length: "a force per length", (1, 0, -2, 0), "N/m", "20 N/m";
    PRESSURE pressure: "a pressure", (1, -1, -2, 0), "Pa", "210 GPa";
    STIFFNESS_PER_LENGTH stiffness_per_length: "a stiffness per length", (1, -1, -2, 0), "N/m^2", "2 MN/m^2";
    STIFFNESS_PER_AREA stiffness_per_area: "a stiffness per area", (1, -2, -2, 0), "N/m^3", "100 kN/m^3";
    DAMPING_PER_AREA damping_per_area: "a damping per area", (1, -2, -1, 0), "N s/m^3", "10 kN s/m^3";
    VISCOSITY viscosity: "a viscosity", (1, -1, -1, 0), "Pa s", "1.2e-3 Pa s";
    MOMENT moment: "a moment", (1, 2, -2, 0), "N m", "15 kN m";
    POWER power: "a power", (1, 2, -3, 0), "W", "30 kW";
    AXIAL_STIFFNESS axial_stiffness: "an axial stiffness", (1, 1, -2, 0), "N", "1.2 MN";
    BENDING_STIFFNESS bending_stiffness: "a bending stiffness", (1, 3, -2, 0), "N m^2", "2 N m^2";
    AXIAL_DAMPING axial_damping: "an axial damping", (1, 1, -1, 0), "N s", "10 kN s";
    BENDING_DAMPING bending_damping: "a bending damping", (1, 3, -1, 0), "N m^2 s", "0.1 N m^2 s";
    SPRING_STIFFNESS spring_stiffness: "a spring stiffness", (1, 0, -2, 0), "N/m", "5 kN/m";
    DAMPING damping: "a damping", (1, 0, -1, 0), "N s/m", "200 N s/m";
    ROTATIONAL_STIFFNESS rotational_stiffness: "a rotational stiffness", (1, 2, -2, 0), "N m/rad", "40 N m/deg";
    ROTATIONAL_DAMPING rotational_damping: "a rotational damping", (1, 2, -1, 0), "N m s/rad", "3 N m s/rad";
}

#[cfg(test)]
mod tests;
