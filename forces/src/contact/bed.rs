//! `type = "bed"`: the sea floor.

use super::friction::Friction;
use super::heights::Heights;
use super::law::Damping;
use super::shape::Shape;
use super::shape_spec::ShapeSpec;
use super::spec::{ContactSpec, Dry, Overlap, dry};
use super::stiffness::Stiffness;
use ropewalk_core::error::{finite, not_negative, positive};
use ropewalk_core::rotation::{IDENTITY, around};
use ropewalk_core::{BuildError, Marker, V3};
use ropewalk_scene::{Builder, ForceSpec, MarkerRef, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;
use std::path::PathBuf;
use std::sync::Arc;

/// Depth over which damping takes hold, in parts of the smallest radius.
const TAKES_HOLD: f64 = 0.1;

/// Heights above the crossings of one line along x of a grid [m].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct HeightRow(#[serde(deserialize_with = "quantity::list::length")] pub Vec<f64>);

/// Heights on a grid, in numbers or from a file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GridSpec {
    /// A CSV file with a row `x, y, z` [m] for each crossing of the grid; its path is relative to the scene file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// Lines of the grid along x, ascending [m].
    #[serde(deserialize_with = "quantity::list::length")]
    pub x: Vec<f64>,
    /// Lines along y [m].
    #[serde(deserialize_with = "quantity::list::length")]
    pub y: Vec<f64>,
    /// Heights: for each `x` a row with one for each `y` [m].
    pub z: Vec<HeightRow>,
}

/// The sea floor: a plane, level or sloping, or heights on a grid. It presses on cables all along where their surface is below it, on
/// hulls and on point masses, brakes what comes down, and holds with dry friction, along and across, without creep.
///
/// A cable lies with its axis half a diameter above the bed, less the sinkage `w/(stiffness d)` under its weight `w` per length: a
/// small part of the water depth keeps tensions right. Records of type `touchdown` show where a line comes to lie.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BedSpec {
    /// Name.
    #[serde(default = "named")]
    pub name: String,
    /// Parts that can lie on it. Default: all but clumps and floats that sit on a cable or a body, and have no size of their own.
    #[serde(default)]
    pub on: Vec<String>,
    /// A point of the bed [m]; with a `grid`, what its lines and heights are counted from. Default: the origin.
    #[serde(default, deserialize_with = "quantity::vec3::length")]
    pub point: V3<f64>,
    /// By what angle it slopes [rad].
    #[serde(default, deserialize_with = "quantity::angle", skip_serializing_if = "is_nought")]
    pub slope: f64,
    /// Horizontal direction in which it rises.
    #[serde(default = "ahead")]
    pub rises: [f64; 2],
    /// Heights on a grid, instead of a plane.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grid: Option<GridSpec>,
    /// Stiffness of the soil: pressure on the diameter of what lies on it, per depth [N/m³], such as `"100 kN/m^3"`.
    #[serde(default = "stiff", deserialize_with = "quantity::stiffness_per_area")]
    pub stiffness: f64,
    /// Damping of what comes down, the same per speed [N s/m³]. What leaves isn't held back.
    #[serde(default, deserialize_with = "quantity::damping_per_area")]
    pub damping: f64,
    /// Dry friction: a coefficient, or `{ mu, across, elastic_slip, equilibrium }`. Equilibria are those without it, unless
    /// `equilibrium` is `laid` or `pulled`.
    #[serde(default, deserialize_with = "dry")]
    #[schemars(with = "Option<Dry>")]
    pub friction: Option<Friction>,
    /// Contact radius of the parts [m]. Default: half of the diameter of the cable or hull.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub radius: Option<f64>,
}
register_spec!(Force, "bed", BedSpec);

fn named() -> String {
    "bed".into()
}
fn ahead() -> [f64; 2] {
    [1.0, 0.0]
}
fn stiff() -> f64 {
    1e6
}
fn is_nought(x: &f64) -> bool {
    *x == 0.0
}

impl Default for BedSpec {
    fn default() -> Self {
        BedSpec {
            name: named(),
            on: Vec::new(),
            point: [0.0; 3],
            slope: 0.0,
            rises: ahead(),
            grid: None,
            stiffness: stiff(),
            damping: 0.0,
            friction: None,
            radius: None,
        }
    }
}

impl BedSpec {
    /// The bed's shape, and where it is.
    fn shape(&self) -> Result<(Shape, Marker), BuildError> {
        finite("point", &self.point)?;
        finite("rises", &self.rises)?;
        let point = self.point;
        if let Some(grid) = &self.grid {
            if self.slope != 0.0 {
                return Err(BuildError::at(
                    "slope",
                    "a bed with a `grid` has its own slopes: leave `slope` out",
                ));
            }
            let heights = match &grid.file {
                Some(_) if !(grid.x.is_empty() && grid.y.is_empty() && grid.z.is_empty()) => {
                    Err(BuildError::at("file", "give either a `file` or `x`, `y` and `z`"))
                }
                Some(file) => Heights::read(file),
                None => {
                    let rows: Vec<Vec<f64>> = grid.z.iter().map(|row| row.0.clone()).collect();
                    Heights::new(grid.x.clone(), grid.y.clone(), &rows)
                }
            };
            let shape = Shape::Heights(Arc::new(heights.map_err(|e| e.of("grid"))?));
            return Ok((shape, Marker::Ground { point, axes: IDENTITY }));
        }
        let size = self.rises[0].hypot(self.rises[1]);
        if !(size > 0.0) {
            return Err(BuildError::at("rises", "`rises` is a direction, such as [1, 0]: it needs a length"));
        }
        if !(self.slope.abs() < FRAC_PI_2) {
            return Err(BuildError::at("slope", "a bed slopes by less than 90 degrees"));
        }
        let (sin, cos) = self.slope.sin_cos();
        let normal: V3<f64> = [-sin * self.rises[0] / size, -sin * self.rises[1] / size, cos];
        Ok((Shape::Plane, Marker::Ground { point, axes: around(normal) }))
    }
}

#[typetag::serde(name = "bed")]
impl ForceSpec for BedSpec {
    fn bed(&self) -> Option<(&str, f64)> {
        (self.grid.is_none() && self.slope == 0.0).then_some((self.name.as_str(), self.point[2]))
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        Vec::new()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        positive("stiffness", self.stiffness)?;
        not_negative("damping", self.damping)?;
        let (shape, marker) = self.shape()?;
        let mut contact = ContactSpec {
            on: self.on.clone(),
            radius: self.radius,
            friction: self.friction,
            // a scene may begin with straight lines that statics lays down
            overlap: Overlap::Allow,
            ..ContactSpec::new(&self.name, ShapeSpec::Plane { normal: [0.0, 0.0, 1.0] })
        };
        if let Some(radius) = self.radius {
            positive("radius", radius)?;
        }
        if self.damping > 0.0 {
            let over = TAKES_HOLD * contact.thinnest(b)?;
            contact.damping = Damping::Approach { retardation_time: self.damping / self.stiffness, over };
        }
        let stiffness = Stiffness { point: 0.0, per_length: 0.0, end: Some(0.0), area: Some(self.stiffness) };
        contact.place(b, shape, &marker, &stiffness)
    }
}
