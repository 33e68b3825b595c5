//! Constraints that say what others have said.

/// Which constraints are redundant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Redundancy {
    /// Equations that could be left out.
    pub equations: usize,
    /// Names of the constraints that take part.
    pub constraints: Vec<String>,
    /// Whether some follow only at the very place where the model starts: a linkage at a dead point.
    pub dead_point: bool,
}

impl Redundancy {
    /// The constraints that take part, as messages name them.
    #[must_use]
    pub fn names(&self) -> String {
        const MOST: usize = 6;
        let names =
            self.constraints.iter().take(MOST).map(|c| format!("`{c}`")).collect::<Vec<_>>().join(", ");
        match self.constraints.len().saturating_sub(MOST) {
            0 => names,
            more => format!("{names} and {more} more"),
        }
    }
}

impl std::fmt::Display for Redundancy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let which = match self.equations {
            1 => "one equation follows".to_string(),
            n => format!("{n} equations follow"),
        };
        write!(f, "{which} from the others: {}", self.names())
    }
}
