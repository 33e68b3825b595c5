//! Mean, deviation and shape of a record, and the waves in it.

/// Moments and bounds of a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// Mean.
    pub mean: f64,
    /// Standard deviation, of the record itself (divided by its number of values).
    pub deviation: f64,
    /// Third central moment over the cube of the deviation: 0 of what is symmetric.
    pub skewness: f64,
    /// Fourth central moment over that of the deviation: 3 of what is Gaussian.
    pub kurtosis: f64,
    /// Least value.
    pub least: f64,
    /// Greatest value.
    pub greatest: f64,
}

impl Moments {
    /// Of a record; `None` if it is empty or holds what is no number.
    pub fn of(record: &[f64]) -> Option<Self> {
        if record.is_empty() || !record.iter().all(|x| x.is_finite()) {
            return None;
        }
        let n = record.len() as f64;
        let mean = record.iter().sum::<f64>() / n;
        let central = |power: i32| record.iter().map(|x| (x - mean).powi(power)).sum::<f64>() / n;
        let variance = central(2);
        let deviation = variance.sqrt();
        let shape = |power| if variance > 0.0 { central(power) / deviation.powi(power) } else { 0.0 };
        Some(Moments {
            mean,
            deviation,
            skewness: shape(3),
            kurtosis: shape(4),
            least: record.iter().copied().fold(f64::INFINITY, f64::min),
            greatest: record.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        })
    }
}

/// The waves of a record between its upward crossings of the mean.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossings {
    /// Instants of the crossings, interpolated [s].
    pub times: Vec<f64>,
    /// Range from the lowest to the highest value between each and the next.
    pub ranges: Vec<f64>,
}

impl Crossings {
    /// Of a record with values at intervals `dt` [s].
    pub fn of(record: &[f64], dt: f64) -> Self {
        let mean = record.iter().sum::<f64>() / record.len().max(1) as f64;
        let (mut times, mut ranges) = (Vec::new(), Vec::new());
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (k, w) in record.windows(2).enumerate() {
            let (a, b) = (w[0] - mean, w[1] - mean);
            if a < 0.0 && b >= 0.0 {
                if !times.is_empty() {
                    ranges.push(high - low);
                }
                times.push(dt * (k as f64 + a / (a - b)));
                (low, high) = (f64::INFINITY, f64::NEG_INFINITY);
            }
            (low, high) = (low.min(b), high.max(b));
        }
        Crossings { times, ranges }
    }

    /// Mean period between crossings [s].
    pub fn period(&self) -> Option<f64> {
        let (first, last) = (self.times.first()?, self.times.last()?);
        (self.times.len() > 1).then(|| (last - first) / (self.times.len() - 1) as f64)
    }

    /// The mean of the largest third of the ranges: the significant range, of a sea its significant height.
    pub fn significant_range(&self) -> Option<f64> {
        let mut all = self.ranges.clone();
        all.sort_by(|a, b| b.total_cmp(a));
        let third = all.len().div_ceil(3);
        (third > 0).then(|| all[..third].iter().sum::<f64>() / third as f64)
    }
}
