//! The equations of joints.

use crate::algebra::lane::{V3, dot};
use crate::algebra::rotation::IDENTITY;
use crate::model::constraint::RowKind;
use crate::model::motion::Motion;
use std::sync::Arc;

/// A vector that an equation is made of.
#[derive(Clone, Debug)]
pub enum Arrow {
    /// From the first marker's point to the second's [m].
    Between,
    /// An axis of one of the markers; of one on a cable without torsion its slope, whichever axis is named.
    Axis {
        /// Which marker, 0 or 1.
        of: usize,
        /// Which of its axes.
        axis: usize,
    },
    /// The slope `r'` of a cable's marker, whether or not its sections know which way they look; of any other its third
    /// axis.
    Tangent {
        /// Which marker, 0 or 1.
        of: usize,
    },
    /// The second axis of a marker, turned about the third by the angle `φ(t)` that is the motion's first component.
    Turned {
        /// Which marker, 0 or 1.
        of: usize,
        /// The angle [rad].
        angle: Arc<dyn Motion>,
    },
}

/// One equation between two markers.
#[derive(Clone, Debug)]
pub enum Equation {
    /// `d·(D - X(t)) = 0`: a coordinate in space.
    Along {
        /// Unit vector `d` in space.
        direction: V3<f64>,
        /// Displacement `X(t)`; `None` if there is none.
        motion: Option<Arc<dyn Motion>>,
    },
    /// `a·b - c - X(t) = 0`
    Dot {
        /// One vector.
        a: Arrow,
        /// The other.
        b: Arrow,
        /// The number `c`.
        value: f64,
        /// Its change with time, the motion's first component; `None` if there is none.
        motion: Option<Arc<dyn Motion>>,
    },
    /// `|D| - L = 0`
    Distance {
        /// The distance `L` [m].
        length: f64,
    },
}

impl Equation {
    /// The three coordinates of the second marker are those of the first.
    pub fn coincide() -> Vec<Equation> {
        (0..3).map(|i| Equation::coordinate(IDENTITY[i], None)).collect()
    }
    /// A coordinate in space.
    pub fn coordinate(direction: V3<f64>, motion: Option<Arc<dyn Motion>>) -> Equation {
        Equation::Along { direction, motion }
    }
    /// An axis of the first marker is normal to one of the second.
    pub fn normal(axis: usize, other: usize) -> Equation {
        let (a, b) = (Arrow::Axis { of: 0, axis }, Arrow::Axis { of: 1, axis: other });
        Equation::Dot { a, b, value: 0.0, motion: None }
    }
    /// An axis of the first marker is normal to the cable at the second; or the other way round, with the cable `of` 0.
    pub fn beside(axis: usize, cable: usize) -> Equation {
        let (a, b) = (Arrow::Axis { of: 1 - cable, axis }, Arrow::Tangent { of: cable });
        Equation::Dot { a, b, value: 0.0, motion: None }
    }
    /// The second marker stays in the plane through the first that is normal to this axis of it.
    pub fn in_plane(axis: usize) -> Equation {
        Equation::Dot { a: Arrow::Axis { of: 0, axis }, b: Arrow::Between, value: 0.0, motion: None }
    }

    /// Whether these are the three of [`Equation::coincide`].
    pub(super) fn coincide_only(equations: &[Equation]) -> bool {
        let axis = |i: usize, e: &Equation| matches!(e, Equation::Along { direction, motion: None } if *direction == IDENTITY[i]);
        equations.len() == 3 && equations.iter().enumerate().all(|(i, e)| axis(i, e))
    }
    /// The two vectors whose product it prescribes.
    pub(super) fn arrows(&self) -> Option<[&Arrow; 2]> {
        match self {
            Equation::Dot { a, b, .. } => Some([a, b]),
            Equation::Along { .. } | Equation::Distance { .. } => None,
        }
    }
    /// By how much it is broken, with the vector `d` between the markers and what its [`Equation::arrows`] are.
    #[inline]
    pub(super) fn violation(&self, d: &V3<f64>, arrows: &[V3<f64>; 2], t: f64) -> f64 {
        match self {
            Equation::Along { direction, motion } => {
                let x = motion.as_ref().map_or([0.0; 3], |m| m.at(t).x);
                (0..3).map(|i| direction[i] * (d[i] - x[i])).sum()
            }
            Equation::Dot { value, motion, .. } => {
                dot(&arrows[0], &arrows[1]) - value - motion.as_ref().map_or(0.0, |m| m.at(t).x[0])
            }
            Equation::Distance { length } => dot(d, d).sqrt() - length,
        }
    }
    pub(super) fn kind(&self) -> RowKind {
        match self {
            Equation::Dot { a, b, .. } if !matches!(a, Arrow::Between) && !matches!(b, Arrow::Between) => {
                RowKind::Direction
            }
            _ => RowKind::Position,
        }
    }
    pub(super) fn motion(&self) -> Vec<&Arc<dyn Motion>> {
        let angle = |arrow: &'_ Arrow| matches!(arrow, Arrow::Turned { .. });
        match self {
            Equation::Along { motion, .. } => motion.iter().collect(),
            Equation::Dot { a, b, motion, .. } => {
                let turned = [a, b].into_iter().filter(|x| angle(x)).filter_map(|x| match x {
                    Arrow::Turned { angle, .. } => Some(angle),
                    _ => None,
                });
                motion.iter().chain(turned).collect()
            }
            Equation::Distance { .. } => Vec::new(),
        }
    }
}
