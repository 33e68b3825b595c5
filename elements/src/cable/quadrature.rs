//! Quadrature rules on `ξ ∈ [0, 1]`, with the shape functions at their points.

/// A quadrature point, and the natural shape functions there.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// Place in the element, `x/L`.
    pub xi: f64,
    /// Weight; the weights of a rule add up to 1.
    pub w: f64,
    /// `r' = φ₀ Δ + φ₁ α + φ₂ β`, with `φ₀ = 1`.
    pub phi: [f64; 3],
    /// `r'' = (ψ₁ α + ψ₂ β)/L`.
    pub psi: [f64; 2],
}

impl Point {
    /// The point at `xi` with weight `w`.
    pub const fn new(xi: f64, w: f64) -> Self {
        let phi = [1.0, (1.0 - xi) * (1.0 - 3.0 * xi), xi * (3.0 * xi - 2.0)];
        Point { xi, w, phi, psi: [6.0 * xi - 4.0, 6.0 * xi - 2.0] }
    }
}

/// The one "point" of a strain that is an average over the element: it sees `Δ` alone.
pub const WHOLE: [Point; 1] = [Point { xi: 0.5, w: 1.0, phi: [1.0, 0.0, 0.0], psi: [0.0, 0.0] }];

/// A quadrature rule: a type, that makes a kernel of its own, or [`Points`], which serve any rule.
pub trait Quadrature: Copy + Send + Sync + 'static {
    /// Short name, for labels.
    fn label(self) -> &'static str;
    /// Its points in ascending order.
    fn points(self) -> &'static [Point];
}

/// A rule that is chosen at run time.
#[derive(Clone, Copy, Debug)]
pub struct Points {
    label: &'static str,
    points: &'static [Point],
}

impl Points {
    /// Those of this rule.
    pub fn of(rule: impl Quadrature) -> Self {
        Points { label: rule.label(), points: rule.points() }
    }
}

impl Quadrature for Points {
    fn label(self) -> &'static str {
        self.label
    }
    #[inline(always)]
    fn points(self) -> &'static [Point] {
        self.points
    }
}

/// Most points of any rule here.
pub const MOST: usize = 5;

macro_rules! rule {
    ($(#[$doc:meta])* $name:ident, $label:literal, $(($x:expr, $w:expr)),+) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name;
        impl $name {
            /// Its points in ascending order.
            pub const POINTS: &'static [Point] = &[$(Point::new($x, $w)),+];
        }
        impl Quadrature for $name {
            fn label(self) -> &'static str {
                $label
            }
            #[inline(always)]
            fn points(self) -> &'static [Point] {
                Self::POINTS
            }
        }
    };
}

rule!(
    /// Gauss, 2 points: exact for cubics.
    Gauss2, "g2",
    (0.211_324_865_405_187_1, 0.5),
    (0.788_675_134_594_812_9, 0.5)
);
rule!(
    /// Gauss, 3 points: exact to degree 5.
    Gauss3, "g3",
    (0.112_701_665_379_258_31, 5.0 / 18.0),
    (0.5, 4.0 / 9.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0)
);
rule!(
    /// Gauss, 4 points: exact to degree 7, hence for the consistent mass.
    Gauss4, "g4",
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_9, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93)
);
rule!(
    /// Gauss, 5 points: exact to degree 9, hence for the Green strain energy of a cubic.
    Gauss5, "g5",
    (0.046_910_077_030_668_004, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 64.0 / 225.0),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54)
);
rule!(
    /// Lobatto, both ends and the middle (Simpson's rule): exact for cubics.
    Lobatto3, "lob3",
    (0.0, 1.0 / 6.0),
    (0.5, 2.0 / 3.0),
    (1.0, 1.0 / 6.0)
);

/// Which quadrature rule integrates which part of the strain energy.
pub trait Rule: Copy + Send + Sync + 'static {
    /// For the longitudinal part.
    type Axial: Quadrature;
    /// For the transverse part.
    type Bending: Quadrature;
    /// Name, for labels.
    fn label(self) -> &'static str;
    /// For the longitudinal part.
    fn axial(self) -> Self::Axial;
    /// For the transverse part.
    fn bending(self) -> Self::Bending;
}

/// Five Gauss points for both parts. Locks: an element that bends can't keep its axial strain at zero everywhere,
/// and for `EA L²/EI ≫ 1` that makes it far too stiff in bending.
#[derive(Clone, Copy, Debug)]
pub struct Full;
impl Rule for Full {
    type Axial = Gauss5;
    type Bending = Gauss5;
    fn label(self) -> &'static str {
        "full"
    }
    #[inline(always)]
    fn axial(self) -> Gauss5 {
        Gauss5
    }
    #[inline(always)]
    fn bending(self) -> Gauss5 {
        Gauss5
    }
}

/// Axial strain at the three Lobatto points, curvature at two Gauss points: no locking, and no spurious modes
/// (two Gauss points for the axial strain would leave one). The reduced rule of Gerstmayr & Irschik, J. Sound
/// Vib. 318 (2008), as Exudyn uses it.
#[derive(Clone, Copy, Debug)]
pub struct LockingFree;
impl Rule for LockingFree {
    type Axial = Lobatto3;
    type Bending = Gauss2;
    fn label(self) -> &'static str {
        "locking-free"
    }
    #[inline(always)]
    fn axial(self) -> Lobatto3 {
        Lobatto3
    }
    #[inline(always)]
    fn bending(self) -> Gauss2 {
        Gauss2
    }
}
