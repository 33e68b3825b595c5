//! Constraints that say what others have said.

/// Which constraints are redundant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Redundancy {
    /// Equations that could be left out.
    pub equations: usize,
    /// Names of the constraints that take part.
    pub constraints: Vec<String>,
}

impl std::fmt::Display for Redundancy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        const MOST: usize = 6;
        let names =
            self.constraints.iter().take(MOST).map(|c| format!("`{c}`")).collect::<Vec<_>>().join(", ");
        let more = match self.constraints.len().saturating_sub(MOST) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let which = match self.equations {
            1 => "one equation follows".to_string(),
            n => format!("{n} equations follow"),
        };
        write!(f, "{which} from the others: {names}{more}")
    }
}
