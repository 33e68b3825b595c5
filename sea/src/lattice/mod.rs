//! The motion of the water in many waves from a table that is filled where it is looked at.
//!
//! A sum over 200 waves costs as much as a hundred elements of a cable. Its terms vary no faster than the shortest wave,
//! so that it can be interpolated between exact sums ([`sums`]). In the plane of the waves the flow is irrotational and free of
//! divergence, so that `f = u - i w` is an analytic function of `ζ = x' + i z`: two sums give it at a corner of a square cell, two
//! more its derivative, and a polynomial of degree 7 in `ζ` meets those of all four corners ([`cell`]). In time it is cubic
//! between instants `n τ`, by velocities and accelerations, of which the second are the rates of the first. Farther down, where
//! no short waves come, cells are larger. Of the polynomials in space what is around a station is kept, to second order, at both
//! instants ([`Stations`]), since a line moves little while the water goes from one to the other; what is left to do for a
//! station at a time are two polynomials ([`look`]).

mod cell;
mod look;
mod phases;
mod stations;
mod sums;

use crate::waves::{Component, Waves};
use cell::{Cell, Edge};
pub use look::Instant;
pub use stations::Stations;
use sums::Sums;

/// The smallest cells are this part of the shortest wave wide.
const SIZE: f64 = 1.0 / 2.5;
/// Instants are this part of the shortest period apart.
const TIME: f64 = 1.0 / 8.0;
/// The largest cells are `2^COARSEST` times as wide as the smallest.
const COARSEST: u32 = 10;
/// Spots in a cell, along and downwards.
const SPOTS: usize = 6;

/// The table of a sea whose waves have one direction. It has a memory of its own, and so is looked at by one at a time.
#[derive(Clone, Debug)]
pub struct Lattice {
    waves: Waves,
    way: [f64; 2],
    /// Speed of the current that carries them, along them [m/s].
    current: f64,
    /// Width of the smallest cells [m], distance of instants [s], and their number per second.
    size: f64,
    time: f64,
    per_time: f64,
    /// The depths from which on cells are `2^0, 2^1, …` times as wide [m].
    levels: Vec<f64>,
    /// Where nothing of the waves is left, or the bed is [m].
    bottom: f64,
    sums: Sums,
    cell: Cell,
    edge: Edge,
}

impl Lattice {
    /// The table of these waves, down to the bed, or to where nothing of them is left; `None` if they have more than one
    /// direction.
    ///
    /// `finer` divides its distances: the error falls with the fourth power.
    pub fn new(waves: Waves, finer: f64) -> Option<Self> {
        let way = waves.way()?;
        let size = SIZE * std::f64::consts::TAU / waves.shortest() / finer;
        let time = TIME * std::f64::consts::TAU / waves.fastest() / finer;
        // a factor of 1e-9 of the longest wave is nothing
        let longest = waves.all.iter().fold(f64::INFINITY, |m, c| c.k.min(m));
        let bottom = waves.depth().min(21.0 / longest);
        let current = waves.all.first().map_or(0.0, |c| (c.omega - c.sigma) / c.k);
        Some(Lattice {
            sums: Sums::new(&waves, [size, time]),
            levels: levels(&waves, size, bottom),
            way,
            current,
            size,
            time,
            per_time: 1.0 / time,
            bottom,
            cell: Cell::new(),
            edge: Edge::new(),
            waves,
        })
    }

    /// The waves themselves.
    pub fn waves(&self) -> &Waves {
        &self.waves
    }

    /// Number of places whose surface it holds.
    pub fn columns(&self) -> usize {
        self.sums.columns()
    }
}

/// The depths from which on cells may be twice as wide, and so on. The error of a wave grows with the eighth power of its
/// wavenumber and of their width, and is to be a quarter of that at the surface.
fn levels(waves: &Waves, size: f64, bottom: f64) -> Vec<f64> {
    let errors = |depth: f64| -> f64 {
        let of = |c: &Component| {
            c.a * c.sigma * c.depths(-depth, waves.depth())[0] * (c.k / waves.shortest()).powi(8)
        };
        waves.all.iter().map(|c| of(c).powi(2)).sum()
    };
    // of squares
    let (most, wider) = (0.25_f64.powi(2) * errors(0.0), 2.0_f64.powi(2 * 8));
    let (mut depth, mut all) = (0.0, vec![0.0]);
    for level in 1..=COARSEST {
        // on a line of the wider cells, so that these begin where the narrower ones end
        let wide = size * f64::from(1_u32 << level);
        depth = (depth / wide).ceil() * wide;
        while depth < bottom && errors(depth) * wider.powi(level as i32) > most {
            depth += wide;
        }
        if depth >= bottom {
            break;
        }
        all.push(depth);
    }
    all
}
