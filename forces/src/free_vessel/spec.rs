//! What a scene says about a vessel that floats freely.

use super::{FreeVessel, Six, VesselInertia};
use ropewalk_core::error::{finite, not_negative};
use ropewalk_core::{BuildError, Marker, NodeKind, Part, Per};
use ropewalk_scene::{Builder, ForceSpec, MarkerRef, RaoSpec, quantity, register_spec, split_marker};
use ropewalk_sea::{MOTIONS, VesselResponse};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A rigid body floats as a vessel or a buoy, by 6 x 6 matrices of stiffness, added mass and damping about its reference point, and loads
/// of waves by frequency and direction.
///
/// The matrices are over surge, sway, heave, roll, pitch, yaw, along axes ahead, to port and up: N/m, N and N m for what is per metre or
/// radian, kg, kg m and kg m² for added mass, N s/m, N s and N m s for damping. The body starts where it floats in still water, and there its
/// weight is carried; `stiffness` says how weight and buoyancy change from there, so that the body needs no `volume`. `mean_load` carries the
/// lines. Motions are turned as those of `vessel`: `R = Rz(heading + yaw) Ry(pitch) Rx(roll)`. Wave loads and mean load are for the
/// mean place and heading; damping and added mass turn with the body. Currents don't act on it, and second-order loads aren't in it: what they
/// are on average goes into `mean_load`. A record of type `force` shows the six motions and the force of the waves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FreeVesselSpec {
    /// Name, by which records ask for it.
    pub name: String,
    /// Reference point, on a rigid body: what all coefficients are about.
    pub marker: MarkerRef,
    /// Mean heading, from x to y [rad].
    #[serde(default, deserialize_with = "quantity::angle")]
    pub heading: f64,
    /// Stiffness: how weight and buoyancy change with the motions, and what holds the vessel beside its lines.
    pub stiffness: SixBySix,
    /// Added mass.
    #[serde(default)]
    pub added_mass: SixBySix,
    /// Linear damping.
    #[serde(default)]
    pub damping: SixBySix,
    /// Quadratic damping of each motion, `B |v| v`, in N s²/m² and N m s².
    #[serde(default)]
    pub quadratic_damping: [f64; MOTIONS],
    /// Constant force in N and moment in N m on it at the reference point: what carries the lines, mean wind and drift.
    #[serde(default)]
    pub mean_load: [f64; MOTIONS],
    /// Loads of waves, per metre of amplitude: forces in N, moments in N m; the scene needs `[water.waves]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loads: Option<RaoSpec>,
}
register_spec!(Force, "free_vessel", FreeVesselSpec);

/// A 6 x 6 matrix over surge, sway, heave, roll, pitch, yaw.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(
    untagged,
    expecting = "a 6 x 6 matrix is six rows of six numbers, or the six numbers of its diagonal"
)]
pub enum SixBySix {
    /// Its diagonal; the rest is 0.
    Diagonal([f64; MOTIONS]),
    /// Six rows.
    Matrix(Box<[[f64; MOTIONS]; MOTIONS]>),
}

impl Default for SixBySix {
    fn default() -> Self {
        SixBySix::Diagonal([0.0; MOTIONS])
    }
}

impl SixBySix {
    fn rows(&self) -> Six {
        match self {
            SixBySix::Matrix(rows) => **rows,
            SixBySix::Diagonal(d) => {
                std::array::from_fn(|i| std::array::from_fn(|j| if i == j { d[i] } else { 0.0 }))
            }
        }
    }

    /// Its rows, if they are finite.
    fn finite(&self, field: &str) -> Result<Six, BuildError> {
        let rows = self.rows();
        rows.iter().try_for_each(|row| finite(field, row))?;
        Ok(rows)
    }

    /// The same of what has an energy.
    fn symmetric(&self, field: &str) -> Result<Six, BuildError> {
        let rows = self.finite(field)?;
        for i in 0..MOTIONS {
            for j in 0..i {
                let (a, b) = (rows[i][j], rows[j][i]);
                if (a - b).abs() > 1e-6 * a.abs().max(b.abs()) {
                    let message = format!(
                        "`{field}` must be symmetric, and {a:e} in row {}, column {} isn't {b:e} across: take their mean",
                        i + 1,
                        j + 1
                    );
                    return Err(BuildError::at(field, message));
                }
            }
        }
        Ok(std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (rows[i][j] + rows[j][i]))))
    }
}

