//! From one mesh to another: the same scene built anew, and states carried over.

use crate::error::BuildError;
use crate::model::Model;
use crate::model::remesh::Plan;
use crate::model::state::State;

impl Model {
    /// The same scene on other meshes.
    ///
    /// # Errors
    /// The mesh of this model never changes, or the new one can't be built.
    pub fn remesh(&self, plan: &Plan) -> Result<Model, BuildError> {
        let none =
            || BuildError::new("this model can't be built anew: its mesh doesn't change while it runs");
        let recipe = self.recipe.as_ref().ok_or_else(none)?;
        let model = recipe(plan)?.with_width(self.width);
        for (new, old) in model.inputs.iter().zip(&self.inputs) {
            new.follow(old.course());
        }
        Ok(model)
    }

    /// A state of another model of the same scene brought over to this one: each part interpolates its own. The
    /// result still has to be made consistent.
    pub fn carry(&self, old: &Model, state: &State) -> State {
        let mut new = self.state();
        new.t = state.t;
        new.internal.clone_from(&state.internal);
        for part in &self.parts {
            if let Some(other) = old.part(part.name()) {
                part.carry(&self.nodes, other.as_ref(), &state.at(), &mut new.q, &mut new.v);
            }
        }
        self.count_on(&old.labels(&state.q), &mut new);
        new
    }
}
