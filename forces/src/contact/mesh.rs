//! Surfaces of triangles: what makes one fit for contact, and the distance to it.

use super::shape::Gap;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQueryWithLocation;
use parry3d_f64::shape::{TriMesh, TriMeshFlags, TrianglePointLocation};
use parry3d_f64::transformation::try_convex_hull;
use ropewalk_core::rotation::{cross, times};
use ropewalk_core::{BuildError, V3, dot};
use std::collections::{BTreeMap, HashMap};
use std::fmt;

/// More triangles are refused: no contact with a cable needs such detail.
pub const MOST_TRIANGLES: usize = 2_000_000;

/// Pairs of triangles and corners that are looked at to see whether a mesh is convex.
const MOST_COMPARED: usize = 4_000_000;
/// What lies in one plane but for this part of its size is flat.
const FLAT: f64 = 1e-9;

/// A surface of triangles whose normals point outwards, counter-clockwise.
///
/// The distance to it is that to its nearest triangle, edge or corner, found through a tree of boxes; it is exact, and
/// so is its derivative, but the normal jumps where another triangle becomes the nearest one. A point touches it at one
/// place only: in a sharp valley the nearer side holds it.
pub struct Mesh {
    surface: TriMesh,
    least: V3<f64>,
    most: V3<f64>,
    dropped: usize,
    convex: bool,
}

impl fmt::Debug for Mesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Mesh of {} triangles", self.surface.num_triangles())
    }
}

/// Corners and triangles as they come from a file.
#[derive(Clone, Debug, Default)]
pub struct Soup {
    /// Corners [m].
    pub corners: Vec<V3<f64>>,
    /// Three corners each.
    pub triangles: Vec<[u32; 3]>,
}

fn to_parry(x: &V3<f64>) -> Vector {
    Vector::new(x[0], x[1], x[2])
}

fn from_parry(x: Vector) -> V3<f64> {
    [x.x, x.y, x.z]
}

fn minus(a: &V3<f64>, b: &V3<f64>) -> V3<f64> {
    std::array::from_fn(|i| a[i] - b[i])
}

impl Soup {
    /// Adds a triangle whose corners may be there already.
    pub fn push(&mut self, corners: [V3<f64>; 3], known: &mut HashMap<[u64; 3], u32>) {
        let triangle = corners.map(|x| {
            // -0 and 0 are the same place
            let x = x.map(|x| x + 0.0);
            *known.entry(x.map(f64::to_bits)).or_insert_with(|| {
                self.corners.push(x);
                self.corners.len() as u32 - 1
            })
        });
        self.triangles.push(triangle);
    }

    /// Scales and turns all corners.
    #[must_use]
    pub fn placed(mut self, scale: f64, turn: &[V3<f64>; 3]) -> Self {
        for x in &mut self.corners {
            *x = times(turn, &x.map(|x| scale * x));
        }
        self
    }

    fn area(&self, t: &[u32; 3]) -> (V3<f64>, f64) {
        let [a, b, c] = t.map(|k| self.corners[k as usize]);
        let (ab, ac, bc) = (minus(&b, &a), minus(&c, &a), minus(&c, &b));
        (cross(&ab, &ac), dot(&ab, &ab).max(dot(&ac, &ac)).max(dot(&bc, &bc)))
    }

