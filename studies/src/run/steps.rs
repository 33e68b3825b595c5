//! How long steps were over time and what limited them, in groups that grow as the run goes on.

use ropewalk_core::integrator::Limit;
use ropewalk_report::Steps;
use serde::{Deserialize, Serialize};

/// Groups are joined in pairs when there are twice as many as these.
const GROUPS: usize = 1000;
const CAUSES: usize = Limit::ALL.len();

/// Some steps that follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Group {
    t: f64,
    least: f64,
    greatest: f64,
    counts: [u32; CAUSES],
}

impl Group {
    const EMPTY: Group = Group { t: 0.0, least: f64::INFINITY, greatest: 0.0, counts: [0; CAUSES] };

    fn join(&mut self, later: &Group) {
        self.t = later.t;
        self.least = self.least.min(later.least);
        self.greatest = self.greatest.max(later.greatest);
        self.counts.iter_mut().zip(later.counts).for_each(|(n, m)| *n = n.saturating_add(m));
    }

    /// What limited most of them.
    fn cause(&self) -> usize {
        (0..CAUSES).rev().max_by_key(|k| self.counts[*k]).unwrap_or(0)
    }
}

/// The course of the steps of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct StepCourse {
    groups: Vec<Group>,
    /// How many steps make a group, and how many the last one has.
    size: u32,
    filled: u32,
    last: Group,
}

impl Default for StepCourse {
    fn default() -> Self {
        StepCourse { groups: Vec::new(), size: 1, filled: 0, last: Group::EMPTY }
    }
}

impl StepCourse {
    /// Takes an accepted step of size `h` that has reached `t`.
    pub fn push(&mut self, t: f64, h: f64, limit: Limit) {
        let last = &mut self.last;
        (last.t, last.least, last.greatest) = (t, last.least.min(h), last.greatest.max(h));
        last.counts[limit as usize] += 1;
        self.filled += 1;
        if self.filled < self.size {
            return;
        }
        self.groups.push(self.last);
        (self.last, self.filled) = (Group::EMPTY, 0);
        if self.groups.len() == 2 * GROUPS {
            self.groups = self.groups.chunks(2).map(joined).collect();
            self.size *= 2;
        }
    }

    /// For pages and files; `counts` are those of all steps, by cause.
    pub fn steps(&self, counts: &[u64]) -> Option<Steps> {
        let open = (self.filled > 0).then_some(self.last);
        let groups: Vec<Group> = self.groups.iter().copied().chain(open).collect();
        (!groups.is_empty()).then(|| Steps {
            t: groups.iter().map(|g| g.t).collect(),
            least: groups.iter().map(|g| g.least).collect(),
            greatest: groups.iter().map(|g| g.greatest).collect(),
            cause: groups.iter().map(Group::cause).collect(),
            causes: Limit::ALL.iter().map(|limit| limit.word().to_string()).collect(),
            counts: counts.to_vec(),
        })
    }
}

fn joined(pair: &[Group]) -> Group {
    let mut all = Group::EMPTY;
    pair.iter().for_each(|group| all.join(group));
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_steps_become_few_groups_that_lose_no_extreme() {
        let mut course = StepCourse::default();
        for k in 0..100_000 {
            let limit = if k % 3 == 0 { Limit::Newton } else { Limit::Force };
            let h = if k == 54_321 { 9.0 } else { 1.0 + f64::from(k % 7) };
            course.push(f64::from(k), h, limit);
        }
        let steps = course.steps(&[0; CAUSES]).unwrap();
        assert!((GROUPS..2 * GROUPS).contains(&steps.t.len()), "{}", steps.t.len());
        assert_eq!(steps.t.last(), Some(&99_999.0));
        assert_eq!(steps.greatest.iter().copied().fold(0.0, f64::max), 9.0);
        assert!(steps.t.windows(2).all(|w| w[0] < w[1]) && steps.least.iter().all(|h| *h >= 1.0));
        assert!(steps.cause.iter().all(|k| steps.causes[*k] == "force error"));
        assert!(StepCourse::default().steps(&[]).is_none());
    }
}
