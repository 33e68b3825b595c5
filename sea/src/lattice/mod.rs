//! The motion of the water in many waves from a table that is filled where it is looked at.
//!
//! A sum over 200 waves costs as much as a hundred elements of a cable. Its terms vary no faster than the shortest wave,
//! so that it can be interpolated: in space between lines `x' = i Δ` along the waves' direction and heights `z_j`, by
//! bicubic Hermite polynomials of velocities, and in time between instants `n τ`, by cubic ones of velocities and
//! accelerations, whose derivative is the acceleration. The table holds exact sums ([`columns`]). Farther down, where no
//! short waves come, its cells are larger. Of the polynomials in space what is around a station is kept, to second order, at
//! both instants ([`spots`], [`Stations`]), since a line moves little while the water goes from one to the other; what is left
//! to do for a station at a time are two polynomials ([`look`]).

mod columns;
mod look;
mod spots;

use crate::waves::{Component, Stretching, Waves};
use columns::Columns;
pub use look::Stations;
use spots::Spots;

/// A line of the table is this part of the shortest wave away from the next.
const ALONG: f64 = 0.2;
/// Heights near the surface are this part of the shortest wave apart.
const DOWN: f64 = 0.1;
/// Farther down they are this part of the depth below the surface apart: short waves don't reach there.
const GROWTH: f64 = 0.07;
/// Instants are this part of the shortest period apart.
const TIME: f64 = 1.0 / 12.0;
/// Lines are at most `2^COARSEST` times as far apart.
const COARSEST: f64 = 10.0;
/// Spots in a cell, along and downwards.
const SPOTS: f64 = 8.0;

/// The table of a sea whose waves have one direction. It has a memory of its own, and so is looked at by one at a time.
#[derive(Clone, Debug)]
pub struct Lattice {
    waves: Waves,
    way: [f64; 2],
    /// Speed of the current that carries them, along them [m/s].
    current: f64,
    /// Distance of lines [m], of instants [s].
    along: f64,
    time: f64,
    /// Heights [m], descending from the highest.
    heights: Vec<f64>,
    /// Below each height every `2^level`-th line counts.
    levels: Vec<u32>,
    columns: Columns,
    /// The surface at spots of lines, and the water there.
    edges: Spots<8>,
    spots: Spots<16>,
}

impl Lattice {
    /// The table of these waves, down to the bed, or to where nothing of them is left; `None` if they have more than one
    /// direction.
    ///
    /// `finer` divides its distances: the error falls with the fourth power.
    pub fn new(waves: Waves, finer: f64) -> Option<Self> {
        let way = waves.way()?;
        let length = std::f64::consts::TAU / waves.shortest();
        let time = TIME * std::f64::consts::TAU / waves.fastest() / finer;
        let top = match waves.stretching {
            // stretched to still water, but for rounding
            Stretching::Wheeler | Stretching::Constant => 0.0,
            Stretching::None => 6.0 * waves.deviation(),
        };
        let step = DOWN * length / finer;
        let mut heights = vec![top + 2.0 * step];
        let mut z = heights[0];
        // a factor of 1e-9 of the longest wave is nothing
        let longest = waves.all.iter().fold(f64::INFINITY, |m, c| c.k.min(m));
        let bottom = (-waves.depth()).max(-21.0 / longest);
        while z > bottom {
            z -= step.max(-GROWTH / finer * z);
            heights.push(z);
        }
        let current = waves.all.first().map_or(0.0, |c| (c.omega - c.sigma) / c.k);
        let along = ALONG * length / finer;
        let levels = heights.iter().map(|z| level(&waves, *z)).collect();
        Some(Lattice {
            columns: Columns::new(&waves, &heights, [along, time]),
            way,
            current,
            along,
            time,
            levels,
            heights,
            edges: Spots::new(),
            spots: Spots::new(),
            waves,
        })
    }

    /// The waves themselves.
    pub fn waves(&self) -> &Waves {
        &self.waves
    }

    /// Number of lines and instants whose surface it holds.
    pub fn columns(&self) -> usize {
        self.columns.len()
    }
}

/// How many times lines may be twice as far apart below a height for errors to be a quarter of those at the surface: that of a
/// wave grows with the fourth power of its wavenumber and of their distance.
fn level(waves: &Waves, z: f64) -> u32 {
    let errors = |z: f64| -> f64 {
        let of =
            |c: &Component| c.a * c.sigma * c.depths(z, waves.depth())[0] * (c.k / waves.shortest()).powi(4);
        waves.all.iter().map(|c| of(c).powi(2)).sum()
    };
    let gained = (0.0625 * errors(0.0) / errors(z.min(0.0))).log2() / 8.0;
    // no number at all where nothing moves
    if gained < COARSEST { gained.max(0.0) as u32 } else { COARSEST as u32 }
}

/// Cubic Hermite polynomials on 0 … 1: value and derivative at the start, value and derivative at the end.
fn hermite(x: f64) -> [f64; 4] {
    let (x2, rest) = (x * x, 1.0 - x);
    let s = x2 * (3.0 - 2.0 * x);
    [1.0 - s, x * rest * rest, s, -x2 * rest]
}

/// Their derivatives.
fn slopes(x: f64) -> [f64; 4] {
    let s = 6.0 * x * (1.0 - x);
    [-s, (1.0 - x) * (1.0 - 3.0 * x), s, x * (3.0 * x - 2.0)]
}
