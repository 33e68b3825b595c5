//! `type = "drag"`.

use super::{Drag, NormalLaw, PerLength, TangentialLaw};
use crate::buoyancy::surface;
use crate::{EndDrag, Surface, Wetted, at_tip};
use ropewalk_core::error::not_negative;
use ropewalk_core::{BuildError, Part, Tip};
use ropewalk_scene::{Builder, Current, ForceSpec, Sea, Water, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

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

/// Drag of water (and air, if the scene has it) on cables and hulls, with one law across and one along. In waves it goes by the
/// velocity relative to current and waves together.
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
        self.law_in(water.density, water.viscosity, water.current()?, water.sea.clone())
    }

    fn law_in(
        &self,
        density: f64,
        viscosity: f64,
        current: Current,
        sea: Option<Arc<Sea>>,
    ) -> Result<Drag, BuildError> {
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
        (drag.current, drag.sea) = (current, sea);
        drag.per = if self.stretched { PerLength::Stretched } else { PerLength::Unstretched };
        drag.blend = self.blend;
        drag.check()?;
        Ok(drag)
    }
}

/// The ends of a part that nothing holds.
pub(crate) fn free_tips(b: &Builder, part: &dyn Part) -> Vec<Tip> {
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
                let end = EndDrag {
                    density: fluid.density,
                    current: fluid.current.clone(),
                    sea: fluid.sea.clone(),
                    coefficient: self.end,
                    diameter: tip.diameter,
                    surface: surface.clone(),
                };
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
        for part in b.parts(&self.on)? {
            b.acts_once("drag", &part)?;
        }
        let air = match b.air() {
            Some(air) => Some(self.law_in(air.density, air.viscosity, air.wind()?, None)?),
            None => None,
        };
        // a scene in the air alone has no water
        if let (Some(air), true) = (&air, b.water().is_err()) {
            self.add_ends(b, air, None)?;
            return b.load(&self.on, air.clone());
        }
        let (water, surface) = (self.law(b.water()?)?, surface(b)?);
        self.add_ends(b, &water, surface.clone().map(|s| (s, false)))?;
        let Some(surface) = surface else { return b.load(&self.on, water) };
        b.load(&self.on, Wetted::below(surface.clone(), water))?;
        let Some(air) = air else { return Ok(()) };
        self.add_ends(b, &air, Some((surface.clone(), true)))?;
        b.load(&self.on, Wetted::above(surface, air))
    }
}
