//! What a scene says about lines that touch each other.

use super::super::friction::Friction;
use super::super::law::{ContactLaw, Damping};
use super::super::spec::{Dry, Overlap, dry};
use super::term::{LineContact, Touching};
use ropewalk_core::{At, BuildError};
use ropewalk_scene::{Builder, ForceSpec, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Contact of cables and of bodies with a hull with each other, and of cables with themselves: lines that cross, coils,
/// knots, a line that falls onto itself.
///
/// They touch anywhere along their length where their middle lines are nearer than both radii; ends are round. With
/// `friction` they hold on to each other. An end that starts in another line, more than half of the radius deep, is taken as tied to
/// it, and both leave each other alone there. Along one line, what is nearer than 1.6 diameters along it isn't looked at.
/// A record of type `force` shows what presses, how deep and over which length, and with friction what holds and which part of
/// what presses slips; a record `clearance` shows how near two
/// lines are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LineContactSpec {
    /// Name.
    pub name: String,
    /// The cables and bodies with a hull that touch one another. Default: all that have a diameter.
    #[serde(default)]
    pub on: Vec<String>,
    /// Whether each cable touches itself too.
    #[serde(default = "yes")]
    pub itself: bool,
    /// Contact stiffness per length [N/m²]; with an exponent other than 1, at a depth of 1 m.
    #[serde(deserialize_with = "quantity::stiffness_per_length")]
    pub stiffness_per_length: f64,
    /// Exponent `p` of the elastic force `k d^p`.
    #[serde(default = "one", deserialize_with = "quantity::number")]
    pub exponent: f64,
    /// Damping law along the normal.
    #[serde(default)]
    pub damping: Damping,
    /// Dry friction: a coefficient, or `{ mu, elastic_slip, equilibrium }`; `elastic_slip` is how far it gives way where lines
    /// press a hundredth of their thickness into each other. Lines that cross at less than 30° hold less across, down to
    /// nothing where they are parallel: they roll on each other. Equilibria are computed without friction unless `equilibrium` is
    /// `laid`.
    #[serde(default, deserialize_with = "dry", skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<Dry>")]
    pub friction: Option<Friction>,
    /// What to do with lines that start deep in each other.
    #[serde(default)]
    pub overlap: Overlap,
}
register_spec!(Force, "line_contact", LineContactSpec);

fn one() -> f64 {
    1.0
}
fn yes() -> bool {
    true
}

impl LineContactSpec {
    /// Contact of all lines with each other and with themselves, without damping.
    pub fn new(name: &str, stiffness_per_length: f64) -> Self {
        LineContactSpec {
            name: name.into(),
            on: Vec::new(),
            itself: true,
            stiffness_per_length,
            exponent: 1.0,
            damping: Damping::None,
            friction: None,
            overlap: Overlap::Refuse,
        }
    }

    /// The lines, and their masses per length.
    fn lines(&self, b: &Builder) -> Result<(Vec<Touching>, Vec<f64>), BuildError> {
        let mut densities = Vec::new();
        let mut lines = Vec::new();
        for (k, name) in self.on.iter().enumerate() {
            if self.on[..k].contains(name) {
                return Err(BuildError::at("on", format!("`{name}` is named twice")));
            }
        }
        for (_, part) in b.parts(&self.on)? {
            let spans = part.contact_spans();
            let slim = spans.is_empty() || spans.iter().any(|s| s.radius == 0.0);
            if !slim {
                let length: f64 = spans.iter().map(|s| s.length).sum();
                densities.push(part.mass() / length);
                lines.push(Touching { name: part.name().to_string(), spans });
            } else if !self.on.is_empty() {
                let what = if part.contact_spans().is_empty() {
                    "is no line: it needs a `hull`"
                } else {
                    "has no thickness: give its section a `diameter`"
                };
                return Err(BuildError::at("on", format!("`{}` {what}", part.name())));
            }
        }
        if lines.is_empty() {
            let message = "there is no cable with a `diameter` and no body with a `hull` in the scene that could touch another";
            return Err(BuildError::new(message));
        }
        Ok((lines, densities))
    }
}

#[typetag::serde(name = "line_contact")]
impl ForceSpec for LineContactSpec {
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let (lines, densities) = self.lines(b)?;
        let friction = self.friction.filter(|f| f.mu != 0.0);
        let law = ContactLaw { exponent: self.exponent, damping: self.damping, friction };
        let still = vec![0.0; b.coordinates().len()];
        let at = At { t: 0.0, q: b.coordinates(), v: &still, a: &still, internal: &[], relaxed: None };
        let contact = LineContact::new(&self.name, &lines, self.itself, self.stiffness_per_length, law, &at)?;
        let deepest = contact.deepest(&at).filter(|d| d.depth > 0.5 * d.radius);
        if let (Overlap::Refuse, Some(d)) = (self.overlap, deepest) {
            let [(a, s), (b, t)] = &d.lines;
            let message = format!(
                "`{a}` at {s:.4} m starts {:.3e} m deep in `{b}` at {t:.4} m, more than half of the radius of {:.3e} m: \
                 move them apart by that much, or set `overlap = \"allow\"` if they are to be thrown apart",
                d.depth, d.radius
            );
            return Err(BuildError::at("overlap", message));
        }
        let contact = match friction {
            Some(_) => {
                let memory = b.memory(&format!("{}: friction", self.name), contact.memory());
                contact.with_friction(&densities, memory)?
            }
            None => contact,
        };
        b.term(Box::new(contact));
        Ok(())
    }
}
