//! What the error of a run hangs on, where tighter steps or a finer mesh change it far more than they should.
//!
//! A finer mesh is one of the runs of the certificate already. What tighter steps change may come of the steps, of what
//! Newton's method leaves in each of them, or of the motion, which makes more of every error than it was. Runs that are
//! solved to the end tell them apart: with the same steps, with the tighter ones, and with tighter ones again.

use super::{Certificate, FAR, Trials, differences, moved};
use crate::error::Error;
use crate::study::{Axes, Measured, Settings, Target, on_all_cores};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// What an error hangs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cause {
    /// What Newton's method leaves in every step.
    Newton,
    /// Steps that are too long.
    Steps,
    /// A mesh that is too coarse.
    Mesh,
    /// The motion, in which small errors grow.
    Motion,
}

/// Tolerance of Newton's method, in parts of the scene's own, that solves to the end.
const SOLVED: f64 = 1e-3;
/// Of two changes one explains the other if it is more than this part of it.
const EXPLAINS: f64 = 0.5;

impl Cause {
    /// What it is and what helps, for people.
    pub(super) fn text(self) -> &'static str {
        match self {
            Cause::Newton => {
                "this is what Newton's method leaves in every step: solved to the end, the same steps agree with tighter \
                 ones. Take a smaller `newton_tolerance`"
            }
            Cause::Steps => {
                "the steps are too long: tighter ones come together. Take a smaller `tolerance`, or a smaller `h`"
            }
            Cause::Mesh => "the mesh is too coarse: take more `elements`",
            Cause::Motion => {
                "small errors grow in this motion, however tight the steps: look at an earlier time, or at means"
            }
        }
    }
}

/// The largest change between two runs, of positions and of records.
fn change(records: &[Target], a: &Measured, b: &Measured) -> f64 {
    let positions = moved(a, b).unwrap_or(0.0);
    let records = records.iter().map(|target| differences(target, a, b).unwrap_or(f64::INFINITY));
    // a NaN counts as the largest
    records.fold(positions, |m, x| if x <= m { m } else { x })
}

/// Looks for the cause of what a certificate found; none if nothing is far off, or if it was stopped.
///
/// # Errors
/// Threads that can't be had.
pub(super) fn find(
    trials: &Trials<'_>,
    settings: &Settings,
    records: &[Target],
    certificate: &Certificate,
) -> Result<Option<Cause>, Error> {
    let far = FAR * certificate.tolerance;
    let largest = |all: &mut dyn Iterator<Item = f64>| all.fold(0.0, |m: f64, x| if x <= m { m } else { x });
    let by_mesh = largest(&mut certificate.records.iter().filter_map(|c| c.mesh));
    let by_steps =
        largest(&mut certificate.records.iter().filter_map(|c| c.step).chain(certificate.positions));
    if by_mesh > far && by_mesh >= by_steps {
        return Ok(Some(Cause::Mesh));
    }
    let (Some(stepping), true) = (settings.stepping, by_steps > far) else { return Ok(None) };
    let solved = Settings { newton: settings.newton.map(|n| SOLVED * n), ..*settings };
    let (tight, tighter) = (Axes::tighter(stepping), Axes::tighter(Axes::tighter(stepping)));
    let wanted = [
        *settings,
        solved,
        settings.stepped(Some(tight)),
        solved.stepped(Some(tight)),
        solved.stepped(Some(tighter)),
    ];
    let done = on_all_cores(|| trials.get(&wanted))?;
    let Some(runs) = done.into_iter().collect::<Option<Vec<Arc<Measured>>>>() else { return Ok(None) };
    let [own, solved, tight, solved_tight, solved_tighter] = &runs[..] else { return Ok(None) };
    let between = |a: &Measured, b: &Measured| change(records, a, b);
    let by_newton = between(own, solved);
    let first = between(solved, solved_tight);
    let second = between(solved_tight, solved_tighter);
    let all = between(own, tight);
    Ok(Some(match () {
        () if by_newton > EXPLAINS * all && first <= EXPLAINS * all => Cause::Newton,
        () if second <= EXPLAINS * first => Cause::Steps,
        () => Cause::Motion,
    }))
}