/// Whether `x·Mx` is nowhere negative, up to rounding: by elimination of the symmetric part.
fn is_positive(m: &Six) -> bool {
    let mut a: Six = std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (m[i][j] + m[j][i])));
    // in units in which the diagonal is 1
    let unit: [f64; MOTIONS] = std::array::from_fn(|i| a[i][i].max(0.0).sqrt());
    for i in 0..MOTIONS {
        if a[i][i] < 0.0 || (0..MOTIONS).any(|j| unit[i] == 0.0 && a[i][j] != 0.0) {
            return false;
        }
        for j in 0..MOTIONS {
            let by = unit[i] * unit[j];
            a[i][j] = if by > 0.0 { a[i][j] / by } else { 0.0 };
        }
    }
    for k in 0..MOTIONS {
        if unit[k] == 0.0 {
            continue;
        }
        let pivot = a[k][k] + 1e-9;
        if !(pivot > 0.0) {
            return false;
        }
        for i in k + 1..MOTIONS {
            let factor = a[i][k] / pivot;
            for j in k..MOTIONS {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    true
}

impl FreeVesselSpec {
    /// The body that the marker is on.
    fn body(&self, b: &Builder) -> Result<Arc<dyn Part>, BuildError> {
        let name = match &self.marker {
            MarkerRef::Name(name) => split_marker(name).map_err(|e| BuildError::at("marker", e))?.0,
            MarkerRef::Point(_) => {
                return Err(BuildError::at("marker", "a vessel is a rigid body, not a point in space"));
            }
        };
        let all = b.parts(&[name.to_string()]).map_err(|e| e.of("marker"))?;
        all.into_iter().next().map(|(_, part)| part).ok_or_else(|| self.no_body())
    }

    fn no_body(&self) -> BuildError {
        let message = format!("a vessel is a rigid body, and {} isn't on one", self.marker);
        BuildError::at("marker", message)
    }

    /// Loads of the waves of the scene.
    fn waves(&self, b: &Builder, place: [f64; 2]) -> Result<Option<(VesselResponse, [f64; 2])>, BuildError> {
        let Some(loads) = &self.loads else { return Ok(None) };
        let responses = loads.loads("loads")?;
        let sea = b.water().ok().and_then(|water| water.sea.clone()).ok_or_else(|| {
            let message = "these are loads of waves, and the scene has none: add [water.waves]";
            BuildError::at("loads", message)
        })?;
        Ok(Some((VesselResponse::new(sea.waves(), &responses, place, self.heading), sea.periods())))
    }
}

#[typetag::serde(name = "free_vessel")]
impl ForceSpec for FreeVesselSpec {
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker]
    }
    fn responses(&self) -> Option<(&str, &RaoSpec)> {
        Some((&self.name, self.loads.as_ref()?))
    }
    fn notes(&self) -> Vec<String> {
        let k = self.stiffness.rows();
        let long = self.loads.as_ref().and_then(|loads| loads.long_loads([k[2][2], k[3][3], k[4][4]]));
        long.into_iter().map(|text| format!("`{}` {text}", self.name)).collect()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        finite("heading", &[self.heading])?;
        finite("mean_load", &self.mean_load)?;
        for x in self.quadratic_damping {
            not_negative("quadratic_damping", x)?;
        }
        let (stiffness, added) =
            (self.stiffness.symmetric("stiffness")?, self.added_mass.symmetric("added_mass")?);
        let damping = self.damping.finite("damping")?;
        for (field, matrix, wrong) in [
            ("added_mass", &added, "has a motion with less than no inertia"),
            ("damping", &damping, "drives a motion instead of damping it"),
        ] {
            if !is_positive(matrix) {
                let message = format!("`{field}` {wrong}: x·{field} x must be nowhere negative");
                return Err(BuildError::at(field, message));
            }
        }
        let part = self.body(b)?;
        let on = b.marker("marker", &self.marker)?;
        let Some(node) = on.on().map(|k| b.nodes()[k.0 as usize]).filter(|n| n.kind == NodeKind::Frame)
        else {
            return Err(self.no_body());
        };
        if part.dead_load(Per::Volume, [0.0, 0.0, 1.0]).is_some() {
            let message = format!("buoyancy of `{}` is in `stiffness`: leave its `volume` out", part.name());
            return Err(BuildError::at("marker", message));
        }
        let place = b.place(&on).x;
        let (sin, cos) = self.heading.sin_cos();
        let axes = [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]];
        let on = on.with_axes(b.nodes(), b.coordinates(), axes);
        let Marker::Node { point, axes: own, .. } = on else { return Err(self.no_body()) };
        let mean = Marker::Ground { point: place, axes };
        let mut vessel = FreeVessel::new(&self.name, b.nodes(), mean, on)?.with(
            stiffness,
            damping,
            self.quadratic_damping,
            self.mean_load,
        );
        if let Some((response, periods)) = self.waves(b, [place[0], place[1]])? {
            vessel = vessel.in_waves(response, periods);
        }
        b.term(Box::new(vessel));
        if added.iter().flatten().any(|x| *x != 0.0) {
            b.term(Box::new(VesselInertia::new(&self.name, [node.q, node.v], point, own, &added)));
        }
        // at rest water carries what it weighs
        if b.weighs(part.name())
            && let Some(lift) = part.dead_load(Per::Mass, b.gravity().map(|g| -g))
        {
            b.term(lift);
        }
        Ok(())
    }
}
