//! What is known of the table around places that were looked at: of cells divided into spots those that stations were in.

use std::hash::Hasher;

/// Number of spots that are remembered, a power of two: few enough to stay in the cache.
const MOST: usize = 1 << 12;
/// Of no spot at all.
const NOWHERE: [i64; 3] = [i64::MIN; 3];

/// `N` numbers for each spot at an instant, which is told by its place along, downwards and in time.
#[derive(Clone, Debug)]
pub(super) struct Spots<const N: usize> {
    keys: Vec<[i64; 3]>,
    all: Vec<[f64; N]>,
}

impl<const N: usize> Spots<N> {
    pub fn new() -> Self {
        Spots { keys: vec![NOWHERE; MOST], all: vec![[0.0; N]; MOST] }
    }

    /// Where it is kept, and whether it was known already.
    pub fn find(&mut self, key: [i64; 3]) -> (usize, bool) {
        let mut mixed = Mixed::default();
        key[..2].iter().for_each(|k| mixed.write_i64(*k));
        // of the instants before and after a time each has a place of its own
        let place = (mixed.finish() ^ (key[2] & 1).cast_unsigned()) as usize % MOST;
        let known = self.keys[place] == key;
        self.keys[place] = key;
        (place, known)
    }

    pub fn numbers(&mut self, place: usize) -> &mut [f64; N] {
        &mut self.all[place]
    }
}

/// Numbers of places and instants, well mixed: they come from nobody who would wish them to meet.
#[derive(Clone, Debug, Default)]
pub(super) struct Mixed(u64);

impl Hasher for Mixed {
    fn finish(&self) -> u64 {
        self.0 ^ (self.0 >> 32)
    }
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|b| self.write_u64(u64::from(*b)));
    }
    fn write_u64(&mut self, x: u64) {
        self.0 = (self.0.rotate_left(23) ^ x).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    }
    fn write_i64(&mut self, x: i64) {
        self.write_u64(x.cast_unsigned());
    }
}
