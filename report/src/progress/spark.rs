//! The course of one number as a line of blocks.

use std::fmt;

/// Blocks from lowest to highest.
const BLOCKS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
/// Blocks of a whole run.
const WIDTH: usize = 16;

/// What a record has been over the run so far, and what it is now.
#[derive(Debug)]
pub(super) struct Spark {
    name: String,
    unit: String,
    /// The last value of each part of the run; NaN where there is none yet.
    values: [f64; WIDTH],
    last: f64,
}

impl Spark {
    pub fn new(name: &str, unit: &str) -> Self {
        Self { name: name.into(), unit: unit.into(), values: [f64::NAN; WIDTH], last: f64::NAN }
    }

    /// Takes the value when this share of the run is done, 0 … 1.
    pub fn push(&mut self, share: f64, value: f64) {
        self.values[((share * WIDTH as f64) as usize).min(WIDTH - 1)] = value;
        self.last = value;
    }
}

impl fmt::Display for Spark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let finite = || self.values.iter().copied().filter(|x| x.is_finite());
        let (low, high) = finite().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        let block = |x: &f64| match (x - low) / (high - low) {
            _ if !x.is_finite() => ' ',
            share if share.is_finite() => BLOCKS[((share * 8.0) as usize).min(7)],
            // all are the same
            _ => BLOCKS[3],
        };
        let line: String = self.values.iter().map(block).collect();
        write!(f, "{} {} {} {}", self.name, line.trim_end(), super::Short(self.last), self.unit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_course_rises_from_the_lowest_block_to_the_highest() {
        let mut spark = Spark::new("hose.end.z", "m");
        for k in 0..=8 {
            spark.push(f64::from(k) / 16.0, f64::from(k) - 8.0);
        }
        assert_eq!(spark.to_string(), "hose.end.z ▁▂▃▄▅▆▇██ 0 m");
        spark.push(1.0, f64::NAN);
        assert_eq!(spark.to_string(), "hose.end.z ▁▂▃▄▅▆▇██ NaN m");
        let mut still = Spark::new("a", "N");
        still.push(0.0, 2.0);
        assert_eq!(still.to_string(), "a ▄ 2 N");
    }
}
