//! Values drawn from ranges: `speed=5 kn..25 kn`, the same ones on every machine.

use super::fault::{Fault, quoted};
use super::vary::{Varied, fault};
use ropewalk_quantity::Written;

/// How values are drawn from ranges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampling {
    /// Number of samples.
    pub count: usize,
    /// Another seed, other samples.
    pub seed: u64,
    /// Whether each range is cut into as many equal parts as there are samples, and each part has one of them (McKay,
    /// Beckman & Conover 1979).
    pub latin: bool,
}

/// What values are drawn from.
struct Interval<'a> {
    from: f64,
    to: f64,
    /// Distance of the values that are drawn, if not all numbers are: `n=4..64:1` are whole numbers.
    step: Option<f64>,
    unit: &'a str,
}

impl Sampling {
    /// Reads `name=from..to` or `name=from..to:step`, and draws values of it; none if the text is no such range.
    ///
    /// What a parameter is given depends on its name, the seed and the number of the sample alone: of twice as many
    /// samples the first half is the same, unless they are those of a Latin hypercube.
    pub fn draw(&self, text: &str) -> Result<Option<Varied>, Fault> {
        let Some((name, value)) = text.split_once('=') else { return Ok(None) };
        let (name, value) = (name.trim(), value.trim());
        let wrong = |what: String| {
            fault(text, what, text.len() - value.len()..text.len()).with_help(
                "a range to draw from is `from..to`, as in `speed=5..25 kn`; `n=4..64:1` draws whole numbers",
            )
        };
        match interval(value).map_err(wrong)? {
            Some(_) if name.is_empty() => Err(fault(text, "there is no name before the `=`", 0..text.len())),
            Some(interval) => Ok(Some(Varied { name: name.into(), values: self.values(name, &interval) })),
            None => Ok(None),
        }
    }

    fn values(&self, name: &str, of: &Interval<'_>) -> Vec<String> {
        let mut random = Random::of(name, self.seed);
        let count = self.count;
        let shares: Vec<f64> = if self.latin {
            let mut parts: Vec<usize> = (0..count).collect();
            (1..count).rev().for_each(|k| parts.swap(k, random.below(k + 1)));
            parts.iter().map(|part| (*part as f64 + random.share()) / count as f64).collect()
        } else {
            (0..count).map(|_| random.share()).collect()
        };
        let value = |share: f64| {
            let x = match of.step {
                Some(step) => {
                    // an end that is missed by rounding is the end
                    let steps = ((of.to - of.from) / step + 1e-9).floor();
                    of.from + step * (share * (steps + 1.0)).floor().min(steps)
                }
                None => of.from + share * (of.to - of.from),
            };
            // 0.30000000000000004 is 0.3
            let x = format!("{x:.11e}").parse().unwrap_or(x);
            if of.unit.is_empty() { format!("{x}") } else { format!("{x} {}", of.unit) }
        };
        shares.into_iter().map(value).collect()
    }
}

/// Whether a value is a range to draw from, right or wrong.
pub(super) fn is_range(value: &str) -> bool {
    !matches!(interval(value), Ok(None))
}

/// Reads `from..to` or `from..to:step`; none if it is something else. Units may all be left to the last number.
fn interval(value: &str) -> Result<Option<Interval<'_>>, String> {
    let Some((from, rest)) = value.split_once("..") else { return Ok(None) };
    let (to, step) = rest.split_once(':').map_or((rest, None), |(to, step)| (to, Some(step)));
    let all = [Some(from), Some(to), step].map(|text| text.map(|text| Written::parse(text.trim())));
    let [Some(Some(from)), Some(Some(to)), step] = all else { return Ok(None) };
    let fail = |what: &str| Err(format!("{} {what}", quoted(value)));
    let step = match step {
        Some(None) => return fail("has no number behind its colon"),
        Some(step) => step,
        None => None,
    };
    let unit = step.map_or(to.unit, |s| s.unit);
    let units = [to.unit, from.unit];
    let (first, second) = (units[0], units[1]);
    if units.iter().any(|u| !u.is_empty() && *u != unit) || (first.is_empty() && !second.is_empty()) {
        return fail("is a range of different units");
    }
    if !(to.number > from.number) {
        return fail("is a range that ends before it begins");
    }
    let step = step.map(|s| s.number);
    if step.is_some_and(|s| !(s > 0.0 && s <= to.number - from.number)) {
        return fail("has a step that doesn't fit into it");
    }
    Ok(Some(Interval { from: from.number, to: to.number, step, unit }))
}

/// Random numbers that are the same everywhere: SplitMix64 (Steele, Lea & Flood 2014).
struct Random(u64);

