//! What a cable is made of, and how that changes along it.

use super::BendingStiffness;
use super::law::{AxialForce, BendingMoment};
use super::mesh::MeshSpec;
use ropewalk_core::BuildError;
use ropewalk_core::error::{finite, not_negative, positive};
use ropewalk_scene::{quantity, register_list};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

fn is_nought(x: &f64) -> bool {
    *x == 0.0
}

/// What a cable is made of. Every number stands for itself: nothing is derived from a diameter unless it is left out.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Section {
    /// Structural mass per unstretched length [kg/m]; gravity acts on it.
    #[serde(deserialize_with = "quantity::mass_per_length")]
    pub mass: f64,
    /// Axial stiffness EA [N]; or give `axial_force`.
    #[serde(default, deserialize_with = "quantity::axial_stiffness", skip_serializing_if = "is_nought")]
    pub ea: f64,
    /// Axial force over strain, instead of `ea`: `{ strain = [0, 0.01, 0.03], force = ["0 kN", "10 kN", "60 kN"] }`. Between
    /// the points the force follows a smooth curve that never falls, beyond them a straight line. Needs L4.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axial_force: Option<AxialForce>,
    /// Whether it only pulls: chains and ropes don't resist being pressed together. Needs L4.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub tension_only: bool,
    /// Bending stiffness EI [N m²]. With 0, the first and last element keep 1 % of their weight times their length
    /// squared, so that free ends have a direction. Two numbers where it isn't the same in all directions, of a cable with
    /// torsion: about the `normal` of the section, and about the axis across it.
    #[serde(default)]
    pub ei: BendingStiffness,
    /// Bending moment over curvature, instead of `ei`: `{ curvature = [0, 0.01, 0.1], moment = ["0 N m", "50 N m", "80 N m"] }`,
    /// the same in all directions and without loss of energy. Needs T3.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bending_moment: Option<BendingMoment>,
    /// Torsional stiffness GJ [N m²]. With it the cable can be twisted, and its ends are held against twisting where they are
    /// built in. Default: no torsion; but EI where the stress-free shape is curved.
    #[serde(
        default,
        deserialize_with = "quantity::optional::bending_stiffness",
        skip_serializing_if = "Option::is_none"
    )]
    pub gj: Option<f64>,
    /// Coupling `C` of torque and tension in laid ropes and armoured cables [N m]: `N = EA ε + C φ'` and `M = C ε + GJ φ'`, with
    /// `ea` measured while the ends can't turn. Positive of a right-hand lay: such a rope unlays when it is pulled. A torque
    /// factor `c`, by which the torque of a held end is `c d T`, means `C = c d EA`. Needs L4.
    #[serde(default, deserialize_with = "quantity::moment", skip_serializing_if = "is_nought")]
    pub torque_tension: f64,
    /// Polar moment of inertia of the section, per length [kg m], of a cable with torsion. Default: that of a solid round
    /// bar, `mass diameter²/8`.
    #[serde(
        default,
        deserialize_with = "quantity::optional::inertia_per_length",
        skip_serializing_if = "Option::is_none"
    )]
    pub rotary_inertia: Option<f64>,
    /// Mass of the water inside [kg/m]. It moves with the part and has no weight in water.
    #[serde(default, deserialize_with = "quantity::mass_per_length")]
    pub flooded: f64,
    /// Hydrodynamic diameter, for drag and added mass; what rolls in a groove, by `fleet_twist` of a `sheave`, rolls by it too [m].
    #[serde(default, deserialize_with = "quantity::length")]
    pub diameter: f64,
    /// Displaced volume per length, for buoyancy [m²]. Default: `π/4 diameter²`.
    #[serde(default, deserialize_with = "quantity::optional::area")]
    pub displaced: Option<f64>,
    /// Retardation time of stretching (Kelvin–Voigt) [s]: the axial force is `EA (ε + τ ε̇)`. With a table EA is its largest
    /// slope here.
    #[serde(default, deserialize_with = "quantity::time")]
    pub axial_retardation_time: f64,
    /// Retardation time of bending (Kelvin–Voigt) [s]: the moment is `EI (κ + τ κ̇)`, with the largest slope of a table. The rate is
    /// that in axes of the section where the cable has torsion, `gj`, and no end feeds, so that a bent shaft that spins is damped; else
    /// that seen along the tangent.
    #[serde(default, deserialize_with = "quantity::time")]
    pub bending_retardation_time: f64,
    /// Retardation time of twisting (Kelvin–Voigt) [s]: the torque is `GJ (φ' + τ dφ'/dt)`.
    #[serde(default, deserialize_with = "quantity::time", skip_serializing_if = "is_nought")]
    pub torsional_retardation_time: f64,
    /// Whether the spin of a cable with torsion about its own axis turns it aside, as that of a top does: of shafts that turn
    /// fast. Ropes don't notice.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub gyroscopic: bool,
}

