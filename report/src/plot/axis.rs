//! One axis of a plot: its span, linear or logarithmic, and the numbers at it.

use super::canvas::text_width;

/// Larger numbers would overflow in the arithmetic of an axis; they are left out like NaN.
const LARGEST: f64 = 1e300;
/// Data that vary less than this, relative to their size, are drawn as constant.
const SAME: f64 = 1e-10;

/// A span of numbers in the plot's own coordinate: the value, or its decimal logarithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Axis {
    log: bool,
    low: f64,
    high: f64,
}

/// A number at an axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tick {
    /// Place on the axis, 0 … 1.
    pub(super) at: f64,
    pub(super) label: String,
}

/// All numbers at an axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Ticks {
    pub(super) major: Vec<Tick>,
    /// Places of grid lines without a number.
    pub(super) minor: Vec<f64>,
    /// A power of ten that all labels are to be multiplied with, such as "×10⁶".
    pub(super) factor: Option<String>,
}

impl Ticks {
    /// Width of the widest label.
    pub(super) fn label_width(&self, size: f64) -> f64 {
        let widths = self.major.iter().map(|tick| text_width(&tick.label, size));
        widths.fold(0.0, f64::max)
    }
}

impl Axis {
    /// The axis that shows all `values`, with `margin` (a share of the span) on both sides; `None`
    /// if none of them can be shown.
    pub(super) fn covering(values: impl Iterator<Item = f64>, log: bool, margin: f64) -> Option<Self> {
        let (low, high) = values
            .filter_map(|value| coordinate(value, log))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), u| (low.min(u), high.max(u)));
        if low > high {
            return None;
        }
        let span = high - low;
        let size = low.abs().max(high.abs());
        let widen = if span > SAME * size && span > 1.0 / LARGEST {
            margin * span
        } else if log {
            0.5
        } else if size > 1.0 / LARGEST {
            0.1 * size
        } else {
            1.0
        };
        Some(Self { log, low: low - widen, high: high + widen })
    }

    /// Length in the plot's own coordinate.
    pub(super) fn span(&self) -> f64 {
        self.high - self.low
    }

    /// Widens the axis about its middle to this span.
    pub(super) fn widen_to(&mut self, span: f64) {
        let extra = 0.5 * (span - self.span());
        if extra > 0.0 {
            self.low -= extra;
            self.high += extra;
        }
    }

    /// Place of a value on the axis, 0 … 1; `None` if it can't be shown.
    pub(super) fn place(&self, value: f64) -> Option<f64> {
        coordinate(value, self.log).map(|u| self.place_of(u))
    }

    /// About `count` numbers, and at least two where that is possible, or no scale could be read.
    pub(super) fn ticks(&self, count: usize) -> Ticks {
        let mut ticks = Ticks::default();
        for count in count.max(2)..count.max(2) + 8 {
            ticks = self.ticks_near(count);
            if ticks.major.len() >= 2 {
                break;
            }
        }
        ticks
    }

    fn ticks_near(&self, count: usize) -> Ticks {
        if !self.log {
            return self.linear_ticks(count);
        }
        let decades = self.high.floor() - self.low.ceil();
        if decades >= 1.0 { self.decade_ticks(count) } else { self.fraction_ticks(count) }
    }

    fn place_of(&self, u: f64) -> f64 {
        (u - self.low) / self.span()
    }

    fn linear_ticks(&self, count: usize) -> Ticks {
        let step = round_step(self.span() / count as f64);
        let values = multiples(step, self.low, self.high);
        let largest = values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        let power = common_power(largest);
        let unit = 10_f64.powi(power);
        let decimals = decimals_of(step / unit);
        Ticks {
            major: values
                .iter()
                .map(|value| Tick { at: self.place_of(*value), label: fixed(value / unit, decimals) })
                .collect(),
            minor: Vec::new(),
            factor: (power != 0).then(|| format!("×{}", power_of_ten(power))),
        }
    }

    fn decade_ticks(&self, count: usize) -> Ticks {
        let (first, last) = (self.low.ceil() as i32, self.high.floor() as i32);
        let stride = ((last - first) as usize / count + 1) as i32;
        let plain = first >= -3 && last <= 4;
        let label = |power: i32| match plain {
            true => fixed(10_f64.powi(power), (-power).max(0) as usize),
            false => power_of_ten(power),
        };
        let major = (first..=last)
            .filter(|power| power.rem_euclid(stride) == 0)
            .map(|power| Tick { at: self.place_of(f64::from(power)), label: label(power) })
            .collect();
        let parts = if stride == 1 && last - first <= 8 { 2..10 } else { 1..2 };
        let minor = (first - 1..=last)
            .flat_map(|power| parts.clone().map(move |m| (power, m)))
            .filter(|(power, m)| *m > 1 || power.rem_euclid(stride) != 0)
            .map(|(power, m)| self.place_of(f64::from(power) + f64::from(m).log10()))
            .filter(|at| (0.0..=1.0).contains(at))
            .collect();
        Ticks { major, minor, factor: None }
    }

    /// Round values on a logarithmic axis that spans less than a decade or two.
    fn fraction_ticks(&self, count: usize) -> Ticks {
        let power = self.low.floor();
        let unit = 10_f64.powf(power);
        let (low, high) = (10_f64.powf(self.low - power), 10_f64.powf(self.high - power));
        let candidates = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0];
        let mut values: Vec<f64> = candidates
            .into_iter()
            .filter(|v| (low * (1.0 - 1e-9)..=high * (1.0 + 1e-9)).contains(v))
            .collect();
        let mut decimals = 0;
        if values.len() < 3 {
            let step = round_step((high - low) / count as f64);
            decimals = decimals_of(step);
            values = multiples(step, low, high);
        }
        let plain = (-3.0..=4.0).contains(&power);
        let major = values
            .into_iter()
            .map(|value| Tick {
                at: self.place_of(value.log10() + power),
                label: if plain {
                    let decimals = (decimals as f64 - power).max(0.0) as usize;
                    fixed(value * unit, decimals)
                } else {
                    format!("{}×{}", fixed(value, decimals), power_of_ten(power as i32))
                },
            })
            .collect();
        Ticks { major, minor: Vec::new(), factor: None }
    }
}

