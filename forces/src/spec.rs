//! What a scene says about forces.

use crate::{
    AddedMass, BluntEnd, Buoyancy, Drag, EndDrag, FeedingEnd, Float, LineLoad, NormalLaw, PerLength,
    PointForce, PointMoment, Spring, Surface, TangentialLaw, Theory, TimeFunction, Wetted, at_tip,
};
use ropewalk_core::error::{finite, not_negative};
use ropewalk_core::{BuildError, Part, Per, Tip, V3};
use ropewalk_scene::{Builder, Current, ForceSpec, MarkerRef, Water, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Weight: the scene's `gravity` acts on the structural mass of every part.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GravitySpec {
    /// Parts it acts on. Default: all.
    #[serde(default)]
    pub on: Vec<String>,
}
register_spec!(Force, "gravity", GravitySpec);

/// Adds a load in a constant direction to parts, once to each.
fn dead_loads(
    b: &mut Builder,
    kind: &'static str,
    on: &[String],
    per: Per,
    load: V3<f64>,
) -> Result<(), BuildError> {
    for part in b.parts(on)? {
        b.acts_once(kind, &part)?;
        if let Some(term) = part.1.dead_load(per, load) {
            b.term(term);
        }
    }
    Ok(())
}

#[typetag::serde(name = "gravity")]
impl ForceSpec for GravitySpec {
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        dead_loads(b, "gravity", &self.on, Per::Mass, b.gravity())
    }
}

/// Buoyancy of the displaced volume; if the water has a `level`, of the volume under water.
///
/// At the surface, cables, hulls and chains are cylinders; other bodies and point masses are spheres.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BuoyancySpec {
    /// Parts it acts on. Default: all.
    #[serde(default)]
    pub on: Vec<String>,
}
register_spec!(Force, "buoyancy", BuoyancySpec);

#[typetag::serde(name = "buoyancy")]
impl ForceSpec for BuoyancySpec {
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let (density, surface) = (b.water()?.density, surface(b)?);
        let lift = b.gravity().map(|g| -density * g);
        match surface {
            None => dead_loads(b, "buoyancy", &self.on, Per::Volume, lift),
            Some(surface) => self.floating(b, lift, surface),
        }
    }
}

impl BuoyancySpec {
    /// Parts that may lie across the surface.
    fn floating(&self, b: &mut Builder, lift: V3<f64>, surface: Surface) -> Result<(), BuildError> {
        let mut slender = Vec::new();
        for part in b.parts(&self.on)? {
            b.acts_once("buoyancy", &part)?;
            let (_, part) = part;
            if part.dead_load(Per::Volume, lift).is_none() {
                continue;
            }
            match part.ball() {
                Some((held, volume)) => {
                    let label = format!("{}: buoyancy", part.name());
                    b.term(Box::new(Float::new(label, held, volume, lift[2], surface)?));
                }
                None => slender.push(part.name().to_string()),
            }
        }
        if slender.is_empty() {
            return Ok(());
        }
        let stiff: Vec<bool> =
            slender.iter().map(|name| b.feeding(name).iter().all(Option::is_none)).collect();
        b.load_by(&slender, |part| {
            let couple = slender.iter().zip(&stiff).any(|(name, stiff)| *stiff && name == part.name());
            Buoyancy { specific_weight: lift[2], surface, couple }
        })
    }
}

/// The surface of the scene's water, if it has one.
///
/// # Errors
/// Gravity doesn't point down: water at rest isn't level then.
fn surface(b: &Builder) -> Result<Option<Surface>, BuildError> {
    let Some(level) = b.water()?.level else { return Ok(None) };
    let g = b.gravity();
    if g[0] != 0.0 || g[1] != 0.0 || g[2] > 0.0 {
        let message = format!(
            "the water has a `level`, but gravity {g:?} m/s² isn't across it: make it point down, along -z"
        );
        return Err(BuildError::at("gravity", message));
    }
    Ok(Some(Surface { level }))
}

/// Law of drag across or along a cable.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DragLaw {
    /// A constant coefficient.
    Constant,
    /// The law of Choo and Casarella (1971), by Reynolds number.
    ChooCasarella,
}

fn constant() -> DragLaw {
    DragLaw::Constant
}
fn normal_coefficient() -> f64 {
    1.2
}
fn tangential_coefficient() -> f64 {
    0.01
}

