//! Quantities of which nobody has said yet what kind they are.

use super::{ALL, Dimension, number_end, unit};

/// A number with or without a unit, as somebody wrote it.
///
/// Use it for values that are handed on as text, such as parameters, where they are to be compared or shown; what
/// they have to be is up to whoever reads them at last.
///
/// ```
/// use ropewalk_quantity::Written;
/// let speed = Written::parse("36 km/h").unwrap();
/// assert_eq!((speed.number, speed.unit, speed.si), (36.0, "km/h", 10.0));
/// assert_eq!(speed.si_unit(), Some("m/s"));
/// assert_eq!(Written::parse("L4"), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Written<'a> {
    /// The number.
    pub number: f64,
    /// The unit; empty for a bare number.
    pub unit: &'a str,
    /// The quantity in SI units; of a bare number, the number.
    pub si: f64,
    /// Dimension of the unit; without exponents for a bare number, which may be of any kind.
    pub dimension: Dimension,
}

impl<'a> Written<'a> {
    /// Reads `25`, `25 kn` or `25kn`; none if it is anything else, or not finite.
    #[must_use]
    pub fn parse(text: &'a str) -> Option<Self> {
        let text = text.trim();
        let (number, rest) = text.split_at(number_end(text));
        let number: f64 = number.parse().ok()?;
        let rest = rest.trim();
        let (si, dimension) = match rest {
            "" => (number, Dimension::default()),
            _ => unit::parse(rest).map(|u| (u.to_si(number), u.dimension)).ok()?,
        };
        si.is_finite().then_some(Self { number, unit: rest, si, dimension })
    }

    /// The SI unit of its dimension, if a kind of quantity has it; `None` for a bare number.
    #[must_use]
    pub fn si_unit(&self) -> Option<&'static str> {
        let kind = ALL.iter().find(|k| k.dimension == self.dimension)?;
        (!self.unit.is_empty()).then_some(kind.unit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whatever_is_a_quantity_is_read() {
        for (text, number, unit, si, si_unit) in [
            ("40", 40.0, "", 40.0, None),
            (" -1.5e2 cm ", -150.0, "cm", -1.5, Some("m")),
            ("20 kN m", 20.0, "kN m", 2e4, Some("N m")),
            ("1 Hz", 1.0, "Hz", 1.0, Some("Hz")),
            ("1 rad/s", 1.0, "rad/s", 1.0, Some("rad/s")),
            ("50 %", 50.0, "%", 0.5, Some("")),
            ("1 m^7", 1.0, "m^7", 1.0, None),
        ] {
            let w = Written::parse(text).unwrap();
            assert_eq!((w.number, w.unit, w.si, w.si_unit()), (number, unit, si, si_unit));
        }
        for text in ["", "kn", "3e", "nan", "inf", "1e999", "5 nots", "1 2", "[1]", "\"5 kn\""] {
            assert_eq!(Written::parse(text), None, "{text}");
        }
    }
}
