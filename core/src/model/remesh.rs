//! Meshes that change while a run goes on.

use std::collections::BTreeMap;

/// A mesh that a part is built on instead of that of its spec.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Mesh {
    /// Unstretched arc length of each node, as material coordinate where material flows [m].
    pub nodes: Vec<f64>,
    /// What the part goes on from; left out, its state is interpolated from what it was before.
    pub state: Option<MeshState>,
    /// Strain that fades out.
    pub prestrain: Vec<Prestrain>,
}

impl From<Vec<f64>> for Mesh {
    fn from(nodes: Vec<f64>) -> Self {
        Mesh { nodes, ..Mesh::default() }
    }
}

/// Coordinates and velocities of the nodes of a new mesh.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MeshState {
    /// Coordinates of each node.
    pub q: Vec<Vec<f64>>,
    /// Velocities of each node.
    pub v: Vec<Vec<f64>>,
    /// What elements have of their own besides (the bubble of those whose bending has a direction), and its rate, element by
    /// element; empty where there is nothing.
    #[cfg_attr(feature = "serde", serde(default))]
    pub inner: Vec<[f64; 2]>,
    /// For the start and the end, where they feed: rate of the material coordinate there [m/s].
    pub boundaries: [f64; 2],
}

/// A stress-free strain of one element that fades out smoothly: what keeps its tension from jumping when its neighbours
/// are split or merged.
///
/// ```
/// use ropewalk_core::Prestrain;
/// let fading = Prestrain { element: 0, strain: vec![1e-3], since: 10.0, fade: 2.0 };
/// assert_eq!((fading.left(10.0).0, fading.left(11.0).0, fading.left(12.0).0), (1.0, 0.5, 0.0));
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Prestrain {
    /// The element, by number along the mesh.
    pub element: usize,
    /// The strain at each of its quadrature points, before it fades.
    pub strain: Vec<f64>,
    /// When it begins to fade [s].
    pub since: f64,
    /// How long it takes [s].
    pub fade: f64,
}

impl Prestrain {
    /// What is left of it at time `t`, between 1 and 0, and the rate of that [1/s].
    pub fn left(&self, t: f64) -> (f64, f64) {
        let u = ((t - self.since) / self.fade).clamp(0.0, 1.0);
        let fall = 30.0 * u * u * (1.0 - u) * (1.0 - u) / self.fade;
        (1.0 - u * u * u * (10.0 + u * (6.0 * u - 15.0)), -fall)
    }
}

/// What happens to the mesh at an end of a cable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// Nothing: the mesh as it is.
    None,
    /// The element at this end is split; the piece beside the old node gets this length [m]. New strains fade within
    /// this time [s].
    Split {
        /// 0 the start, 1 the end.
        end: usize,
        /// Length of the piece that goes on with the rest [m].
        keep: f64,
        /// Time in which prestrain fades [s].
        fade: f64,
    },
    /// The element at this end is merged with its neighbour.
    Merge {
        /// 0 the start, 1 the end.
        end: usize,
        /// Time in which prestrain fades [s].
        fade: f64,
    },
}

/// New meshes, by name of the part.
pub type Plan = BTreeMap<String, Mesh>;

/// What a change of mesh has done, for reports: all of it is zero for an ideal one.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Remeshed {
    /// Which event.
    pub name: String,
    /// When [s].
    pub t: f64,
    /// Change of kinetic energy [J].
    pub kinetic: f64,
    /// Change of potential energy [J].
    pub potential: f64,
    /// Change of momentum [kg m/s].
    pub momentum: [f64; 3],
    /// Tension at the end, before and after [N].
    pub tension: [f64; 2],
}

impl Remeshed {
    /// Largest jump of momentum in any direction [kg m/s].
    pub fn impulse(&self) -> f64 {
        self.momentum.iter().map(|p| p * p).sum::<f64>().sqrt()
    }
    /// Jump of the tension [N].
    pub fn jump(&self) -> f64 {
        self.tension[1] - self.tension[0]
    }
}