    fn volume(&self) -> f64 {
        let of = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|k| minus(&self.corners[k as usize], &self.corners[0]));
            dot(&a, &cross(&b, &c)) / 6.0
        };
        self.triangles.iter().map(of).sum()
    }

    /// Whether no corner is outside of any triangle; large ones are taken to be not.
    fn convex(&self, least: V3<f64>, most: V3<f64>) -> bool {
        if self.triangles.len() * self.corners.len() > MOST_COMPARED {
            return false;
        }
        let size = minus(&most, &least);
        let slack = FLAT * dot(&size, &size).sqrt();
        self.triangles.iter().all(|t| {
            let normal = unit(&self.area(t).0);
            let level = dot(&normal, &self.corners[t[0] as usize]);
            self.corners.iter().all(|x| dot(&normal, x) <= level + slack)
        })
    }

    /// What keeps it from being the surface of a solid, or with `open` from having an outer side.
    fn check(&self, open: bool) -> Result<(), String> {
        if self.triangles.is_empty() {
            return Err("it holds no triangles".into());
        }
        if self.triangles.len() > MOST_TRIANGLES {
            return Err(format!(
                "it has {} triangles, more than the {MOST_TRIANGLES} that contact takes: simplify it to a few thousand \
                 (in Blender, Decimate; in MeshLab, Quadric Edge Collapse), which is finer than a cable feels",
                self.triangles.len()
            ));
        }
        if let Some(x) = self.corners.iter().flatten().find(|x| !x.is_finite()) {
            return Err(format!("a corner of it has the coordinate {x}"));
        }
        // how often each edge is run along, in the one direction and in the other
        let mut runs: BTreeMap<(u32, u32), [u32; 2]> = BTreeMap::new();
        for t in self.triangles.iter().filter(|t| !pinched(t)) {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                runs.entry((a.min(b), a.max(b))).or_default()[usize::from(a > b)] += 1;
            }
        }
        let place = |e: &(u32, u32)| {
            let [x, y, z] = self.corners[e.0 as usize];
            format!("[{x:.4}, {y:.4}, {z:.4}]")
        };
        let twisted: Vec<_> = runs.iter().filter(|(_, n)| n[0] + n[1] == 2 && n[0] != n[1]).collect();
        if let Some((edge, _)) = twisted.first() {
            return Err(format!(
                "the triangles on both sides of {} of its edges, one at {}, have normals to opposite sides: make them \
                 consistent (in Blender, Recalculate Outside)",
                twisted.len(),
                place(edge)
            ));
        }
        if open {
            return Ok(());
        }
        let holes: Vec<_> = runs.iter().filter(|(_, n)| n[0] != n[1]).collect();
        if let Some((edge, _)) = holes.first() {
            return Err(format!(
                "it has holes: {} of its {} edges, one at {}, have a triangle on one side only, so there is no inside. \
                 Close them, or set `open = true` if it is a surface such as a sea floor, whose outer side is the one \
                 that its normals point to",
                holes.len(),
                runs.len(),
                place(edge)
            ));
        }
        if !(self.volume() > 0.0) {
            return Err("it is turned inside out: its normals point inwards. Flip them".into());
        }
        Ok(())
    }
}

fn unit(x: &V3<f64>) -> V3<f64> {
    let size = dot(x, x).sqrt();
    x.map(|x| x / size)
}

/// Whether two corners of a triangle are the same: it has neither area nor edges.
fn pinched(t: &[u32; 3]) -> bool {
    t[0] == t[1] || t[1] == t[2] || t[2] == t[0]
}

impl Mesh {
    /// Makes a surface of triangles. Those without area are left out.
    ///
    /// # Errors
    /// No triangles or too many, corners that aren't finite, normals to both sides, and unless `open`: holes, or all
    /// normals inwards.
    pub fn new(mut soup: Soup, open: bool) -> Result<Self, BuildError> {
        soup.check(open).map_err(BuildError::new)?;
        let before = soup.triangles.len();
        let kept: Vec<[u32; 3]> = soup
            .triangles
            .iter()
            .filter(|t| {
                let (area, size) = soup.area(t);
                dot(&area, &area).sqrt() > 1e-12 * size
            })
            .copied()
            .collect();
        soup.triangles = kept;
        let dropped = before - soup.triangles.len();
        let (mut least, mut most) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for x in soup.triangles.iter().flatten().map(|&k| &soup.corners[k as usize]) {
            for i in 0..3 {
                least[i] = least[i].min(x[i]);
                most[i] = most[i].max(x[i]);
            }
        }
        let convex = !open && soup.convex(least, most);
        let corners = soup.corners.iter().map(to_parry).collect();
        let surface = TriMesh::with_flags(corners, soup.triangles, TriMeshFlags::ORIENTED)
            .map_err(|e| BuildError::new(e.to_string()))?;
        Ok(Mesh { surface, least, most, dropped, convex })
    }

    /// The convex hull of points.
    ///
    /// # Errors
    /// Points that don't span a volume.
    pub fn hull(points: &[V3<f64>]) -> Result<Self, BuildError> {
        let message = "these points span no volume: a hull needs four points that aren't in one plane";
        let flat = || BuildError::new(message);
        if points.len() < 4 {
            return Err(flat());
        }
        let points: Vec<Vector> = points.iter().map(to_parry).collect();
        let (corners, triangles) = try_convex_hull(&points).map_err(|_| flat())?;
        let soup = Soup { corners: corners.into_iter().map(from_parry).collect(), triangles };
        let size = soup.corners.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
        if !(soup.volume() > 1e-9 * size.powi(3)) {
            return Err(flat());
        }
        Mesh::new(soup, false)
    }

