//! Largest values that a record would show if it went on, or were made anew.

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

/// The most probable largest of `n` peaks of a narrow-banded Gaussian process of this deviation, above its mean (Rayleigh).
pub fn most_probable_maximum(deviation: f64, n: f64) -> f64 {
    deviation * (2.0 * n.ln()).sqrt()
}

/// The expected largest of them.
pub fn expected_maximum(deviation: f64, n: f64) -> f64 {
    let u = (2.0 * n.ln()).sqrt();
    deviation * (u + EULER / u)
}

/// What the largest of them stays below with this probability.
pub fn quantile_of_maximum(deviation: f64, n: f64, probability: f64) -> f64 {
    deviation * (-2.0 * (-(probability.ln() / n).exp_m1()).ln()).sqrt()
}

/// A distribution of largest values: `P(x) = exp(-exp(-(x - location)/scale))`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gumbel {
    /// Its most probable value.
    pub location: f64,
    /// How wide it is.
    pub scale: f64,
}

/// A value, and between what it lies with some confidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The estimate.
    pub value: f64,
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

impl Gumbel {
    /// From the largest values of several runs, by L-moments; `None` of less than two.
    pub fn by_l_moments(largest: &[f64]) -> Option<Self> {
        let n = largest.len() as f64;
        if largest.len() < 2 || !largest.iter().all(|x| x.is_finite()) {
            return None;
        }
        let mut sorted = largest.to_vec();
        sorted.sort_by(f64::total_cmp);
        let mean = sorted.iter().sum::<f64>() / n;
        let weighted: f64 = sorted.iter().enumerate().map(|(k, x)| k as f64 / (n - 1.0) * x).sum::<f64>() / n;
        let scale = (2.0 * weighted - mean) / std::f64::consts::LN_2;
        Some(Gumbel { location: mean - EULER * scale, scale })
    }

    /// By mean and standard deviation (divided by `n - 1`); `None` of less than two.
    pub fn by_moments(largest: &[f64]) -> Option<Self> {
        let n = largest.len() as f64;
        if largest.len() < 2 || !largest.iter().all(|x| x.is_finite()) {
            return None;
        }
        let mean = largest.iter().sum::<f64>() / n;
        let variance = largest.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0);
        let scale = (6.0 * variance).sqrt() / std::f64::consts::PI;
        Some(Gumbel { location: mean - EULER * scale, scale })
    }

    /// By maximum likelihood: Newton's method on the equation for the scale, from that of the moments.
    pub fn by_likelihood(largest: &[f64]) -> Option<Self> {
        let start = Self::by_moments(largest)?;
        let n = largest.len() as f64;
        let mean = largest.iter().sum::<f64>() / n;
        let mut scale = start.scale;
        for _ in 0..100 {
            // weights relative to the mean, so that none overflows
            let weight = |x: f64| (-(x - mean) / scale).exp();
            let sums = largest.iter().fold([0.0; 3], |[a, b, c], &x| {
                let (w, d) = (weight(x), x - mean);
                [a + w, b + d * w, c + d * d * w]
            });
            let f = scale + sums[1] / sums[0];
            let slope = 1.0 + (sums[2] / sums[0] - (sums[1] / sums[0]).powi(2)) / (scale * scale);
            let next = scale - f / slope;
            let moved = (next - scale).abs();
            scale = if next > 0.0 { next } else { 0.5 * scale };
            if moved <= 1e-14 * scale {
                break;
            }
        }
        let sum: f64 = largest.iter().map(|x| (-(x - mean) / scale).exp()).sum();
        Some(Gumbel { location: mean - scale * (sum / n).ln(), scale })
    }

    /// What a largest value stays below with this probability.
    pub fn quantile(&self, probability: f64) -> f64 {
        self.location - self.scale * (-probability.ln()).ln()
    }

    /// A quantile of the distribution by L-moments, with the interval that holds it with this confidence: from samples drawn
    /// anew out of the given ones (bootstrap), always the same ones.
    pub fn bootstrap(largest: &[f64], probability: f64, confidence: f64) -> Option<Interval> {
        const DRAWS: usize = 2000;
        let value = Self::by_l_moments(largest)?.quantile(probability);
        let mut state = 0x5EED_u64;
        // a linear congruential generator does for choosing among a few (Knuth's MMIX)
        let mut below = |n: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) as usize) % n
        };
        let mut all: Vec<f64> = (0..DRAWS)
            .filter_map(|_| {
                let drawn: Vec<f64> = largest.iter().map(|_| largest[below(largest.len())]).collect();
                Some(Self::by_l_moments(&drawn)?.quantile(probability))
            })
            .collect();
        all.sort_by(f64::total_cmp);
        let at = |p: f64| all[((p * (all.len() - 1) as f64).round() as usize).min(all.len() - 1)];
        Some(Interval { value, low: at(0.5 * (1.0 - confidence)), high: at(0.5 * (1.0 + confidence)) })
    }
}
