//! What a scene says about bushings and torsion springs.

use super::{Bushing, RotationalSpring};
use crate::signals::least;
use ropewalk_core::error::{finite, not_negative};
use ropewalk_core::rotation::{IDENTITY, M3, around, cross};
use ropewalk_core::{BuildError, Marker, Signal, V3, dot};
use ropewalk_scene::quantity::{Kind, Setting, kind};
use ropewalk_scene::{Builder, ForceSpec, MarkerRef, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A spring and damper in all six directions between two rigid bodies, or a body and space: a rubber mount, a soft
/// joint. There is no force in the initial position. Rotations up to half a turn are valid: a run ends there. A record of type
/// `force` shows the force and the moment on `marker`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BushingSpec {
    /// Name.
    pub name: String,
    /// The marker that is held.
    pub marker: MarkerRef,
    /// The other marker, on a rigid body or a cable with torsion, or a point in space; its axes are those of the
    /// stiffnesses. Default: the point where `marker` starts.
    #[serde(default)]
    pub to: Option<MarkerRef>,
    /// Direction of the first axis in space at the start. Default, with `axis_y`: the axes of space.
    #[serde(default)]
    pub axis_x: Option<V3<f64>>,
    /// Direction of the second axis in space at the start, at right angles to the first.
    #[serde(default)]
    pub axis_y: Option<V3<f64>>,
    /// Stiffness along each axis [N/m].
    #[serde(default, deserialize_with = "quantity::setting::vec3::spring_stiffness")]
    pub stiffness: [Setting; 3],
    /// Damping along each axis [N s/m].
    #[serde(default, deserialize_with = "quantity::setting::vec3::damping")]
    pub damping: [Setting; 3],
    /// Stiffness about each axis [N m/rad].
    #[serde(default, deserialize_with = "quantity::setting::vec3::rotational_stiffness")]
    pub rotational_stiffness: [Setting; 3],
    /// Damping about each axis [N m s/rad].
    #[serde(default, deserialize_with = "quantity::setting::vec3::rotational_damping")]
    pub rotational_damping: [Setting; 3],
}
register_spec!(Force, "bushing", BushingSpec);

/// Both markers, the holding one first, with the same axes in space at the start.
fn pair(
    b: &Builder,
    marker: &MarkerRef,
    to: Option<&MarkerRef>,
    axes: M3,
) -> Result<[Marker; 2], BuildError> {
    let held = b.marker("marker", marker)?;
    let holds = match to {
        Some(to) => b.marker("to", to)?,
        None => Marker::ground(b.place(&held).x),
    };
    Ok([holds, held].map(|m| m.with_axes(b.nodes(), b.coordinates(), axes)))
}

/// Three numbers of a kind that may be read from inputs.
fn three(b: &Builder, field: &str, of: &[Setting; 3], kind: &Kind) -> Result<[Signal; 3], BuildError> {
    let [x, y, z] = of.each_ref().map(|s| b.signal(field, s, kind));
    Ok([x?, y?, z?])
}

fn unit(field: &str, d: V3<f64>) -> Result<V3<f64>, BuildError> {
    finite(field, &d)?;
    let size = dot(&d, &d).sqrt();
    if size > 0.0 {
        Ok(d.map(|x| x / size))
    } else {
        Err(BuildError::at(field, format!("`{field}` must have a length")))
    }
}

#[typetag::serde(name = "bushing")]
impl ForceSpec for BushingSpec {
    fn markers(&self) -> Vec<&MarkerRef> {
        std::iter::once(&self.marker).chain(&self.to).collect()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let axes = match (self.axis_x, self.axis_y) {
            (None, None) => IDENTITY,
            (Some(x), Some(y)) => {
                let (x, y) = (unit("axis_x", x)?, unit("axis_y", y)?);
                if dot(&x, &y).abs() > 1e-6 {
                    return Err(BuildError::at("axis_y", "`axis_y` must be at right angles to `axis_x`"));
                }
                [x, y, cross(&x, &y)]
            }
            _ => return Err(BuildError::at("axis_x", "give both `axis_x` and `axis_y`, or neither")),
        };
        let markers = pair(b, &self.marker, self.to.as_ref(), axes)?;
        let mut bushing = Bushing::new(&self.name, b.nodes(), markers)?;
        bushing.stiffness = three(b, "stiffness", &self.stiffness, &kind::SPRING_STIFFNESS)?;
        bushing.damping = three(b, "damping", &self.damping, &kind::DAMPING)?;
        let (stiffness, damping) = (&kind::ROTATIONAL_STIFFNESS, &kind::ROTATIONAL_DAMPING);
        bushing.rotational_stiffness =
            three(b, "rotational_stiffness", &self.rotational_stiffness, stiffness)?;
        bushing.rotational_damping = three(b, "rotational_damping", &self.rotational_damping, damping)?;
        bushing.check()?;
        b.term(Box::new(bushing));
        Ok(())
    }
}

/// A torsion spring and damper about an axis, used with a `revolute` joint, or at the end of a cable with torsion
/// (`section.gj`), which may lie on a swivel. Whole turns count.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RotationalSpringSpec {
    /// Name.
    pub name: String,
    /// The marker, on a rigid body or a cable with torsion.
    pub marker: MarkerRef,
    /// The other marker, on a rigid body or a cable with torsion. Default: space.
    #[serde(default)]
    pub to: Option<MarkerRef>,
    /// Direction of the axis in space at the start.
    pub axis: V3<f64>,
    /// Stiffness [N m/rad].
    #[serde(default, deserialize_with = "quantity::setting::rotational_stiffness")]
    pub stiffness: Setting,
    /// Damping [N m s/rad].
    #[serde(default, deserialize_with = "quantity::setting::rotational_damping")]
    pub damping: Setting,
    /// Angle without moment, from the initial position [rad].
    #[serde(default, deserialize_with = "quantity::setting::angle")]
    pub angle: Setting,
}
register_spec!(Force, "rotational_spring", RotationalSpringSpec);

#[typetag::serde(name = "rotational_spring")]
impl ForceSpec for RotationalSpringSpec {
    fn markers(&self) -> Vec<&MarkerRef> {
        std::iter::once(&self.marker).chain(&self.to).collect()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let axes = around(unit("axis", self.axis)?);
        let markers = pair(b, &self.marker, self.to.as_ref(), axes)?;
        let stiffness = b.signal("stiffness", &self.stiffness, &kind::ROTATIONAL_STIFFNESS)?;
        let angle = b.signal("angle", &self.angle, &kind::ANGLE)?;
        let damping = b.signal("damping", &self.damping, &kind::ROTATIONAL_DAMPING)?;
        not_negative("damping", least(&damping))?;
        let memory = b.memory(&format!("angle of {}", self.name), 1);
        let spring = RotationalSpring::new(&self.name, b.nodes(), markers, stiffness, angle)?;
        let mut spring = spring.counting(memory);
        spring.damping = damping;
        b.term(Box::new(spring));
        Ok(())
    }
}
