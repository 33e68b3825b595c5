//! Connections that break.

use ropewalk_core::error::positive;
use ropewalk_core::{Action, BuildError, Depends, Event, Marker, Model, State};
use ropewalk_scene::{Builder, ConstraintSpec, MarkerRef, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Breaks a constraint permanently once its force reaches a limit: a shear pin, a weak link. The event is located in
/// time and reported.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BreakSpec {
    /// Name; the report of the event uses it.
    pub name: String,
    /// Name of the constraint that breaks. It must come earlier in the scene.
    pub constraint: String,
    /// Magnitude of the force at which the constraint breaks [N].
    #[serde(deserialize_with = "quantity::force")]
    pub force: f64,
}
register_spec!(Constraint, "break", BreakSpec);

#[typetag::serde(name = "break")]
impl ConstraintSpec for BreakSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        Vec::new()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        positive("force", self.force)?;
        if let Some(guide) = guided(b, &self.constraint) {
            let message = format!(
                "`{guide}` leads a cable, which can't come off from it by breaking: break what carries `{guide}`"
            );
            return Err(BuildError::at("constraint", message));
        }
        let variable = b.internal_variable(&self.name);
        let constraint = b.release(&self.constraint, variable)?;
        b.event(Break { name: self.name.clone(), constraint, variable, force: self.force });
        Ok(())
    }
}

/// The sheave, ring or drum that made a constraint, if one did: it can't do without, and others of its equations would stay.
fn guided<'a>(b: &Builder, constraint: &'a str) -> Option<&'a str> {
    let numbered = |name: &'a str| {
        name.rsplit_once('.').filter(|(_, k)| k.parse::<usize>().is_ok()).map(|(name, _)| name)
    };
    let bare = [".in", ".out", ".rope", ": torsion"].iter().find_map(|what| constraint.strip_suffix(what));
    [Some(constraint), bare, numbered(constraint)].into_iter().flatten().find(|name| b.guide(name).is_ok())
}

struct Break {
    name: String,
    constraint: usize,
    variable: usize,
    force: f64,
}

impl Event for Break {
    fn name(&self) -> String {
        self.name.clone()
    }
    fn value(&self, model: &Model, state: &State) -> f64 {
        if state.internal[self.variable] != 0.0 {
            return -1.0;
        }
        let Some(node) = model.constraints()[self.constraint].markers().iter().rev().find_map(Marker::on)
        else {
            return -1.0;
        };
        let force = model.reaction(self.constraint, node, &state.at(), &state.lambda);
        force.iter().take(3).map(|f| f * f).sum::<f64>().sqrt() / self.force - 1.0
    }
    fn direction(&self) -> i8 {
        1
    }
    fn depends(&self) -> Depends {
        Depends::OnForces
    }
    fn act(&self, _: &Model, state: &mut State) -> Action {
        state.internal[self.variable] = 1.0;
        Action::Restart
    }
}