    /// Its corners [m], and the numbers of the corners of each triangle.
    pub fn surface(&self) -> (Vec<V3<f64>>, Vec<[u32; 3]>) {
        let corners = self.surface.vertices().iter().map(|x| from_parry(*x)).collect();
        (corners, self.surface.indices().to_vec())
    }

    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.surface.num_triangles()
    }

    /// How many triangles had no area and were left out.
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    /// Whether it is known to be convex.
    pub(crate) fn convex(&self) -> bool {
        self.convex
    }

    /// Zero where all triangles that may be nearer than `reach` to what is within `way` of a point lie in one plane, or
    /// the mesh is convex; else infinite, since there may be a valley.
    pub(crate) fn hollow(&self, x: &V3<f64>, way: f64, reach: f64) -> f64 {
        if self.convex {
            return 0.0;
        }
        let far = way + reach;
        let (x, far) = (to_parry(x), Vector::new(far, far, far));
        let around = Aabb::new(x - far, x + far);
        let mut plane: Option<(V3<f64>, f64)> = None;
        let slack = FLAT * dot(&self.most, &self.most).max(dot(&self.least, &self.least)).sqrt();
        for k in self.surface.bvh().intersect_aabb(&around) {
            let triangle = self.surface.triangle(k);
            let corners = [triangle.a, triangle.b, triangle.c].map(from_parry);
            let (normal, level) = *plane.get_or_insert_with(|| {
                let normal = unit(&cross(&minus(&corners[1], &corners[0]), &minus(&corners[2], &corners[0])));
                (normal, dot(&normal, &corners[0]))
            });
            if corners.iter().any(|x| (dot(&normal, x) - level).abs() > slack) {
                return f64::INFINITY;
            }
        }
        0.0
    }

    /// How far a point is from the box around the mesh, squared, and the way from there.
    fn outside_box(&self, x: &V3<f64>) -> (f64, V3<f64>) {
        let way: V3<f64> = std::array::from_fn(|i| x[i] - x[i].clamp(self.least[i], self.most[i]));
        (dot(&way, &way), way)
    }

    /// The surface as seen from a point, if it is nearer than `reach`. Inside the box around it, it is found however
    /// far away.
    pub(crate) fn gap(&self, x: &V3<f64>, reach: f64) -> Option<Gap> {
        let (square, _) = self.outside_box(x);
        if !(square < reach * reach) {
            return None;
        }
        let most = if square > 0.0 && reach.is_finite() { reach } else { f64::MAX };
        let (found, (k, place)) =
            self.surface.project_local_point_and_get_location_with_max_dist(to_parry(x), false, most)?;
        let way = minus(x, &from_parry(found.point));
        let length = dot(&way, &way).sqrt();
        let triangle = self.surface.triangle(k);
        let corners = [triangle.a, triangle.b, triangle.c].map(from_parry);
        if length < 1e-9 * dot(x, x).sqrt().max(f64::MIN_POSITIVE) {
            // on the surface, where the way to it has no direction
            let area = cross(&minus(&corners[1], &corners[0]), &minus(&corners[2], &corners[0]));
            let size = dot(&area, &area).sqrt();
            return Some(Gap::flat(0.0, area.map(|a| a / size)));
        }
        let side = if found.is_inside { -1.0 } else { 1.0 };
        let (distance, normal) = (side * length, way.map(|w| side * w / length));
        let gap = match place {
            TrianglePointLocation::OnVertex(_) => Gap::round(distance, normal, 1.0 / distance),
            TrianglePointLocation::OnEdge(e, _) => {
                let (a, b) = [(0, 1), (1, 2), (2, 0)][e as usize];
                let edge = minus(&corners[b], &corners[a]);
                let across = cross(&edge, &normal);
                let size = dot(&across, &across).sqrt();
                let bend = (1.0 / distance, across.map(|a| a / size));
                Gap { distance, normal, bends: [bend, (0.0, [0.0; 3])] }
            }
            _ => Gap::flat(distance, normal),
        };
        (gap.distance < reach).then_some(gap)
    }

    /// As [`Mesh::gap`] where the point is in the box around it; else the distance to that box.
    pub(crate) fn at_least(&self, x: &V3<f64>) -> Option<Gap> {
        let (square, way) = self.outside_box(x);
        if square > 0.0 {
            let distance = square.sqrt();
            return Some(Gap::flat(distance, way.map(|w| w / distance)));
        }
        self.gap(x, f64::INFINITY)
    }
}