impl Random {
    /// Those of a parameter: its name by FNV-1a.
    fn of(name: &str, seed: u64) -> Self {
        let hash = |h: u64, b: u8| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3);
        let name = name.bytes().fold(0xcbf2_9ce4_8422_2325, hash);
        // neighbouring seeds would else run through the same numbers, one behind the other
        Random(name ^ Random(seed).next())
    }
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    /// From 0 up to but without 1.
    fn share(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }
    /// A whole number below `n`.
    fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.next()) * n as u128) >> 64) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(text: &str, count: usize, seed: u64, latin: bool) -> Vec<String> {
        let sampling = Sampling { count, seed, latin };
        sampling.draw(text).unwrap_or_else(|fault| panic!("{fault}")).unwrap().values
    }

    fn numbers(values: &[String]) -> Vec<f64> {
        values.iter().map(|v| Written::parse(v).unwrap().number).collect()
    }

    #[test]
    fn the_generator_is_the_published_one() {
        // the first numbers for the seed 1234567, as the authors' own program prints them
        let mut random = Random(1_234_567);
        let first: Vec<u64> = (0..3).map(|_| random.next()).collect();
        assert_eq!(first, [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423]);
    }

    #[test]
    fn samples_are_the_same_everywhere_and_the_first_stay_when_there_are_more() {
        let few = drawn("speed=5 kn..25 kn", 3, 1, false);
        assert_eq!(few, drawn("speed = 5..25 kn", 5, 1, false)[..3]);
        assert!(few.iter().all(|v| v.ends_with(" kn")), "{few:?}");
        assert_ne!(few, drawn("speed=5..25 kn", 3, 2, false));
        // another name, other numbers: two parameters don't go together
        assert_ne!(numbers(&few), numbers(&drawn("start=5..25 s", 3, 1, false)));
    }

    #[test]
    fn samples_fill_their_range_evenly() {
        let n = 20_000;
        let x = numbers(&drawn("a=-1..3", n, 7, false));
        assert!(x.iter().all(|x| (-1.0..=3.0).contains(x)));
        let mean = x.iter().sum::<f64>() / n as f64;
        let variance = x.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n as f64;
        // five standard errors of each
        assert!((mean - 1.0).abs() < 5.0 * (16.0_f64 / 12.0 / n as f64).sqrt(), "{mean}");
        assert!((variance - 16.0 / 12.0).abs() < 0.05, "{variance}");
        // and two parameters are independent of each other
        let y = numbers(&drawn("b=-1..3", n, 7, false));
        let covariance = x.iter().zip(&y).map(|(x, y)| (x - 1.0) * (y - 1.0)).sum::<f64>() / n as f64;
        assert!(covariance.abs() < 0.05, "{covariance}");
    }

    #[test]
    fn a_latin_hypercube_has_one_sample_in_each_part() {
        let n = 200;
        for name in ["a", "b"] {
            let x = numbers(&drawn(&format!("{name}=10..30"), n, 3, true));
            let mut parts: Vec<usize> = x.iter().map(|x| ((x - 10.0) / 20.0 * n as f64) as usize).collect();
            assert_ne!(parts, (0..n).collect::<Vec<_>>());
            parts.sort_unstable();
            assert_eq!(parts, (0..n).collect::<Vec<_>>());
        }
    }

    #[test]
    fn steps_draw_from_a_list() {
        let x = numbers(&drawn("n=4..6:1", 3000, 1, false));
        for k in [4.0, 5.0, 6.0] {
            let share = x.iter().filter(|x| **x == k).count() as f64 / 3000.0;
            assert!((share - 1.0 / 3.0).abs() < 0.05, "{k}: {share}");
        }
        assert!(x.iter().all(|x| (4.0..=6.0).contains(x)));
        // a quarter of 50 parts is twelve and a half: the part at the border may fall to either side
        let last = drawn("a=0..0.3:0.1 m", 50, 1, true).iter().filter(|v| *v == "0.3 m").count();
        assert!((12..=13).contains(&last), "{last}");
    }

    #[test]
    fn what_is_no_range_is_left_alone_and_what_is_wrong_is_said() {
        let sampling = Sampling { count: 2, seed: 1, latin: false };
        for text in ["a=1,2", "a=1:2:1", "file=../a.csv", "a=b..c", "a", "a=1.."] {
            assert_eq!(sampling.draw(text), Ok(None), "{text}");
        }
        for (text, message) in [
            ("a=2..1", "`2..1` is a range that ends before it begins"),
            ("a=1..1", "ends before it begins"),
            ("a=1 m..2 s", "is a range of different units"),
            ("a=1 m..2", "is a range of different units"),
            ("a=1..2:x", "has no number behind its colon"),
            ("a=1..2:0", "has a step that doesn't fit into it"),
            ("a=1..2:5", "has a step that doesn't fit into it"),
            ("=1..2", "there is no name"),
        ] {
            let fault = sampling.draw(text).unwrap_err();
            assert!(fault.message.contains(message), "{fault}");
            assert_eq!(fault.place.as_ref().unwrap().file, "--vary");
        }
    }
}
