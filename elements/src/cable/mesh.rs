//! How a cable is divided into elements: evenly, graded towards its ends, or as a list of lengths.

use ropewalk_core::BuildError;
use ropewalk_core::error::positive;
use ropewalk_scene::quantity;
use schemars::JsonSchema;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};
use std::fmt;

/// More elements than any cable has.
const MOST_ELEMENTS: usize = 1_000_000;

/// By how much a list of lengths may differ from the length of the cable, in parts of it.
const ROUNDING: f64 = 1e-6;

/// Elements of different lengths: `{ elements = 24, last = "1 mm" }`, or a list with the length of each, from start to end.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum MeshSpec {
    /// Lengths that change from element to element by a smooth factor.
    Graded(Grading),
    /// The unstretched length of each element [m], whose sum is that of the cable.
    Lengths(Vec<f64>),
}

/// Elements that become shorter towards one end or both, where a bending layer has to be resolved.
///
/// With one length given, neighbours differ by the same factor all along (a geometric series). With both, the logarithm
/// of the length is a parabola over the number of the element, which passes through both and has the sum that the cable
/// needs; with lengths that fit a geometric series it is one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Grading {
    /// Number of elements.
    pub elements: usize,
    /// Length of the element at the start [m]. Default: from the grading.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub first: Option<f64>,
    /// Length of the element at the end [m]. Default: from the grading.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub last: Option<f64>,
}

impl<'de> Deserialize<'de> for MeshSpec {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        struct Either;
        impl<'de> Visitor<'de> for Either {
            type Value = MeshSpec;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "a mesh like {{ elements = 24, last = \"1 mm\" }}, or a list of lengths")
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<MeshSpec, A::Error> {
                Grading::deserialize(MapAccessDeserializer::new(map)).map(MeshSpec::Graded)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<MeshSpec, A::Error> {
                quantity::list::length(SeqAccessDeserializer::new(seq)).map(MeshSpec::Lengths)
            }
        }
        d.deserialize_any(Either)
    }
}

fn fault(message: String) -> BuildError {
    BuildError::at("mesh", message)
}

/// Checks a number of elements that stands in `field`.
pub(super) fn counted(field: &str, elements: usize) -> Result<usize, BuildError> {
    if (1..=MOST_ELEMENTS).contains(&elements) {
        return Ok(elements);
    }
    let message = format!(
        "`elements` must be between 1 and {MOST_ELEMENTS}, not {elements}: give the number of elements, or their lengths by \
         `mesh`"
    );
    Err(BuildError::at(field, message))
}

impl MeshSpec {
    /// Arc lengths of the nodes of a cable of this length [m].
    ///
    /// # Errors
    /// Lengths that aren't positive, or that don't make up the cable.
    pub fn nodes(&self, length: f64) -> Result<Vec<f64>, BuildError> {
        let lengths = match self {
            MeshSpec::Graded(grading) => grading.lengths(length)?,
            MeshSpec::Lengths(lengths) => listed(lengths, length)?,
        };
        let whole: f64 = lengths.iter().sum();
        let mut nodes = vec![0.0];
        let mut sum = 0.0;
        for l in &lengths[..lengths.len() - 1] {
            sum += l;
            nodes.push(length * (sum / whole));
        }
        nodes.push(length);
        if nodes.windows(2).any(|w| !(w[1] > w[0])) {
            let message = "its shortest elements vanish beside the length of the cable: make them longer";
            return Err(fault(message.into()));
        }
        Ok(nodes)
    }
}

fn listed(lengths: &[f64], length: f64) -> Result<Vec<f64>, BuildError> {
    counted("mesh", lengths.len())?;
    if let Some(k) = lengths.iter().position(|l| !(*l > 0.0 && l.is_finite())) {
        return Err(fault(format!(
            "element {} of `mesh` must have a positive length, not {} m",
            k + 1,
            lengths[k]
        )));
    }
    let whole: f64 = lengths.iter().sum();
    if (whole - length).abs() <= ROUNDING * length {
        return Ok(lengths.to_vec());
    }
    let count = lengths.len();
    Err(fault(format!(
        "the {count} elements of `mesh` are {whole} m long together, but the cable is {length} m long: change one of them, \
         or give {{ elements = {count}, first = …, last = … }}, which fits by itself"
    )))
}

