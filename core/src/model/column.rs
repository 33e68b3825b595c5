//! Columns of a history.

/// A named column of the history.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name, such as `hose.end.x`.
    pub name: String,
    /// SI unit, such as `m`.
    pub unit: String,
}

impl Column {
    /// A column.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Column { name: name.into(), unit: unit.into() }
    }
}