/// Drag of water (and air, if the scene has it) on cables and hulls, with one law across and one along.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DragSpec {
    /// Law across the cable.
    #[serde(default = "constant")]
    pub normal: DragLaw,
    /// Law along the cable.
    #[serde(default = "constant")]
    pub tangential: DragLaw,
    /// Coefficient across, for the constant law, on the diameter.
    #[serde(default = "normal_coefficient", deserialize_with = "quantity::number")]
    pub cn: f64,
    /// Coefficient along, for the constant law, on the circumference.
    #[serde(default = "tangential_coefficient", deserialize_with = "quantity::number")]
    pub ct: f64,
    /// Form drag of each free end of cables, hulls and chains: coefficient on the area of the end face. Both ends of
    /// a long blunt cylinder have about 0.8 together.
    #[serde(default, deserialize_with = "quantity::number")]
    pub end: f64,
    /// Whether drag acts per stretched length instead of unstretched length.
    #[serde(default)]
    pub stretched: bool,
    /// Relative width in Reynolds number over which the branches of Choo and Casarella are blended. Default: they
    /// jump, as published.
    #[serde(default, deserialize_with = "quantity::optional::number")]
    pub blend: Option<f64>,
    /// Cables it acts on. Default: all.
    #[serde(default)]
    pub on: Vec<String>,
}
register_spec!(Force, "drag", DragSpec);

impl Default for DragSpec {
    fn default() -> Self {
        DragSpec {
            normal: DragLaw::Constant,
            tangential: DragLaw::Constant,
            cn: normal_coefficient(),
            ct: tangential_coefficient(),
            end: 0.0,
            stretched: false,
            blend: None,
            on: Vec::new(),
        }
    }
}

impl DragSpec {
    /// The law in this water.
    ///
    /// # Errors
    /// Numbers that make no sense.
    pub fn law(&self, water: &Water) -> Result<Drag, BuildError> {
        self.law_in(water.density, water.viscosity, water.current()?)
    }

    fn law_in(&self, density: f64, viscosity: f64, current: Current) -> Result<Drag, BuildError> {
        not_negative("cn", self.cn)?;
        not_negative("ct", self.ct)?;
        let normal = match self.normal {
            DragLaw::Constant => NormalLaw::Constant(self.cn),
            DragLaw::ChooCasarella => NormalLaw::ChooCasarella,
        };
        let tangential = match self.tangential {
            DragLaw::Constant => TangentialLaw::Quadratic(self.ct),
            DragLaw::ChooCasarella => TangentialLaw::ChooCasarella,
        };
        let mut drag = Drag::new(density, viscosity, normal, tangential)?;
        drag.current = current;
        drag.per = if self.stretched { PerLength::Stretched } else { PerLength::Unstretched };
        drag.blend = self.blend;
        drag.check()?;
        Ok(drag)
    }
}

/// The ends of a part that nothing holds.
fn free_tips(b: &Builder, part: &dyn Part) -> Vec<Tip> {
    part.tips().into_iter().filter(|tip| !b.is_held(&tip.marker)).collect()
}

impl DragSpec {
    /// Form drag of the ends that nothing holds.
    fn add_ends(
        &self,
        b: &mut Builder,
        fluid: &Drag,
        surface: Option<(Surface, bool)>,
    ) -> Result<(), BuildError> {
        if not_negative("end", self.end)? == 0.0 {
            return Ok(());
        }
        for (_, part) in b.parts(&self.on)? {
            for tip in free_tips(b, part.as_ref()) {
                let (density, current) = (fluid.density, fluid.current.clone());
                let end =
                    EndDrag { density, current, coefficient: self.end, diameter: tip.diameter, surface };
                if let Some(term) = at_tip(end, part.name(), b.nodes(), &tip) {
                    b.term(term);
                }
            }
        }
        Ok(())
    }
}

#[typetag::serde(name = "drag")]
impl ForceSpec for DragSpec {
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let air = match b.air() {
            Some(air) => Some(self.law_in(air.density, air.viscosity, air.wind()?)?),
            None => None,
        };
        // a scene in the air alone has no water
        if let (Some(air), true) = (&air, b.water().is_err()) {
            self.add_ends(b, air, None)?;
            return b.load(&self.on, air.clone());
        }
        let (water, surface) = (self.law(b.water()?)?, surface(b)?);
        self.add_ends(b, &water, surface.map(|s| (s, false)))?;
        let Some(surface) = surface else { return b.load(&self.on, water) };
        b.load(&self.on, Wetted::below(surface, water))?;
        let Some(air) = air else { return Ok(()) };
        self.add_ends(b, &air, Some((surface, true)))?;
        b.load(&self.on, Wetted::above(surface, air))
    }
}

