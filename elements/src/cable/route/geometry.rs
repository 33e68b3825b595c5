//! The shortest taut line along a route: tangents of its wheels, found from the route alone.

use ropewalk_core::rotation::cross;
use ropewalk_core::{V3, dot};
use std::f64::consts::TAU;

/// How a line runs over a wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Side {
    /// The middle of the wrap is on the side of this direction.
    Towards(V3<f64>),
    /// It turns about the axis by the right-hand rule.
    About,
}

/// A point of a route, or a wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stop {
    /// A point: an end, or a ring.
    Point(V3<f64>),
    /// A wheel.
    Wheel {
        /// Its centre [m].
        centre: V3<f64>,
        /// Its axis, a unit vector.
        axis: V3<f64>,
        /// Its radius [m].
        radius: f64,
        /// Which way round.
        side: Side,
    },
}

/// How the line lies at a stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// Where it arrives and where it leaves; the same at a point [m].
    pub at: [V3<f64>; 2],
    /// Axis about which it turns by the right-hand rule; zero at a point.
    pub axis: V3<f64>,
    /// Angle of wrap [rad]; 0 at a point.
    pub wrap: f64,
}

/// What is wrong with a route, and at which of its stops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Number of the stop.
    pub stop: usize,
    /// What is wrong.
    pub what: &'static str,
}

/// Wraps that a line can start with: it touches the wheel, and doesn't meet itself [rad].
const WRAPS: std::ops::Range<f64> = 0.02..TAU - 0.3;

fn minus(a: &V3<f64>, b: &V3<f64>) -> V3<f64> {
    std::array::from_fn(|i| a[i] - b[i])
}

fn size(a: &V3<f64>) -> f64 {
    dot(a, a).sqrt()
}

/// The point of a wheel at which a straight line from there (`arrives`) or to there touches it.
fn touch(centre: &V3<f64>, axis: &V3<f64>, radius: f64, x: &V3<f64>, arrives: bool) -> Option<V3<f64>> {
    let d = minus(x, centre);
    let along = dot(&d, axis);
    let d: V3<f64> = std::array::from_fn(|i| d[i] - along * axis[i]);
    let far = size(&d);
    let u = d.map(|x| x / far);
    let (cos, across) = (radius / far, cross(axis, &u));
    // the line runs in direction axis x e
    let sin = (1.0 - cos * cos).sqrt() * if arrives { 1.0 } else { -1.0 };
    (cos < 1.0).then(|| std::array::from_fn(|i| centre[i] + radius * (cos * u[i] + sin * across[i])))
}

/// A stop with its axis turned such that the line runs about it by the right-hand rule.
#[derive(Clone, Copy)]
struct Placed {
    centre: V3<f64>,
    axis: V3<f64>,
    radius: f64,
}

impl Placed {
    fn touch(&self, x: &V3<f64>, arrives: bool) -> Option<V3<f64>> {
        if self.radius == 0.0 {
            Some(self.centre)
        } else {
            touch(&self.centre, &self.axis, self.radius, x, arrives)
        }
    }
}

impl Stop {
    /// Both ways round a wheel; a point twice.
    fn placed(&self) -> [Placed; 2] {
        match *self {
            Stop::Point(centre) => [Placed { centre, axis: [0.0; 3], radius: 0.0 }; 2],
            Stop::Wheel { centre, axis, radius, .. } => {
                [1.0, -1.0].map(|sign| Placed { centre, axis: axis.map(|x| sign * x), radius })
            }
        }
    }

    /// Whether a line may begin or end there this way round: a drum has one.
    fn starts(&self, way: usize) -> bool {
        way == 0 || !matches!(self, Stop::Wheel { side: Side::About, .. })
    }

    /// Whether a line that arrives and leaves there runs over it as it is to, and its wrap.
    fn wraps(&self, way: usize, [arrives, leaves]: [&V3<f64>; 2]) -> Option<f64> {
        let Stop::Wheel { centre, radius, side, .. } = self else { return Some(0.0) };
        let axis = self.placed()[way].axis;
        let [a, b] = [arrives, leaves].map(|x| minus(x, centre).map(|x| x / radius));
        let wrap = dot(&axis, &cross(&a, &b)).atan2(dot(&a, &b)).rem_euclid(TAU);
        let (sin, cos) = (0.5 * wrap).sin_cos();
        let across = cross(&axis, &a);
        let middle: V3<f64> = std::array::from_fn(|i| cos * a[i] + sin * across[i]);
        let fits = match side {
            Side::Towards(up) => dot(&middle, up) > 0.0,
            Side::About => way == 0,
        };
        (fits && WRAPS.contains(&wrap)).then_some(wrap)
    }
}

/// Straight lines from one stop to the next, for both ways round each; none where a wheel is in the way.
type Tangents = [[Option<[V3<f64>; 2]>; 2]; 2];

/// The straight line from one stop to the next: where it leaves and where it arrives.
fn tangent(from: &Placed, to: &Placed) -> Option<[V3<f64>; 2]> {
    let (mut leaves, mut arrives) = (from.centre, to.centre);
    let far = size(&minus(&leaves, &arrives));
    for _ in 0..2000 {
        let before = [leaves, arrives];
        leaves = from.touch(&arrives, false)?;
        arrives = to.touch(&leaves, true)?;
        let moved = size(&minus(&leaves, &before[0])) + size(&minus(&arrives, &before[1]));
        if moved <= 1e-15 * far {
            return Some([leaves, arrives]);
        }
    }
    Some([leaves, arrives])
}

