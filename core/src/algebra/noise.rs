//! Numbers without pattern that are the same on every machine: start vectors of iterations.

/// Marsaglia's xorshift (J. Statistical Software 8(14), 2003) with shifts 13, 7 and 17.
#[derive(Clone, Debug)]
pub(crate) struct Noise(u64);

impl Noise {
    /// A sequence of its own for every seed.
    pub fn new(seed: u32) -> Self {
        Noise(0x2545_F491_4F6C_DD1Du64.wrapping_mul(u64::from(seed) | 1))
    }

    /// The next number, between -1/2 and 1/2.
    pub fn draw(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    }
}

impl Default for Noise {
    fn default() -> Self {
        Noise::new(1)
    }
}