impl Section {
    /// A section with mass and stiffness only.
    pub fn new(mass: f64, ea: f64, ei: f64) -> Self {
        Section {
            mass,
            ea,
            axial_force: None,
            tension_only: false,
            ei: ei.into(),
            bending_moment: None,
            gj: None,
            torque_tension: 0.0,
            rotary_inertia: None,
            flooded: 0.0,
            diameter: 0.0,
            displaced: None,
            axial_retardation_time: 0.0,
            bending_retardation_time: 0.0,
            torsional_retardation_time: 0.0,
            gyroscopic: false,
        }
    }
    /// Displaced volume per length [m²].
    pub fn displaced_area(&self) -> f64 {
        self.displaced.unwrap_or(std::f64::consts::PI * self.diameter * self.diameter / 4.0)
    }
    /// Whether it says nothing: of a cable that has several sections instead.
    pub(super) fn is_missing(&self) -> bool {
        *self == Section::default()
    }
    /// A field that means something for cables with torsion only, if one is given.
    pub(super) fn asks_for_torsion(&self) -> Option<&'static str> {
        let asked = [
            ("gj", self.gj.is_some()),
            ("torque_tension", self.torque_tension != 0.0),
            ("ei", self.ei.has_direction()),
            ("rotary_inertia", self.rotary_inertia.is_some()),
            ("torsional_retardation_time", self.torsional_retardation_time != 0.0),
            ("gyroscopic", self.gyroscopic),
        ];
        asked.into_iter().find(|(_, asked)| *asked).map(|(field, _)| field)
    }
    /// What of it bending with a direction or the lay of a rope asks for, if anything.
    pub(super) fn asks_for_direction(&self) -> Option<&'static str> {
        let asked = [("torque_tension", self.torque_tension != 0.0), ("ei", self.ei.has_direction())];
        asked.into_iter().find(|(_, asked)| *asked).map(|(field, _)| field)
    }
    /// Refuses numbers that no cable has.
    pub(super) fn check(&self) -> Result<(), BuildError> {
        positive("mass", self.mass)?;
        let both = |field: &'static str, other: &str| {
            Err(BuildError::at(
                field,
                format!("give `{other}` or `{field}`, not both: the table tells the stiffness"),
            ))
        };
        match &self.axial_force {
            Some(_) if self.ea != 0.0 => return both("axial_force", "ea"),
            Some(table) => table.curve().map(|_| ())?,
            None => positive("ea", self.ea).map(|_| ())?,
        }
        match &self.bending_moment {
            Some(_) if self.ei.largest() != 0.0 => return both("bending_moment", "ei"),
            Some(_) if self.gj.is_some() => {
                let message = "a cable with torsion has bending stiffnesses, `ei`, and no table";
                return Err(BuildError::at("bending_moment", message));
            }
            Some(table) => table.curve().map(|_| ())?,
            None => {}
        }
        positive("gj", self.gj.unwrap_or(1.0))?;
        finite("torque_tension", &[self.torque_tension])?;
        let (c, both) = (self.torque_tension, self.ea * self.gj.unwrap_or(0.0));
        if c != 0.0 && self.gj.is_some() && !(c * c < both) {
            let message = format!(
                "a rope of this coupling would stretch or twist by itself: `torque_tension` must be below √(EA GJ) = {:.4} N m",
                both.sqrt()
            );
            return Err(BuildError::at("torque_tension", message));
        }
        for (name, x) in [
            ("ei", self.ei.about_normal),
            ("ei", self.ei.across),
            ("flooded", self.flooded),
            ("diameter", self.diameter),
            ("displaced", self.displaced.unwrap_or(0.0)),
            ("axial_retardation_time", self.axial_retardation_time),
            ("bending_retardation_time", self.bending_retardation_time),
            ("torsional_retardation_time", self.torsional_retardation_time),
        ] {
            not_negative(name, x)?;
        }
        Ok(())
    }
}

/// One of several sections along a cable, from where the one before it ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SectionAlong {
    /// Where it ends: unstretched length from the start of the cable [m]. Default, of the last one: the end of the cable.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub to: Option<f64>,
    /// Its cross-section, or the name of one of the scene's `sections`.
    #[schemars(with = "NameOrSection")]
    pub section: Section,
    /// The cross-section at its end, of one that changes from `section` to this, such as a bend stiffener. EA and EI change
    /// linearly; all else (mass, diameter, …) too, in steps from element to element.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<NameOrSection>")]
    pub end_section: Option<Section>,
    /// Whether it can turn freely against the section before, as at a shackle: with a weight or a float there a line has a
    /// corner. Sections that differ in EA, one of which has no bending stiffness, always can.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub hinged: bool,
    /// Number of its elements, of equal length. Default: its share of the cable's `elements`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elements: Option<usize>,
    /// Elements of different lengths, instead of `elements`: as `mesh` of the cable, for this part of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshSpec>,
}

/// A cross-section, or the name of one: names are replaced when a scene is read.
#[derive(JsonSchema)]
#[serde(untagged)]
#[allow(dead_code)]
pub(super) enum NameOrSection {
    /// The section itself.
    Section(Box<Section>),
    /// The name of one of the scene's `sections`.
    Name(String),
}

/// An entry of a scene's `sections`, as editors and `describe` know it; the scene itself puts them where their names stand.
struct NamedSection;
register_list!("sections", NamedSection);

impl JsonSchema for NamedSection {
    fn schema_name() -> Cow<'static, str> {
        "NamedSection".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut schema = Section::json_schema(generator);
        let text = |about: &str| json_schema!({ "type": "string", "description": about }).to_value();
        if let Some(fields) = schema.get_mut("properties").and_then(|p| p.as_object_mut()) {
            let own = [
                ("name", "Name, by which cables ask for it: `section = \"chain\"`."),
                (
                    "file",
                    "Instead of all else: a `.toml` or `.json` file with more `[[sections]]`, relative to the scene.",
                ),
            ];
            let all = own.map(|(name, about)| (name.to_string(), text(about))).into_iter();
            *fields = all.chain(std::mem::take(fields)).collect();
        }
        schema.remove("required");
        schema.insert("description".into(), ABOUT.into());
        schema
    }
}

const ABOUT: &str = "A library of sections with names, for cables of this scene. What a cable is made of is then a name: \
                     `section = \"chain\"`. Sections of a file are read together with those of the scene.";