fn coordinate(value: f64, log: bool) -> Option<f64> {
    if !value.is_finite() || value.abs() > LARGEST {
        None
    } else if !log {
        Some(value)
    } else {
        (value > 0.0).then(|| value.log10())
    }
}

/// The least of 1, 2, 2.5 and 5 times a power of ten that isn't below `rough`.
fn round_step(rough: f64) -> f64 {
    let power = rough.log10().floor();
    let part = rough / 10_f64.powf(power);
    let digit = [1.0, 2.0, 2.5, 5.0].into_iter().find(|d| part <= *d);
    digit.unwrap_or(10.0) * 10_f64.powi(power as i32)
}

fn multiples(step: f64, low: f64, high: f64) -> Vec<f64> {
    let first = (low / step - 1e-6).ceil();
    let last = (high / step + 1e-6).floor();
    // Bounded, should rounding ever let the steps vanish against the values.
    let count = ((last - first + 1.0).max(0.0) as usize).min(100);
    (0..count).map(|i| (first + i as f64) * step).collect()
}

/// The power of ten to take out of labels that would be long otherwise.
fn common_power(largest: f64) -> i32 {
    if largest == 0.0 || (1e-2..1e5).contains(&largest) {
        return 0;
    }
    // Thousands, as in units with prefixes.
    let power = (largest.log10() + 1e-9).floor() as i32;
    power.div_euclid(3) * 3
}

/// Decimals that multiples of this round step have.
fn decimals_of(step: f64) -> usize {
    let is_whole = |decimals: &usize| {
        let value = step * 10_f64.powi(*decimals as i32);
        value > 0.5 && (value - value.round()).abs() < 1e-3 * value
    };
    (0..15).find(is_whole).unwrap_or(15)
}

fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| c == '0' || c == '.') => digits.into(),
        Some(digits) => format!("−{digits}"),
        None => text,
    }
}

fn power_of_ten(power: i32) -> String {
    let mut text = String::from("10");
    for c in power.to_string().chars() {
        text.push(match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            '0' => '⁰',
            // The superscripts four to nine follow each other in Unicode.
            c => c.to_digit(10).and_then(|d| char::from_u32(0x2070 + d)).unwrap_or(c),
        });
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(low: f64, high: f64, log: bool) -> Axis {
        Axis::covering([low, high].into_iter(), log, 0.0).unwrap()
    }

    fn labels(low: f64, high: f64, log: bool) -> (String, Option<String>) {
        let ticks = axis(low, high, log).ticks(6);
        assert!(ticks.major.iter().all(|t| (-1e-6..=1.0 + 1e-6).contains(&t.at)));
        let labels: Vec<_> = ticks.major.into_iter().map(|t| t.label).collect();
        (labels.join(" "), ticks.factor)
    }

    #[test]
    fn linear_numbers_are_round() {
        assert_eq!(labels(0.0, 10.0, false), ("0 2 4 6 8 10".into(), None));
        assert_eq!(labels(-0.3, 0.31, false), ("−0.2 0.0 0.2".into(), None));
        assert_eq!(labels(1000.0, 1000.01, false).0, "1000.000 1000.002 1000.004 1000.006 1000.008 1000.010");
        let far = |low, high| labels(low, high, false);
        assert_eq!(far(0.0, 2.5e6), ("0.0 0.5 1.0 1.5 2.0 2.5".into(), Some("×10⁶".into())));
        assert_eq!(far(-4e-5, 0.0), ("−40 −30 −20 −10 0".into(), Some("×10⁻⁶".into())));
        assert_eq!(far(0.0, 1.2e-12).1, Some("×10⁻¹²".into()));
    }

    #[test]
    fn logarithmic_numbers_are_decades_or_round_parts() {
        assert_eq!(labels(1e-3, 1.0, true).0, "0.001 0.01 0.1 1");
        assert_eq!(labels(1e-9, 1e-5, true).0, "10⁻⁹ 10⁻⁸ 10⁻⁷ 10⁻⁶ 10⁻⁵");
        assert_eq!(labels(0.02, 0.3, true).0, "0.02 0.05 0.10 0.20");
        assert_eq!(labels(2e-7, 6e-7, true).0, "2×10⁻⁷ 3×10⁻⁷ 4×10⁻⁷ 5×10⁻⁷ 6×10⁻⁷");
        let wide = axis(1e-200, 1e200, true).ticks(6);
        assert!(wide.major.len() <= 7);
        assert!(labels(1.0, 1.02, true).0.starts_with("1.000 1.005"));
    }

    #[test]
    fn constant_and_extreme_data_have_an_axis() {
        for (value, log) in [(0.0, false), (5.0, false), (-1e299, false), (5e-324, false), (1e-5, true)] {
            let axis = Axis::covering([value, f64::NAN].into_iter(), log, 0.05).unwrap();
            assert!((axis.place(value).unwrap() - 0.5).abs() < 1e-9);
            let count = axis.ticks(6).major.len();
            assert!((1..=8).contains(&count), "{value}: {count}");
        }
        assert!(Axis::covering([f64::NAN, f64::INFINITY].into_iter(), false, 0.0).is_none());
        assert!(Axis::covering([0.0, -1.0].into_iter(), true, 0.0).is_none());
    }

    #[test]
    fn any_span_gets_few_labels() {
        for exponent in -100..100 {
            for low in [-1.0, 0.0, 0.37, 12.3] {
                let unit = 10_f64.powi(exponent);
                let ticks = axis(low * unit, (low + 1.7) * unit, false).ticks(6);
                assert!((3..=7).contains(&ticks.major.len()));
                assert!(ticks.major.iter().all(|t| t.label.chars().count() <= 6));
            }
        }
    }
}
