//! Which unknowns are coupled: what terms and constraints declare before the structure of the matrix is made.

/// Collects the couplings of all terms, each as a clique of unknowns.
///
/// ```
/// use ropewalk_core::Pattern;
/// let mut pattern = Pattern::default();
/// pattern.clique(0..6);
/// pattern.clique([3, 4, 5, 9]);
/// assert_eq!((pattern.len(), pattern.get(1)), (2, &[3, 4, 5, 9][..]));
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Pattern {
    /// Unknowns of all cliques, one after the other.
    dofs: Vec<u32>,
    /// Where each clique ends in `dofs`.
    ends: Vec<usize>,
}

impl Pattern {
    /// Declares that these unknowns (indices of velocities) are coupled with each other.
    pub fn clique(&mut self, dofs: impl IntoIterator<Item = usize>) {
        self.dofs.extend(dofs.into_iter().map(|d| d as u32));
        self.ends.push(self.dofs.len());
    }
    /// Number of cliques so far.
    pub fn len(&self) -> usize {
        self.ends.len()
    }
    /// Whether there is no clique.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }
    /// The unknowns of one clique.
    pub fn get(&self, k: usize) -> &[u32] {
        &self.dofs[if k == 0 { 0 } else { self.ends[k - 1] }..self.ends[k]]
    }
}
