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

/// Whether one of the markers is on a cable, which has a slope but no twist.
pub(crate) fn on_cable(b: &Builder, markers: &[Marker; 2]) -> bool {
    markers.iter().filter_map(Marker::on).any(|n| b.nodes()[n.0 as usize].kind == NodeKind::Slope)
}

/// The direction of a marker on a cable at the start, or the axis that the scene gives.
pub(crate) fn direction(
    b: &Builder,
    field: &str,
    marker: &Marker,
    given: Option<V3<f64>>,
) -> Result<V3<f64>, BuildError> {
    let slope = marker.on().is_some_and(|n| b.nodes()[n.0 as usize].kind == NodeKind::Slope);
    match given {
        None if slope => Ok(b.place(marker).axes[0]),
        Some(_) if slope => {
            Err(BuildError::at(field, format!("a cable has only its own direction: leave `{field}` out")))
        }
        Some(axis) => unit(field, axis),
        None => Err(BuildError::at(field, format!("`{field}` is missing: which axis is it to be?"))),
    }
}
