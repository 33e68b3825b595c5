//! Checks of what constraints and motions are made of.

use ropewalk_core::build::{BuildError, finite, need};
use ropewalk_core::{Marker, Node, NodeKind, V3};

/// A direction of length 1.
pub(crate) fn unit(name: &str, d: V3<f64>) -> Result<V3<f64>, BuildError> {
    finite(name, &d)?;
    let length = d.iter().map(|x| x * x).sum::<f64>().sqrt();
    if !(length > 0.0 && length.is_finite()) {
        let message = format!("`{name}` has no length that can be computed; give any vector along it");
        return Err(BuildError::at(name, message));
    }
    Ok(d.map(|x| x / length))
}

/// Refuses markers whose node isn't there or has no position, and pairs that hold nothing.
pub(crate) fn markers(name: &str, nodes: &[Node], markers: &[Marker]) -> Result<(), BuildError> {
    for m in markers.iter().filter_map(Marker::on) {
        let node = nodes.get(m.0 as usize);
        let node = node.ok_or_else(|| BuildError::new(format!("{name}: there is no node {}", m.0)))?;
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
