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
    let message = format!("`elements` must be between 1 and {MOST_ELEMENTS}, not {elements}");
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
pub(crate) fn pinned(nodes: &[f64], pins: &[f64]) -> Vec<f64> {
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
pub(crate) fn even(length: f64, elements: usize, pins: &[f64]) -> Vec<f64> {
    let stops = stops(length, pins);
    let mut mesh = vec![0.0];
    for w in stops.windows(2) {
        let n = ((w[1] - w[0]) / length * elements as f64).round().max(1.0) as usize;
        mesh.extend((1..=n).map(|i| if i == n { w[1] } else { w[0] + (w[1] - w[0]) * i as f64 / n as f64 }));
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lengths(mesh: &[f64]) -> Vec<f64> {
        mesh.windows(2).map(|w| w[1] - w[0]).collect()
    }
    fn graded(elements: usize, first: Option<f64>, last: Option<f64>) -> MeshSpec {
        MeshSpec::Graded(Grading { elements, first, last })
    }

    #[test]
    fn even_meshes_hold_their_pins() {
        assert_eq!(even(10.0, 5, &[]), vec![0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        let m = even(10.0, 4, &[3.0, 3.0, 10.0]);
        assert_eq!(m, vec![0.0, 3.0, 3.0 + 7.0 / 3.0, 3.0 + 14.0 / 3.0, 10.0]);
        assert_eq!(even(10.0, 4, &[-1.0, 11.0, f64::NAN]), even(10.0, 4, &[]));
    }

    #[test]
    fn a_grading_to_one_end_is_a_geometric_series() {
        for mesh in [graded(7, None, Some(0.01)), graded(7, Some(0.01), None)] {
            let nodes = mesh.nodes(3.0).expect("mesh");
            let mut l = lengths(&nodes);
            if l[0] > l[6] {
                l.reverse();
            }
            assert!((l[0] - 0.01).abs() < 1e-12 && (nodes[7], nodes[0]) == (3.0, 0.0));
            let q = l[1] / l[0];
            assert!(l.windows(2).all(|w| (w[1] / w[0] / q - 1.0).abs() < 1e-9));
            assert!((0.01 * (q.powi(7) - 1.0) / (q - 1.0) - 3.0).abs() < 1e-9);
        }
        assert_eq!(graded(4, None, None).nodes(2.0).expect("mesh"), vec![0.0, 0.5, 1.0, 1.5, 2.0]);
    }

    #[test]
    fn a_grading_to_both_ends_has_both_lengths_and_the_sum() {
        for (n, a, b) in [(9, 0.01, 0.01), (9, 0.01, 0.2), (3, 0.3, 0.1), (40, 0.1, 0.1)] {
            let l = lengths(&graded(n, Some(a), Some(b)).nodes(3.0).expect("mesh"));
            assert!((l[0] - a).abs() < 1e-9 && (l[n - 1] - b).abs() < 1e-9, "{l:?}");
            assert!((l.iter().sum::<f64>() - 3.0).abs() < 1e-12);
        }
        // what is a geometric series stays one
        let q = 1.3_f64;
        let sum: f64 = (0..8).map(|k| q.powi(k)).sum();
        let l = lengths(&graded(8, Some(1.0), Some(q.powi(7))).nodes(sum).expect("mesh"));
        assert!(l.iter().zip(0..).all(|(l, k)| (l / q.powi(k) - 1.0).abs() < 1e-9), "{l:?}");
    }

    #[test]
    fn a_graded_mesh_keeps_its_grading_between_pins() {
        let nodes = graded(12, None, Some(0.02)).nodes(4.0).expect("mesh");
        assert_eq!(pinned(&nodes, &[]), nodes);
        let mesh = pinned(&nodes, &[1.0, 3.3]);
        assert!(mesh.contains(&1.0) && mesh.contains(&3.3) && mesh.len().abs_diff(13) < 2);
        let l = lengths(&mesh);
        assert!(l.windows(2).all(|w| w[1] < 1.1 * w[0]) && l[l.len() - 1] < 0.03, "{l:?}");
    }

    #[test]
    fn wrong_meshes_are_refused_with_a_remedy() {
        let says = |mesh: MeshSpec, what: &str| {
            let e = mesh.nodes(2.0).expect_err(what);
            assert!(e.message.contains(what) && e.field.as_deref() == Some("mesh"), "{e}");
        };
        says(MeshSpec::Lengths(vec![1.0, 0.9]), "the cable is 2 m long");
        says(MeshSpec::Lengths(vec![]), "between 1 and");
        says(MeshSpec::Lengths(vec![1.0, -1.0, 2.0]), "element 2 of `mesh` must have a positive length");
        says(MeshSpec::Lengths(vec![1.0, f64::NAN]), "element 2");
        says(graded(0, None, None), "between 1 and");
        says(graded(8, Some(-1.0), None), "must be positive");
        says(graded(8, None, Some(f64::NAN)), "must be positive");
        says(graded(1, None, Some(0.5)), "`elements = 2` or more");
        says(graded(2, Some(0.5), Some(0.5)), "`elements = 3` or more");
        says(graded(8, Some(1.5), Some(0.6)), "longer than the cable");
        says(graded(2, None, Some(1e-300)), "vanish");
        assert!(MeshSpec::Lengths(vec![1.0, 1.0 + 1e-7]).nodes(2.0).is_ok());
    }
}