fn one() -> f64 {
    1.0
}

/// Added mass of cables and hulls: inertia of the water, and its forces in flow along the body.
///
/// It follows from the kinetic energy of the water: a hull at an angle to the flow has Munk's moment, and flow along
/// a cable acts like compression and can cause flutter. `theory = "morison"` keeps the inertia only, for comparison
/// with codes that have no more.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AddedMassSpec {
    /// Coefficient: added mass over the mass of water in a cylinder of the hydrodynamic diameter.
    #[serde(default = "one", deserialize_with = "quantity::number")]
    pub ca: f64,
    /// `energy` or `morison`. Default: `energy`.
    #[serde(default)]
    pub theory: Option<Theory>,
    /// Fraction of its momentum that the water returns at free ends of cables: 0 for cut ends, about 0.8 for tapered
    /// ends, 1 for an ideal tail.
    #[serde(default, deserialize_with = "quantity::number")]
    pub tail: f64,
    /// Parts it acts on. Default: all.
    #[serde(default)]
    pub on: Vec<String>,
}
register_spec!(Force, "added_mass", AddedMassSpec);

impl Default for AddedMassSpec {
    fn default() -> Self {
        AddedMassSpec { ca: 1.0, theory: None, tail: 0.0, on: Vec::new() }
    }
}

#[typetag::serde(name = "added_mass")]
impl ForceSpec for AddedMassSpec {
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        not_negative("ca", self.ca)?;
        if !(0.0..=1.0).contains(&self.tail) {
            return Err(BuildError::at("tail", format!("`tail` must be between 0 and 1, not {}", self.tail)));
        }
        let surface = surface(b)?;
        let water = b.water()?;
        let law = AddedMass::new(water.density, self.ca)?.in_current(water.current()?)?;
        let theory = self.theory.unwrap_or_default();
        for numbered in b.parts(&self.on)? {
            b.acts_once("added_mass", &numbered)?;
            if theory == Theory::Energy {
                self.add_ends(b, numbered.1.as_ref(), &law, surface);
            }
        }
        let law = law.by(theory);
        match surface {
            None => b.load(&self.on, law),
            Some(surface) => b.load(&self.on, Wetted::below(surface, law)),
        }
    }
}

impl AddedMassSpec {
    /// Water leaves at the ends of a cable or a chain that nothing holds. Hulls of single bodies keep what it has, as
    /// Kirchhoff's equations have it. Where an end feeds, more or less of the cable has water beside it.
    fn add_ends(&self, b: &mut Builder, part: &dyn Part, law: &AddedMass, surface: Option<Surface>) {
        for tip in free_tips(b, part).into_iter().filter(|tip| tip.sheds) {
            let (added_mass, taper) = (law.clone(), self.tail);
            let end = BluntEnd { added_mass, diameter: tip.diameter, taper, first: tip.first, surface };
            if let Some(term) = at_tip(end, part.name(), b.nodes(), &tip) {
                b.term(term);
            }
        }
        let diameter = part.tips().first().map_or(0.0, |tip| tip.diameter);
        for (end, name) in [(0, "start"), (1, "end")] {
            if let Some(boundary) = part.boundary(end).filter(|_| diameter > 0.0) {
                let label = format!("{}: water at its {name}", part.name());
                let added_mass = law.clone();
                b.term(Box::new(FeedingEnd { label, added_mass, diameter, surface, boundary }));
            }
        }
    }
}

/// A distributed force in a constant direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LineLoadSpec {
    /// Force per length [N/m].
    #[serde(deserialize_with = "quantity::vec3::force_per_length")]
    pub force: V3<f64>,
    /// Whether it acts per stretched length instead of unstretched length.
    #[serde(default)]
    pub stretched: bool,
    /// Factor as a function of time.
    #[serde(default)]
    pub time: TimeFunction,
    /// Cables it acts on. Default: all.
    #[serde(default)]
    pub on: Vec<String>,
}
register_spec!(Force, "line_load", LineLoadSpec);

#[typetag::serde(name = "line_load")]
impl ForceSpec for LineLoadSpec {
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        finite("force", &self.force)?;
        let per = if self.stretched { PerLength::Stretched } else { PerLength::Unstretched };
        b.load(&self.on, LineLoad::new(self.force, per, self.time.clone())?)
    }
}

