//! Sines and cosines of the phases of all waves along a row of equal steps: of lines side by side, or of instants.
//!
//! A sine costs as much as a dozen products. So those of few places are found, `APART` steps apart, and of the steps between
//! them; all others are their products, the same whatever was asked for before.

use rustc_hash::FxHashMap;
use std::collections::hash_map::Entry;

/// Numbers of each wave, side by side, from the longest to the shortest; filled up with noughts to as many as lanes take.
pub(super) type Row = Vec<f64>;

/// Sines and cosines of the phase of each wave.
pub(super) type Phases = [Row; 2];

/// So many steps lie between places whose sines are found.
const APART: i64 = 16;
/// As many of these as are remembered.
const MOST: usize = 512;

/// The phases `first + i step` of each wave.
#[derive(Clone, Debug)]
pub(super) struct Steps {
    first: Row,
    step: Row,
    known: FxHashMap<i64, Phases>,
    /// Of each `APART`th place, and of the steps from there.
    coarse: FxHashMap<i64, Phases>,
    fine: FxHashMap<i64, Phases>,
}

impl Steps {
    pub fn new(first: Row, step: Row) -> Self {
        let none = FxHashMap::default;
        Steps { first, step, known: none(), coarse: none(), fine: none() }
    }

    /// Number of places whose phases are known.
    pub fn len(&self) -> usize {
        self.known.len()
    }

    pub fn clear(&mut self) {
        self.known.clear();
    }

    /// Forgets all places but these.
    pub fn retain(&mut self, keeps: impl Fn(i64) -> bool) {
        self.known.retain(|i, _| keeps(*i));
    }

    /// Finds the phases at a place.
    pub fn meet(&mut self, i: i64) {
        let Entry::Vacant(place) = self.known.entry(i) else { return };
        if self.coarse.len() > MOST {
            self.coarse.clear();
        }
        let (far, near) = (i.div_euclid(APART), i.rem_euclid(APART));
        let found = |from: Option<&Row>, steps: i64| -> Phases {
            let phase = |c: usize| from.map_or(0.0, |first| first[c]) + self.step[c] * steps as f64;
            let (sin, cos) = (0..self.step.len()).map(|c| phase(c).sin_cos()).unzip();
            [filled(sin), filled(cos)]
        };
        let [s, c] = &*self.coarse.entry(far).or_insert_with(|| found(Some(&self.first), far * APART));
        let [ds, dc] = &*self.fine.entry(near).or_insert_with(|| found(None, near));
        let pairs = || s.iter().zip(c).zip(ds.iter().zip(dc));
        let sin = pairs().map(|((s, c), (ds, dc))| s * dc + c * ds).collect();
        let cos = pairs().map(|((s, c), (ds, dc))| c * dc - s * ds).collect();
        place.insert([sin, cos]);
    }

    /// The phases at a place that was met.
    pub fn at(&self, i: i64) -> &Phases {
        &self.known[&i]
    }
}

/// A row filled up with noughts.
pub(super) fn filled(mut row: Row) -> Row {
    row.resize(row.len().next_multiple_of(8), 0.0);
    row
}