impl Grading {
    fn lengths(&self, length: f64) -> Result<Vec<f64>, BuildError> {
        let n = counted("mesh", self.elements)?;
        let given: Vec<f64> = self.first.into_iter().chain(self.last).collect();
        for (name, l) in [("first", self.first), ("last", self.last)] {
            positive(name, l.unwrap_or(1.0)).map_err(|e| fault(format!("of the mesh, {}", e.message)))?;
        }
        if n < given.len() + 1 && !given.is_empty() {
            let message = format!(
                "with lengths at {} of the mesh, give `elements = {}` or more",
                if given.len() == 1 { "an end" } else { "both ends" },
                given.len() + 1
            );
            return Err(fault(message));
        }
        if given.iter().sum::<f64>() >= length {
            let message = format!(
                "the elements at the ends of the mesh are longer than the cable, which is {length} m long"
            );
            return Err(fault(message));
        }
        let t = |k: usize| k as f64 / (n - 1).max(1) as f64;
        // logarithms of the lengths as far as they are known; what is unknown grows with the one number `c`
        let law = |c: f64, k: usize| -> f64 {
            let t = t(k);
            match (self.first, self.last) {
                (None, None) => (length / n as f64).ln(),
                (Some(a), None) => a.ln() + c * t,
                (None, Some(b)) => b.ln() + c * (1.0 - t),
                (Some(a), Some(b)) => (1.0 - t) * a.ln() + t * b.ln() + 4.0 * c * t * (1.0 - t),
            }
        };
        let all = |c: f64| (0..n).map(|k| law(c, k).exp()).collect::<Vec<f64>>();
        if given.is_empty() {
            return Ok(all(0.0));
        }
        // the sum grows with `c`, from the given lengths alone to any
        let (mut low, mut high) = (-700.0, 700.0);
        for _ in 0..200 {
            let c = 0.5 * (low + high);
            if all(c).iter().sum::<f64>() > length { high = c } else { low = c }
        }
        Ok(all(0.5 * (low + high)))
    }
}

/// The ends of a cable and the pins between them.
fn stops(length: f64, pins: &[f64]) -> Vec<f64> {
    let mut stops = vec![0.0];
    for &p in pins {
        // a marker on top of another, or of an end, needs no node of its own; whoever asks for one that is off the
        // cable is refused there
        if p - stops[stops.len() - 1] > 1e-9 * length && length - p > 1e-9 * length {
            stops.push(p);
        }
    }
    stops.push(length);
    stops
}

/// Arc lengths of the nodes of a mesh that is like the given one, with a node at each of the pins: each stretch between
/// two pins has as many elements as it had before, to the nearest, whose lengths follow those of before.
pub fn pinned(nodes: &[f64], pins: &[f64]) -> Vec<f64> {
    let stops = stops(nodes[nodes.len() - 1], pins);
    // the number of the element as a number that runs along the cable, and the way back
    let number = |s: f64| {
        let k = nodes.partition_point(|x| *x <= s).clamp(1, nodes.len() - 1) - 1;
        k as f64 + (s - nodes[k]) / (nodes[k + 1] - nodes[k])
    };
    let place = |x: f64| {
        let k = (x.floor() as usize).min(nodes.len() - 2);
        nodes[k] + (x - k as f64) * (nodes[k + 1] - nodes[k])
    };
    let mut mesh = vec![0.0];
    for w in stops.windows(2) {
        let [from, to] = [number(w[0]), number(w[1])];
        let n = (to - from).round().max(1.0) as usize;
        mesh.extend(
            (1..=n).map(|i| if i == n { w[1] } else { place(from + (to - from) * i as f64 / n as f64) }),
        );
    }
    mesh
}

/// Arc lengths of the nodes of a cable: about `elements` of equal length, with a node at each pin.
pub fn even(length: f64, elements: usize, pins: &[f64]) -> Vec<f64> {
    let stops = stops(length, pins);
    let mut mesh = vec![0.0];
    for w in stops.windows(2) {
        let n = ((w[1] - w[0]) / length * elements as f64).round().max(1.0) as usize;
        mesh.extend((1..=n).map(|i| if i == n { w[1] } else { w[0] + (w[1] - w[0]) * i as f64 / n as f64 }));
    }
    mesh
}
