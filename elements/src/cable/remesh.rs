//! The mesh of a cable while it runs: elements that are born and swallowed where it feeds.

use super::flow::change::{self, Snapshot};
use super::flow::turning::Sections;
use super::part::CablePart;
use ropewalk_core::{At, Change, Mesh, MeshState, Prestrain, V3};

impl CablePart {
    /// Its mesh at an instant.
    fn snapshot(&self, at: &At<'_>) -> Result<Snapshot, String> {
        let three = |x: &[f64], i: usize| [x[i], x[i + 1], x[i + 2]];
        let nodes = 0..self.along.len();
        let mut snapshot = Snapshot {
            p: self.material(at.q).into_owned(),
            pd: nodes.map(|k| self.line.as_ref().map_or(0.0, |line| line.rate(k, at.v))).collect(),
            r: self.seats.iter().map(|s| three(at.q, s.0)).collect(),
            s: self.seats.iter().map(|s| three(at.q, s.0 + 3)).collect(),
            rd: self.seats.iter().map(|s| three(at.v, s.1)).collect(),
            sd: self.seats.iter().map(|s| three(at.v, s.1 + 3)).collect(),
            stress: vec![Vec::new(); self.along.len() - 1],
            sections: self.sections(at),
        };
        for k in self.layout.elements() {
            let mut stress = change::strains(self.model, &snapshot.dofs(k), snapshot.l(k))?;
            for p in self.prestrain.iter().filter(|p| p.element == k) {
                let left = p.left(at.t).0;
                stress.iter_mut().zip(&p.strain).for_each(|(s, p)| *s -= left * p);
            }
            snapshot.stress[k] = stress;
        }
        Ok(snapshot)
    }

    /// The sections at its nodes, of a cable with torsion.
    fn sections(&self, at: &At<'_>) -> Option<Sections> {
        let twisted = self.twisted.as_ref()?;
        let mut fed = [[0.0; 2]; 2];
        if let Some(line) = &self.line {
            for (end, b) in &line.boundaries {
                fed[*end] = [line.twist[*end] * (at.q[b.q] - b.home), line.twist[*end] * at.v[b.v]];
            }
        }
        Some(Sections {
            u: self.seats.iter().map(|s| [at.q[s.0 + 6], at.q[s.0 + 7], at.q[s.0 + 8]]).collect(),
            angle: self.seats.iter().map(|s| at.q[s.0 + 9]).collect(),
            spin: self.seats.iter().map(|s| at.v[s.1 + 6]).collect(),
            bubble: (0..self.along.len() - 1).map(|k| twisted.within(k, at)).collect(),
            fed,
        })
    }

    /// Whether node `k`, between two elements at an end that feeds, is inside the section there.
    fn is_inside(&self, end: usize, k: usize) -> bool {
        let [behind, before] = self.layout.holds();
        if end == 0 { k < behind } else { k > before }
    }

    /// Its mesh after a change, with the state to go on from; `None` where it may be interpolated.
    pub(super) fn remeshed(&self, what: Change, at: &At<'_>) -> Result<Option<Mesh>, String> {
        if self.line.is_none() && self.twisted.is_none() {
            return Ok(None);
        }
        let (mut new, last) = (self.snapshot(at)?, self.along.len() - 1);
        // elements whose strain goes on fading, by their new numbers, and those that are new
        let mut fading: Vec<Prestrain> =
            self.prestrain.iter().filter(|p| p.left(at.t).0 > 0.0).cloned().collect();
        let mut born: Vec<(usize, Vec<f64>)> = Vec::new();
        let mut time = 0.0;
        match (what, &self.line) {
            (Change::None, _) | (_, None) => {}
            (Change::Split { end, keep, fade }, Some(line)) => {
                let k = line.grows(end);
                let p = if end == 0 { new.p[k + 1] - keep } else { new.p[k] + keep };
                fading.retain(|p| p.element != k);
                fading.iter_mut().filter(|p| p.element > k).for_each(|p| p.element += 1);
                let [a, b] = new.split(k, p, self.model)?;
                (born, time) = (vec![(k, a), (k + 1, b)], fade);
            }
            (Change::Merge { end, fade }, Some(line)) => {
                let k = if end == 0 { line.grows(0) + 1 } else { line.grows(1) };
                if last < 2 + line.rides[0] + line.rides[1] || !self.is_inside(end, k) {
                    return Err("there is but one element left, which can't be merged".into());
                }
                // the slope at the end changes, which the element that rides beside it feels too
                let beside = match end {
                    0 => (k > 1).then(|| k - 2),
                    _ => (k + 1 < last).then_some(k),
                };
                fading.retain(|p| p.element + 1 != k && p.element != k);
                fading.iter_mut().filter(|p| p.element >= k).for_each(|p| p.element -= 1);
                (born, time) = (vec![(k - 1, new.merge(k, end, self.model)?)], fade);
                if let Some(beside) = beside {
                    fading.retain(|p| p.element != beside);
                    born.push((beside, new.stress[beside].clone()));
                }
            }
        }
        for (element, stress) in born {
            let strain = new.prestrain(element, &stress, self.model)?;
            fading.push(Prestrain { element, strain, since: at.t, fade: time });
        }
        let mut boundaries = [0.0; 2];
        if let Some(line) = &self.line {
            for (end, _) in &line.boundaries {
                boundaries[*end] = if *end == 0 { new.pd[0] } else { new.pd[new.pd.len() - 1] };
            }
        }
        let both = |a: &[V3<f64>], b: &[V3<f64>]| -> Vec<Vec<f64>> {
            a.iter().zip(b).map(|(a, b)| [*a, *b].concat()).collect()
        };
        let (mut q, mut v, mut inner) = (both(&new.r, &new.s), both(&new.rd, &new.sd), Vec::new());
        if let Some(sections) = new.sections {
            for (k, (q, v)) in q.iter_mut().zip(&mut v).enumerate() {
                q.extend(sections.u[k]);
                q.push(sections.angle[k]);
                v.push(sections.spin[k]);
            }
            inner = sections.bubble;
        }
        let state = MeshState { q, v, inner, boundaries };
        Ok(Some(Mesh { nodes: new.p, state: Some(state), prestrain: fading }))
    }
}
