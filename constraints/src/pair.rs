//! What the specs of joints have in common: two markers, and the axes that a joint gives them.

use crate::check::unit;
use ropewalk_core::rotation::{M3, around};
use ropewalk_core::{BuildError, Marker, NodeKind, V3};
use ropewalk_scene::{Builder, MarkerRef};

/// The markers that a joint holds: first what holds, then what is held. Without the first, it is the point in space
/// where the second starts.
pub(crate) fn pair(
    b: &Builder,
    marker: &MarkerRef,
    to: Option<&MarkerRef>,
) -> Result<[Marker; 2], BuildError> {
    let held = b.marker("marker", marker)?;
    let holds = match to {
        Some(to) => b.marker("to", to)?,
        None => Marker::ground(b.place(&held).x),
    };
    Ok([holds, held])
}

/// Gives both markers the same axes in space at the start.
pub(crate) fn aligned(b: &Builder, markers: [Marker; 2], axes: M3) -> [Marker; 2] {
    markers.map(|m| m.with_axes(b.nodes(), b.coordinates(), axes))
}

/// Axes whose third is this direction.
pub(crate) fn along(field: &str, direction: V3<f64>) -> Result<M3, BuildError> {
    Ok(around(unit(field, direction)?))
}

/// What the node of a marker is, if it has one.
pub(crate) fn kind(b: &Builder, marker: &Marker) -> Option<NodeKind> {
    marker.on().map(|n| b.nodes()[n.0 as usize].kind)
}

/// Whether a marker is on a cable without torsion, which has a slope but no twist.
pub(crate) fn on_cable(b: &Builder, marker: &Marker) -> bool {
    kind(b, marker) == Some(NodeKind::Slope)
}

/// The slope of a marker on a cable when the run began.
pub(crate) fn slope(b: &Builder, marker: &Marker) -> Option<V3<f64>> {
    marker.slope(b.nodes(), b.coordinates())
}

/// The direction of a marker on a cable at the start, or the axis that the scene gives: it must on a body, it may on a
/// cable with torsion.
pub(crate) fn direction(
    b: &Builder,
    field: &str,
    marker: &Marker,
    given: Option<V3<f64>>,
) -> Result<V3<f64>, BuildError> {
    match (given, slope(b, marker)) {
        (None, Some(slope)) => Ok(slope),
        (Some(_), Some(_)) if on_cable(b, marker) => {
            Err(BuildError::at(field, format!("a cable has only its own direction: leave `{field}` out")))
        }
        (Some(axis), _) => unit(field, axis),
        (None, None) => Err(BuildError::at(field, format!("`{field}` is missing: which axis is it to be?"))),
    }
}

/// Refuses to say what is to become of a twist that isn't there.
pub(crate) fn untwisted(twist: Option<bool>) -> Result<(), BuildError> {
    match twist {
        None => Ok(()),
        Some(_) => Err(BuildError::at(
            "twist",
            "what is held here has no torsion: leave `twist` out, or give the section of the cable a torsional stiffness, `gj`",
        )),
    }
}