/// The shortest line along a route of at least two stops, the first and last of which are points or drums.
///
/// Between two wheels a taut line is their tangent, whatever lies beyond; so the ways round all wheels are found one
/// after the other (Viterbi's algorithm).
///
/// # Errors
/// A wheel that can't be passed as asked.
pub fn lay(stops: &[Stop]) -> Result<Vec<Turn>, Fault> {
    let placed: Vec<[Placed; 2]> = stops.iter().map(Stop::placed).collect();
    // the tangent between each pair of neighbours, for both ways round each
    let tangents: Vec<Tangents> =
        placed.windows(2).map(|w| [0, 1].map(|a| [0, 1].map(|b| tangent(&w[0][a], &w[1][b])))).collect();
    // least length up to stop k + 1 with these ways round stops k and k + 1, and the way round the stop before
    let mut least = vec![[[(f64::INFINITY, 0); 2]; 2]; tangents.len()];
    let length = |x: &[V3<f64>; 2]| size(&minus(&x[1], &x[0]));
    for k in 0..tangents.len() {
        for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let Some(next) = &tangents[k][a][b] else { continue };
            if k == 0 {
                if stops[0].starts(a) {
                    least[0][a][b] = (length(next), 0);
                }
                continue;
            }
            let radius = placed[k][a].radius;
            for z in 0..2 {
                let Some(last) = &tangents[k - 1][z][a] else { continue };
                let Some(wrap) = stops[k].wraps(a, [&last[1], &next[0]]) else { continue };
                let sum = least[k - 1][z][a].0 + radius * wrap + length(next);
                if sum < least[k][a][b].0 {
                    least[k][a][b] = (sum, z);
                }
            }
        }
        if least[k].iter().flatten().all(|x| x.0.is_infinite()) {
            return Err(fault(stops, &tangents, k));
        }
    }
    let last = tangents.len() - 1;
    let ways = [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter().filter(|way| stops[last + 1].starts(way.1));
    let best = ways.min_by(|x, y| least[last][x.0][x.1].0.total_cmp(&least[last][y.0][y.1].0));
    let (mut a, mut b) = best.unwrap_or_default();
    if least[last][a][b].0.is_infinite() {
        return Err(fault(stops, &tangents, last));
    }
    let mut way = vec![0; stops.len()];
    for k in (0..=last).rev() {
        way[k + 1] = b;
        (a, b) = (least[k][a][b].1, a);
    }
    way[0] = b;
    let line = |k: usize| tangents[k][way[k]][way[k + 1]].unwrap_or([placed[k][0].centre; 2]);
    let turn = |k: usize| {
        let at = [line(k.max(1) - 1)[1], line(k.min(last))[0]];
        let at = [if k == 0 { at[1] } else { at[0] }, if k > last { at[0] } else { at[1] }];
        let wrap = stops[k].wraps(way[k], [&at[0], &at[1]]).unwrap_or(0.0);
        Turn { at, axis: placed[k][way[k]].axis, wrap }
    };
    Ok((0..stops.len()).map(turn).collect())
}

/// The shortest closed line along a route of at least two stops, none of which is a drum.
///
/// # Errors
/// A wheel that can't be passed as asked.
pub fn lay_closed(stops: &[Stop]) -> Result<Vec<Turn>, Fault> {
    let mut best: Result<(f64, Vec<Turn>), Fault> = Err(Fault { stop: 0, what: ASKEW });
    // whichever way round the first wheel, the line comes back to it in that way
    for way in [0, 1] {
        let placed = stops[0].placed()[way];
        let first = match stops[0] {
            Stop::Wheel { centre, radius, .. } => {
                Stop::Wheel { centre, axis: placed.axis, radius, side: Side::About }
            }
            point => point,
        };
        let round: Vec<Stop> =
            std::iter::once(first).chain(stops[1..].iter().copied()).chain([first]).collect();
        let mut turns = match lay(&round) {
            Ok(turns) => turns,
            Err(Fault { stop, what }) => {
                if best.as_ref().is_err_and(|fault| fault.what == ASKEW) {
                    best = Err(Fault { stop: stop % stops.len(), what });
                }
                continue;
            }
        };
        let Some(last) = turns.pop() else { continue };
        let at = [last.at[0], turns[0].at[1]];
        let Some(wrap) = stops[0].wraps(way, [&at[0], &at[1]]) else { continue };
        turns[0] = Turn { at, axis: placed.axis, wrap };
        let radius = |k: usize| match stops[k] {
            Stop::Wheel { radius, .. } => radius,
            Stop::Point(_) => 0.0,
        };
        let length: f64 = (0..turns.len())
            .map(|k| {
                let next = &turns[(k + 1) % turns.len()];
                radius(k) * turns[k].wrap + size(&minus(&next.at[0], &turns[k].at[1]))
            })
            .sum();
        if best.as_ref().map_or(true, |(least, _)| length < *least) {
            best = Ok((length, turns));
        }
    }
    best.map(|(_, turns)| turns)
}

/// What is wrong with a wheel that the line doesn't pass as asked.
const ASKEW: &str = "a taut cable wouldn't touch it on that side, or would wrap all round it";

/// Why no line reaches stop `k + 1`.
fn fault(stops: &[Stop], tangents: &[Tangents], k: usize) -> Fault {
    if tangents[k].iter().flatten().all(Option::is_none) {
        let wheel = |k: usize| matches!(stops[k], Stop::Wheel { .. });
        let stop = if wheel(k) { k } else { k + 1 };
        return Fault { stop, what: "the stop beside it in the route lies within the wheel" };
    }
    Fault { stop: k, what: ASKEW }
}
