//! Why a constraint or motion can't be made.

use ropewalk_core::{Marker, Node, NodeKind, V3};

/// A constraint or motion that can't be made of the given numbers; the message says which one, and what it must be.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Refused(pub String);

/// `Ok` if `holds`, else a refusal with this message.
pub(crate) fn need(holds: bool, message: impl FnOnce() -> String) -> Result<(), Refused> {
    if holds { Ok(()) } else { Err(Refused(message())) }
}

/// Refuses what is not finite.
pub(crate) fn finite(name: &str, x: &[f64]) -> Result<(), Refused> {
    need(x.iter().all(|x| x.is_finite()), || format!("{name} must be finite, not {x:?}"))
}

/// Refuses what is not finite and above zero.
pub(crate) fn positive(name: &str, x: f64) -> Result<(), Refused> {
    need(x.is_finite() && x > 0.0, || format!("{name} must be finite and above zero, not {x}"))
}

/// A direction of length 1.
pub(crate) fn unit(name: &str, d: V3<f64>) -> Result<V3<f64>, Refused> {
    finite(name, &d)?;
    let length = d.iter().map(|x| x * x).sum::<f64>().sqrt();
    need(length > 0.0, || format!("{name} has no length; give any vector along it"))?;
    Ok(d.map(|x| x / length))
}

/// Refuses markers whose node isn't there or has no position, and pairs that hold nothing.
pub(crate) fn markers(name: &str, nodes: &[Node], markers: &[Marker]) -> Result<(), Refused> {
    for m in markers.iter().filter_map(Marker::on) {
        let node = nodes.get(m.0 as usize);
        let node = node.ok_or_else(|| Refused(format!("{name}: there is no node {}", m.0)))?;
        let has_position = !matches!(node.kind, NodeKind::Scalars(_));
        need(has_position, || format!("{name}: node {} has no position", m.0))?;
    }
    need(markers.iter().any(|m| m.on().is_some()), || {
        format!("{name}: holds only fixed points; put one marker on a node")
    })?;
    if let [a, b] = markers {
        need(a.on() != b.on(), || format!("{name}: both markers are on the same node"))?;
    }
    Ok(())
}

/// Whether a marker's position changes linearly with the increments of its node.
pub(crate) fn moves_linearly(nodes: &[Node], marker: &Marker) -> bool {
    match *marker {
        Marker::Ground { .. } => true,
        Marker::Node { node, point, .. } => {
            nodes[node.0 as usize].kind != NodeKind::Frame || point == [0.0; 3]
        }
    }
}
