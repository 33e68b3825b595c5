//! What is known of the table around places that were looked at: of cells divided into spots those that stations were in.

use ropewalk_core::Real;
use std::hash::Hasher;

/// Number of spots that are remembered, a power of two.
const MOST: usize = 1 << 14;
/// Of no spot at all.
const NOWHERE: [i64; 3] = [i64::MIN; 3];

/// `N` numbers for each spot, which is told by its place along, downwards and in time.
#[derive(Clone, Debug)]
pub(super) struct Spots<const N: usize> {
    /// Which one it is, and who looked at it last.
    keys: Vec<([i64; 3], u64)>,
    all: Vec<[f64; N]>,
    looks: u64,
}

impl<const N: usize> Spots<N> {
    pub fn new() -> Self {
        Spots { keys: vec![(NOWHERE, 0); MOST], all: vec![[0.0; N]; MOST], looks: 0 }
    }

    /// Begins to look at several at once, which don't put one another out.
    pub fn begin(&mut self) {
        self.looks += 1;
    }

    /// Where it is kept, and whether it was known already.
    #[inline(always)]
    pub fn find(&mut self, key: [i64; 3]) -> (usize, bool) {
        let mut mixed = Mixed::default();
        key[..2].iter().for_each(|k| mixed.write_i64(*k));
        let mut place = mixed.finish() as usize % MOST;
        loop {
            let (own, look) = &mut self.keys[place];
            if *own == key {
                *look = self.looks;
                return (place, true);
            }
            if *look != self.looks {
                (*own, *look) = (key, self.looks);
                return (place, false);
            }
            place = (place + 1) % MOST;
        }
    }

    pub fn put(&mut self, place: usize, numbers: [f64; N]) {
        self.all[place] = numbers;
    }

    /// Four numbers of each of some spots, from the `4 k`-th on.
    #[inline(always)]
    pub fn four<R: Real>(&self, places: &[usize; 8], k: usize) -> [R; 4] {
        R::from_rows(
            #[inline(always)]
            |lane| {
                let all = &self.all[places[lane]];
                [all[4 * k], all[4 * k + 1], all[4 * k + 2], all[4 * k + 3]]
            },
        )
    }
}

/// Numbers of places and instants, well mixed: they come from nobody who would wish them to meet.
#[derive(Clone, Debug, Default)]
pub(super) struct Mixed(u64);

impl Hasher for Mixed {
    #[inline(always)]
    fn finish(&self) -> u64 {
        self.0 ^ (self.0 >> 32)
    }
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|b| self.write_u64(u64::from(*b)));
    }
    #[inline(always)]
    fn write_u64(&mut self, x: u64) {
        self.0 = (self.0.rotate_left(23) ^ x).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    }
    #[inline(always)]
    fn write_i64(&mut self, x: i64) {
        self.write_u64(x.cast_unsigned());
    }
}
