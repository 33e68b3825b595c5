//! Repeatable random numbers.

/// A linear congruential generator.
pub struct Random(pub u64);

impl Random {
    /// A number between -`size` and `size`.
    pub fn number(&mut self, size: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        size * ((self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
    }
    /// A vector whose components are between `size`/4 and `size`, of either sign.
    pub fn vector(&mut self, size: f64) -> [f64; 3] {
        std::array::from_fn(|_| {
            let x = self.number(0.75 * size);
            x + (0.25 * size).copysign(x)
        })
    }
    /// So many numbers.
    pub fn list(&mut self, n: usize, size: f64) -> Vec<f64> {
        (0..n).map(|_| self.number(size)).collect()
    }
}

/// Turns `u` by the rotation vector `theta` (Rodrigues).
pub fn rotate(theta: [f64; 3], u: [f64; 3]) -> [f64; 3] {
    let angle = theta.iter().map(|x| x * x).sum::<f64>().sqrt();
    let k = theta.map(|x| x / angle);
    let cross = [k[1] * u[2] - k[2] * u[1], k[2] * u[0] - k[0] * u[2], k[0] * u[1] - k[1] * u[0]];
    let along: f64 = (0..3).map(|i| k[i] * u[i]).sum();
    let (sin, cos) = angle.sin_cos();
    std::array::from_fn(|i| u[i] * cos + cross[i] * sin + k[i] * along * (1.0 - cos))
}
