//! What a thread has found of a sea lately: many laws ask for the same, and lines move little from one step to the next.
//!
//! Each thread has its own, so that nobody waits and no lock is taken at every station. Answers don't depend on it.

use super::Sea;
use ropewalk_core::{Real, Station};
use ropewalk_sea::{Lattice, Stations};
use rustc_hash::FxHashMap;
use std::cell::Cell;
use std::sync::{Arc, Weak};

/// Most packs that are remembered.
const PACKS: usize = 4096;
/// As many lanes as the widest carrier has.
pub(super) const MOST: usize = 8;
/// A station's pack keeps its slot while its first place stays in a cell of this size [m].
const CELL: f64 = 16.0;
/// In place of a cell where stations say who they are.
const NAMED: u64 = 0;
/// Numbers about as large as this have no places for fractions.
const WHOLE: f64 = (3_u64 << 51) as f64;

/// Numbers that tell the motion at places side by side, in the order of [`Swell`](super::Swell).
pub(super) type Rows = [[f64; MOST]; 43];
pub(super) type Places = [[f64; MOST]; 3];
/// What packs are told apart by.
pub(super) type Key = (u64, u64, u64);

thread_local! {
    /// Of the sea that was asked last, and of others.
    static LAST: Cell<Option<Box<Memory>>> = const { Cell::new(None) };
    static OTHERS: Cell<Vec<Memory>> = const { Cell::new(Vec::new()) };
}

/// What was found lately, and the table that stands for many waves.
pub(super) struct Memory {
    /// Of which sea, as long as there is that.
    of: Weak<()>,
    pub lattice: Option<Lattice>,
    /// The slot of each pack: the same as the last time, if what asks has moved little.
    slots: FxHashMap<Key, usize>,
    keys: Vec<Key>,
    /// The slot of who asked last, and of who asked after each of them.
    last: usize,
    after: Vec<usize>,
    pub packs: Vec<Found>,
    /// What is known of the table at each of them.
    pub stations: Vec<Stations>,
}

/// The motion at places side by side, number by number over all of them: several laws ask for the same, one after the other.
pub(super) struct Found {
    pub t: f64,
    pub lanes: usize,
    pub at: Places,
    pub rows: Rows,
}

impl Memory {
    /// This thread's own of a sea, to be [kept](Memory::keep) again.
    #[inline(always)]
    pub fn of(sea: &Sea) -> Box<Self> {
        match LAST.take() {
            Some(memory) if memory.of.as_ptr() == Arc::as_ptr(&sea.alive) => memory,
            other => Self::of_another(sea, other),
        }
    }

    /// Who panics before has to find everything again.
    #[inline(always)]
    pub fn keep(self: Box<Self>) {
        LAST.set(Some(self));
    }

    #[inline(never)]
    fn of_another(sea: &Sea, last: Option<Box<Self>>) -> Box<Self> {
        let mut others = OTHERS.take();
        others.extend(last.map(|memory| *memory));
        others.retain(|memory| memory.of.strong_count() > 0);
        let own = others.iter().position(|memory| memory.of.as_ptr() == Arc::as_ptr(&sea.alive));
        let memory = own.map(|own| others.swap_remove(own));
        OTHERS.set(others);
        Box::new(memory.unwrap_or_else(|| Memory {
            of: Arc::downgrade(&sea.alive),
            lattice: sea.lattice.clone(),
            slots: FxHashMap::default(),
            keys: Vec::new(),
            last: 0,
            after: Vec::new(),
            packs: Vec::new(),
            stations: Vec::new(),
        }))
    }

    /// The slot of a pack.
    #[inline(always)]
    pub fn slot(&mut self, key: Key) -> usize {
        // they mostly ask in the same order
        let next = self.after.get(self.last).copied().unwrap_or(0);
        self.last = if self.keys.get(next) == Some(&key) { next } else { self.slot_of(key) };
        self.last
    }

    #[inline(never)]
    fn slot_of(&mut self, key: Key) -> usize {
        if self.keys.get(self.last) == Some(&key) {
            return self.last;
        }
        let slot = if let Some(&slot) = self.slots.get(&key) { slot } else { self.new_slot(key) };
        if let Some(after) = self.after.get_mut(self.last) {
            *after = slot;
        }
        slot
    }

    fn new_slot(&mut self, key: Key) -> usize {
        if self.packs.len() >= PACKS {
            self.slots.clear();
            self.keys.clear();
            self.after.clear();
            self.packs.clear();
            self.stations.clear();
        }
        let slot = self.packs.len();
        self.slots.insert(key, slot);
        self.keys.push(key);
        // whoever comes next is new, too
        self.after.push(slot + 1);
        self.packs.push(Found::nothing());
        self.stations.push(Stations::default());
        slot
    }
}

impl Found {
    fn nothing() -> Self {
        Found { t: f64::NAN, lanes: 0, at: [[f64::NAN; MOST]; 3], rows: [[0.0; MOST]; 43] }
    }

    /// Whether it is that of these places at this time; what is no number is never found.
    #[inline(always)]
    pub fn is(&self, t: f64, lanes: usize, places: &Places) -> bool {
        let mut same = (self.t, self.lanes) == (t, lanes);
        for i in 0..3 {
            for lane in 0..MOST {
                same &= self.at[i][lane] == places[i][lane];
            }
        }
        same
    }
}

/// What tells stations apart. Those of which nobody says who they are have other arc lengths on the same body, and bodies are
/// elsewhere.
#[inline(always)]
pub(super) fn key_of<R: Real>(at: &Station<R>) -> Key {
    if at.who > 0 {
        return (at.who as u64, R::LANES as u64, NAMED);
    }
    // what is added leaves the number of the cell in the last bits
    let [x, y] = [at.x[0], at.x[1]].map(|x| (x.lane(0) * (1.0 / CELL) + WHOLE).to_bits());
    let place = x.rotate_left(32) ^ y;
    (at.s.lane(0).to_bits(), at.diameter.lane(0).to_bits(), place)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_side_by_side_have_slots_of_their_own_and_keep_them_as_they_move() {
        let none = [0.0; 3];
        let at = |x: f64, who: usize| Station {
            x: [x, 0.0, -5.0],
            v: none,
            a: none,
            slope: [1.0, 0.0, 0.0],
            slope_rate: none,
            s: 2.0,
            weight: 1.0,
            before: 0.5,
            element: 4.0,
            diameter: 0.1,
            area: 0.01,
            who,
        };
        assert_ne!(key_of(&at(0.0, 1)), key_of(&at(1.0, 2)));
        assert_eq!(key_of(&at(0.0, 1)), key_of(&at(100.0, 1)));
        // of whom nothing is known
        assert_ne!(key_of(&at(0.0, 0)), key_of(&at(100.0, 0)));
    }
}