/// A force at a marker: in a constant direction, in the axes of a rigid body, or along a cable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointForceSpec {
    /// The marker on which it acts.
    pub marker: MarkerRef,
    /// Force in space [N].
    #[serde(default, deserialize_with = "quantity::vec3::force")]
    pub force: V3<f64>,
    /// Whether `force` is given in the axes of the rigid body and turns with it.
    #[serde(default)]
    pub local: bool,
    /// Follower force along the cable, towards its end [N], instead of `force`. It turns with the cable.
    #[serde(default, deserialize_with = "quantity::optional::force")]
    pub follower: Option<f64>,
    /// Factor as a function of time.
    #[serde(default)]
    pub time: TimeFunction,
}
register_spec!(Force, "point_force", PointForceSpec);

impl PointForceSpec {
    /// A force in space.
    pub fn new(marker: impl Into<MarkerRef>, force: V3<f64>, time: TimeFunction) -> Self {
        PointForceSpec { marker: marker.into(), force, local: false, follower: None, time }
    }
}

#[typetag::serde(name = "point_force")]
impl ForceSpec for PointForceSpec {
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker]
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let marker = b.marker("marker", &self.marker)?;
        let label = format!("force at {}", self.marker);
        let term = match (self.follower, marker.on()) {
            (None, _) if self.local => {
                PointForce::on_body(label, b.nodes(), &marker, self.force, self.time.clone())?
            }
            (None, _) => PointForce::dead(label, b.nodes(), &marker, self.force, self.time.clone())?,
            (Some(_), _) if self.force != [0.0; 3] => {
                return Err(BuildError::at("follower", "give `force` or `follower`, not both"));
            }
            (Some(f), Some(node)) => PointForce::follower(label, b.nodes(), node, f, self.time.clone())?,
            (Some(_), None) => {
                return Err(BuildError::at("marker", "a follower force needs a marker on a cable"));
            }
        };
        b.term(Box::new(term));
        Ok(())
    }
}

/// A moment on a rigid body or a cable, in space or in the axes of the body. A component along a cable has no effect:
/// cables have no torsion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointMomentSpec {
    /// The marker on which it acts.
    pub marker: MarkerRef,
    /// Moment [N m].
    #[serde(deserialize_with = "quantity::vec3::moment")]
    pub moment: V3<f64>,
    /// Whether `moment` is given in the axes of the rigid body and turns with it.
    #[serde(default)]
    pub local: bool,
    /// Factor as a function of time.
    #[serde(default)]
    pub time: TimeFunction,
}
register_spec!(Force, "point_moment", PointMomentSpec);

#[typetag::serde(name = "point_moment")]
impl ForceSpec for PointMomentSpec {
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker]
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let marker = b.marker("marker", &self.marker)?;
        let Some(node) = marker.on() else {
            return Err(BuildError::at("marker", "a moment needs a marker on a rigid body or a cable"));
        };
        let label = format!("moment at {}", self.marker);
        let make = if self.local { PointMoment::on_body } else { PointMoment::new };
        let term = make(label, b.nodes(), node, self.moment, self.time.clone())?;
        b.term(Box::new(term));
        Ok(())
    }
}

/// A spring and damper between two markers, along the line between them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpringSpec {
    /// Name.
    pub name: String,
    /// One end.
    pub marker: MarkerRef,
    /// The other end: a marker or a point in space.
    pub to: MarkerRef,
    /// Stiffness [N/m].
    #[serde(deserialize_with = "quantity::spring_stiffness")]
    pub stiffness: f64,
    /// Damping [N s/m].
    #[serde(default, deserialize_with = "quantity::damping")]
    pub damping: f64,
    /// Length without force [m]. Default: the initial length.
    #[serde(default, deserialize_with = "quantity::optional::length")]
    pub length: Option<f64>,
    /// Whether it can only pull.
    #[serde(default)]
    pub tension_only: bool,
}
register_spec!(Force, "spring", SpringSpec);

#[typetag::serde(name = "spring")]
impl ForceSpec for SpringSpec {
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker, &self.to]
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        not_negative("stiffness", self.stiffness)?;
        not_negative("damping", self.damping)?;
        let ends = [b.marker("marker", &self.marker)?, b.marker("to", &self.to)?];
        let [a, c] = [b.place(&ends[0]).x, b.place(&ends[1]).x];
        let start = (0..3).map(|i| (c[i] - a[i]).powi(2)).sum::<f64>().sqrt();
        let length = not_negative("length", self.length.unwrap_or(start))?;
        let mut spring = Spring::new(&self.name, b.nodes(), ends, self.stiffness, length)?;
        spring.damping = self.damping;
        spring.tension_only = self.tension_only;
        b.term(Box::new(spring));
        Ok(())
    }
}
