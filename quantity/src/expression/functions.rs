//! The functions that a formula may call.

/// What a function asks of its arguments and gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Units {
    /// A plain number of a plain number.
    Plain,
    /// A plain number of an angle, or of a plain number.
    OfAngle,
    /// Of any, and all of the same; gives that.
    Same,
    /// The root of any.
    Root,
    /// A plain number of any, all of the same.
    Ratio,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Function {
    pub name: &'static str,
    pub arguments: usize,
    pub units: Units,
    pub apply: fn(&[f64]) -> f64,
}

impl PartialEq for Function {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

const fn function(name: &'static str, arguments: usize, units: Units, apply: fn(&[f64]) -> f64) -> Function {
    Function { name, arguments, units, apply }
}

pub(super) const FUNCTIONS: &[Function] = &[
    function("sqrt", 1, Units::Root, |x| x[0].sqrt()),
    function("abs", 1, Units::Same, |x| x[0].abs()),
    function("sign", 1, Units::Ratio, |x| if x[0] == 0.0 { 0.0 } else { x[0].signum() }),
    function("exp", 1, Units::Plain, |x| x[0].exp()),
    function("ln", 1, Units::Plain, |x| x[0].ln()),
    function("sin", 1, Units::OfAngle, |x| x[0].sin()),
    function("cos", 1, Units::OfAngle, |x| x[0].cos()),
    function("tan", 1, Units::OfAngle, |x| x[0].tan()),
    function("asin", 1, Units::Plain, |x| x[0].asin()),
    function("acos", 1, Units::Plain, |x| x[0].acos()),
    function("atan", 1, Units::Plain, |x| x[0].atan()),
    function("tanh", 1, Units::Plain, |x| x[0].tanh()),
    function("floor", 1, Units::Plain, |x| x[0].floor()),
    function("round", 1, Units::Plain, |x| x[0].round()),
    function("atan2", 2, Units::Ratio, |x| x[0].atan2(x[1])),
    // f64's own would hide what is no number
    function("min", 2, Units::Same, |x| if x[0] <= x[1] || x[0].is_nan() { x[0] } else { x[1] }),
    function("max", 2, Units::Same, |x| if x[0] >= x[1] || x[0].is_nan() { x[0] } else { x[1] }),
    function("clamp", 3, Units::Same, |x| {
        if x[0] < x[1] {
            x[1]
        } else if x[0] > x[2] {
            x[2]
        } else {
            x[0]
        }
    }),
];
